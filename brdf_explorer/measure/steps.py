"""Long computations in short steps, whose results are kept."""

import numpy as np


class Steps:
    """What a generator returns, which yields after each short step. result: None until it is there."""

    def __init__(self, steps):
        self.steps, self.result = steps, None

    @np.errstate(under="ignore")  # in the tails of a density
    def step(self):
        try:
            next(self.steps)
        except StopIteration as end:
            if end.value is None:  # one that an error ended before is over, too
                raise RuntimeError("the computation has ended with an error") from end
            self.result = end.value

    def all(self):
        """The result, after all steps that are left."""
        while self.result is None:
            self.step()
        return self.result

"""Drawings that take long, in steps between which the window answers: a small preview, then strip by strip."""

import time
from collections import deque

import numpy as np

STEP = 0.012  # seconds of a step in the window: three panels and the window itself then answer within 50 ms
REDRAWN = 0.1  # seconds at least from one drawing to the next while what it shows gets better
MOST = 16  # pixels along a side that one of the preview stands for, at most


class Pace:
    """How a drawing by one program is divided, by how long it took before.

    gpu: its `pace` is how long a step may take; without one nothing is divided.
    weights: pixels to draw in each row (rows,), from the bottom.
    """

    def __init__(self, gpu, program, weights):
        self.gpu, self.program = gpu, program
        self.below = np.concatenate([[0.0], np.cumsum(weights)])

    def timed(self, draw, pixels):
        """Call draw() and keep what it takes by pixel."""
        self.gpu.ctx.finish()
        start = time.perf_counter()
        draw()
        self.gpu.ctx.finish()
        self.gpu.speeds[self.program] = (time.perf_counter() - start) / max(pixels, 1.0)

    def preview(self, draw):
        """Pixels along a side that one of a preview stands for, so that it is a step; 1 if the whole drawing is one.

        A program that was not drawn before is: draw(n) is called with the largest number, twice, because drivers compile at the
        first drawing.
        """
        if self.gpu.pace is None:
            return 1
        whole = self.below[-1]
        if self.program not in self.gpu.speeds:
            for _ in range(2):
                self.timed(lambda: draw(MOST), whole / MOST**2)
        over = self.gpu.speeds[self.program] * whole / self.gpu.pace
        return int(min(2 ** np.ceil(np.log2(max(over, 1.0)) / 2), MOST))

    def strips(self, draw, width):
        """Call draw(box) for strips of rows from the bottom up, each a step; yield whether it was the last.

        box: left, bottom, right, top in pixels; None if all is one step.
        """
        rows = len(self.below) - 1
        if self.gpu.pace is None:
            draw(None)
            yield True
            return
        bottom = 0
        while bottom < rows:
            reach = self.below[bottom] + self.gpu.pace / self.gpu.speeds[self.program]
            top = max(int(np.searchsorted(self.below, reach, "right")) - 1, bottom + 1)
            self.timed(lambda box=(0, bottom, width, top): draw(box), self.below[top] - self.below[bottom])
            bottom = top
            yield bottom == rows


def chords(height, radius):
    """Pixels of each of `height` rows (height,) that lie within a disc about their middle."""
    y = np.arange(height) + 0.5 - height / 2
    return 2 * np.sqrt(np.maximum(radius**2 - y**2, 0.0))


def in_turn(gpu, runs):
    """Advance generators, {name: generator}, in turns; yield ({name: what it gave last}, done) whenever a step's time is over.

    Where steps have no time to keep, after each round.
    """
    queue, latest = deque(runs.items()), {}
    while queue:
        start, left = time.perf_counter(), len(queue)
        while queue and (left > 0 if gpu.pace is None else time.perf_counter() - start < gpu.pace):
            name, run = queue.popleft()
            found = next(run, None)
            if found is not None:
                latest[name] = found
                queue.append((name, run))
            if gpu.pace is not None:
                gpu.ctx.finish()
            left -= 1
        yield dict(latest), not queue

"""Means of estimates, each with its standard error: f of a stochastic model by many walks."""

from typing import NamedTuple

import numpy as np

WALKS = 4096
"""Estimates of a mean, unless said otherwise."""
BATCH = 65536
"""Estimates that are made in one call, at most, if there are no more directions."""


class Mean(NamedTuple):
    """A mean and its standard error, arrays of one shape."""

    value: np.ndarray
    error: np.ndarray


class Running:
    """Mean and standard error of arrays that come in groups."""

    def __init__(self):
        self.count, self.value, self.squares = 0, 0.0, 0.0

    def add(self, values):
        """Arrays (n, ...) of estimates. Squares are of deviations from means, so that nothing cancels (Chan et al. 1983)."""
        n, total = len(values), self.count + len(values)
        mean = np.mean(values, axis=0, dtype=float)
        with np.errstate(under="ignore"):
            squares = np.sum((values - mean) ** 2, axis=0, dtype=float)
            off = mean - self.value
            self.squares = self.squares + squares + off * off * (self.count * n / total)
            self.value = self.value + off * (n / total)
        self.count = total

    def mean(self):
        """The Mean so far; of one array the error is infinite."""
        n = self.count
        error = np.sqrt(self.squares / (n * (n - 1))) if n > 1 else np.full(np.shape(self.value), np.inf)
        return Mean(self.value, error)


def mean_f(evaluator, wo, wi, walks=WALKS):
    """The Mean of `walks` estimates f(wo, wi) of an evaluator, such as a model or its Shader: wo, wi (..., 3) -> (..., 3)."""
    wo, wi = np.broadcast_arrays(np.asarray(wo, dtype=float), np.asarray(wi, dtype=float))
    each = max(BATCH // max(wo[..., 0].size, 1), 1)
    running = Running()
    for done in range(0, walks, each):
        with np.errstate(under="ignore"):  # in the tails of a density
            running.add(evaluator.f(np.broadcast_to(wo, (min(each, walks - done), *wo.shape)), wi))
    return running.mean()

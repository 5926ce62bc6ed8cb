"""Integrals over the hemisphere of wi, by quadrature that follows the lobe; the directional albedo is one."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .grid import grid, spread
from .noise import Mean, Running

NODES, REPEATS = 24, 16
"""Rays, and directions a ray, of a grid of estimates, and how many of these are averaged."""


class Integral(NamedTuple):
    """A value by quadrature, and an estimate of its error.

    Where the tolerance is met it is the difference from the value with half as many rays and nodes. Elsewhere differences may
    shrink as n^-2 on average, as across a kink, and one be small by chance: the estimate is the geometric mean of the last two,
    or if they shrink slower than n^-4 the largest of all, each less a factor 4 for every doubling since.
    """

    value: np.ndarray
    error: np.ndarray


def albedo(model, wo, tolerance=1e-10, most=512):
    """Directional albedo of a model, the integral of f cos over wi: wo (..., 3) -> (..., 3). Arguments as `integral`."""
    return albedo_with_error(model, wo, tolerance, most).value


def albedo_with_error(model, wo, tolerance=1e-10, most=512):
    """The directional albedo as an Integral, value and error (..., 3).

    Of a stochastic model it is the mean over REPEATS grids of NODES rays, moved at random within their cells, with one estimate of
    f for each direction: without bias, and the error is the standard error.
    """
    wo = np.asarray(wo, dtype=float)
    if model.stochastic:
        found = [_averaged(model, w) for w in wo.reshape(-1, 3)]
        return Integral(*(np.array(part).reshape(wo.shape) for part in zip(*found, strict=True)))
    found = [
        integral(lambda o, i: model.f(o, i) * i[..., 2:], w, model.slopes(), tolerance, most) for w in wo.reshape(-1, 3)
    ]
    return Integral(*(np.array(part).reshape(wo.shape) for part in zip(*found, strict=True)))


def _averaged(model, wo):
    """The albedo of a stochastic model for one wo (3,)."""
    if wo[2] <= 0:
        return Mean(np.zeros(3), np.zeros(3))
    rng, running = np.random.default_rng(1), Running()
    grids, turns = [], []
    for _ in range(REPEATS):
        fraction, t = (np.arange(NODES) + rng.random((2, NODES))) / NODES
        psi, turn = spread(wo, model.slopes(), fraction)
        grids.append(grid(wo, model.slopes(), t, psi))
        turns.append(turn)
    wi, density = (np.stack([getattr(g, name) for g in grids]) for name in ("wi", "density"))
    with np.errstate(under="ignore"):
        weight = density * np.stack(turns)[..., None] * wi[..., 2] / NODES**2
        running.add(np.einsum("rptc,rpt->rc", model.f(wo, wi), weight))
    return running.mean()


def integral(function, wo, alpha, tolerance=1e-10, most=512):
    """The Integral of function(wo, wi) (..., n) over the solid angle of wi, for one wo (3,) above the horizon, else 0.

    Gauss-Legendre along the rays of `grid`, the trapezoidal rule around them: both converge exponentially for a smooth lobe
    and about as n^-2 across a kink. Both are doubled until two values differ by less than `tolerance`, or to `most` rays.
    """
    wo = np.asarray(wo, dtype=float)
    if wo[2] <= 0:
        zero = np.zeros(np.shape(function(wo, wo))[-1:])
        return Integral(zero, zero)
    n, before, difference, envelope = 32, None, 1.0, 0.0
    while True:
        g, weight = quadrature(wo, alpha, n)
        with np.errstate(under="ignore"):  # in the tails of a density
            value = np.einsum("ptc,pt->c", function(wo, g.wi), weight)
        if before is not None:
            last, difference = difference, np.abs(value - before)
            envelope = np.maximum(difference, envelope / 4)
            if np.all(difference <= tolerance) or 2 * n > most:
                chance = np.where(difference > last / 16, envelope, np.sqrt(difference * last))
                return Integral(value, np.where(difference <= tolerance, difference, chance))
        before, n = value, 2 * n


def quadrature(wo, alpha, n):
    """The Grid of n rays of n directions for one viewer wo (3,), and the solid angle that each stands for, sr (n, n)."""
    t, dt = gauss(n)
    psi, turn = spread(wo, alpha, (np.arange(n) + 0.5) / n)
    g = grid(wo, alpha, t, psi)
    return g, g.density * dt * (turn / n)[:, None]


@lru_cache(16)
def gauss(n):
    """Nodes and weights of Gauss-Legendre quadrature on [0, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    return 0.5 * (nodes + 1), 0.5 * weights

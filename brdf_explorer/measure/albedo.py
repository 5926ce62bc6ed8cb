"""Integrals over the hemisphere of wi, by quadrature that follows the lobe; the directional albedo is one."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .grid import Grid, grid, sides, spread
from .noise import Running

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
    """Directional albedo of a model, the integral of f |cos| over wi: wo (..., 3) -> (..., 3). Arguments as `integral`.

    Of radiance: what a viewer sees where both sides of the surface are in light of 1. `shares` has energies.
    """
    return albedo_with_error(model, wo, tolerance, most).value


def albedo_with_error(model, wo, tolerance=1e-10, most=512):
    """The directional albedo as an Integral, value and error (..., 3)."""
    return _integrals(lambda o, i: model.f(o, i) * np.abs(i[..., 2:]), model, wo, 3, tolerance, most)


def shares(model, wo, tolerance=1e-10, most=512):
    """The shares R, reflected, and T, transmitted, of the energy that arrives along wo (..., 3): an Integral of (..., 2, 3).

    T is n^2, of the far side over the near, times what the viewer sees of radiance 1 on the far side: by reciprocity.
    """
    wo = np.asarray(wo, dtype=float)

    def function(wo, wi):
        value = model.f(wo, wi) * np.abs(wi[..., 2:])
        crosses = (wo[2] > 0) != (wi[..., 2:] > 0)
        dense = (model.index() or 1.0) ** (2 * np.sign(wo[2]))
        return np.concatenate([np.where(crosses, 0.0, value), np.where(crosses, dense * value, 0.0)], axis=-1)

    found = _integrals(function, model, wo, 6, tolerance, most)
    return Integral(*(part.reshape(*wo.shape[:-1], 2, 3) for part in found))


def _integrals(function, model, wo, n, tolerance, most):
    """The Integral of function(wo, wi) (..., n) for viewers wo (..., 3): (..., n)."""
    wo = np.asarray(wo, dtype=float)
    if model.stochastic:
        found = [_averaged(function, w, n, model) for w in wo.reshape(-1, 3)]
    else:
        found = [integral(function, w, model.slopes(), tolerance, most, model.index()) for w in wo.reshape(-1, 3)]
    return Integral(*(np.array(part).reshape(*wo.shape[:-1], n) for part in zip(*found, strict=True)))


def _averaged(function, wo, n, model):
    """The Integral of a function of estimates for one wo (3,): its mean over REPEATS grids of NODES rays, whose places in their
    cells are drawn, with one estimate for each direction. So it has no bias, and its error is the standard error.
    """
    rng, running, total = np.random.default_rng(1), Running(), np.zeros((REPEATS, n))
    for side in sides(wo, model.slopes(), model.index()):
        grids, turns = [], []
        for _ in range(REPEATS):
            fraction, t = (np.arange(NODES) + rng.random((2, NODES))) / NODES
            psi, turn = spread(side.wo, side.alpha, fraction)
            grids.append(grid(side.wo, side.alpha, t, psi))
            turns.append(turn)
        wi, density = (np.stack([getattr(g, name) for g in grids]) for name in ("wi", "density"))
        with np.errstate(under="ignore"):  # in the tails of a density
            weight = density * np.stack(turns)[..., None] / NODES**2
            total += np.einsum("rptc,rpt->rc", function(wo, side.turned(wi)), weight)
    running.add(total)
    return Integral(*running.mean())


def integral(function, wo, alpha, tolerance=1e-10, most=512, index=None):
    """The Integral of function(wo, wi) (..., n) over the solid angle of wi, for one wo (3,); over the sides that `sides` names.

    Gauss-Legendre along the rays of `grid`, the trapezoidal rule around them: both converge exponentially for a smooth lobe
    and about as n^-2 across a kink. Both are doubled until two values differ by less than `tolerance`, or to `most` rays.
    """
    wo = np.asarray(wo, dtype=float)
    if not sides(wo, alpha, index):
        zero = np.zeros(np.shape(function(wo, wo))[-1:])
        return Integral(zero, zero)
    n, before, difference, envelope = 32, None, 1.0, 0.0
    while True:
        g, weight = quadrature(wo, alpha, n, index)
        with np.errstate(under="ignore"):  # in the tails of a density
            value = np.einsum("ptc,pt->c", function(wo, g.wi), weight)
        if before is not None:
            last, difference = difference, np.abs(value - before)
            envelope = np.maximum(difference, envelope / 4)
            if np.all(difference <= tolerance) or 2 * n > most:
                chance = np.where(difference > last / 16, envelope, np.sqrt(difference) * np.sqrt(last))
                return Integral(value, np.where(difference <= tolerance, difference, chance))
        before, n = value, 2 * n


def quadrature(wo, alpha, n, index=None):
    """The Grid of n rays of n directions for one viewer wo (3,), and the solid angle that each stands for, sr (n, n).

    With an index, as Model.index, n more rays are those of the other side of the surface.
    """
    t, dt = gauss(n)
    grids, weights = [], []
    for side in sides(wo, alpha, index):
        psi, turn = spread(side.wo, side.alpha, (np.arange(n) + 0.5) / n)
        g = grid(side.wo, side.alpha, t, psi)
        grids.append(Grid(side.turned(g.wi), g.density))
        weights.append(g.density * dt * (turn / n)[:, None])
    if len(grids) == 1:
        return grids[0], weights[0]
    return Grid(*(np.concatenate([getattr(g, a) for g in grids]) for a in ("wi", "density"))), np.concatenate(weights)


@lru_cache(16)
def gauss(n):
    """Nodes and weights of Gauss-Legendre quadrature on [0, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    return 0.5 * (nodes + 1), 0.5 * weights

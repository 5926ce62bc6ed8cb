"""Whether sample_f draws from pdf: Pearson's chi-square test, and the mean of its weights, which is the albedo."""

from typing import NamedTuple

import numpy as np

from ..lib.common import HORIZON, quotient
from ..lib.random import random2
from .albedo import gauss
from .grid import grid, place, sides, spread

PSI_BINS, T_BINS, NODES = 12, 12, 12
"""Bins, and nodes a bin each way: more bins would see finer faults, but large ones less, as the statistic's noise grows."""
FAR_NODES = 32
"""On the other side of a surface that transmits: there D ends inside of bins, where facets are on edge, for GGX by a step."""
POOL = 5.0
"""Bins that expect fewer samples are counted together, as the statistic's distribution needs."""


class ChiSquare(NamedTuple):
    """Pearson's statistic, its degrees of freedom, the chance of a larger one, and what is above the horizon, or off it.

    mass is the integral of pdf there, share the part of the samples.
    """

    statistic: float
    freedom: int
    p: float
    mass: float
    share: float
    samples: int


class Mean(NamedTuple):
    """A mean over points that are spread evenly, and its standard error from independent rotations of them.

    The error is never below the largest weight that there is over the number of points: what is rarer may not have been seen.
    """

    value: np.ndarray
    error: np.ndarray


def bins(model, wo):
    """Probability by model.pdf of each bin (sides, PSI_BINS, T_BINS) of wi, one viewer wo (3,): Gauss-Legendre inside each bin.

    A bin is an interval of psi by one of t on the grid that follows the lobe, so the horizon is the last bins' edge and no
    lobe is too sharp for them. They are finer near the peak (t = s^2) and where rays crowd.
    """
    edges = (np.arange(T_BINS + 1) / T_BINS) ** 2
    width = np.diff(edges)
    found = []
    for side in sides(wo, model.slopes(), model.index()):
        nodes = NODES if side.dense == 1 else FAR_NODES
        x, dx = gauss(nodes)
        t = (edges[:-1, None] + x * width[:, None]).ravel()
        psi, turn = spread(side.wo, side.alpha, (np.arange(PSI_BINS)[:, None] + x).ravel() / PSI_BINS)
        g = grid(side.wo, side.alpha, t, psi)
        with np.errstate(under="ignore"):  # in the tails of a density
            mass = model.pdf(wo, side.turned(g.wi)) * g.density
            mass *= (turn * np.tile(dx, PSI_BINS) / PSI_BINS)[:, None] * (width[:, None] * dx).ravel()
            found.append(mass.reshape(PSI_BINS, nodes, T_BINS, nodes).sum(axis=(1, 3)))
    return np.stack(found)


def chi_square(model, wo, n=50_000, seed=1, sample=None):
    """Test n directions drawn for one viewer wo (3,) against pdf: a ChiSquare. 50 000 show an alpha that is 5 % off.

    sample(wo, u) -> wi, weight is model.sample_f if not given; gpu.sample_f of the model is another. Directions on the
    horizon, and below it if the model does not transmit, are one bin more.
    """
    from scipy.stats import chi2

    wo = np.asarray(wo, dtype=float)
    u = np.random.default_rng(seed).integers(0, 2**24, (n, 2)) * 2.0**-24
    wi = np.asarray((sample or model.sample_f)(wo, u)[0], dtype=float)
    counts = []
    for side in sides(wo, model.slopes(), model.index()):
        seen = side.turned(wi[side.up * wi[:, 2] > HORIZON])
        t, psi = place(side.wo, side.alpha, seen)
        edges, _ = spread(side.wo, side.alpha, np.arange(1, PSI_BINS) / PSI_BINS)
        i = np.searchsorted(edges, psi)
        j = np.minimum((np.sqrt(t) * T_BINS).astype(int), T_BINS - 1)
        counts.append(np.bincount(i * T_BINS + j, minlength=PSI_BINS * T_BINS).astype(float))
    counts = np.concatenate(counts)
    mass = bins(model, wo).ravel()
    expected = n * np.append(mass, max(1 - mass.sum(), 0.0))
    observed = np.append(counts, n - counts.sum())
    observed, expected = pooled(observed, expected)
    statistic = float(np.sum((observed - expected) ** 2 / expected))
    freedom = len(expected) - 1
    p = float(chi2.sf(statistic, freedom)) if freedom else 1.0
    return ChiSquare(statistic, freedom, p, float(mass.sum()), float(counts.sum() / n), n)


def pooled(observed, expected):
    """Counts with those bins that expect fewer than POOL added up, in order of what they expect, to bins that do."""
    order = np.argsort(expected)
    observed, expected = observed[order], expected[order]
    small = int(np.searchsorted(expected, POOL))
    out, o, e = [], 0.0, 0.0
    for k in range(small):
        o, e = o + observed[k], e + expected[k]
        if e >= POOL:
            out.append((o, e))
            o = e = 0.0
    out += list(zip(observed[small:], expected[small:], strict=True))
    if o or e:  # what is left joins the least of the others
        first = out.pop(0) if out else (0.0, 0.0)
        out.append((first[0] + o, first[1] + e))
    return tuple(np.array(out).T)


def mean_weight(model, wo, points=1024, rotations=16, sample=None):
    """The Mean of sample_f's weights (3,) for one viewer wo (3,): an estimate of the albedo that shares nothing with f or pdf.

    Points of a Kronecker sequence, rotated at random; `sample` as for chi_square.
    """
    pixel = np.stack([np.arange(rotations), np.zeros(rotations)], axis=-1)[:, None]
    u = random2(pixel.astype(np.uint32), np.arange(points, dtype=np.uint32)[None], 1)
    weight = np.asarray((sample or model.sample_f)(np.asarray(wo, dtype=float), u)[1], dtype=float)
    means = weight.mean(axis=1)
    unseen = largest_weight(model, wo) / (points * rotations)
    return Mean(means.mean(axis=0), np.hypot(means.std(axis=0, ddof=1) / np.sqrt(rotations), unseen))


def largest_weight(model, wo, n=64):
    """The largest f cos / pdf (3,) for one viewer wo (3,), of n x n directions that follow the lobe."""
    found = []
    for side in sides(wo, model.slopes(), model.index()):
        psi, _ = spread(side.wo, side.alpha, (np.arange(n) + 0.5) / n)
        wi = side.turned(grid(side.wo, side.alpha, np.arange(n) / n, psi).wi)
        with np.errstate(under="ignore"):  # in the tails of a density
            found.append(quotient(model.f(wo, wi) * np.abs(wi[..., 2:]), model.pdf(wo, wi)[..., None]))
    return np.max(found, axis=(0, 1, 2))

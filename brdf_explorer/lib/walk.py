"""Steps of a random walk over Smith's microsurface. Heitz, Hanika, d'Eon and Dachsbacher 2016, "Multiple-Scattering Microfacet
BSDFs with the Smith Model".

Heights enter only by their distribution C1, and C1 only as depth = -log(C1), 0 above all facets: in it flights are exponential,
as in a volume (Dupuy, Heitz and d'Eon 2016, "Additional Progress Towards the Unification of Microfacet and Microflake
Theories"), and light that leaves along w is not met by a facet with probability exp(-depth Lambda(w)).

`area` is that of the facets visible from -w, projected along w: |w.z Lambda(w)| for a ray w that goes up or down.
"""

import numpy as np

from .common import quotient, split
from .transcendental import exp_precise, log_precise


def mean_exp(x):
    """(1 - exp(-x)) / x for x >= 0."""
    x = np.asarray(x, dtype=float)
    return np.where(x > 0, quotient(-np.expm1(-x), x), 1.0)


def flight(depth, w, area, u):
    """Depth (...) at which a ray w that begins at `depth` meets a facet; below 0 if it leaves. u (..., 2) in [0, 1)."""
    return depth + log_precise(1 - split(u)[0]) * split(w)[2] / area


def meets(depth, w, area):
    """Probability that a ray w that begins at `depth` meets a facet."""
    z = split(w)[2]
    rise = np.where(z > 0, z, 1.0)
    return np.where(z > 0, -np.expm1(-depth * area / rise), 1.0)


def passage(depth, w, area, wi, hidden):
    """Mean over the flights of a ray w that begins at `depth` of the probability that it meets a facet and that what goes on from
    there along wi, wi.z > 0, meets none; over wi.z.

    hidden is wi.z Lambda(wi). For depth = 0 it is G2 / (G1(wo) wi.z), wo = -w.
    """
    z, i = split(w)[2], split(wi)[2]
    difference = area * i - z * hidden
    leave = hidden / i
    down = exp_precise(-depth * leave) * area / np.where(z <= 0, difference, 1.0)
    rise = np.where(z > 0, z, 1.0)
    meet = area / rise
    with np.errstate(over="ignore"):
        x = np.abs(difference) / i * depth / rise
    lesser = exp_precise(-depth * np.minimum(leave, meet))
    far = x >= 1
    apart = lesser * -np.expm1(-x) * area / np.where(far, np.abs(difference), 1.0)
    near = lesser * np.where(far, 0.0, meet) * (depth / i) * mean_exp(np.where(far, 0.0, x))
    return np.where(z <= 0, down, np.where(far, apart, near))


def depth_below(depth):
    """Depth of the same height below the surface, where it is measured from the lowest facet up: -log(1 - C1)."""
    depth = np.asarray(depth, dtype=float)
    small = depth < 0.5
    return np.where(
        small,
        -log_precise(np.where(small, depth * mean_exp(depth), 1.0)),
        -np.log1p(-exp_precise(-np.where(small, 1.0, depth))),
    )

"""What white facets lose, 1 - E(w): the light that they reflect onto facets, which leaves after more than one reflection.

Fits by shaders/lib/derive_lost.py in lost_{ndf}_{shadowing}.py, in s = cos / (cos + alpha) and alpha; this is what these share.

Anisotropic facets are taken for isotropic ones of the root mean square of alpha, seen from where these have the same Lambda:
w.xy stretched by alpha. That errs by up to 0.05 of the light for GGX and 0.10 for Beckmann, at any ratio of the two alphas; for
GGX with separable shadowing by up to 0.09, and by 0.21 with directional where one alpha is 100 times the other.
Of Beckmann with the rational smith it is the exact one's, which differs by up to 3e-3.
"""

import numpy as np

from .common import length, split, vec


def alpha_mean(alpha):
    ax, ay = split(alpha)
    return np.sqrt(0.5 * (ax * ax + ay * ay))


def parts(w, alpha):
    """s and 1 - s (..., 2), each without cancellation."""
    x, y, z = split(w)
    ax, ay = split(alpha)
    steep = length(vec(ax * x, ay * y, alpha_mean(alpha) * z))
    return vec(z / (z + steep), steep / (z + steep))


def spline(f):
    """The weights (..., 3) of three neighbours in a quadratic spline, f in [0, 1] between the first two knots."""
    return vec(0.5 * (1 - f) * (1 - f), 0.5 + f * (1 - f), 0.5 * f * f)


def interpolated(table, x, y):
    """A quadratic spline of coefficients (n, m) at x, y in [0, 1]."""
    (i, u), (j, v) = map(_cell, (x, y), table.shape)
    near = np.stack([[table[i + p, j + q] for q in range(3)] for p in range(3)])
    return np.einsum("...p,pq...,...q->...", u, near, v)


def lost_by(table, power, w, alpha):
    """The fit at w (..., 3) and alpha (..., 2): s^power (1 - s)^2 times a spline of 1 - s (1 + alpha) and alpha."""
    a = alpha_mean(alpha)
    s, rest = split(parts(w, alpha))
    return s**power * rest * rest * interpolated(table, rest - a * s, a + 0 * s)


def lost_mean_by(table, alpha):
    """Its mean over directions, each weighted by its cosine: alpha^2 times a spline of the fourth root of alpha and of the root
    of the ratio of the two alphas."""
    ax, ay = split(alpha)
    a = alpha_mean(alpha)
    return interpolated(table, np.sqrt(np.sqrt(a)), np.sqrt(np.minimum(ax, ay) / np.maximum(ax, ay))) * a * a


def _cell(x, n):
    """The first of the coefficients that count at x, and their weights."""
    place = (n - 2) * x
    first = np.clip(place.astype(int), 0, n - 3)
    return first, spline(place - first)

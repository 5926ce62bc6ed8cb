"""Slot ndf: Beckmann, the normals of a surface with Gaussian heights. Beckmann and Spizzichino 1963; Walter et al. 2007,
Eq. 25. Anisotropic by stretching, as GGX.
"""

import numpy as np

from .beckmann import z_Lambda_beckmann
from .common import PI, dot, length, split
from .transcendental import exp_precise


def D(wm, alpha):
    """Density of microfacet area over normals, 1/sr; D cos integrates to 1. wm may have any length."""
    x, y, z = split(wm)
    ax, ay = split(alpha)
    # at a steeper normal exp(-slope^2) is 0 for any alpha <= 1, and slope^2 still finite here
    up = z > 1e-70 * length(wm)
    z = np.where(up, z, 1.0)
    density = exp_precise(-((x / (ax * z)) ** 2 + (y / (ay * z)) ** 2))
    c2 = z * z / dot(wm, wm)
    return np.where(up, density / (PI * ax * ay * c2 * c2), 0.0)


def visible_area(wo, alpha):
    """Area of the facets visible from wo, wo.z > 0, projected along wo: wo.z (1 + Lambda), the integral of D (wo . wm)+."""
    return split(wo)[2] + z_Lambda_beckmann(wo, alpha)

"""Slot ndf: Trowbridge-Reitz (GGX), an ellipsoid's normals. Trowbridge and Reitz 1975; Walter et al. 2007, Eq. 33.

Anisotropic by stretching: normals are remapped by 1/alpha, directions by alpha (Heitz 2014, section 5.3).
"""

import numpy as np

from .common import PI, dot, length, split, vec


def D(wm, alpha):
    """Density of microfacet area over normals, 1/sr; D cos integrates to 1. wm may have any length."""
    x, y, z = split(wm)
    ax, ay = split(alpha)
    s = (x / ax) ** 2 + (y / ay) ** 2 + z * z
    s = s / dot(wm, wm)
    return np.where(z > 0, 1 / (PI * ax * ay * s * s), 0.0)


def visible_area(wo, alpha):
    """Area of the facets visible from wo, wo.z > 0, projected along wo: wo.z (1 + Lambda), the integral of D (wo . wm)+."""
    x, y, z = split(wo)
    ax, ay = split(alpha)
    return 0.5 * (z + length(vec(ax * x, ay * y, z)))

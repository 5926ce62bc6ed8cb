"""Slot sampling: visible normals, D_visible = D (wo . wm)+ / visible_area.

Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", Listing 3.
"""

import numpy as np

from .common import TWO_PI, mirror, normalize, split, vec
from .ndf_ggx import visible_area


def sample_wi(wo, u, alpha):
    x, y, z = split(wo)
    ax, ay = split(alpha)
    u0, u1 = split(u)
    vx, vy, vz = split(normalize(vec(ax * x, ay * y, z)))
    phi = TWO_PI * u0
    q = u1 * (1 + vz)
    r = np.sqrt(q * (2 - q))
    wm = normalize(vec(ax * (r * np.cos(phi) + vx), ay * (r * np.sin(phi) + vy), (1 - u1) * (1 + vz)))
    return mirror(wo, wm)


def pdf_wi(wo, wi, density, alpha):
    return density / (4 * visible_area(wo, alpha))


def weight_wi(wo, wi, density, alpha):
    return visible_area(wo, alpha)

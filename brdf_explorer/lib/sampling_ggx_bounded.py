"""Slot sampling: visible normals less those that reflect below the horizon, as far as a smaller cap leaves them out.

Eto and Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections", Eq. 5. For wo above the horizon.
"""

import numpy as np

from .common import TWO_PI, length, mirror, normalize, split, vec
from .ndf_ggx import visible_area


def cut_of_cap(wo, alpha):
    """1 - k of Eq. 5, by which the cap's lower bound, -v.z, is scaled: as a product, for k -> 1 as alpha -> 0."""
    x, y, z = split(wo)
    a2 = np.min(alpha, axis=-1) ** 2
    s2 = (1 + length(vec(x, y))) ** 2
    return a2 * (s2 + z * z) / (s2 + a2 * z * z)


def sample_wi(wo, u, alpha):
    x, y, z = split(wo)
    ax, ay = split(alpha)
    u0, u1 = split(u)
    vx, vy, vz = split(normalize(vec(ax * x, ay * y, z)))
    cut = cut_of_cap(wo, alpha) * vz
    phi = TWO_PI * u0
    q = u1 * (1 + vz - cut)
    r = np.sqrt(q * (2 - q))
    wm = normalize(vec(ax * (r * np.cos(phi) + vx), ay * (r * np.sin(phi) + vy), (1 - u1) * (1 + vz - cut) + cut))
    return mirror(wo, wm)


def pdf_wi(wo, wi, density, alpha):
    return density / (4 * weight_wi(wo, wi, density, alpha))


def weight_wi(wo, wi, density, alpha):
    return visible_area(wo, alpha) - 0.5 * cut_of_cap(wo, alpha) * split(wo)[2]

"""Slot sampling: visible normals less those that reflect below the horizon, as far as a smaller cap leaves them out.

Eto and Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections", Eq. 5. For wo above the horizon.
"""

import numpy as np

from .caps import sum_with_cap
from .common import length, mirror, normalize, split, vec
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
    sum_x, sum_y, height = split(sum_with_cap(normalize(vec(ax * x, ay * y, z)), u, cut_of_cap(wo, alpha)))
    return mirror(wo, normalize(vec(ax * sum_x, ay * sum_y, height)))


def pdf_wi(wo, wi, density, alpha):
    return density / (4 * weight_wi(wo, wi, density, alpha))


def weight_wi(wo, wi, density, alpha):
    return visible_area(wo, alpha) - 0.5 * cut_of_cap(wo, alpha) * split(wo)[2]

"""Slot sampling: visible normals, D_visible = D (wo . wm)+ / visible_area.

Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", Listing 3.
"""

from .caps import sum_with_cap
from .common import mirror, normalize, split, vec
from .ndf_ggx import visible_area


def sample_wm(wo, u, alpha):
    """A visible normal; wo may lie below the horizon."""
    x, y, z = split(wo)
    ax, ay = split(alpha)
    sum_x, sum_y, height = split(sum_with_cap(normalize(vec(ax * x, ay * y, z)), u, 0.0))
    return normalize(vec(ax * sum_x, ay * sum_y, height))


def sample_wi(wo, u, alpha):
    return mirror(wo, sample_wm(wo, u, alpha))


def pdf_wi(wo, wi, density, alpha):
    return density / (4 * visible_area(wo, alpha))


def weight_wi(wo, wi, density, alpha):
    return visible_area(wo, alpha)

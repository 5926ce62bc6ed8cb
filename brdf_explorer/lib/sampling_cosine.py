"""Slot sampling: in proportion to the cosine, as for a diffuse surface; sampling_uniform.py says what the functions are."""

from .common import INV_PI, PI, split
from .warp import cosine_hemisphere


def sample_wi(wo, u, alpha):
    return cosine_hemisphere(u)


def pdf_wi(wo, wi, density, alpha):
    return INV_PI * split(wi)[2]


def weight_wi(wo, wi, density, alpha):
    return 0.25 * PI * density / split(wi)[2]

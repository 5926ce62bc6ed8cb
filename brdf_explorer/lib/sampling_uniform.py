"""Slot sampling: every direction above the horizon alike. It knows nothing of the material: the lobe is found by chance.

All files of the slot define three functions of wo and wi (..., 3) above the horizon, with `density` (...) for D at the facet's
normal: sample_wi draws directions to the light, which may lie below the horizon; pdf_wi is their density per solid angle; and
weight_wi is D / (4 pdf_wi), of which the weight of a sample is F G2 / wo.z times, in a form in which what cancels does.
"""

import numpy as np

from .common import INV_PI, PI
from .warp import uniform_hemisphere


def sample_wi(wo, u, alpha):
    return uniform_hemisphere(u)


def pdf_wi(wo, wi, density, alpha):
    return np.full(np.shape(density), 0.5 * INV_PI)


def weight_wi(wo, wi, density, alpha):
    return 0.5 * PI * density

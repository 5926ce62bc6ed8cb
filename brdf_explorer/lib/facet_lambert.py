"""Slot facet: f_mf of a facet that reflects as Lambert's law says, albedo / pi.

All files of the slot define four functions. facet_sharpness is the kappa of the integral in facets.py; facet_scale is what
f_mf is at the peak of that lobe, 1/sr; facet_wi draws a direction to the light, which may lie below the horizon, and facet_pdf
is its density per solid angle. Their last arguments are functions of the slots fresnel, ndf and sampling.
"""

import numpy as np

from .common import INV_PI, split
from .warp import cosine_hemisphere


def facet_sharpness(kappa):
    return np.zeros(np.shape(kappa))


def facet_scale(c, albedo, eta, k, kappa, F):
    return INV_PI * np.broadcast_to(albedo, (*np.shape(c), 3))


def facet_wi(wo, u, alpha, kappa, sample_wi):
    return cosine_hemisphere(u)


def facet_pdf(wo, wi, alpha, kappa, D, pdf_wi):
    return INV_PI * split(wi)[2]

"""Slot sampling: normals by D cos theta_m. Walter et al. 2007, Eqs. 28 and 29, as slopes, stretched by alpha."""

import numpy as np

from .common import TWO_PI, mirror, normalize, split, vec
from .sampling_facet import pdf_wi as pdf_wi
from .sampling_facet import weight_wi as weight_wi
from .transcendental import log_precise


def sample_wi(wo, u, alpha):
    ax, ay = split(alpha)
    u0, u1 = split(u)
    phi = TWO_PI * u1
    slope = np.sqrt(-log_precise(1 - u0))
    return mirror(wo, normalize(vec(ax * slope * np.cos(phi), ay * slope * np.sin(phi), np.ones_like(slope))))

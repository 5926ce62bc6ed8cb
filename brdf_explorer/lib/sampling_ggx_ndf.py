"""Slot sampling: normals by D cos theta_m. Walter et al. 2007, Eqs. 35 and 36, as slopes, stretched by alpha."""

import numpy as np

from .common import TWO_PI, mirror, normalize, split, vec
from .sampling_facet import pdf_wi as pdf_wi
from .sampling_facet import weight_wi as weight_wi


def sample_wi(wo, u, alpha):
    ax, ay = split(alpha)
    u0, u1 = split(u)
    phi = TWO_PI * u1
    r = np.sqrt(u0)
    return mirror(wo, normalize(vec(ax * r * np.cos(phi), ay * r * np.sin(phi), np.sqrt(1 - u0))))

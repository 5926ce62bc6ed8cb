"""Slot walk: of Beckmann, for directions above and below the horizon."""

import numpy as np

from .beckmann import z_Lambda_beckmann
from .common import split, vec


def projected_area(w, alpha):
    """Area of the facets visible from w, projected along w: |w.z (1 + Lambda(w))|, the integral of D (w . wm)+."""
    x, y, z = split(w)
    return np.maximum(z, 0.0) + z_Lambda_beckmann(vec(x, y, np.abs(z)), alpha)

"""Slot walk: of GGX, for directions above and below the horizon."""

import numpy as np

from .common import split


def projected_area(w, alpha):
    """Area of the facets visible from w, projected along w: |w.z (1 + Lambda(w))|, the integral of D (w . wm)+."""
    x, y, z = split(w)
    ax, ay = split(alpha)
    s2 = (ax * x) ** 2 + (ay * y) ** 2
    v = np.sqrt(s2 + z * z)
    return 0.5 * np.where(z > 0, v + z, s2 / (v + np.abs(z)))

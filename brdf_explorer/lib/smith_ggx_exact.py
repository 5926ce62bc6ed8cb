"""Slot smith: Smith's Lambda of GGX, w.z > 0. Walter et al. 2007, Eq. 34; Heitz 2014, Eq. 72."""

import numpy as np

from .common import split


def Lambda(w, alpha):
    x, y, z = split(w)
    ax, ay = split(alpha)
    q = (ax * x) ** 2 + (ay * y) ** 2
    return q / (2 * z * (z + np.sqrt(z * z + q)))

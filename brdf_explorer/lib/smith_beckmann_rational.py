"""Slot smith: Walter's rational fit of Beckmann's G1 (Walter et al. 2007, Eq. 27), as Lambda = 1/G1 - 1, w.z > 0.

G1 errs by up to 3.1e-3 (at a = 1.34). From a = 1.548 to 1.6 the fit of G1 exceeds 1, by 6e-5; there Lambda is 0. Where
1/Lambda is needed this is no substitute: its relative error reaches 100 %.
"""

import numpy as np

from .common import split


def Lambda(w, alpha):
    x, y, z = split(w)
    ax, ay = split(alpha)
    s = np.hypot(ax * x, ay * y)
    steep = z <= 1.6 * s
    a = np.where(steep, z, 1.0) / np.where(steep, s, 1.0)
    return np.where(steep, np.maximum((1 + a * (-1.259 + a * 0.396)) / (a * (3.535 + a * 2.181)), 0.0), 0.0)

"""Slot fresnel: the reflectance at normal incidence of eta + i k, at all angles.

Errs by 1 - F0 at grazing angles, where everything reflects all: by 0.96 for glass, 0.03 for gold's red.
"""

import numpy as np

from .fresnel import F0


def F(c, eta, k):
    along = F0(eta, k)
    return np.broadcast_to(along, np.broadcast_shapes((*np.shape(c), 3), along.shape))

"""Slot fresnel: exact, real index eta; k is ignored."""

import numpy as np

from .fresnel import F_dielectric


def F(c, eta, k):
    return F_dielectric(np.asarray(c)[..., None], eta)

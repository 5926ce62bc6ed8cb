"""Slot fresnel: exact, complex index eta + i k."""

import numpy as np

from .fresnel import F_conductor


def F(c, eta, k):
    return F_conductor(np.asarray(c)[..., None], eta, k)

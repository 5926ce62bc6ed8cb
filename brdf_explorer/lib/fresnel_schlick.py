"""Slot fresnel: Schlick's approximation from the reflectance at normal incidence of eta + i k (a dielectric has k = 0).

Largest absolute error: 0.036 for glass (eta = 1.5, at 85 degrees), 0.32 at eta = 1.05, 0.17 at 3.5, 0.29 for a metal of
5.6 + 1.2 i. It knows no total internal reflection: 0.96 at the critical angle from inside glass, eta = 1 / 1.5.
"""

import numpy as np

from .fresnel import F0
from .schlick import F_schlick


def F(c, eta, k):
    return F_schlick(np.asarray(c)[..., None], F0(eta, k))

"""Slot fresnel: Schlick's approximation bent to the exact reflectance at 82 degrees of eta + i k (a dielectric has k = 0).

Largest absolute error: 0.028 for glass (eta = 1.5, at 68 degrees), 0.058 at eta = 1.05, 0.032 at 3.5, 0.074 for a metal of
5.6 + 1.2 i, 0.0039 for one of 0.143 + 3.98 i. It knows no total internal reflection, as Schlick's does not.
"""

import numpy as np

from .fresnel import F0, F_conductor
from .schlick import F_f82


def F(c, eta, k):
    return F_f82(np.asarray(c)[..., None], F0(eta, k), F_conductor(1 / 7, eta, k))

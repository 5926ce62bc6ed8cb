"""Slot shadowing: correlated by azimuth. Where wo and wi share it, what one sees the other lights (G = min); a quarter turn
apart they are independent. Ashikhmin, Premoze and Shirley 2000, "A Microfacet-based BRDF Generator", section 4: a
Gaussian of 15 degrees, so 1 / (2 (15 deg)^2) = 7.3. Empirical, and blind to height.
"""

import numpy as np

from .common import dot, mix
from .transcendental import atan2_precise, exp_precise


def G2(wo, wi, Lambda_o, Lambda_i):
    cross = wo[..., 0] * wi[..., 1] - wo[..., 1] * wi[..., 0]
    phi = atan2_precise(np.abs(cross), dot(wo[..., :2], wi[..., :2]))
    G1_o = 1 / (1 + Lambda_o)
    G1_i = 1 / (1 + Lambda_i)
    return mix(G1_o * G1_i, np.minimum(G1_o, G1_i), exp_precise(-7.3 * phi * phi))

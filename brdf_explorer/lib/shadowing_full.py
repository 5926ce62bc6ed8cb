"""Slot shadowing: fully correlated, G = min: whichever of masking and shadowing is stronger hides the other. Exact where
wo = wi; elsewhere an upper bound. The lecture's "correlated", in its reciprocal reading.
"""

import numpy as np


def G2(wo, wi, Lambda_o, Lambda_i):
    return 1 / (1 + np.maximum(Lambda_o, Lambda_i))

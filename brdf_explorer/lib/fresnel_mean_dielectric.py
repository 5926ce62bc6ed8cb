"""Slot fresnel_mean: of a dielectric.

From outside, our rational minimax fit in eta - 1 over [1, 20], all coefficients positive, errs by 1.5e-4; from inside it is
1 - (1 - that of 1 / eta) eta^2, exactly, since as much light goes out as in.
"""

import numpy as np


def F_mean_dielectric(eta):
    eta = np.asarray(eta, dtype=float)
    x = np.maximum(eta - 1, (1 - eta) / eta)
    p = 0.31063493 + x * (0.72676247 + x * 0.80208363)
    q = 1 + x * (5.03409298 + x * (4.61229612 + x * 0.80887551))
    inside = np.minimum(eta, 1.0)
    return (1 - inside) * (1 + inside) + inside * inside * (x * p / q)


def F_mean(eta, k):
    return F_mean_dielectric(eta)

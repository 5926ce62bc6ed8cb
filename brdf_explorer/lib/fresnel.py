"""Fresnel reflectance of unpolarised light at a smooth interface.

c is the cosine of the angle of incidence, in [0, 1]; eta (and k) the transmitted over the incident (complex) index.
Born and Wolf, Principles of Optics, sections 1.5.2 and 14.2, rearranged so that nothing cancels as eta -> 1 or k -> 0.
"""

import numpy as np

from .common import quotient


def eta2_cos2_t(c, eta):
    """(eta cos theta_t)^2, negative at total internal reflection."""
    return np.where(eta < 0.7, eta * eta - (1 - c) * (1 + c), (eta - 1) * (eta + 1) + c * c)


def F_dielectric(c, eta):
    """Reflectance of a dielectric; 1 at total internal reflection."""
    c, eta = np.broadcast_arrays(np.asarray(c, dtype=float), eta)
    excess = (eta - 1) * (eta + 1)
    s2 = (1 - c) * (1 + c)
    square = eta2_cos2_t(c, eta)
    total = square <= 0
    t = np.sqrt(np.where(total, 1.0, square))
    rs = excess / ((c + t) * (c + t))
    rp = rs * (c * t - s2) / (c * t + s2)
    return np.where(total, 1.0, 0.5 * (rs * rs + rp * rp))


def F_conductor(c, eta, k):
    """Reflectance of a conductor of complex index eta + i k."""
    c, eta, k = np.broadcast_arrays(np.asarray(c, dtype=float), eta, k)
    excess = (eta - 1) * (eta + 1)
    s2 = (1 - c) * (1 + c)
    square = eta2_cos2_t(c, eta) - k * k
    root = np.sqrt(0.5 * (np.hypot(square, 2 * eta * k) + np.abs(square)))
    other = quotient(eta * k, root)
    a = np.where(square > 0, root, other)
    b = np.where(square > 0, other, root)
    sum = (c + a) ** 2 + b * b
    difference = np.where(square > 0, quotient(excess - k * k + b * b, c + a), a - c)
    Rs = quotient(difference * difference + b * b, sum)
    cb2 = c * c * b * b
    Rp = Rs * ((c * a - s2) ** 2 + cb2) / ((c * a + s2) ** 2 + cb2)
    return np.where(sum == 0, 1.0, 0.5 * (Rs + Rp))


def F0(eta, k):
    """Reflectance at normal incidence."""
    eta, k = np.asarray(eta, dtype=float), np.asarray(k, dtype=float)
    return ((eta - 1) ** 2 + k * k) / ((eta + 1) ** 2 + k * k)

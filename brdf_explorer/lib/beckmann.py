"""Smith's Lambda of Gaussian slopes. Smith 1967; Walter et al. 2007, Eq. 26; Heitz 2014, Eq. 66.

Lambda = (exp(-a^2) / (a sqrt(pi)) - erfc(a)) / 2 = exp(-a^2) h(a) / a, a = 1 / (alpha tan theta).
"""

import numpy as np

from .common import quotient, split
from .transcendental import erfcx_precise, exp_precise


def h_beckmann(a):
    """1/(2 sqrt(pi)) - a erfcx(a) / 2; from a = 8 on by its asymptotic series, where the difference would cancel."""
    a = np.asarray(a, dtype=float)
    near = 0.5 / np.sqrt(np.pi) - 0.5 * a * erfcx_precise(np.minimum(a, 8.0))
    t = 0.5 / np.maximum(a, 8.0) ** 2
    term, series = np.ones_like(t), np.zeros_like(t)
    for n in range(1, 13):  # the terms fall until n = 64
        term = -term * (2 * n - 1) * t
        series = series - term
    return np.where(a < 8.0, near, 0.5 / np.sqrt(np.pi) * series)


def z_Lambda_beckmann(w, alpha):
    """w.z Lambda(w), w.z > 0: finite at grazing angles."""
    x, y, z = split(w)
    ax, ay = split(alpha)
    s = np.hypot(ax * x, ay * y)
    visible = 27.0 * s > z  # else exp(-a^2) is 0
    a = quotient(np.where(visible, z, 0.0), s)
    return np.where(visible, s * exp_precise(-a * a) * h_beckmann(a), 0.0)

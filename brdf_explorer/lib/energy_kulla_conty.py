"""Slot energy: what single scattering loses is added as a wide lobe.

Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks", after Kelemen and Szirmay-Kalos 2001:
(1 - E(wo)) (1 - E(wi)) / (pi (1 - E_mean)), times F_multiple. With white facets the albedo is 1; reciprocal. Leaves out that
the second reflection keeps something of the lobe while alpha is small.
"""

import numpy as np

from .common import PI, TWO_PI, split, vec
from .lost import alpha_mean

COSINES = (0.212340538239, 0.590533135559, 0.911412040487)
"""Cosines at which F is asked for its mean over directions, weighted by the cosine: Gauss's three points. Exact for Schlick's F;
errs by up to 0.002 for metals, k > 1, 0.003 for glass, eta > 1, and 0.22 where total reflection begins, eta < 1, k small."""


def F_mean(F_1, F_2, F_3):
    return 0.139653959803 * F_1 + 0.458482212719 * F_2 + 0.401863827478 * F_3


def F_multiple(F, lost_mean):
    """What facets that each reflect F (..., 3), a mean, return of the light that one reflection lost.

    Of each further reflection E_mean = 1 - lost_mean leaves. Two at least have been made, so F counts twice.
    """
    lost_mean = np.asarray(lost_mean)[..., None]
    return F * F * ((1 - lost_mean) / (1 - F * lost_mean))


def wide(lost_o, lost_i, lost_mean):
    """The lobe of white facets, 1/sr."""
    return lost_o * lost_i / (PI * lost_mean)


def share_wide(F0, lost_o):
    """The share of directions drawn from sample_wide: its share of the light, F being the mean colour F0."""
    F = np.mean(F0, axis=-1)
    return F * lost_o / (1 - lost_o + F * lost_o)


def sample_wide(u, alpha):
    """Directions (..., 3) with a density proportional to cos / (cos^2 + alpha_mean^2)."""
    (x, y), a = split(u), alpha_mean(alpha)
    with np.errstate(under="ignore"):  # of a component of no length
        z2 = np.minimum(a * a * np.expm1(x * np.log1p(1 / (a * a))), 1.0)
        phi, r = TWO_PI * y, np.sqrt(1 - z2)
        return vec(r * np.cos(phi), r * np.sin(phi), np.sqrt(z2))


def pdf_wide(w, alpha):
    z, a = split(w)[2], alpha_mean(alpha)
    return z / (PI * (z * z + a * a) * np.log1p(1 / (a * a)))

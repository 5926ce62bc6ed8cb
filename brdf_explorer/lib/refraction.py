"""The geometry of refraction by a facet, and the share of the light that passes it.

Of two directions one, wo, is above the surface and one, wt, below it; eta is the index below over that above.
Walter et al. 2007, section 4: Eqs. 16, 17, 21 and 40.
"""

import numpy as np

from .common import dot, length, split
from .fresnel import eta2_cos2_t

LEAST_EXCESS = 2.0**-16
"""Nearer to 1 refraction would be a delta: float32 has no direction between its lobe's peak and its foot."""


def apart_from_one(eta):
    """The index (...), or 1 and LEAST_EXCESS where it is nearer to 1."""
    return np.where(np.abs(np.asarray(eta) - 1) < LEAST_EXCESS, 1 + LEAST_EXCESS, eta)


def upward(w):
    """The directions w (..., 3), mirrored to above the surface if they are below."""
    w = np.asarray(w, dtype=float)
    return np.concatenate([w[..., :2], np.abs(w[..., 2:])], axis=-1)


def sum_refracted(wo, wt, eta):
    """wo + eta wt, Eq. 16 but for its length: along the facet's normal, against it if eta > 1; |cos_o - eta cos_t| long."""
    return np.asarray(wo, dtype=float) + np.asarray(eta)[..., None] * wt


def cos_refracted(L, eta):
    """Cosines (..., 2), above and below, of the directions at the facet, from the length L of their sum.

    By Snell's law eta cos_t + cos_o = |eta^2 - 1| / L. The smaller is not above 0 where no facet refracts wt to wo.
    """
    q = np.abs((eta - 1) * (eta + 1)) / L
    dense = np.asarray(eta) > 1
    return 0.5 * np.stack([np.where(dense, q - L, q + L), np.where(dense, q + L, q - L) / eta], axis=-1)


def T_dielectric(cos_o, cos_t, eta):
    """1 - F of unpolarised light, from both cosines; the same from both sides."""
    s = cos_o + eta * cos_t
    p = eta * cos_o + cos_t
    return 2 * eta * cos_o * cos_t * (1 / (s * s) + 1 / (p * p))


def T_spread(m, eta):
    """What facets of normal m, L long, pass, over the spread of what they refract: T cos_o cos_t / L^2; 0 where none refracts.

    Eq. 21 is this times D G2, over both cosines; the same for both ways through.
    """
    L = length(m)
    c = cos_refracted(L, eta)
    passes = (split(m)[2] > 0) & np.all(c > 0, axis=-1)
    above, below = split(np.where(passes[..., None], c, 1.0))
    return np.where(passes, T_dielectric(above, below, eta) * (above / L) * (below / L), 0.0)


def refracted(w, wm, eta):
    """The direction into which w is refracted by a facet of normal wm, w . wm > 0; eta: index of the other side over w's.

    Eq. 40, as a difference from straight on. No total internal reflection.
    """
    c = dot(w, wm)
    t = np.sqrt(np.maximum(eta2_cos2_t(c, eta), 0.0))
    turn = (eta - 1) * (eta + 1) / (c + t)
    return (-np.asarray(w, dtype=float) - turn[..., None] * wm) / np.asarray(eta)[..., None]

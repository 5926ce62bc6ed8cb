"""Slot diffuse: EON, the energy-preserving Oren-Nayar model. Portsmouth, Kutz and Hill 2025, "EON: A Practical
Energy-Preserving Rough Diffuse BRDF", Listing 1 with the exact albedo.

Light that meets one facet follows Fujii's Oren-Nayar (FON), of roughness r in [0, 1], a shape and not an angle; the share 1 - E
that FON loses comes back as a reciprocal lobe of multiple scattering. The albedo of white facets is 1 at every angle and
every r. Leaves out where light goes that meets several facets: its lobe is a product of one function of each cosine.
"""

import numpy as np

from .common import INV_PI, dot, length
from .transcendental import atan2_precise

FON_ONE = 0.2877934092108062
"""1/2 - 2 / (3 pi): FON's A is 1 / (1 + FON_ONE r)."""
FON_TWO = 0.07248821245692394
"""2/3 - 28 / (15 pi): FON's mean albedo is A (1 + FON_TWO r)."""


def fon_loss(w):
    """What FON loses of white light along w, (1 - E) / (A r), for a cosine c in (0, 1].

    E = A (1 + r G(c) / pi) and G(0) = pi FON_ONE, so 1 - E cancels at the horizon; this is FON_ONE - G / pi with all its terms
    in proportion to c.
    """
    c, s = w[..., 2], length(w[..., :2])
    flat_part = (np.pi / 2 - 2 / 3) * c * c / (1 + s)
    slope = atan2_precise(c, s) + c * (s - 2 / 3 * (1 + s + s * s) / (1 + s))
    return INV_PI * (flat_part + s * slope)


def diffuse_f(wo, wi, albedo, sigma, r):
    albedo, r = np.asarray(albedo), np.asarray(r)
    A = 1 / (1 + FON_ONE * r)
    mean = A * (1 + FON_TWO * r)
    co, ci = wo[..., 2], wi[..., 2]
    s = dot(wo[..., :2], wi[..., :2])
    h = (wo + wi)[..., :2]
    # below 0, where 1 + r s may cancel: 1 + s = (|h.xy|^2 + wo.z^2 + wi.z^2) / 2
    single = np.where(s > 0, 1 + r * s / np.maximum(co, ci), (1 - r) + 0.5 * r * (dot(h, h) + co * co + ci * ci))
    lobe = r * fon_loss(wo) * fon_loss(wi) / (FON_ONE - FON_TWO)
    mean = mean[..., None]
    several = albedo * mean / (1 - albedo * (1 - mean))
    return INV_PI * A[..., None] * albedo * (single[..., None] + several * lobe[..., None])

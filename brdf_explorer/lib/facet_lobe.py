"""Slot facet: f_mf is a lobe about the facet's mirror direction R(wm, wo), von Mises and Fisher's density of sharpness kappa,
times Fresnel's reflectance F(c), over c = |wo + wi| / 2, the cosine at a facet that would mirror wo to wi.

    f_mf = F(c) / c kappa / (2 pi (1 - exp(-2 kappa))) exp(kappa (wi . R - 1))

Over c and not over wi . wm as the lecture's delta: where wi = R both are the same, and this f_mf is reciprocal. As kappa grows
it becomes F delta(wi - R) / (wi . wm), and f that of Torrance and Sparrow; without F the limit is D G / (4 cos cos). Leaves
out the light that the lobe sends below the facet: seen along its normal a facet reflects 0.46 of the light at kappa = 1, 0.92
at 10 and 0.992 at 100; at no angle more than 1.
"""

import numpy as np

from .common import INV_PI, mix, split, vec
from .warp import cosine_hemisphere

EVEN = 0.25
"""The share of the directions that are drawn by the cosine, so that no weight is large where the lobe is thin."""


def facet_sharpness(kappa):
    return np.asarray(kappa, dtype=float)


def facet_scale(c, albedo, eta, k, kappa, F):
    return F(c, eta, k) * (0.5 * INV_PI * kappa / (-np.expm1(-2.0 * np.asarray(kappa)) * c))[..., None]


def blurred(alpha, kappa):
    """The scale of the half vectors' slopes: that of the facets, and of the lobe, whose density over normals is a Gaussian of
    variance 1 / (4 kappa).
    """
    return np.sqrt(np.square(alpha) + 0.5 / np.asarray(kappa)[..., None])


def facet_wi(wo, u, alpha, kappa, sample_wi):
    u0, u1 = split(u)
    even = u0 < EVEN
    within = np.where(even, u0 / EVEN, (u0 - EVEN) / (1 - EVEN))
    wi = cosine_hemisphere(vec(within, u1))
    wi[~even] = sample_wi(wo[~even], vec(within, u1)[~even], blurred(alpha, kappa))
    return wi


def facet_pdf(wo, wi, alpha, kappa, D, pdf_wi):
    wider = blurred(alpha, kappa)
    return mix(pdf_wi(wo, wi, D(wo + wi, wider), wider), INV_PI * split(wi)[2], EVEN)

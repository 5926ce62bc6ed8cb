"""Slot diffuse: Oren and Nayar 1994, "Generalization of Lambert's Reflectance Model", the qualitative model: V-shaped grooves
with Lambertian walls. With wo.xy . wi.xy = sin sin cos(dphi), its sin(max angle) tan(min angle) needs no angles.

Leaves out interreflection in the grooves. Gains energy at grazing angles for a white facet: its albedo there is A + B/2,
at most 1.0152 (sigma = 0.20).
"""

import numpy as np

from .common import INV_PI, dot


def diffuse_f(wo, wi, albedo, sigma, r):
    s2 = np.square(sigma)
    A = 1 - 0.5 * s2 / (s2 + 0.33)
    B = 0.45 * s2 / (s2 + 0.09)
    factor = A + B * np.maximum(dot(wo[..., :2], wi[..., :2]), 0.0) / np.maximum(wo[..., 2], wi[..., 2])
    return INV_PI * np.asarray(albedo) * factor[..., None]

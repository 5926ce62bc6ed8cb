"""Slot diffuse: f of a diffuse law in 1/sr, both directions above the horizon. Lambert: the same radiance in all directions."""

import numpy as np

from .common import INV_PI


def diffuse_f(wo, wi, albedo, sigma, r):
    return INV_PI * np.asarray(albedo) * np.ones_like(wo)

"""Slot diffuse: Lambert, the same radiance in all directions."""

import numpy as np


def diffuse_factor(wo, wi, sigma):
    return np.ones(np.broadcast_shapes(wo.shape[:-1], wi.shape[:-1]))

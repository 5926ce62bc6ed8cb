"""Slot fresnel: all light is reflected, as a white furnace test needs."""

import numpy as np


def F(c, eta, k):
    return np.ones(np.broadcast_shapes(np.shape(c) + (1,), np.shape(eta)))

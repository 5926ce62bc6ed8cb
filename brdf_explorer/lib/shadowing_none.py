"""Slot shadowing: none. Creates energy at grazing angles without bound; a lesson, not a model."""

import numpy as np


def G2(wo, wi, Lambda_o, Lambda_i):
    return np.ones(np.broadcast_shapes(np.shape(Lambda_o), np.shape(Lambda_i)))

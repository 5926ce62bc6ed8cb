"""Slot tonemap: ACES, the fit of the Reference Rendering Transform and the sRGB Output Device Transform by Stephen Hill."""

import numpy as np

INPUT = np.array([[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]])
OUTPUT = np.array([[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]])


def tonemap(color):
    v = np.asarray(color) @ INPUT.T
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)
    return v @ OUTPUT.T

"""The sRGB transfer function, IEC 61966-2-1."""

import numpy as np


def srgb_encode(linear):
    """sRGB values of linear ones in [0, 1]."""
    linear = np.asarray(linear, dtype=float)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def srgb_decode(encoded):
    """Linear values of sRGB ones in [0, 1]."""
    encoded = np.asarray(encoded, dtype=float)
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)

"""sRGB, IEC 61966-2-1."""

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Luminance of linear RGB: Rec. 709's weights."""


def luminance(color):
    """Luminance (...) of linear colours (..., 3)."""
    return np.asarray(color) @ LUMINANCE


def srgb_encode(linear):
    """sRGB values of linear ones in [0, 1]."""
    linear = np.asarray(linear, dtype=float)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def srgb_decode(encoded):
    """Linear values of sRGB ones in [0, 1]."""
    encoded = np.asarray(encoded, dtype=float)
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)

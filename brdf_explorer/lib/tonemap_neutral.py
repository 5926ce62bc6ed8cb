"""Slot tonemap: Khronos PBR Neutral (2024): colours below 0.8 stay as they are, brighter ones are compressed and desaturated."""

import numpy as np

from .common import mix

START = 0.8 - 0.04


def tonemap(color):
    color = np.asarray(color, dtype=float)
    low = np.min(color, axis=-1, keepdims=True)
    color = color - np.where(low < 0.08, low - 6.25 * low * low, 0.04)
    peak = np.max(color, axis=-1, keepdims=True)
    room = 1 - START
    bright = np.maximum(peak, START)
    compressed = 1 - room * room / (bright + room - START)
    squeezed = mix(compressed, color * compressed / bright, 1 / (0.15 * (bright - compressed) + 1))
    return np.where(peak < START, color, squeezed)

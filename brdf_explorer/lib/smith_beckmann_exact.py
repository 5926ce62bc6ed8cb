"""Slot smith: Smith's Lambda of Beckmann, exact, w.z > 0."""

from .beckmann import z_Lambda_beckmann
from .common import split


def Lambda(w, alpha):
    return z_Lambda_beckmann(w, alpha) / split(w)[2]

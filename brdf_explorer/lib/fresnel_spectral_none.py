"""Slot fresnel, spectral: no spectrum is known, so eta + i k at R, G, B."""

from .fresnel_conductor import F as F

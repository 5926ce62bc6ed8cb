"""Maps from the unit square to directions."""

import numpy as np

from .common import TWO_PI, split, vec


def uniform_hemisphere(u):
    """Directions (..., 3) with the same density, 1 / (2 pi), everywhere above z = 0, from u (..., 2) in the unit square."""
    x, y = split(u)
    r = np.sqrt(x * (2 - x))
    with np.errstate(under="ignore"):  # of a component of no length, or an angle of none
        phi = TWO_PI * y
        return vec(r * np.cos(phi), r * np.sin(phi), 1 - x)


def cosine_hemisphere(u):
    """Directions (..., 3) with density cos(theta) / pi about +z, from u (..., 2) in the unit square."""
    x, y = split(u)
    r = np.sqrt(x)
    with np.errstate(under="ignore"):  # of a component of no length, or an angle of none
        phi = TWO_PI * y
        return vec(r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - x))

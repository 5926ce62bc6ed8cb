"""Schlick's approximation of Fresnel reflectance, from that along the normal, and the one that is right at 82 degrees, too.

c is the cosine of the angle of incidence, in [0, 1]; F0 the reflectance along the normal.
"""

import numpy as np


def F_schlick(c, F0):
    """Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", Eq. 15."""
    m = 1 - np.asarray(c, dtype=float)
    m2 = m * m
    return F0 + (1 - F0) * (m2 * m2 * m)


def F_f82(c, F0, F82):
    """Schlick's curve bent to be F82 at a cosine of 1/7, 82 degrees, but no brighter than it was: the "F82-tint" model.

    Kutz, Hasan and Edmondson 2021, "Novel aspects of the Adobe Standard Material", after Lazanyi and Szirmay-Kalos 2005 and
    Hoffman 2019; as OpenPBR Surface 1.1 prints it, section "Metal", Eq. 30. The curve is negative for indices next to 1; there it
    is 0.
    """
    m = 1 - np.asarray(c, dtype=float)
    m2 = m * m
    edge = F_schlick(1 / 7, F0)
    bent = F_schlick(c, F0) - np.maximum(edge - F82, 0) * (117649 * 7 / 46656) * (c * (m2 * m2 * m2))
    return np.where(bent < 0, 0.0, bent)

"""The sum c + v of a direction v and a point c of the sphere, drawn evenly from the cap above -(1 - cut) v.z.

Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", Listing 3; Eto and Tokuyoshi 2023, Eq. 5, for a cut
of more than 0. Rearranged so that nothing cancels where c is opposite to v.
"""

import numpy as np

from .common import TWO_PI, quotient, split, vec


def sum_with_cap(v, u, cut):
    x, y, z = split(v)
    u0, u1 = split(u)
    sin_o = np.hypot(x, y)
    azimuth_x, azimuth_y = np.where(sin_o > 0, quotient(x, sin_o), 1.0), quotient(y, sin_o)
    phi = TWO_PI * u0
    cosine = azimuth_x * np.cos(phi) + azimuth_y * np.sin(phi)
    sine = azimuth_x * np.sin(phi) - azimuth_y * np.cos(phi)
    low = cut * z
    wide = 1 + np.abs(z)
    narrow = sin_o * sin_o / wide
    extent = np.where(z < 0, narrow, wide) - low
    height = (1 - u1) * extent + low
    q = u1 * extent
    t = np.where(z < 0, wide, narrow)
    r = np.sqrt(q * (t + height))
    excess = quotient(height * (q - t), r + sin_o)
    opposite = excess * cosine + sin_o * sine * sine / (1 - np.minimum(cosine, 0.0))
    along = np.where(cosine < 0, opposite, r * cosine + sin_o)
    across = r * sine
    return vec(along * azimuth_x - across * azimuth_y, along * azimuth_y + across * azimuth_x, height)

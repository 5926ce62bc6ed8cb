"""Colours as they are told apart on a display of high dynamic range: IC_TC_P and the difference Delta E ITP."""

import numpy as np

WHITE = 203.0
"""cd/m2 at which a linear value of 1 is shown: the reference white of ITU-R BT.2408-7, section 2.1."""
PEAK = 10000.0
"""cd/m2 at which PQ ends; brighter values are shown so."""
BT2020 = np.array([[0.6274, 0.3293, 0.0433], [0.0691, 0.9195, 0.0114], [0.0164, 0.0880, 0.8956]])
"""Linear RGB of Rec. 709's primaries to those of BT.2020: ITU-R BT.2087-0, section 2."""
LMS = np.array([[1688, 2146, 262], [683, 2951, 462], [99, 309, 3688]]) / 4096
"""RGB of BT.2020 to cone responses: ITU-R BT.2100-2, table 7, as the next."""
ICTCP = np.array([[2048, 2048, 0], [6610, -13613, 7003], [17933, -17390, -543]]) / 4096


def pq(light):
    """Values in [0, 1] of the perceptual quantizer for cd/m2: ITU-R BT.2100-2, table 4, inverse EOTF."""
    m1, m2 = 2610 / 16384, 2523 / 4096 * 128
    c1, c2, c3 = 3424 / 4096, 2413 / 4096 * 32, 2392 / 4096 * 32
    y = np.clip(np.asarray(light, dtype=float) / PEAK, 0.0, 1.0) ** m1
    return ((c1 + c2 * y) / (1 + c3 * y)) ** m2


def ictcp(color):
    """I, C_T and C_P (..., 3) of linear RGB (..., 3) with Rec. 709's primaries."""
    return pq(np.asarray(color, dtype=float) @ BT2020.T @ LMS.T * WHITE) @ ICTCP.T


def delta_e_itp(a, b):
    """The difference (...) of linear RGB colours (..., 3): about 1 can just be seen. ITU-R BT.2124-0, Eq. 1 of annex 1."""
    i, t, p = np.moveaxis(ictcp(a) - ictcp(b), -1, 0)
    return 720 * np.sqrt(i**2 + 0.25 * t**2 + p**2)

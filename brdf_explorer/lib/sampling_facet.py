"""What the samplers of the slot share that draw normals with density D cos theta_m, of all facets whether they are seen or not.

By the reflection's Jacobian pdf = D wm.z / (4 wo . wm), Walter et al. 2007, Eqs. 24 and 38; with h = wo + wi, wm.z is
h.z / |h| and wo . wm is |h| / 2.
"""

from .common import dot, split


def pdf_wi(wo, wi, density, alpha):
    h = wo + wi
    return density * split(h)[2] / (2 * dot(h, h))


def weight_wi(wo, wi, density, alpha):
    h = wo + wi
    return dot(h, h) / (2 * split(h)[2])

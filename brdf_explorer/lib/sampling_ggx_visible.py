"""Slot sampling: visible normals, D_visible = D (wo . wm)+ / visible_area.

Heitz 2018, "Sampling the GGX Distribution of Visible Normals", Listing 1, rearranged so that nothing cancels near the rim of
the disc.
"""

import numpy as np

from .common import TWO_PI, mirror, normalize, quotient, split, vec
from .ndf_ggx import visible_area


def sample_wm(wo, u, alpha):
    x, y, z = split(wo)
    ax, ay = split(alpha)
    u0, u1 = split(u)
    vx, vy, vz = split(normalize(vec(ax * x, ay * y, z)))
    sin_o = np.hypot(vx, vy)
    cos_phi, sin_phi = np.where(sin_o > 0, quotient(vx, sin_o), 1.0), quotient(vy, sin_o)
    s = 0.5 * (1 + vz)
    phi = TWO_PI * u1
    px, py = np.sqrt(u0) * np.cos(phi), np.sqrt(u0) * np.sin(phi)
    w = np.sqrt(1 - u0 + py * py)
    far = w + np.abs(py)
    near = (1 - u0) / far
    up, down = np.where(py > 0, near, far), np.where(py > 0, far, near)
    y = w - s * up
    z = np.sqrt(up * (0.5 * sin_o * sin_o * w + s * s * down))
    height = np.where(y < 0, quotient(s * down * (w * vz - y), z * vz - y * sin_o), z * vz + y * sin_o)
    along = z * sin_o - y * vz
    return normalize(vec(ax * (along * cos_phi - px * sin_phi), ay * (along * sin_phi + px * cos_phi), height))


def sample_wi(wo, u, alpha):
    return mirror(wo, sample_wm(wo, u, alpha))


def pdf_wi(wo, wi, density, alpha):
    return density / (4 * visible_area(wo, alpha))


def weight_wi(wo, wi, density, alpha):
    return visible_area(wo, alpha)

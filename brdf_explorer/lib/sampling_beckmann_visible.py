"""Slot sampling: visible normals, D_visible = D (wo . wm)+ / visible_area.

Heitz and d'Eon 2014, "Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals", section 4; the
CDFs are solved, not fitted.
"""

import numpy as np

from .beckmann import h_beckmann
from .common import PI, mirror, normalize, quotient, split, vec
from .ndf_beckmann import visible_area
from .transcendental import erfcx_precise, exp_precise


def visible_slope_beckmann(u, sin_o, cos_o):
    """Slope along the view's azimuth of facets with alpha = 1 seen from (sin_o, 0, cos_o).

    It is where the visible area of facets with a smaller slope is u of the whole: Newton's method kept inside a bracket. The
    area's CDF is cos_o erfc(-x)/2 + sin_o exp(-x^2) / (2 sqrt(pi)); above 0 its complement is solved, so that neither tail
    is rounded away.
    """
    u, sin_o, cos_o = np.broadcast_arrays(u, sin_o, cos_o)
    half_inv_sqrt_pi = 0.5 / np.sqrt(PI)
    low = np.full(u.shape, -6.0)
    high = np.clip(cos_o / np.maximum(sin_o, 1e-9), -6.0, 6.0)
    head = 0.5 * cos_o + half_inv_sqrt_pi * sin_o
    tail = sin_o * exp_precise(-high * high) * h_beckmann(np.abs(high))
    area = np.maximum(cos_o, 0.0) + tail
    upper = (cos_o > 0) & (u * area > head)
    low = np.where(upper, 0.0, low)
    high = np.where(upper, high, np.minimum(high, 0.0))
    x = 0.5 * (low + high)
    found = x.copy()
    left = np.arange(x.size)  # of the flat arrays, those whose root is not found yet
    rows = [np.ravel(a) for a in (x, low, high, u, sin_o, cos_o, tail, area, upper)]
    for _ in range(60):
        x, low, high, p, s, c, tail, area, upper = rows
        gauss = exp_precise(-x * x)
        half_erfcx = 0.5 * c * erfcx_precise(np.abs(x))
        above = (1 - p) * area - tail - gauss * (half_erfcx - half_inv_sqrt_pi * s)
        below = gauss * (half_erfcx + half_inv_sqrt_pi * s) - p * area
        error = np.where(upper, above, below)
        high = np.where(error > 0, x, high)
        low = np.where(error > 0, low, x)
        density = (c - x * s) * gauss * 2 * half_inv_sqrt_pi
        step = np.where(density > 0, x - quotient(error, np.maximum(density, 0.0)), low - 1)
        step = np.where((step > low) & (step < high), step, 0.5 * (low + high))
        found.flat[left] = step
        going = np.abs(step - x) > 1e-15 * (1 + np.abs(x))
        left = left[going]
        if not left.size:
            break
        rows = [a[going] for a in (step, low, high, *rows[3:])]
    return np.where(u == 0, -6.0, found)


def sample_wm(wo, u, alpha):
    """A visible normal; wo may lie below the horizon."""
    from scipy.special import ndtri

    x, y, z = split(wo)
    ax, ay = split(alpha)
    u0, u1 = split(u)
    vx, vy, vz = split(normalize(vec(ax * x, ay * y, z)))
    sin_o = np.hypot(vx, vy)
    cos_phi = np.where(sin_o > 0, quotient(vx, sin_o), 1.0)
    sin_phi = quotient(vy, sin_o)
    along = visible_slope_beckmann(u0, sin_o, vz)
    across = np.clip(ndtri(u1) / np.sqrt(2), -6.0, 6.0)  # the closed form of visible_slope_beckmann(u1, 0, 1)
    slope_x = along * cos_phi - across * sin_phi
    slope_y = along * sin_phi + across * cos_phi
    return normalize(vec(-ax * slope_x, -ay * slope_y, np.ones_like(slope_x)))


def sample_wi(wo, u, alpha):
    return mirror(wo, sample_wm(wo, u, alpha))


def pdf_wi(wo, wi, density, alpha):
    return density / (4 * visible_area(wo, alpha))


def weight_wi(wo, wi, density, alpha):
    return visible_area(wo, alpha)

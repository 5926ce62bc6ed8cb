"""A grid over the hemisphere that follows a lobe, and quadrature on it.

Directions are wi = wo mirrored about microfacet normals whose slopes are s = rho (alpha_x cos psi, alpha_y sin psi): a polar
grid of slopes, stretched as the microsurface is. Each ray psi begins at the mirror direction (rho = 0) and ends on the horizon
(rho = rho_max(psi)), so the grid covers the hemisphere once, is as fine as the lobe near its peak whatever alpha is, and has
the horizon as its edge. Along a ray rho = sinh(t asinh(rho_max)), t in [0, 1]: uniform inside the lobe, logarithmic outside.

Of a surface that transmits there is a second such grid on the other side, about the direction that the flat surface refracts to.
"""

from dataclasses import dataclass

import numpy as np

from ..lib.common import split, vec
from ..lib.refraction import refracted


@dataclass(frozen=True)
class Grid:
    """Directions on rays from the mirror direction to the horizon.

    wi      unit directions (psi, t, 3)
    density solid angle per dt dpsi (psi, t), sr: sum f density dt dpsi integrates f
    """

    wi: np.ndarray
    density: np.ndarray


def grid(wo, alpha, t, psi):
    """The Grid of directions for a viewer wo (3,) and slopes' scale alpha (2,).

    Nodes t (n,), or (m, n), are in [0, 1], psi (m,) in radians.
    """
    wo = np.asarray(wo, dtype=float)
    psi, t = np.asarray(psi, dtype=float)[:, None], np.atleast_2d(np.asarray(t, dtype=float))
    ax, ay = alpha
    cx, cy = ax * np.cos(psi), ay * np.sin(psi)  # slopes at rho = 1
    q = cx * cx + cy * cy
    co = wo[2]
    b, rho_max = _ray(wo, alpha, psi)
    scale = np.arcsinh(rho_max)
    rho = np.sinh(t * scale)
    n2 = 1 + q * rho * rho
    along = co + b * rho  # wo . m before m is normalised
    z = (co + 2 * b * rho - co * q * rho * rho) / n2
    z = np.where(t == 1, 0.0, np.maximum(z, 0.0))
    wi = vec(-2 * along * cx * rho / n2 - wo[0], -2 * along * cy * rho / n2 - wo[1], z)
    # d omega_i = 4 (wo . wm) d omega_m, d omega_m = d slope / n2^(3/2), d slope = alpha_x alpha_y rho d rho d psi
    d_rho = scale * np.cosh(t * scale)
    density = 4 * along * ax * ay * rho * d_rho / n2**2
    return Grid(wi, density)


LEAST_COSINE, LEAST_ALPHA = 0.05, 1e-9
"""Of the viewer that stands for a refracted lobe: at total internal reflection there is none, and without refraction no width."""


@dataclass(frozen=True)
class Side:
    """A side of the surface as a grid sees it.

    wo, alpha   a viewer (3,) above the surface and a scale of slopes (2,), for `grid`, `place` and `spread`
    up          1 if the side is that above the horizon, -1 if it is below: what their wi.z is multiplied by
    dense       n^2 of the side over that of the viewer's: a share of energy is this times one of radiance
    """

    wo: np.ndarray
    alpha: tuple
    up: float = 1.0
    dense: float = 1.0

    def turned(self, wi):
        """Directions wi (..., 3) of a grid above the horizon, on this side; or back."""
        return wi * [1.0, 1.0, self.up]


def sides(wo, alpha, index=None):
    """The Sides on which a viewer wo (3,) meets light: its own, and the other one if index, as Model.index, is not None.

    The flat surface refracts wo to -v. A tilt of a facet turns that by |1 - cos_o / (eta cos_t)| times the tilt, and the mirrored
    direction by twice the tilt: so the grid of the other side is that of a viewer v above a surface of such slopes.
    """
    wo = np.asarray(wo, dtype=float)
    if index is None:
        return [Side(wo, tuple(alpha))] if wo[2] > 0 else []
    if wo[2] == 0:
        return []
    up = float(np.sign(wo[2]))
    eta = index**up
    near = Side(wo * [1.0, 1.0, up], tuple(alpha), up)
    cos_t = max(1 - (1 - near.wo[2] ** 2) / eta**2, LEAST_COSINE**2) ** 0.5
    across = near.wo[:2] / max(np.hypot(*near.wo[:2]), 1e-300) * (1 - cos_t**2) ** 0.5
    factor = 0.5 * abs(1 - near.wo[2] / (eta * cos_t))
    far = tuple(float(np.clip(factor * a, LEAST_ALPHA, 1.0)) for a in alpha)
    return [near, Side(vec(*across, cos_t), far, -up, eta**2)]


def flat_refraction(wo, index):
    """Where the flat surface refracts wo (3,) above it to; None at total internal reflection, or without an index."""
    if index is None or wo[2] ** 2 <= 1 - index**2:
        return None
    return refracted(wo, np.array([0.0, 0.0, 1.0]), np.array(index))


def place(wo, alpha, wi):
    """The t in [0, 1] and psi in [0, 2 pi] of directions wi (..., 3) above the horizon: the inverse of `grid`."""
    x, y, z = split(np.asarray(wo, dtype=float) + wi)
    sx, sy = -x / (z * alpha[0]), -y / (z * alpha[1])
    psi = np.arctan2(sy, sx) % (2 * np.pi)
    return np.minimum(np.arcsinh(np.hypot(sx, sy)) / np.arcsinh(_ray(wo, alpha, psi)[1]), 1.0), psi


def _ray(wo, alpha, psi):
    """Rise b of wo . (unnormalised normal) = wo.z + b rho along a ray, and rho_max, where its wi meets the horizon."""
    cx, cy = alpha[0] * np.cos(psi), alpha[1] * np.sin(psi)
    q = cx * cx + cy * cy
    b = -(cx * wo[0] + cy * wo[1])
    co = wo[2]
    # the horizon: co + 2 b rho - co q rho^2 = 0
    root = np.sqrt(b * b + co * co * q)
    return b, np.where(b > 0, (b + root) / (co * q), co / (root - np.minimum(b, 0)))


def spread(wo, alpha, fraction):
    """psi of rays, and d psi / d fraction, for fractions (n,) of the turn: even spacing of these makes quadrature converge fast.

    A ray's rho_max has branch points i epsilon from the two psi at which the ray is level, epsilon = cot theta_o if isotropic;
    and its stretch has them i alpha_min / alpha_max from the psi of the longer axis. So fraction is the sum of two elliptic
    integrals, of 1 / sqrt(cos^2 + epsilon^2 sin^2): rays lie logarithmically about those places, however near the points
    are, and the map is analytic and periodic, as the trapezoidal rule needs to converge exponentially.
    """
    from scipy.special import ellipk, ellipkinc

    fraction = np.asarray(fraction, dtype=float)
    ax, ay = alpha
    level = np.arctan2(ay * wo[1], ax * wo[0])  # a quarter turn from the level rays
    width = wo[2] * np.hypot(ax * np.sin(level), ay * np.cos(level))
    steep = np.hypot(ax * wo[0], ay * wo[1])
    # (a quarter turn from the cluster, 1 - epsilon^2)
    clusters = [
        (level, 1 - max(width / max(steep, width), 1e-7) ** 2),
        (0.0 if ax > ay else 0.5 * np.pi, 1 - (min(ax, ay) / max(ax, ay)) ** 2),
    ]

    def turn(psi):
        return sum(ellipkinc(psi - c, m) - ellipkinc(-c, m) for c, m in clusters)

    period = sum(4 * ellipk(m) for _, m in clusters)
    low, high = np.zeros(fraction.shape), np.full(fraction.shape, 2 * np.pi)
    psi = 2 * np.pi * fraction
    for _ in range(80):  # Newton's method kept inside a bracket
        error = turn(psi) - fraction * period
        slope = sum(1 / np.sqrt(np.cos(psi - c) ** 2 + (1 - m) * np.sin(psi - c) ** 2) for c, m in clusters)
        if np.all(np.abs(error) <= 1e-14 * period):
            break
        low, high = np.where(error < 0, psi, low), np.where(error < 0, high, psi)
        step = psi - error / slope
        psi = np.where((step >= low) & (step <= high), step, 0.5 * (low + high))
    return psi, period / slope


def plane_of_incidence(phi, alpha):
    """The psi whose ray, with that of psi + pi, is the slice through the normal at azimuth phi."""
    return np.arctan2(np.sin(phi) / alpha[1], np.cos(phi) / alpha[0])


def direction(theta, phi):
    """Unit vectors (..., 3) from polar angle and azimuth in radians."""
    return vec(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta))


def angles(w):
    """Polar angle and azimuth of directions (..., 3), in radians."""
    x, y, z = split(w)
    return np.arctan2(np.hypot(x, y), z), np.arctan2(y, x)

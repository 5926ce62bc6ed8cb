"""A grid over the hemisphere that follows a lobe, and quadrature on it.

Directions are wi = wo mirrored about microfacet normals whose slopes are s = rho (alpha_x cos psi, alpha_y sin psi): a polar
grid of slopes, stretched as the microsurface is. Each ray psi begins at the mirror direction (rho = 0) and ends on the horizon
(rho = rho_max(psi)), so the grid covers the hemisphere once, is as fine as the lobe near its peak whatever alpha is, and has
the horizon as its edge. Along a ray rho = sinh(t asinh(rho_max)), t in [0, 1]: uniform inside the lobe, logarithmic outside.
"""

from dataclasses import dataclass

import numpy as np

from ..lib.common import split, vec


@dataclass(frozen=True)
class Grid:
    """Directions on rays from the mirror direction to the horizon.

    wi      unit directions (psi, t, 3)
    density solid angle per dt dpsi (psi, t), sr: sum f density dt dpsi integrates f
    """

    wi: np.ndarray
    density: np.ndarray


def grid(wo, alpha, t, psi):
    """The Grid of directions for a viewer wo (3,), slopes' scale alpha (2,), nodes t (n,) in [0, 1], psi (m,) in radians."""
    wo = np.asarray(wo, dtype=float)
    ax, ay = alpha
    cx, cy = ax * np.cos(psi)[:, None], ay * np.sin(psi)[:, None]  # slopes at rho = 1
    q = cx * cx + cy * cy
    b = -(cx * wo[0] + cy * wo[1])  # wo . (unnormalised normal) = co + b rho
    co = wo[2]
    # the horizon: co + 2 b rho - co q rho^2 = 0
    root = np.sqrt(b * b + co * co * q)
    rho_max = np.where(b > 0, (b + root) / (co * q), co / (root - np.minimum(b, 0)))
    scale = np.arcsinh(rho_max)
    rho = np.sinh(t[None, :] * scale)
    n2 = 1 + q * rho * rho
    along = co + b * rho  # wo . m before m is normalised
    z = (co + 2 * b * rho - co * q * rho * rho) / n2
    z = np.where(t[None, :] == 1, 0.0, np.maximum(z, 0.0))
    wi = vec(-2 * along * cx * rho / n2 - wo[0], -2 * along * cy * rho / n2 - wo[1], z)
    # d omega_i = 4 (wo . wm) d omega_m, d omega_m = d slope / n2^(3/2), d slope = alpha_x alpha_y rho d rho d psi
    d_rho = scale * np.cosh(t[None, :] * scale)
    density = 4 * along * ax * ay * rho * d_rho / n2**2
    return Grid(wi, density)


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

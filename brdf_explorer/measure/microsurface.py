"""Areas of a microsurface: integrals over all its normals, for models that have a distribution of them (a choice `ndf`)."""

import numpy as np

from ..lib import slot
from ..lib.common import dot, length, vec
from .albedo import gauss
from .grid import spread


def facets(wo, alpha, n):
    """Normals wm (n, n, 3) of the facets that face wo (3,), and the solid angle that each stands for in quadrature, sr (n, n).

    n rays of n normals, out to the slope at which facets turn away from wo, with slopes rho = s / (1 - s) in units of alpha.
    """
    wo = np.asarray(wo, dtype=float)
    ax, ay = alpha
    psi, turn = spread(wo, alpha, (np.arange(n) + 0.5) / n)
    cx, cy = ax * np.cos(psi)[:, None], ay * np.sin(psi)[:, None]
    b = -(cx * wo[0] + cy * wo[1])
    end = np.where(b < 0, wo[2] / (wo[2] + np.maximum(-b, 0)), 1.0)  # s where wo.z + b rho = 0
    x, dx = gauss(n)
    s = x * end
    rho = s / (1 - s)
    wm = vec(-cx * rho, -cy * rho, np.ones_like(rho))
    size = length(wm)
    # d wm = alpha_x alpha_y rho d rho d psi / |wm|^3
    return wm / size[..., None], ax * ay * rho / size**3 / (1 - s) ** 2 * end * dx * (turn / n)[:, None]


def projected_area(model, wo, n=256):
    """Area of the facets that face wo (3,), projected along wo: the integral of D (wo . wm)+ over wm, by quadrature.

    Along the normal it is the integral of D cos, which is 1 for every D.
    """
    wm, solid_angle = facets(wo, model.alpha, n)
    with np.errstate(under="ignore"):  # in the tails of a density
        D = slot("ndf", model.ndf).D(wm, np.array(model.alpha))
        return float(np.sum(D * np.maximum(dot(wo, wm), 0.0) * solid_angle))


def D_visible(model, wo, wm):
    """Density of the facets' area that wo (3,) sees over normals wm (..., 3), 1/sr: D (wo . wm)+ / visible_area."""
    ndf, alpha = slot("ndf", model.ndf), np.array(model.alpha)
    return ndf.D(wm, alpha) * np.maximum(dot(wo, wm), 0.0) / ndf.visible_area(wo, alpha)


def G1(model, wo):
    """Share of the area of the facets that face wo (..., 3) which is visible, 1 / (1 + Lambda) by the model's own Lambda."""
    return 1 / (1 + slot("smith", model.ndf, model.smith).Lambda(np.asarray(wo, dtype=float), np.array(model.alpha)))

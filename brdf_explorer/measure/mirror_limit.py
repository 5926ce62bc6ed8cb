"""Facets whose lobes sharpen until they are mirrors: how far f is from Torrance and Sparrow's then.

For models with the slots of `microfacet`: alpha, ndf, smith, shadowing, fresnel, eta and k.
"""

from functools import lru_cache

import numpy as np

from ..lib import facet_lobe, fresnel_one, slot
from ..lib.common import above_horizon, quotient, split, vec
from ..lib.facets import facets
from ..lib.microfacet import cos_facet
from ..models import MODELS
from .grid import direction

NODES = 24
"""Points of the quadrature along each angle: what it cuts off a sharp lobe is exp(-1 - NODES / 2) = 2e-6 of it."""
SHARPNESS = 10.0 ** np.arange(1, 6.5, 0.5)
"""The kappas that `differences` is measured at."""
DIRECTIONS = 25
"""Directions to the light on each side of the mirror direction, for a difference."""
STEEPEST = np.radians(80.0)
"""From the normal to the last of these: nearer to the horizon lobes are cut off, however sharp. Of a viewer beyond, theta_o."""


def without_facets(model):
    """Why a model has no facets that could be sharpened until they are mirrors, or ""."""
    if "ndf" not in model.choices():
        return "it has no distribution of facets"
    if model.transmits:
        return "its facets let light through"
    if not {"shadowing", "smith", "fresnel"} <= set(model.choices()):
        return "its light meets several facets"
    return ""


def slope_scale(alpha, phi):
    """Scale of the slopes of facets that are tilted within the plane of incidence, which lies at the azimuth phi."""
    return float(1 / np.hypot(np.cos(phi) / alpha[0], np.sin(phi) / alpha[1]))


def mirrors(model):
    """Torrance and Sparrow's model of the same facets."""
    names = ("alpha", "eta", "k", "ndf", "shadowing", "fresnel", "spectrum", "smith")
    return MODELS["microfacet"](**{name: getattr(model, name) for name in names})


def gauss(i):
    """Node and weight (..., 2), as those of the slot gauss."""
    return vec(*(part[i] for part in np.polynomial.legendre.leggauss(NODES)))


def sharpened(model, kappa, wo, wi, reflectance=True):
    """f (..., 3) of facets of this model whose lobes have the sharpness kappa; without F, as the lecture prints it, if asked."""
    alpha = np.array(model.alpha)
    D, node_scale = slot("ndf", model.ndf).D, slot("facets", model.ndf).NODE_SCALE
    Lambda, G2 = slot("smith", model.ndf, model.smith).Lambda, slot("shadowing", model.shadowing).G2
    F = slot("fresnel", model.slots()["fresnel"]).F if reflectance else fresnel_one.F

    def value(wo, wi):
        seen = facets(wo, wi, alpha, kappa, node_scale, NODES, D, gauss)
        scale = facet_lobe.facet_scale(cos_facet(wo, wi), None, np.array(model.eta), np.array(model.k), kappa, F)
        G = G2(wo, wi, Lambda(wo, alpha), Lambda(wi, alpha))
        return scale * (G * seen / (split(wo)[2] * split(wi)[2]))[..., None]

    return above_horizon(value, wo, wi, 3)


def differences(model, theta_o, phi_o=0.0, kappas=SHARPNESS):
    """The largest |f - Torrance and Sparrow's f| in the plane of incidence over the largest f there, for each kappa (n,).

    theta_o, phi_o: radians. Directions lie about the mirror direction, as close as alpha, up to STEEPEST.
    """
    return np.array([difference(mirrors(model), theta_o, phi_o, float(k)) for k in kappas])


@lru_cache(512)
@np.errstate(under="ignore")  # in the tails of a density
def difference(model, theta_o, phi_o, kappa):
    """One of the `differences`, of a microfacet model."""
    near = np.tan(np.linspace(0.0, 1.2, DIRECTIONS)) * slope_scale(model.alpha, phi_o)
    theta = np.concatenate([-theta_o - near[::-1], -theta_o + near[1:]])
    theta = theta[np.abs(theta) <= max(STEEPEST, theta_o)]
    wo, wi = direction(theta_o, phi_o), direction(theta, phi_o)
    exact = model.f(wo, wi)
    return float(quotient(np.max(np.abs(sharpened(model, kappa, wo, wi) - exact)), exact.max()))

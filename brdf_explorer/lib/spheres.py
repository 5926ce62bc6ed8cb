"""Light among Lambertian spheres, each of which reflects the share c of its light: d'Eon 2021, "An Analytic BRDF for Materials
with Spherical Lambertian Scatterers". The phase function of one, exactly, and c of a diffuse albedo.
"""

import numpy as np

from .common import PI, length
from .transcendental import atan2_precise


def phase(wo, wi):
    """The phase function of a Lambertian sphere, 1/sr: 2 (sin x - x cos x) / (3 pi^2), where x is the deflection, the angle
    between -wi and wo; by its series where that cancels. Lambert 1760; Blinn 1982.
    """
    forth, back = length(wo + wi), length(wo - wi)
    x = 2 * atan2_precise(forth, back)
    x2 = x * x
    series = x * x2 * (1 / 3 - x2 * (1 / 30 - x2 * (1 / 840 - x2 * (1 / 45360 - x2 * (1 / 3991680 - x2 / 518918400)))))
    cubic = np.where(x > 0.4, 0.5 * forth * back - 0.25 * x * (back * back - forth * forth), series)
    return 2 / (3 * PI * PI) * cubic


def sphere_c(albedo):
    """c of a diffuse albedo, d'Eon's fit, Eq. 46. Takes c above 1 by up to 3e-10 where the albedo is above 0.9988."""
    lost = _log_lost(albedo)
    return -np.expm1(2.73556 * lost) / (1 - 0.184096 * np.exp(2.48423 * lost))


def sphere_s(albedo):
    """s = sqrt(1 - c), of the same fit."""
    lost = _log_lost(albedo)
    power = np.exp(2.48423 * lost)
    return np.sqrt(np.maximum(power * (np.exp(0.25133 * lost) - 0.184096) / (1 - 0.184096 * power), 0.0))


def _log_lost(albedo):
    albedo = np.asarray(albedo, dtype=float)
    return np.log1p(-np.minimum(albedo, 1 - 1e-16))

"""Diffuse reflection: Lambert's law, and its generalisations to rough surfaces of facets and bodies of spheres that obey it."""

from dataclasses import dataclass

import numpy as np

from ..lib import slot
from ..lib.common import INV_PI, PI, above_horizon, split
from ..lib.diffuse_lambert_sphere_fast import grazing_albedo
from ..lib.warp import cosine_hemisphere
from ..model import Model, choice, param


def r_of_sigma(sigma):
    """eon's r that has the shape of oren_nayar of a sigma: B / A, since r is that ratio of Fujii's terms of the same names.

    Where wo.xy . wi.xy > 0 and white facets would add nothing by a second reflection, the laws are then in one proportion.
    """
    s2 = sigma * sigma
    return 0.45 * s2 / (s2 + 0.09) / (1 - 0.5 * s2 / (s2 + 0.33))


def sigma_of_r(r):
    """The sigma of `r_of_sigma`; 1, the largest, where r is above 0.66."""
    r = min(r, r_of_sigma(1.0))
    b, c = 0.1485 - 0.375 * r, 0.0297 * r
    return min((2 * c / (b + (b * b + 4 * (0.45 - 0.5 * r) * c) ** 0.5)) ** 0.5, 1.0)


@dataclass(frozen=True)
class Diffuse(Model):
    """Diffuse reflection by one of several laws. Leaves out light that leaves the body elsewhere."""

    albedo: tuple = param((0.8, 0.8, 0.8), 0.0, 1.0, "share of the light that a facet reflects, linear RGB", color=True)
    sigma: float = param(
        0.3, 0.0, 1.0, "standard deviation of the facets' angle of slope, for oren_nayar and facets", unit="rad"
    )
    r: float = param(0.5, 0.0, 1.0, "roughness of eon, Fujii's: 0 is Lambert's law")
    diffuse: str = choice(
        "lambert",
        ("lambert", "oren_nayar", "facets", "eon", "lambert_sphere", "lambert_sphere_fast"),
        "law of reflection",
    )

    def exceptions(self):
        if self.diffuse == "lambert_sphere":  # white spheres' albedo is 1 within 1e-5, by tables
            return {"energy": 1 + 1e-5}
        if (
            self.diffuse == "lambert_sphere_fast"
        ):  # its fit gains up to 30 %, at grazing angles, from an albedo of 0.765 on
            albedo = float(np.max(grazing_albedo(self.albedo)))
            return {"energy": albedo} if albedo > 1 else {}
        if self.diffuse == "facets":  # next to each other, exchanged directions have nodes about another corner
            return {"reciprocity": 1e-6}
        if self.diffuse != "oren_nayar":
            return {}
        # largest for a grazing viewer: A + B/2, the mean of the factors A at the normal and A + B between horizon and 45 degrees
        normal, horizon, between = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.5**0.5, 0.0, 0.5**0.5]])
        albedo = float(np.max(0.5 * PI * (self._law(normal, normal) + self._law(horizon, between))))
        return {"energy": albedo} if albedo > 1 else {}

    def f(self, wo, wi):
        return above_horizon(self._law, wo, wi, 3)

    def pdf(self, wo, wi):
        return above_horizon(lambda o, i: INV_PI * split(i)[2], wo, wi)

    def sample_f(self, wo, u):
        wi = cosine_hemisphere(u)
        return wi, above_horizon(lambda o, i: PI * self._law(o, i), wo, wi, 3)

    def _law(self, wo, wi):
        return slot("diffuse", self.diffuse).diffuse_f(wo, wi, self.albedo, self.sigma, self.r)

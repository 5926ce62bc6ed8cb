"""Diffuse reflection: Lambert's law, and Oren and Nayar's rough surface of facets that obey it."""

from dataclasses import dataclass

import numpy as np

from ..lib import slot
from ..lib.common import INV_PI, above_horizon, split
from ..lib.warp import cosine_hemisphere
from ..model import Model, choice, param


@dataclass(frozen=True)
class Diffuse(Model):
    """Diffuse reflection: f = albedo / pi times a factor for roughness. Leaves out light that leaves the body elsewhere."""

    albedo: tuple = param((0.8, 0.8, 0.8), 0.0, 1.0, "share of the light that a facet reflects, linear RGB", color=True)
    sigma: float = param(0.3, 0.0, 1.0, "standard deviation of the facets' angle of slope, for oren_nayar", unit="rad")
    diffuse: str = choice("lambert", ("lambert", "oren_nayar"), "law of reflection")

    def exceptions(self):
        # largest for a grazing viewer: A + B/2, the mean of the factors A at the normal and A + B between horizon and 45 degrees
        normal, horizon, between = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.5**0.5, 0.0, 0.5**0.5]])
        factor = slot("diffuse", self.diffuse).diffuse_factor
        grazing = 0.5 * (factor(normal, normal, self.sigma) + factor(horizon, between, self.sigma))
        albedo = float(max(self.albedo) * grazing)
        return {"energy": albedo} if albedo > 1 else {}

    def f(self, wo, wi):
        return above_horizon(lambda o, i: INV_PI * self._value(o, i), wo, wi, 3)

    def pdf(self, wo, wi):
        return above_horizon(lambda o, i: INV_PI * split(i)[2], wo, wi)

    def sample_f(self, wo, u):
        wi = cosine_hemisphere(u)
        wo, wi = np.broadcast_arrays(wo, wi)
        return wi, above_horizon(self._value, wo, wi, 3)

    def _value(self, wo, wi):
        return np.array(self.albedo) * slot("diffuse", self.diffuse).diffuse_factor(wo, wi, self.sigma)[..., None]

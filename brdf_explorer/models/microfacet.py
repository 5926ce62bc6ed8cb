"""Microfacets that are mirrors: Torrance and Sparrow 1967; Cook and Torrance 1982; as Walter et al. 2007, Eq. 20."""

from dataclasses import dataclass

import numpy as np

from ..lib import slot
from ..lib.common import HORIZON, above_horizon, split
from ..lib.microfacet import cos_facet
from ..model import Model, choice
from . import microsurface


@dataclass(frozen=True)
class Microfacet(Model):
    """Torrance-Sparrow: f = D G F / (4 cos cos), facets that are mirrors.

    Leaves out light that meets more than one facet, so rough metals lose energy: up to 0.69 of it for GGX at alpha = 1,
    seen along the normal (its albedo is 1 - ln 2), and transmission.
    """

    alpha: tuple = microsurface.alpha(0.2)
    eta: tuple = microsurface.eta()
    k: tuple = microsurface.k()
    ndf: str = microsurface.ndf()
    shadowing: str = microsurface.shadowing()
    fresnel: str = microsurface.fresnel()
    spectrum: str = microsurface.spectrum()
    sampling: str = choice(
        "caps",
        ("uniform", "cosine", "ndf", "visible", "caps", "bounded"),
        "how sample_f draws directions: over the hemisphere, by D, or by the normals that the viewer sees",
    )
    smith: str = microsurface.smith()

    def slots(self):
        return microsurface.filled(self.choices())

    def slopes(self):
        return self.alpha

    def exceptions(self):
        found = {}
        if self.ndf == "beckmann" and self.smith == "rational":  # the fit's G1 errs by 3.1e-3
            found["weak white furnace"] = 3.2e-3
        if self.fresnel == "spectral" and self.spectrum == "gold":  # its red is outside of the primaries
            found["energy"] = 1.038
        if self.shadowing == "none":
            found["energy"] = np.inf
        return found

    def f(self, wo, wi):
        alpha = np.array(self.alpha)
        D = slot("ndf", self.ndf).D

        def value(wo, wi):
            facet = self._F(wo, wi)
            scale = D(wo + wi, alpha) * self._G2(wo, wi) / (4 * split(wo)[2] * split(wi)[2])
            return facet * scale[..., None]

        return above_horizon(value, wo, wi, 3)

    def pdf(self, wo, wi):
        alpha = np.array(self.alpha)
        D, pdf_wi = slot("ndf", self.ndf).D, self._sampling().pdf_wi
        return above_horizon(lambda o, i: pdf_wi(o, i, D(o + i, alpha), alpha), wo, wi)

    def sample_f(self, wo, u):
        wo, u = np.asarray(wo, dtype=float), np.asarray(u, dtype=float)
        shape = np.broadcast_shapes(wo.shape[:-1], u.shape[:-1])
        wo, u = np.broadcast_to(wo, (*shape, 3)), np.broadcast_to(u, (*shape, 2))
        alpha = np.array(self.alpha)
        D, sampling = slot("ndf", self.ndf).D, self._sampling()
        wi = np.broadcast_to([0.0, 0.0, 1.0], wo.shape).copy()
        up = wo[..., 2] > HORIZON
        with np.errstate(under="ignore"):  # of a component of no weight
            wi[up] = sampling.sample_wi(wo[up], u[up], alpha)

        def weight(wo, wi):
            facet = self._F(wo, wi)
            share = sampling.weight_wi(wo, wi, D(wo + wi, alpha), alpha)
            return facet * (self._G2(wo, wi) * share / split(wo)[2])[..., None]

        return wi, above_horizon(weight, wo, wi, 3)

    def factors(self, wo, wi):
        """D, G, F and the Jacobian, whose product is f, for directions above the horizon: name -> (...), of F (..., 3)."""
        D = slot("ndf", self.ndf).D(wo + wi, np.array(self.alpha))
        return {"D": D, "G": self._G2(wo, wi), "F": self._F(wo, wi), "jacobian": 1 / (4 * split(wo)[2] * split(wi)[2])}

    def _F(self, wo, wi):
        return slot("fresnel", self.slots()["fresnel"]).F(cos_facet(wo, wi), np.array(self.eta), np.array(self.k))

    def _sampling(self):
        return slot("sampling", self.ndf, self.sampling)

    def _G2(self, wo, wi):
        alpha = np.array(self.alpha)
        Lambda = slot("smith", self.ndf, self.smith).Lambda
        return slot("shadowing", self.shadowing).G2(wo, wi, Lambda(wo, alpha), Lambda(wi, alpha))

"""Microfacets that are mirrors: Torrance and Sparrow 1967; Cook and Torrance 1982; as Walter et al. 2007, Eq. 20."""

from dataclasses import dataclass
from importlib import import_module

import numpy as np

from .. import microsurface
from ..lib import slot
from ..lib.common import HORIZON, above_horizon, split, vec
from ..lib.energy_turquin import gain_turquin
from ..lib.microfacet import cos_facet
from ..model import Model, choice

GAINS = {"turquin": (0.005, 0.08, 0.3), "kulla_conty": (0.004, 0.05, 0.25)}
"""What the fits of what facets lose may create: of isotropic alpha, of others, and of others with shadowing by azimuth."""


@dataclass(frozen=True)
class Microfacet(Model):
    """Torrance-Sparrow: f = D G F / (4 cos cos), facets that are mirrors.

    Leaves out transmission, and light that meets more than one facet, so rough metals lose energy: up to 0.69 of it for GGX at
    alpha = 1, seen along the normal (its albedo is 1 - ln 2). The choice energy puts it back.
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
    energy: str = choice(
        "none",
        ("none", "turquin", "kulla_conty"),
        "how light that meets more than one facet is put back: not, by a brighter lobe, or as a wide lobe",
    )

    def slots(self):
        return microsurface.filled(self.choices())

    def slopes(self):
        return self.alpha

    def exceptions(self):
        found = microsurface.exceptions(self)
        if self.energy != "none" and self.shadowing != "none":
            found["energy"] = found.get("energy", 1.0) ** 2 * (1 + self._gain())
        if self.energy == "turquin":
            found["reciprocity"] = self._not_reciprocal()
        return found

    def f(self, wo, wi):
        D = slot("ndf", self.ndf).D

        def value(wo, wi):
            scale = D(wo + wi, np.array(self.alpha)) * self._G2(wo, wi) / (4 * split(wo)[2] * split(wi)[2])
            return self._energy().energy_f(self, self.facet(cos_facet(wo, wi)) * scale[..., None], wo, wi)

        return above_horizon(value, wo, wi, 3)

    def pdf(self, wo, wi):
        return above_horizon(lambda o, i: self._energy().energy_pdf(self, self.single_pdf(o, i), o, i), wo, wi)

    def sample_f(self, wo, u):
        wo, u = np.asarray(wo, dtype=float), np.asarray(u, dtype=float)
        shape = np.broadcast_shapes(wo.shape[:-1], u.shape[:-1])
        wo, u = np.broadcast_to(wo, (*shape, 3)), np.broadcast_to(u, (*shape, 2))
        wi = np.broadcast_to([0.0, 0.0, 1.0], wo.shape).copy()
        up = wo[..., 2] > HORIZON
        with np.errstate(under="ignore"):  # of a component of no weight
            wi[up] = self._energy().energy_wi(self, wo[up], u[up])

        def weight(wo, wi):
            alpha = np.array(self.alpha)
            share = self._sampling().weight_wi(wo, wi, slot("ndf", self.ndf).D(wo + wi, alpha), alpha)
            single = self.facet(cos_facet(wo, wi)) * (self._G2(wo, wi) * share / split(wo)[2])[..., None]
            return self._energy().energy_weight(self, single, wo, wi)

        return wi, above_horizon(weight, wo, wi, 3)

    def facet(self, c):
        """Reflectance (..., 3) of a facet at a cosine of incidence (...)."""
        return slot("fresnel", self.slots()["fresnel"]).F(np.asarray(c), np.array(self.eta), np.array(self.k))

    def single_wi(self, wo, u):
        """Directions drawn for single scattering, of viewers above the horizon."""
        return self._sampling().sample_wi(wo, u, np.array(self.alpha))

    def single_pdf(self, wo, wi):
        """Their density, of directions above the horizon."""
        alpha = np.array(self.alpha)
        return self._sampling().pdf_wi(wo, wi, slot("ndf", self.ndf).D(wo + wi, alpha), alpha)

    def factors(self, wo, wi):
        """D, G, F and the Jacobian, whose product is f of single scattering, for directions above the horizon: name -> (...),
        of F (..., 3)."""
        F = self.facet(cos_facet(wo, wi))
        D = slot("ndf", self.ndf).D(wo + wi, np.array(self.alpha))
        return {"D": D, "G": self._G2(wo, wi), "F": F, "jacobian": 1 / (4 * split(wo)[2] * split(wi)[2])}

    def _sampling(self):
        return slot("sampling", self.ndf, self.sampling)

    def _gain(self):
        isotropic, other, by_azimuth = GAINS[self.energy]
        fit = isotropic if self.alpha[0] == self.alpha[1] else by_azimuth if self.shadowing == "directional" else other
        return fit + microsurface.RATIONAL * (self.smith == "rational")

    def _not_reciprocal(self):
        """A bound of |f(wo, wi) - f(wi, wo)| over the larger one: 1 - 1 / gain, Turquin's largest; none is below 1."""
        cosine, phi = np.meshgrid(np.geomspace(1e-5, 1, 200), [0.0, 0.5 * np.pi])
        sine = np.sqrt((1 - cosine) * (1 + cosine))
        w = vec(sine * np.cos(phi), sine * np.sin(phi), cosine)
        lost = slot("lost", self.ndf, self.shadowing).lost(w, np.array(self.alpha))
        return float(1 - 1 / np.max(gain_turquin(self.facet(1.0), lost))) * 1.001 + 1e-12

    def _energy(self):
        return import_module(f"{__package__}.microfacet_{self.energy}")

    def _G2(self, wo, wi):
        alpha = np.array(self.alpha)
        Lambda = slot("smith", self.ndf, self.smith).Lambda
        return slot("shadowing", self.shadowing).G2(wo, wi, Lambda(wo, alpha), Lambda(wi, alpha))

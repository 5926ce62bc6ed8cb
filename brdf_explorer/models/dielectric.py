"""A rough interface between two dielectrics, whose facets reflect and refract: Walter et al. 2007, Eqs. 20 and 21."""

from dataclasses import dataclass

import numpy as np

from ..lib import slot
from ..lib.common import HORIZON, dot, length, mirror, quotient, split, vec
from ..lib.fresnel import F_dielectric
from ..lib.microfacet import cos_facet
from ..lib.random import third
from ..lib.refraction import T_dielectric, T_spread, apart_from_one, cos_refracted, refracted, sum_refracted, upward
from ..model import Model, choice, param

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Dielectric(Model):
    """A rough interface between two dielectrics: facets that reflect and refract. Below the horizon is the medium of index eta.

    Leaves out light that meets more than one facet. Radiance is that of the viewer's side, so from air light from below looks
    diluted by 1 / eta^2.
    """

    transmits = True

    alpha: tuple = param((0.1, 0.1), 1e-4, 1.0, "roughness along x and y: scale of the facets' slopes", scale="log")
    eta: float = param(1.5, 0.25, 4.0, "index of refraction below the surface over that above", scale="log")
    ndf: str = choice("ggx", ("ggx", "beckmann"), "distribution of the facets' normals")
    masking: str = choice(
        "beta",
        ("correlated", "separable", "beta"),
        "how masking and shadowing combine: beta is exact for random heights, separable Mitsuba's, correlated pbrt's",
    )

    def slopes(self):
        return self.alpha

    def index(self):
        return float(apart_from_one(self.eta))

    def f(self, wo, wi):
        def reflected(wo, wi):
            return self._mirroring(wo, wi) * self.G2(wo, wi) / (wo[..., 2] * wi[..., 2])

        def transmitted(wo, wi):
            n = np.where(wo[..., 2] > 0, 1.0, self.eta_seen(wi))
            return n * n * self.passing(wo, wi) * self.G2(wo, wi) / np.abs(wo[..., 2] * wi[..., 2])

        return self._by_side(reflected, transmitted, wo, wi)[..., None] * np.ones(3)

    def pdf(self, wo, wi):
        def reflected(wo, wi):
            return self._mirroring(wo, wi) / self._area(wo)

        def transmitted(wo, wi):
            n = np.where(wo[..., 2] > 0, self.eta_seen(wo), 1.0)
            return n * n * self.passing(wo, wi) / self._area(wo)

        return self._by_side(reflected, transmitted, wo, wi)

    def sample_f(self, wo, u):
        wo, u = np.asarray(wo, dtype=float), np.asarray(u, dtype=float)
        shape = np.broadcast_shapes(wo.shape[:-1], u.shape[:-1])
        wo, u = np.broadcast_to(wo, (*shape, 3)), np.broadcast_to(u, (*shape, 2))
        level = np.abs(wo[..., 2]) <= HORIZON
        wo = np.where(level[..., None], UP, wo)
        with np.errstate(under="ignore"):  # of a component of no weight
            wi, weight = self._sample(wo, u)
        return np.where(level[..., None], [1.0, 0.0, 0.0], wi), np.where(level, 0.0, weight)[..., None] * np.ones(3)

    def _sample(self, wo, u):
        o, eta = upward(wo), self.eta_seen(wo)
        wm = slot("sampling", self.ndf, "caps").sample_wm(o, u, np.array(self.alpha))
        reflects = third(u) < F_dielectric(np.clip(dot(o, wm), 0.0, 1.0), eta)
        w = np.where(reflects[..., None], mirror(o, wm), refracted(o, wm, eta))
        lost = np.where(reflects, w[..., 2] <= HORIZON, w[..., 2] >= -HORIZON)
        z = np.where(wo[..., 2] > 0, w[..., 2], -w[..., 2])
        wi = vec(w[..., 0], w[..., 1], np.where(lost, 0.0, z))
        share = self._area(wo) / o[..., 2] * self.G2(wo, np.where(lost[..., None], wo, wi))
        return wi, np.where(lost, 0.0, np.where(reflects, share, share / eta**2))

    def _by_side(self, reflected, transmitted, wo, wi):
        """reflected(wo, wi) (...) where both directions are on one side, transmitted where not, and 0 on the horizon."""
        wo, wi = np.broadcast_arrays(np.asarray(wo, dtype=float), np.asarray(wi, dtype=float))
        level = (np.abs(wo[..., 2]) <= HORIZON) | (np.abs(wi[..., 2]) <= HORIZON)
        wo, wi = (np.where(level[..., None], UP, w) for w in (wo, wi))
        with np.errstate(under="ignore"):
            return np.where(level, 0.0, np.where(crosses(wo, wi), transmitted(wo, wi), reflected(wo, wi)))

    def eta_seen(self, w):
        """The index of the other side over that of w."""
        eta = apart_from_one(self.eta)
        return np.where(split(w)[2] > 0, eta, 1 / eta)

    def _area(self, w):
        """Area of the facets that w sees."""
        return slot("ndf", self.ndf).visible_area(upward(w), np.array(self.alpha))

    def _mirroring(self, wo, wi):
        """Of facets that mirror wi to wo: F D / 4."""
        o, i = upward(wo), upward(wi)
        D = slot("ndf", self.ndf).D(o + i, np.array(self.alpha))
        return 0.25 * F_dielectric(cos_facet(o, i), self.eta_seen(wo)) * D

    def passing(self, wo, wi):
        """Of facets that refract wi to wo: T D cos cos / L^2, the same with wo and wi exchanged."""
        D, share, _ = self._refracting(wo, wi)
        return share * D

    def _refracting(self, wo, wi):
        """Of facets that refract wi to wo: D, T_spread, and its T; all 0 where there are none."""
        eta, up = apart_from_one(self.eta), wo[..., 2:] > 0
        sum = sum_refracted(np.where(up, wo, wi), np.where(up, wi, wo), eta)
        wm = np.where(np.asarray(eta > 1)[..., None], -sum, sum)
        share = T_spread(wm, eta)
        passes = share > 0
        D = slot("ndf", self.ndf).D(np.where(passes[..., None], wm, UP), np.array(self.alpha))
        above, below = split(np.where(passes[..., None], cos_refracted(length(wm), eta), 1.0))
        return np.where(passes, D, 0.0), share, np.where(passes, T_dielectric(above, below, eta), 0.0)

    def factors(self, wo, wi):
        """D, G, F or 1 - F, and the Jacobian, whose product is f, off the horizon: name -> (...), of F (..., 3)."""
        wo, wi = np.broadcast_arrays(np.asarray(wo, dtype=float), np.asarray(wi, dtype=float))
        o, i, crossing = upward(wo), upward(wi), crosses(wo, wi)
        D, share, T = self._refracting(wo, wi)
        n = np.where(wo[..., 2] > 0, 1.0, self.eta_seen(wi))
        F = np.where(crossing, T, F_dielectric(cos_facet(o, i), self.eta_seen(wo)))
        D = np.where(crossing, D, slot("ndf", self.ndf).D(o + i, np.array(self.alpha)))
        jacobian = np.where(crossing, n * n * quotient(share, T), 0.25) / (o[..., 2] * i[..., 2])
        return {"D": D, "G": self.G2(wo, wi), "F": F[..., None] * np.ones(3), "jacobian": jacobian}

    def G2(self, wo, wi):
        """Share of the facets that both directions see, of those that reflect or, for directions on both sides, transmit."""
        Lambda, masking = slot("smith", self.ndf, "exact").Lambda, slot("masking", self.masking)
        both = [np.asarray(Lambda(upward(w), np.array(self.alpha))) for w in (wo, wi)]
        found, at = np.array(masking.G2_reflected(*both)), crosses(wo, wi)
        found[at] = masking.G2_transmitted(*(Lambda[at] for Lambda in both))
        return found


def crosses(wo, wi):
    """Whether the surface is between two directions (..., 3)."""
    return (wo[..., 2] > 0) != (wi[..., 2] > 0)

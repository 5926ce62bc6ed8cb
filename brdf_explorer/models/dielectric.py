"""A rough interface between two dielectrics, whose facets reflect and refract: Walter et al. 2007, Eqs. 20 and 21."""

from dataclasses import dataclass

import numpy as np

from ..lib import slot
from ..lib.common import HORIZON, dot, length, mirror, split, vec
from ..lib.fresnel import F_dielectric
from ..lib.microfacet import cos_facet
from ..lib.random import third
from ..lib.refraction import T_dielectric, apart_from_one, cos_refracted, refracted, sum_refracted, upward
from ..model import Model, choice, param


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
        return self._by_side(self._f_reflected, self._f_transmitted, wo, wi)[..., None] * np.ones(3)

    def pdf(self, wo, wi):
        return self._by_side(self._pdf_reflected, self._pdf_transmitted, wo, wi)

    def sample_f(self, wo, u):
        wo, u = np.asarray(wo, dtype=float), np.asarray(u, dtype=float)
        shape = np.broadcast_shapes(wo.shape[:-1], u.shape[:-1])
        wo, u = np.broadcast_to(wo, (*shape, 3)), np.broadcast_to(u, (*shape, 2))
        wi = np.broadcast_to([1.0, 0.0, 0.0], wo.shape).copy()
        weight = np.zeros(shape)
        off = np.abs(wo[..., 2]) > HORIZON
        with np.errstate(under="ignore"):  # of a component of no weight
            wi[off], weight[off] = self._sample(wo[off], u[off])
        return wi, weight[..., None] * np.ones(3)

    def _sample(self, wo, u):
        alpha, o, eta = np.array(self.alpha), upward(wo), self.eta_seen(wo)
        wm = slot("sampling", self.ndf, "caps").sample_wm(o, u, alpha)
        reflects = third(u) < F_dielectric(np.clip(dot(o, wm), 0.0, 1.0), eta)
        w = np.where(reflects[..., None], mirror(o, wm), refracted(o, wm, eta))
        lost = np.where(reflects, w[..., 2] <= HORIZON, w[..., 2] >= -HORIZON)
        wi = vec(w[..., 0], w[..., 1], np.where(lost, 0.0, np.where(wo[..., 2] > 0, w[..., 2], -w[..., 2])))
        weight = np.zeros(lost.shape)
        share = slot("ndf", self.ndf).visible_area(o, alpha) / o[..., 2]
        weight[~lost] = share[~lost] * self.G2(wo[~lost], wi[~lost])
        return wi, np.where(reflects, weight, weight / eta**2)

    def _by_side(self, reflected, transmitted, wo, wi):
        """reflected(wo, wi) (...) where both directions are on one side, transmitted where not, and 0 on the horizon."""
        wo, wi = np.broadcast_arrays(np.asarray(wo, dtype=float), np.asarray(wi, dtype=float))
        off = (np.abs(wo[..., 2]) > HORIZON) & (np.abs(wi[..., 2]) > HORIZON)
        crosses = (wo[..., 2] > 0) != (wi[..., 2] > 0)
        out = np.zeros(off.shape)
        with np.errstate(under="ignore"):
            for function, at in ((reflected, off & ~crosses), (transmitted, off & crosses)):
                out[at] = function(wo[at], wi[at])
        return out

    def _f_reflected(self, wo, wi):
        return self._mirroring(wo, wi) * self.G2(wo, wi) / (wo[..., 2] * wi[..., 2])

    def _pdf_reflected(self, wo, wi):
        return self._mirroring(wo, wi) / slot("ndf", self.ndf).visible_area(upward(wo), np.array(self.alpha))

    def _f_transmitted(self, wo, wi):
        n = np.where(wo[..., 2] > 0, 1.0, self.index())
        return n * n * self.passing(wo, wi) * self.G2(wo, wi) / np.abs(wo[..., 2] * wi[..., 2])

    def _pdf_transmitted(self, wo, wi):
        n = np.where(wo[..., 2] > 0, self.index(), 1.0)
        return n * n * self.passing(wo, wi) / slot("ndf", self.ndf).visible_area(upward(wo), np.array(self.alpha))

    def eta_seen(self, w):
        """The index of the other side over that of w."""
        return np.where(split(w)[2] > 0, self.index(), 1 / self.index())

    def _mirroring(self, wo, wi):
        """Of facets that mirror wi to wo: F D / 4."""
        o, i = upward(wo), upward(wi)
        return (
            0.25
            * F_dielectric(cos_facet(o, i), self.eta_seen(wo))
            * slot("ndf", self.ndf).D(o + i, np.array(self.alpha))
        )

    def passing(self, wo, wi):
        """Of facets that refract wi to wo: T D cos cos / L^2, the same with wo and wi exchanged."""
        eta = np.array(self.index())
        up = (wo[..., 2] > 0)[..., None]
        sum = sum_refracted(np.where(up, wo, wi), np.where(up, wi, wo), eta)
        wm = -sum if eta > 1 else sum
        L = length(sum)
        found = np.zeros(L.shape)
        seen = (L > 0) & (wm[..., 2] > 0)
        c = cos_refracted(np.where(seen, L, 1.0), eta)
        seen &= np.all(c > 0, axis=-1)
        c, L = c[seen], L[seen]
        D = slot("ndf", self.ndf).D(wm[seen], np.array(self.alpha))
        found[seen] = T_dielectric(c[:, 0], c[:, 1], eta) * (c[:, 0] / L) * (c[:, 1] / L) * D
        return found

    def G2(self, wo, wi):
        """Share of the facets that both directions see, of those that reflect or, for directions on both sides, transmit."""
        Lambda, masking = slot("smith", self.ndf, "exact").Lambda, slot("masking", self.masking)
        Lambda_o, Lambda_i = (Lambda(upward(w), np.array(self.alpha)) for w in (wo, wi))
        crosses = (wo[..., 2] > 0) != (wi[..., 2] > 0)
        found = masking.G2_reflected(Lambda_o, Lambda_i)
        found[crosses] = masking.G2_transmitted(Lambda_o[crosses], Lambda_i[crosses])
        return found

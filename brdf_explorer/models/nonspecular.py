"""Microfacets that are no mirrors: the lecture's "Non-Specular Microfacets", its general integral by quadrature.

Its last step, "Specular Microfacets Redux", is the limit of sharp lobes: Torrance and Sparrow's model.
"""

from dataclasses import dataclass

import numpy as np

from .. import microsurface
from ..lib import slot
from ..lib.common import HORIZON, above_horizon, quotient, split
from ..lib.facet_lobe import blurred
from ..lib.facets import facets
from ..lib.microfacet import cos_facet
from ..model import Model, choice, param


@dataclass(frozen=True)
class Nonspecular(Model):
    """Facets that are no mirrors: f is the integral of D G f_mf (wo . wm)+ (wi . wm)+ over their normals, over cos cos.

    Leaves out light that meets more than one facet, so rough surfaces lose energy. Of the parameters, albedo is of lambert, and
    eta, k, kappa and fresnel are of lobe.

    alpha is from 0.01, where Lambertian facets are Lambert's law within 1 %. At 1e-4 rounding in float32 makes 2.4e-3 of a lobe.
    """

    alpha: tuple = microsurface.alpha(0.3, low=0.01)
    albedo: tuple = param((0.8, 0.8, 0.8), 0.0, 1.0, "share of the light that a facet reflects, linear RGB", color=True)
    kappa: float = param(100.0, 1.0, 1e6, "sharpness of a facet's lobe: about 1 / its variance in angle", scale="log")
    eta: tuple = microsurface.eta()
    k: tuple = microsurface.k()
    facet: str = choice("lambert", ("lambert", "lobe"), "f_mf: Lambert's law, or a lobe about the mirror direction")
    ndf: str = microsurface.ndf()
    shadowing: str = microsurface.shadowing()
    fresnel: str = microsurface.fresnel()
    spectrum: str = microsurface.spectrum()
    smith: str = microsurface.smith()
    nodes: str = choice("12", ("8", "12", "16"), "points of the quadrature along each of two angles")

    def slots(self):
        return microsurface.filled(self.choices())

    def slopes(self):
        if self.facet == "lambert":
            return (1.0, 1.0)
        return tuple(np.minimum(blurred(self.alpha, self.kappa), 1.0).tolist())

    def exceptions(self):
        found = microsurface.exceptions(self)
        found["reciprocity"] = (
            1e-6  # exchanged, the nodes may lie about another corner; and the exponent multiplies rounding
        )
        if self.facet == "lobe":
            found["float32 is float64"] = 2e-3  # in a tail rounding moves the nodes; 1e-4 of the largest value and more
        return found

    def f(self, wo, wi):
        return above_horizon(self._f, wo, wi, 3)

    def pdf(self, wo, wi):
        return above_horizon(self._pdf, wo, wi)

    def sample_f(self, wo, u):
        wo, u = np.asarray(wo, dtype=float), np.asarray(u, dtype=float)
        shape = np.broadcast_shapes(wo.shape[:-1], u.shape[:-1])
        wo, u = np.broadcast_to(wo, (*shape, 3)), np.broadcast_to(u, (*shape, 2))
        wi = np.broadcast_to([0.0, 0.0, 1.0], wo.shape).copy()
        up = wo[..., 2] > HORIZON
        with np.errstate(under="ignore"):  # of a component of no weight
            sample_wi = slot("sampling", self.ndf, "caps").sample_wi
            wi[up] = self._facet().facet_wi(wo[up], u[up], np.array(self.alpha), self.kappa, sample_wi)
        return wi, above_horizon(
            lambda o, i: self._f(o, i) * quotient(split(i)[2], self._pdf(o, i))[..., None], wo, wi, 3
        )

    def _f(self, wo, wi):
        alpha, facet = np.array(self.alpha), self._facet()
        Lambda = slot("smith", self.ndf, self.smith).Lambda
        G = slot("shadowing", self.shadowing).G2(wo, wi, Lambda(wo, alpha), Lambda(wi, alpha))
        gauss = slot("gauss", self.nodes)
        seen = facets(
            wo,
            wi,
            alpha,
            facet.facet_sharpness(self.kappa),
            slot("facets", self.ndf).NODE_SCALE,
            gauss.NODES,
            slot("ndf", self.ndf).D,
            gauss.gauss,
        )
        F = slot("fresnel", self.slots()["fresnel"]).F
        scale = facet.facet_scale(
            cos_facet(wo, wi), np.array(self.albedo), np.array(self.eta), np.array(self.k), self.kappa, F
        )
        return scale * (G * seen / (split(wo)[2] * split(wi)[2]))[..., None]

    def _pdf(self, wo, wi):
        D, pdf_wi = slot("ndf", self.ndf).D, slot("sampling", self.ndf, "caps").pdf_wi
        return self._facet().facet_pdf(wo, wi, np.array(self.alpha), self.kappa, D, pdf_wi)

    def _facet(self):
        return slot("facet", self.facet)

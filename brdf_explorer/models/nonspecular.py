"""Microfacets that are no mirrors: the lecture's "Non-Specular Microfacets", its general integral by quadrature.

Its last step, "Specular Microfacets Redux", is the limit of sharp lobes: Torrance and Sparrow's model.
"""

from dataclasses import dataclass

import numpy as np

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
    """

    alpha: tuple = param((0.3, 0.3), 0.01, 1.0, "roughness along x and y: scale of the facets' slopes", scale="log")
    albedo: tuple = param((0.8, 0.8, 0.8), 0.0, 1.0, "share of the light that a facet reflects, linear RGB", color=True)
    kappa: float = param(100.0, 1.0, 1e6, "sharpness of a facet's lobe: about 1 / its variance in angle", scale="log")
    eta: tuple = param((0.143, 0.375, 1.442), 0.05, 6.0, "index of refraction at R, G, B, relative to the air's")
    k: tuple = param((3.983, 2.386, 1.603), 0.0, 15.0, "extinction coefficient at R, G, B; 0 for a dielectric")
    facet: str = choice("lambert", ("lambert", "lobe"), "f_mf: Lambert's law, or a lobe about the mirror direction")
    ndf: str = choice("ggx", ("ggx", "beckmann"), "distribution of the facets' normals")
    shadowing: str = choice(
        "correlated",
        ("none", "separable", "correlated", "directional", "full"),
        "how masking towards the viewer and shadowing from the light combine",
    )
    fresnel: str = choice("conductor", ("conductor", "dielectric", "schlick", "one"), "reflectance of a facet")
    smith: str = choice("exact", ("exact", "rational"), "Smith's Lambda of Beckmann: exact, or Walter's rational fit")
    nodes: str = choice("12", ("8", "12", "16"), "points of the quadrature along each of two angles")

    def slopes(self):
        if self.facet == "lambert":
            return (1.0, 1.0)
        return tuple(np.minimum(blurred(self.alpha, self.kappa), 1.0).tolist())

    def exceptions(self):
        found = {}
        if self.ndf == "beckmann" and self.smith == "rational":  # the fit's G1 errs by 3.1e-3
            found["weak white furnace"] = 3.2e-3
        if self.shadowing == "none":
            found["energy"] = np.inf
        found["reciprocity"] = (
            1e-8  # exchanged, the nodes may lie about another corner; and the exponent multiplies rounding
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
        F = slot("fresnel", self.fresnel).F
        scale = facet.facet_scale(
            cos_facet(wo, wi), np.array(self.albedo), np.array(self.eta), np.array(self.k), self.kappa, F
        )
        return scale * (G * seen / (split(wo)[2] * split(wi)[2]))[..., None]

    def _pdf(self, wo, wi):
        D, pdf_wi = slot("ndf", self.ndf).D, slot("sampling", self.ndf, "caps").pdf_wi
        return self._facet().facet_pdf(wo, wi, np.array(self.alpha), self.kappa, D, pdf_wi)

    def _facet(self):
        return slot("facet", self.facet)

"""Facets that light meets many times: Heitz, Hanika, d'Eon and Dachsbacher 2016, "Multiple-Scattering Microfacet BSDFs with the
Smith Model"."""

from dataclasses import dataclass, replace
from importlib import import_module

import numpy as np

from .. import microsurface
from ..lib import slot
from ..lib.common import quotient, split
from ..lib.random import Draws, next_pass, random_states
from ..lib.refraction import apart_from_one
from ..model import Model, choice, param

MOST = 64
"""Orders of scattering that a walk has at most. Beyond lies less than 1e-7 of the energy where most is left, for white diffuse
facets of alpha = 1."""
CLEAR = 1e-14
"""A Lambda below this: no facet lies ahead."""


@dataclass(frozen=True)
class Multiscatter(Model):
    """Facets that light meets many times: a random walk over Smith's microsurface.

    f is an unbiased estimate by one walk from wo, at each of whose facets what goes on to wi is added up, in orders of
    scattering. Leaves out that heights and slopes of neighbouring facets go together, and orders above 64.
    """

    stochastic = True

    alpha: tuple = microsurface.alpha(0.2)
    eta: tuple = microsurface.eta()
    k: tuple = microsurface.k()
    albedo: tuple = param(
        (0.8, 0.8, 0.8), 0.0, 1.0, "share of the light that a diffuse facet reflects, linear RGB", color=True
    )
    eta_below: float = param(
        1.5, 0.25, 4.0, "index of refraction below the surface over that above, for dielectric facets", scale="log"
    )
    lowest: int = param(1, 1, MOST, "lowest order of scattering that counts", scale="log")
    orders: int = param(MOST, 1, MOST, "number of orders of scattering that count, from the lowest on", scale="log")
    facets: str = choice(
        "conductor",
        ("conductor", "dielectric", "diffuse"),
        "what a facet does: mirrors, reflects and refracts, or Lambert's law",
    )
    ndf: str = microsurface.ndf()
    fresnel: str = microsurface.fresnel()
    spectrum: str = microsurface.spectrum()

    def __post_init__(self):
        super().__post_init__()
        object.__setattr__(self, "transmits", self.facets == "dielectric")

    def slots(self):
        return microsurface.filled(self.choices())

    def index(self):
        return float(apart_from_one(self.eta_below)) if self.transmits else None

    def slopes(self):
        return (1.0, 1.0) if self.facets == "diffuse" else self.alpha

    def exceptions(self):
        # light meets 3.1 of them on average where alpha is 1
        gold = self.facets == "conductor" and self.fresnel == "spectral" and self.spectrum == "gold"
        return {"energy": microsurface.GOLD**4} if gold else {}

    def parts(self):
        """The orders of scattering."""
        last, found = self.last_order(), {}
        for name, low, high in (("order 1", 1, 1), ("order 2", 2, 2), ("orders 3 and up", 3, MOST)):
            low, high = max(low, self.lowest), min(high, last)
            if low <= high:
                found[name] = replace(self, lowest=low, orders=high - low + 1)
        return found

    def f(self, wo, wi):
        wo, wi = np.broadcast_arrays(np.asarray(wo, dtype=float), np.asarray(wi, dtype=float))
        at = self._facets().counts(wo) & self._facets().counts(wi)
        out = np.zeros((*at.shape, 3))
        states = random_states(at.size, next_pass()).reshape(wo.shape)
        with np.errstate(under="ignore"):  # in the tails of a density
            out[at] = self._facets().walk(self, wo[at], wi[at], Draws(states[at]))
        return out

    def pdf(self, wo, wi):
        wo, wi = np.broadcast_arrays(np.asarray(wo, dtype=float), np.asarray(wi, dtype=float))
        at = self._facets().counts(wo) & self._facets().counts(wi)
        out = np.zeros(at.shape)
        with np.errstate(under="ignore"):
            out[at] = self._facets().pdf_lobes(self, wo[at], wi[at])
        return out

    def sample_f(self, wo, u):
        wo, u = np.asarray(wo, dtype=float), np.asarray(u, dtype=float)
        shape = np.broadcast_shapes(wo.shape[:-1], u.shape[:-1])
        wo, u = np.broadcast_to(wo, (*shape, 3)), np.broadcast_to(u, (*shape, 2))
        wi = np.broadcast_to([1.0, 0.0, 0.0], wo.shape).copy()
        at = self._facets().counts(wo)
        with np.errstate(under="ignore"):  # of a component of no weight
            wi[at] = self._facets().sample_lobes(self, wo[at], u[at])
            weight = self.f(wo, wi) * quotient(np.abs(split(wi)[2]), self.pdf(wo, wi))[..., None]
        return wi, weight

    def last_order(self):
        return min(self.lowest + self.orders - 1, MOST)

    def D(self, wm):
        return slot("ndf", self.ndf).D(wm, np.array(self.alpha))

    def F(self, c):
        return slot("fresnel", self.slots()["fresnel"]).F(c, np.array(self.eta), np.array(self.k))

    def projected_area(self, w):
        return slot("walk", self.ndf).projected_area(w, np.array(self.alpha))

    def sample_wm(self, wo, u):
        return slot("sampling", self.ndf, "caps").sample_wm(wo, u, np.array(self.alpha))

    def _facets(self):
        return import_module(f"{__package__}.multiscatter_{self.facets}")

"""Ladders: the questions that have several methods for an answer, each with its methods from the cheapest to the reference.

The speed-accuracy chart, the stability map and the advice on the least sufficient method walk along them. A new method joins
by a line here, a new question by one Ladder in LADDERS.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .lib import slot
from .lib.common import vec
from .model import Choice, declared
from .models import MODELS
from .models.diffuse import r_of_sigma, sigma_of_r
from .models.multiscatter import MOST

HALF = float(np.finfo(np.float16).max)
"""The largest half-float."""


def within(state):
    return ""


def exact(state):
    return 0.0


def as_they_are(model, changes):
    return {}


@dataclass(frozen=True)
class Method:
    """An answer.

    changes   the parameters of the ladder's section that choose it; None: no state holds it. Of a material "model" may be among
              them: then the parameters that both models have are kept, and others take their defaults
    dtype     of what numbers are its values where that is the question: "f2", stored as half-floats by the shader; "f4", the
              shader's; "f8", numpy's; else "": errors are found in float64 and costs by the shader
    outside   outside(state): why it leaves its domain there, in a few words, or ""
    own       own(state): how far it may be, relative, from the truth that it stands for as a reference
    """

    name: str
    changes: dict | None
    dtype: str = ""
    outside: Callable = within
    own: Callable = exact


@dataclass(frozen=True)
class Ladder:
    """A question with its methods, the last of which is the reference, unless it is outside its domain.

    section   what the methods change: "material", or the name of a view
    measures  what a method is judged by: "f", its values; "numbers", how they are held; "samples", the spread of its weights;
              "picture", the sphere's
    applies   whether the question arises for a state
    carried   carried(model, changes): what a method's own parameters become, so that they say what the model's say
    """

    name: str
    question: str
    section: str
    measures: str
    methods: tuple[Method, ...]
    applies: Callable
    carried: Callable = as_they_are

    def reference(self, state):
        """The most accurate method for a state: the last that is within its domain."""
        return next(m for m in reversed(self.methods) if not m.outside(state))

    def at(self, state, method):
        """The state with a method of this ladder in use."""
        changes = dict(method.changes or {})
        if self.section != "material":
            return state.with_view(self.section, **changes)
        cls = MODELS[changes.pop("model", state.model.name())]
        kept = {name: getattr(state.model, name) for name in declared(cls) if name in declared(state.model)}
        return state.with_model(cls(**kept | changes | self.carried(state.model, changes)))

    def current(self, state):
        """The method that a state uses, or None if it is none of these."""
        at = state.model if self.section == "material" else state.views[self.section]
        known = {"model": at.name()} | {name: getattr(at, name) for name in declared(at)}
        return next((m for m in self.methods if m.changes is not None and m.changes.items() <= known.items()), None)

    def stochastic(self, state):
        """Whether some method's f is an estimate."""
        return any(self.at(state, m).model.stochastic for m in self.methods)


def of_choice(
    name, question, measures, options, applies=None, outside=None, own=None, choice=None, carried=as_they_are
):
    """The Ladder of a choice among a model's, named as it unless said, its options from the cheapest to the reference."""
    choice = choice or name

    def has(state):
        return choice in declared(state.model, Choice) and (applies is None or applies(state.model))

    outside, own = outside or {}, own or {}
    methods = tuple(Method(o, {choice: o}, "", outside.get(o, within), own.get(o, exact)) for o in options)
    return Ladder(name, question, "material", measures, methods, has, carried)


def absorbs(state):
    return "k is not 0" if max(state.model.k) > 0 else ""


def mirrors(model):
    """Whether a facet's reflectance is Fresnel's at complex indices."""
    chosen = model.choices()
    return chosen.get("facets", "conductor") == "conductor" and chosen.get("facet", "lobe") == "lobe"


def of_no_metal(state):
    return "no spectrum is chosen: the same as conductor" if state.model.spectrum == "none" else ""


def of_spectrum(state):
    return slot("fresnel", "spectral", state.model.spectrum).ERROR


def beyond_half(state):
    """Whether f has values that half-floats hold as infinite: its peaks are near the mirror's direction."""
    cosine = np.array([1.0, 0.5, 0.2, 0.1])
    wo = vec(np.sqrt(1 - cosine**2), 0.0, cosine)
    largest = state.model.f(wo, wo * [-1, -1, 1]).max()
    return f"f is up to {largest:.2g}, beyond {HALF:.0f}" if largest > HALF else ""


def surrounded(state):
    return state.light.environment != "none" and state.light.gain > 0


def not_of_ggx(state):
    return "visible normals of Beckmann have no caps: the same as visible" if state.model.ndf != "ggx" else ""


def as_rough(model, changes):
    """eon's r of sigma where a diffuse law comes to be eon, and back where it ceases to be."""
    was, now = model.diffuse == "eon", changes["diffuse"] == "eon"
    if was == now:
        return {}
    return {"r": r_of_sigma(model.sigma)} if now else {"sigma": sigma_of_r(model.r)}


def loses(state):
    """Whether facets that are mirrors, and opaque, lose what meets more than one of them."""
    model = state.model
    return model.name() == "microfacet" or (model.name() == "multiscatter" and model.facets == "conductor")


def walk(orders):
    return {"model": "multiscatter", "facets": "conductor", "lowest": 1, "orders": orders}


ESTIMATORS = {"light": "light", "bsdf": "BSDF", "mis": "MIS"}
"""The sphere's ways of gathering light, from the cheapest, and the names that they have here."""

LADDERS = {
    ladder.name: ladder
    for ladder in (
        of_choice(
            "smith",
            "How exact must Smith's Lambda of Beckmann be?",
            "f",
            ("rational", "exact"),
            applies=lambda model: model.ndf == "beckmann",
        ),
        of_choice(
            "shadowing",
            "How do masking and shadowing combine?",
            "f",
            ("none", "separable", "full", "directional", "correlated"),
        ),
        of_choice(
            "masking",
            "How do masking and shadowing combine on both sides of a surface?",
            "f",
            ("correlated", "separable", "beta"),
        ),
        Ladder(
            "energy",
            "How is light that meets more than one facet put back?",
            "material",
            "f",
            (
                *(Method(e, {"model": "microfacet", "energy": e}) for e in ("none", "turquin", "kulla_conty")),
                *(Method(f"walk_{n}", walk(n)) for n in (2, 3, 5)),
                Method("walk", walk(MOST)),
            ),
            loses,
        ),
        of_choice(
            "fresnel",
            "How exact must the reflectance of a facet be?",
            "f",
            ("constant", "schlick", "f82", "dielectric", "conductor", "spectral"),
            applies=lambda model: model.fresnel != "one" and mirrors(model),
            outside={"dielectric": absorbs, "spectral": of_no_metal},
            own={"spectral": of_spectrum},
        ),
        # "diffuse" has two truths: a rough surface is not a heap of grains, so each has its own question
        of_choice(
            "diffuse",
            "Does the roughness of a diffuse surface show? (r of eon is B/A of oren_nayar)",
            "f",
            ("lambert", "oren_nayar", "facets", "eon"),
            carried=as_rough,
        ),
        of_choice(
            "spheres",
            "Does it show that a body consists of grains?",
            "f",
            ("lambert", "lambert_sphere_fast", "lambert_sphere"),
            choice="diffuse",
        ),
        of_choice("nodes", "How many nodes does the integral over facets need?", "f", ("8", "12", "16")),
        of_choice(
            "sampling",
            "How are directions drawn?",
            "samples",
            ("uniform", "cosine", "ndf", "visible", "caps", "bounded"),
            outside={"caps": not_of_ggx, "bounded": not_of_ggx},
        ),
        Ladder(
            "environment",
            "How is the light from all around gathered?",
            "sphere",
            "picture",
            (
                *(
                    Method(f"{name} {n}", {"estimator": estimator, "samples": n})
                    for n in (1, 16, 256)
                    for estimator, name in ESTIMATORS.items()
                ),
                Method("MIS 4096", {"estimator": "mis", "samples": 4096}),
            ),
            surrounded,
        ),
        Ladder(
            "precision",
            "How precise must numbers be?",
            "material",
            "numbers",
            (
                Method("half output", None, "f2", beyond_half),
                Method("float32", {}, "f4"),
                Method("float64 numpy", None, "f8"),
            ),
            lambda state: not state.model.stochastic,
        ),
    )
}
"""The ladders by name."""

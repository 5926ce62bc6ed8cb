"""Ladders: the questions that have several methods for an answer, each with its methods from the cheapest to the reference.

The speed-accuracy chart, the stability map and the advice on the least sufficient method walk along them. A new method joins
by a line here, a new question by one Ladder in LADDERS.
"""

from collections.abc import Callable
from dataclasses import dataclass

from .model import Choice, declared
from .models import MODELS
from .models.multiscatter import MOST


def within(state):
    return ""


@dataclass(frozen=True)
class Method:
    """An answer. changes: the parameters of the ladder's section that choose it; None: in float64 by numpy, not in a shader.

    Of a material "model" may be among them: then the parameters that both models have are kept, and others take their defaults.
    outside(state): why the method leaves its domain there, in a few words, or "".
    """

    name: str
    changes: dict | None
    outside: Callable = within


@dataclass(frozen=True)
class Ladder:
    """A question with its methods, the last of which is the reference, unless it is outside its domain.

    section   what the methods change: "material", or the name of a view
    measures  what a method is judged by: "f", its values; "samples", the spread of its weights; "picture", the sphere's
    applies   whether the question arises for a state
    """

    name: str
    question: str
    section: str
    measures: str
    methods: tuple[Method, ...]
    applies: Callable

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
        return state.with_model(cls(**kept | changes))

    def current(self, state):
        """The method that a state uses, or None if it is none of these."""
        at = state.model if self.section == "material" else state.views[self.section]
        known = {"model": at.name()} | {name: getattr(at, name) for name in declared(at)}
        return next((m for m in self.methods if m.changes is not None and m.changes.items() <= known.items()), None)

    def stochastic(self, state):
        """Whether some method's f is an estimate."""
        return any(self.at(state, m).model.stochastic for m in self.methods)


def of_choice(name, question, measures, options, applies=None, outside=None, choice=None):
    """The Ladder of a choice among a model's, named as it unless said, its options from the cheapest to the reference."""
    choice = choice or name

    def has(state):
        return choice in declared(state.model, Choice) and (applies is None or applies(state.model))

    outside = outside or {}
    methods = tuple(Method(o, {choice: o}, outside.get(o, within)) for o in options)
    return Ladder(name, question, "material", measures, methods, has)


def absorbs(state):
    return "k is not 0" if max(state.model.k) > 0 else ""


def not_of_ggx(state):
    return "visible normals of Beckmann have no caps: the same as visible" if state.model.ndf != "ggx" else ""


def loses(state):
    """Whether facets that are mirrors, and opaque, lose what meets more than one of them, and the walk knows their Fresnel."""
    model, known = state.model, declared(MODELS["multiscatter"])["fresnel"].options
    return (
        model.name() == "multiscatter"
        and model.facets == "conductor"
        or (model.name() == "microfacet" and model.fresnel in known)
    )


def walk(orders):
    return {"model": "multiscatter", "facets": "conductor", "first": 1, "orders": orders}


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
                Method("walk_2", walk(2)),
                Method("walk", walk(MOST)),
            ),
            loses,
        ),
        of_choice(
            "fresnel",
            "How exact must the reflectance of a facet be?",
            "f",
            ("schlick", "dielectric", "conductor"),
            applies=lambda model: model.fresnel != "one" and getattr(model, "facets", "conductor") == "conductor",
            outside={"dielectric": absorbs},
        ),
        # "diffuse" has two truths: a rough surface is not a heap of grains, so each has its own question
        of_choice("diffuse", "Does the roughness of a diffuse surface show?", "f", ("lambert", "oren_nayar", "eon")),
        of_choice(
            "spheres",
            "Does it show that a body consists of grains?",
            "f",
            ("lambert", "lambert_sphere"),
            choice="diffuse",
        ),
        of_choice(
            "sampling",
            "How are directions drawn?",
            "samples",
            ("uniform", "cosine", "ndf", "visible", "caps", "bounded"),
            outside={"caps": not_of_ggx, "bounded": not_of_ggx},
        ),
    )
}
"""The ladders by name."""

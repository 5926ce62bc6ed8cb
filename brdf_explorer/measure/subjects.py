"""The functions of a material that formulas are judged by: in float32 by their forms, in float64 by their twins."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..glsl import Signature, assemble, filled, functions, of_model, params_glsl, read
from ..lib import slot
from ..lib.common import length, quotient
from ..model import Choice, Param, declared
from .regimes import FIRST, ORDINARY, TINY, UNIT, decades, linear

FORMS = ("stable", "textbook")
STEPS = (1, -1, 10, -10)
"""Changes of an argument that its condition is taken from, in UNITs. Ten of them see a kink next to it, as at total reflection,
where a formula that rounds more than once may end on the other side."""
PARTS = {"pdf_wi", "weight_wi", "facets", "facet_sharpness", "facet_scale", "facet_wi", "facet_pdf"}
PARTS |= {"refracted", "upward", "apart_from_one", "third", "flight", "exp_precise"}
"""Functions that are no rows: they are all of f, pdf and sample_f but for what has a row, or round nothing; and a depth, below 0
where a ray leaves."""
COLORS = ("f", "F", "sample_f", "diffuse_f")
"""Functions whose components are compared each; other vectors are directions, compared relative to their length."""


@dataclass(frozen=True)
class Subject:
    """A function of a material, in float32 by its forms and in float64.

    label     name and, of a chunk, the choices that selected it
    kinds     {argument: GLSL type}; of a function of the model its parameters are arguments too
    source    source(call, form) -> the Source of a probe of it
    """

    name: str
    label: str
    signature: str
    kinds: dict
    source: Callable
    double: Callable = field(repr=False)
    model: type
    choices: dict  # those that selected it
    is_model: bool = False

    @property
    def arguments(self):
        return tuple(self.kinds)

    @property
    def sizes(self):
        return [kind.components for kind in Signature(self.signature).inputs]

    @property
    def direction(self):
        """Whether its value is a vector of one meaning, not several numbers."""
        return self.signature.startswith("vec3") and self.name not in COLORS

    @cached_property
    def texts(self):
        """The texts of its forms; equal where the function has no printed form."""
        return tuple(self.source("", form).text for form in FORMS)

    @property
    def forms(self):
        return FORMS if self.texts[0] != self.texts[1] else FORMS[:1]

    def draw(self, regime, u):
        """Arguments {name: (n,) or (n, components)} that float32 holds, at points u (n, arguments, 4) of the cube."""
        drawn = {}
        first = ("alpha", "wo", "eta") if regime.below else FIRST
        order = sorted(range(len(self.arguments)), key=lambda i: _order(self.arguments[i], first))
        for i in order:
            name, size = self.arguments[i], self.sizes[i]
            how = regime.draws.get(name) or ORDINARY.get(name) or self._range(name)
            with np.errstate(all="ignore"):
                value = how(u[:, i], size, drawn).astype(np.float32).astype(float)
            drawn[name] = value[:, 0] if size == 1 else value
        return {name: drawn[name] for name in self.arguments}

    def _range(self, name):
        p = declared(self.model, Param)[name]
        return decades(p.low, p.high) if p.scale == "log" and p.low > 0 else linear(p.low, p.high)

    def single(self, gpu, arguments, form):
        """The float32 values (n, components) of a form, and for a sampler the directions (n, 3), else None."""
        found = gpu.evaluate(lambda call: self.source(call, form), self.signature, *arguments.values())
        value = found[0].reshape(len(found[0]), -1)
        return value, found[1] if len(found) > 1 else None

    def exact(self, arguments):
        """The float64 values (n, components)."""
        with np.errstate(all="ignore"):
            value = np.asarray(self.double(**arguments), dtype=float)
        count = len(next(iter(arguments.values())))
        if value.ndim == 0 or len(value) != count:
            value = np.broadcast_to(value, (count, *value.shape[-1:]))
        return value.reshape(count, -1)

    def condition(self, arguments):
        """Condition numbers (n, components), summed over all components of the arguments; infinite next to NaN."""
        base = self.exact(arguments)
        total = np.zeros(base[:, :1].shape if self.direction else base.shape)
        for name, value in arguments.items():
            for i in range(value.shape[1] if value.ndim == 2 else 1):
                largest = np.zeros(total.shape)
                for step in STEPS:
                    moved = np.array(value)
                    at = (slice(None), i) if value.ndim == 2 else slice(None)
                    moved[at] *= 1 + step * UNIT
                    change = np.abs(self.exact({**arguments, name: moved}) - base) / abs(step)
                    change = length(change)[:, None] if self.direction else change
                    largest = np.maximum(largest, np.where(np.isnan(change), np.inf, change))
                total += largest
        size = length(base)[:, None] if self.direction else np.abs(base)
        with np.errstate(all="ignore"):
            return np.where(total == 0, 0.0, total / np.maximum(size, TINY)) / UNIT


def _order(name, first):
    return first.index(name) if name in first else len(first)


def subjects(model):
    """The Subjects of a material: the functions of chunks that its shader calls, and its own."""
    cls, path = type(model), f"models/{model.name()}.glsl"
    text = read(path, [])
    for include in re.findall(r'#include "(models/[^"]+)"', text):
        text += read(filled(include, model.choices(), path), [])
    called = set(re.findall(r"\b(\w+)\(", text))
    found = []
    for include in re.findall(r'#include "(lib/[^"]+)"', text):
        file = filled(include, model.slots(), path)
        chosen = {k: v for k, v in model.choices().items() if len(_fillings(include, model, k)) > 1}
        for function in _all_functions(file):
            there = hasattr(slot(file[4:-5]), function.name)
            if there and function.name in called - PARTS - {s.name for s in found}:
                found.append(_chunk(cls, file, function, chosen))
    # of an estimate one value says nothing; its parts have rows, and so have those of a pdf of both sides
    own = ("f", "pdf", "sample_f") if not model.stochastic else () if model.transmits else ("pdf",)
    return found + [_of_model(cls, model, function) for function in functions(path) if function.name in own]


def all_subjects(model):
    """The Subjects of a material and of every other option of each of its choices."""
    found = {s.label: s for s in subjects(model) if not s.is_model}
    for name, c in declared(model, Choice).items():
        for option in c.options:
            found |= {s.label: s for s in subjects(replace(model, **{name: option})) if not s.is_model}
    return sorted(found.values(), key=lambda s: s.name) + [s for s in subjects(model) if s.is_model]


def _fillings(include, model, choice):
    """What the slots of a path become by the options of a choice."""
    options = declared(model, Choice)[choice].options
    return {filled(include, replace(model, **{choice: o}).slots(), include) for o in options}


def _all_functions(file):
    """Functions of a file, or of those that it stands for."""
    own = functions(file)
    included = re.findall(r'#include "(lib/[^"{]+)"', read(file, []))
    return own if own and len(included) == 0 else own + [f for i in included for f in _all_functions(i)]


def _chunk(cls, file, function, choices):
    def source(call, form):
        return assemble(
            "views/probe.frag", None, {"chunk.glsl": f'#include "{file}"\n', "call.glsl": call}, formulas=form
        )

    twin = getattr(slot(file[4:-5]), function.name)
    kinds = {name: kind for kind, name in function.arguments}
    label = " ".join([function.name, *choices.values()])
    return Subject(function.name, label, function.signature, kinds, source, twin, cls, choices)


def _of_model(cls, model, function):
    """A function of a model, its parameters made arguments."""
    params = declared(cls, Param)
    whole = {name for name, p in params.items() if p.glsl == "int"}  # a table holds no whole numbers
    kinds = {name: kind for kind, name in function.arguments}
    kinds |= {name: "float" if name in whole else p.glsl for name, p in params.items()}
    out = re.search(r", (out \w+ \w+)\)", function.signature)
    takes = ", ".join(f"{kind} {name}" for name, kind in kinds.items()) + (f", {out[1]}" if out else "")
    gives = ", ".join([name for _, name in function.arguments] + ([out[1].split()[-1]] if out else []))
    signature = f"{function.signature.split()[0]} at({takes})"
    made = ", ".join(f"int({name})" if name in whole else name for name in params)
    body = f"{signature} {{\n  material = Material({made});\n  return {function.name}({gives});\n}}\n"
    variable = params_glsl("material", cls).replace("uniform Material", "Material")

    def source(call, form):
        generated = {
            "chunk.glsl": f'#include "models/{cls.name()}.glsl"\n{body}',
            "call.glsl": call,
            "params.glsl": variable,
        }
        return of_model("views/probe.frag", model, generated=generated, formulas=form)

    choices = model.choices()

    def twin(**arguments):
        values = {name: arguments.pop(name) for name in params}
        rows = rows_of(cls, choices, values)
        if function.name != "sample_f":
            return getattr(rows, function.name)(**arguments)
        wo, wi = arguments["wo"], arguments["wi"]
        return quotient(rows.f(wo, wi) * np.abs(wi[:, 2:]), rows.pdf(wo, wi)[:, None])

    label = f"{function.name} {cls.name()}"
    return Subject(function.name, label, signature, kinds, source, twin, cls, {}, True)


def rows_of(cls, choices, values):
    """A material whose parameters differ from row to row, beyond their ranges too: not checked."""
    rows = object.__new__(cls)
    for name, value in {**choices, **values}.items():
        object.__setattr__(rows, name, value)
    return rows

"""Where formulas fail: for each function of a material, the corners of its arguments in which float32 goes wrong.

A row is a function, a column a regime of arguments, a cell what became of float32 there: of our form and of the one that is
printed in the lecture and the papers (shaders/textbook), both against the float64 twin at the same float32 arguments. A cell is
searched, not only sampled: points around the worst are tried again, closer and closer.

Where the question itself is ill-conditioned no form can answer it in float32. So errors are told apart by the condition number
of the float64 function: the relative change of its value, over the relative change of its arguments, all components together.
An argument is known to half a unit in the last place, 2^-24, so it alone makes an error of condition x 2^-24.
"""

import re
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..glsl import Signature, assemble, filled, functions, of_model, params_glsl, read
from ..lib import slot
from ..lib.common import HORIZON, TWO_PI, dot, length, mirror, normalize, quotient, vec
from ..lib.fresnel import eta2_cos2_t
from ..lib.microfacet import cos_facet
from ..lib.refraction import refracted
from ..model import Choice, Param, declared
from .albedo import quadrature

FORMS = ("stable", "textbook")
LIMIT = 1e-4
"""The relative error that ours must not exceed where the function is well conditioned."""
UNIT = 2.0**-24
"""The relative error of a number that is rounded to float32."""
WELL = 1e-5
"""What the arguments' rounding alone may make of the value, condition x UNIT, where a function is called well conditioned: a
tenth of LIMIT, so that ours may round ten times as its arguments were."""
GAIN = 1e-3
"""What float32 may add to an albedo, relative, before it is called a gain of energy."""
TINY = float(np.finfo(np.float32).tiny)
NODES = 24
"""Rays, and directions a ray, of an albedo."""
STEPS = (1, -1, 10, -10)
"""Changes of an argument that its condition is taken from, in UNITs. Ten of them see a kink next to it, as at total reflection,
where a formula that rounds more than once may end on the other side."""
PARTS = {"pdf_wi", "weight_wi", "facets", "facet_sharpness", "facet_scale", "facet_wi", "facet_pdf"}
PARTS |= {"refracted", "upward", "apart_from_one", "third", "flight", "exp_precise"}
"""Functions that are no rows: they are all of f, pdf and sample_f but for what has a row, or round nothing; and a depth, below 0
where a ray leaves."""
COLORS = ("f", "F", "sample_f", "diffuse_f")
"""Functions whose components are compared each; other vectors are directions, compared relative to their length."""


# --- arguments -------------------------------------------------------------------------------------------------------
# A draw maps points u (n, 4) of the unit cube, the number of an argument's components and the arguments drawn before to values
# (n, components). So a search can move in the cube.


def decades(low, high):
    return lambda u, size, drawn: low * (high / low) ** u[:, :size]


def linear(low, high):
    return lambda u, size, drawn: low + (high - low) * u[:, :size]


def some(share, draw, other):
    """`draw` for a share of the points, by the last coordinate, else another."""
    return lambda u, size, drawn: np.where(u[:, 3:] < share, draw(u, size, drawn), other(u, size, drawn))


def about(value, draw):
    """Numbers on either side of a value, the distance drawn."""

    def either(u, size, drawn):
        off = draw(np.abs(2 * u - 1), size, drawn)
        return value + np.where(u[:, :size] < 0.5, -off, off)

    return either


def direction(cosine):
    """Unit vectors by a draw of their cosine."""

    def draw(u, size, drawn):
        z = cosine(u, 1, drawn)[:, 0]
        r, phi = np.sqrt((1 - z) * (1 + z)), TWO_PI * u[:, 1]
        return vec(r * np.cos(phi), r * np.sin(phi), z)

    return draw


def about_normal(sine):
    """Unit vectors by a draw of their sine."""

    def draw(u, size, drawn):
        r, phi = sine(u, 1, drawn)[:, 0], TWO_PI * u[:, 1]
        return vec(r * np.cos(phi), r * np.sin(phi), np.sqrt((1 - r) * (1 + r)))

    return draw


def normals(slope):
    """Facets' normals by a draw of their slope, in units of alpha where there is one."""

    def draw(u, size, drawn):
        rho, psi = slope(u, 1, drawn)[:, 0], TWO_PI * u[:, 1]
        alpha = drawn.get("alpha", np.full((len(u), 2), 0.3))
        return normalize(vec(alpha[:, 0] * rho * np.cos(psi), alpha[:, 1] * rho * np.sin(psi), np.ones(len(u))))

    return draw


def reflected(slope, share=1.0):
    """Directions that facets of a drawn slope reflect wo to, for a share of the points; others, and those below, anywhere."""

    def draw(u, size, drawn):
        z, phi = 0.05 + 0.95 * u[:, 0], TWO_PI * u[:, 1]
        r = np.sqrt((1 - z) * (1 + z))
        anywhere = vec(r * np.cos(phi), r * np.sin(phi), z)
        if "wo" not in drawn:
            return anywhere
        wi = mirror(drawn["wo"], normals(slope)(u, 3, drawn))
        return np.where(((wi[:, 2] > 1e-9) & (u[:, 3] < share))[:, None], wi, anywhere)

    return draw


def near(signs, off):
    """Directions next to wo, or a ray w, with the signs of its components changed, turned by `off`; opposite at any height."""

    def draw(u, size, drawn):
        w = drawn.get("wo", drawn.get("w")) * signs
        turn = off(np.abs(2 * u - 1), 1, drawn)[:, 0] * np.where(u[:, 0] < 0.5, -1, 1)
        if np.all(np.asarray(signs) == (-1, -1, 1)):
            z = np.minimum(w[:, 2] * 10.0 ** (4 * u[:, 1] - 2), 0.5)
        else:
            z = np.clip(w[:, 2] * (1 + off(u[:, 1:], 1, drawn)[:, 0] * np.where(u[:, 2] < 0.5, -1, 1)), 1e-9, 1.0)
        phi = np.arctan2(w[:, 1], w[:, 0]) + turn
        r = np.sqrt((1 - z) * (1 + z))
        return vec(r * np.cos(phi), r * np.sin(phi), z)

    return draw


def critical(off):
    """Indices at which the facet's cosine is next to the critical angle's."""

    def draw(u, size, drawn):
        if "c" in drawn:
            c = drawn["c"]
        else:
            c = cos_facet(drawn["wo"], drawn["wi"]) if "wi" in drawn else 0.05 + 0.95 * u[:, 3]
        sine = np.sqrt(np.maximum((1 - c) * (1 + c), 0.0025))
        return np.clip(sine[:, None] * about(1.0, off)(u, size, drawn), 0.05, 0.99)

    return draw


def unequal(u, size, drawn):
    fine, rough = decades(1e-6, 1e-2)(u, 1, drawn), linear(0.3, 1.0)(u[:, 1:], 1, drawn)
    pair = np.concatenate([fine, rough], axis=1)
    return np.where(u[:, 3:] < 0.5, pair, pair[:, ::-1])


def alike(draw):
    """Half of the pairs of one number."""
    return lambda u, size, drawn: np.where(
        u[:, 3:] < 0.5, draw(u[:, :1], 1, drawn).repeat(size, 1), draw(u, size, drawn)
    )


def through(slope):
    """Directions below the surface that facets of a drawn slope refract wo to; where there is none, anywhere below."""

    def draw(u, size, drawn):
        z, phi = 0.05 + 0.95 * u[:, 0], TWO_PI * u[:, 1]
        r = np.sqrt((1 - z) * (1 + z))
        anywhere = vec(r * np.cos(phi), r * np.sin(phi), -z)
        wm, eta = normals(slope)(u, 3, drawn), drawn["eta"]
        w = refracted(drawn["wo"], wm, eta)
        c = dot(drawn["wo"], wm)
        passes = (c > 1e-3) & (eta2_cos2_t(c, eta) > 0) & (w[:, 2] < -1e-9)
        return np.where(passes[:, None], w, anywhere)

    return draw


def sum_of_refraction(u, size, drawn):
    """The length of wo + eta wi, from straight to nearly grazing incidence."""
    eta = drawn["eta"][:, None]
    least, most = np.abs(eta - 1), 0.999 * np.sqrt(np.abs(eta - 1) * (eta + 1))
    return least * (most / least) ** u[:, :size]


def uniforms(draw):
    """Random numbers of 24 bits, as lib/random.glsl makes them, below 1."""
    return lambda u, size, drawn: np.minimum(np.round(draw(u, size, drawn) / UNIT) * UNIT, 1 - UNIT)


def ends(u, size, drawn):
    """Numbers next to 0 and to 1, and at times 0."""
    low = decades(UNIT / 4, 1e-2)(np.abs(2 * u - 1), size, drawn)
    return np.where(u[:, :size] < 0.5, low, 1 - low)


ZERO = linear(0.0, 0.0)
GRAZING = decades(1e-9, 0.03)
ORDINARY = {
    "alpha": alike(decades(0.05, 0.7)),
    "wo": direction(linear(0.05, 1.0)),
    "w": direction(linear(0.05, 1.0)),
    "m": direction(linear(0.05, 1.0)),
    "wm": normals(decades(1e-2, 4.0)),
    "wi": reflected(decades(1e-2, 4.0), 0.6),
    "u": uniforms(linear(0.01, 0.99)),
    "c": linear(0.05, 1.0),
    "eta": linear(1.2, 4.0),
    "k": linear(0.5, 8.0),
    "Lambda_o": decades(1e-3, 10.0),
    "Lambda_i": decades(1e-3, 10.0),
    "density": decades(1e-3, 1e3),
    "lost_o": decades(1e-8, 0.7),
    "lost_i": decades(1e-8, 0.7),
    "lost_mean": decades(1e-8, 0.7),
    "F0": linear(0.02, 1.0),
    "F": linear(0.02, 1.0),
    "F_1": linear(0.02, 1.0),
    "F_2": linear(0.02, 1.0),
    "F_3": linear(0.02, 1.0),
    "depth": decades(1e-2, 10.0),
    "area": linear(0.05, 1.0),
    "hidden": decades(1e-3, 1.0),
    "wt": through(decades(1e-2, 4.0)),
    "cos_o": linear(0.05, 1.0),
    "cos_t": linear(0.05, 1.0),
    "L": sum_of_refraction,
}
"""Where nothing special happens. A parameter of a model that is not here is drawn from its range."""


@dataclass(frozen=True)
class Regime:
    """A corner of the arguments.

    head     two short lines for the head of a column
    draws    how some arguments are drawn there; others are ordinary
    needs    arguments that a function must have to be concerned; else one of `draws` is enough
    half     values are stored as float16
    below    of functions of a model that transmits, whose light then comes from below
    """

    name: str
    head: tuple[str, str]
    doc: str
    draws: dict
    needs: tuple[str, ...] = ()
    half: bool = False
    below: bool = False

    def concerns(self, subject):
        names = subject.arguments
        if self.below and not subject.model.transmits:
            return False
        if self.half and not subject.is_model:
            return False
        return all(n in names for n in self.needs) and any(n in names for n in self.draws)

    @property
    def largest(self):
        """The largest value that is not rounded to infinity."""
        return 65519.0 if self.half else float(np.finfo(np.float32).max)

    @property
    def tiny(self):
        return 2.0**-14 if self.half else TINY

    @property
    def limit(self):
        return LIMIT + 2.0**-11 * self.half


REGIMES = {
    r.name: r
    for r in (
        Regime("ordinary", ("ordi-", "nary"), "nothing special", ORDINARY),
        Regime(
            "grazing_o",
            ("ωo", "grazes"),
            "viewer down to a cosine of 1e-9",
            {"wo": direction(GRAZING), "w": direction(GRAZING), "c": GRAZING, "Lambda_o": decades(1.0, 1e9)},
        ),
        Regime(
            "grazing_i",
            ("ωi", "grazes"),
            "light down to a cosine of 1e-9",
            {"wi": direction(GRAZING), "Lambda_i": decades(1.0, 1e9)},
        ),
        Regime(
            "grazing_both",
            ("both", "graze"),
            "viewer and light down to a cosine of 1e-9",
            {
                "wo": direction(GRAZING),
                "wi": some(0.5, direction(GRAZING), reflected(decades(1e-3, 10.0))),
                "Lambda_o": decades(1.0, 1e9),
                "Lambda_i": decades(1.0, 1e9),
            },
            ("wo", "wi"),
        ),
        Regime(
            "opposite",
            ("ωi near", "-ωo"),
            "light nearly opposite to the viewer, both grazing",
            {"wo": direction(decades(1e-7, 0.1)), "wi": near((-1, -1, 1), decades(1e-9, 0.1))},
            ("wo", "wi"),
        ),
        Regime(
            "mirror",
            ("mirror,", "normal"),
            "normal incidence, and light in the mirror direction, down to angles of 1e-9",
            {
                "wo": some(0.5, about_normal(decades(1e-9, 1e-2)), ORDINARY["wo"]),
                "w": about_normal(decades(1e-9, 1e-2)),
                "wm": about_normal(decades(1e-9, 1e-2)),
                "wi": some(0.5, near((-1, -1, 1), ZERO), reflected(decades(1e-9, 1e-2))),
                "c": lambda u, size, drawn: 1 - decades(1e-8, 1e-2)(u, size, drawn),
                "Lambda_o": decades(1e-12, 1e-3),
                "Lambda_i": decades(1e-12, 1e-3),
            },
        ),
        Regime(
            "equal",
            ("ωi near", "ωo"),
            "light next to the viewer, down to angles of 1e-9",
            {"wi": near((1, 1, 1), decades(1e-9, 1e-2))},
            ("wo", "wi"),
        ),
        Regime(
            "alpha_0",
            ("α", "to 0"),
            "alpha from 1e-3 down to 1e-6",
            {"alpha": alike(decades(1e-6, 1e-3))},
        ),
        Regime(
            "alpha_1",
            ("α", "to 1"),
            "alpha of 0.9 up to exactly 1",
            {"alpha": alike(lambda u, size, drawn: np.minimum(0.9 + 0.12 * u[:, :size], 1.0))},
        ),
        Regime(
            "anisotropic",
            ("αx, αy", "apart"),
            "alpha of 1e-6 to 1e-2 along one axis, 0.3 to 1 along the other",
            {"alpha": unequal},
        ),
        Regime(
            "eta_1",
            ("η", "to 1"),
            "index within 1e-1 down to 1e-7 of 1, k as small or 0",
            {"eta": about(1.0, decades(1e-7, 0.1)), "k": some(0.5, ZERO, decades(1e-7, 0.1))},
            ("eta",),
        ),
        Regime(
            "total",
            ("η < 1", "total"),
            "index below 1 where total reflection begins, within 1e-7 of it and farther, k small or 0",
            {"eta": critical(decades(1e-7, 0.9)), "k": some(0.7, ZERO, decades(1e-9, 1e-2))},
            ("eta",),
        ),
        Regime(
            "k_0",
            ("k", "to 0"),
            "k of 1e-2 down to 1e-9, any index",
            {"k": decades(1e-9, 1e-2), "eta": linear(0.05, 4.0)},
            ("k",),
        ),
        Regime(
            "through",
            ("through", "it"),
            "light from below the surface, refracted by facets of all slopes, any index",
            {"eta": decades(0.3, 4.0), "wi": through(decades(1e-3, 4.0)), "wt": through(decades(1e-3, 4.0))},
            ("eta",),
            below=True,
        ),
        Regime(
            "straight",
            ("through,", "η to 1"),
            "light from below the surface, nearly straight through: index within 1e-1 down to 1e-4 of 1",
            {
                "eta": about(1.0, decades(1e-4, 0.1)),
                "wi": through(decades(1e-3, 4.0)),
                "wt": through(decades(1e-3, 4.0)),
            },
            ("eta",),
            below=True,
        ),
        Regime(
            "tails",
            ("pdf", "to 0"),
            "normals far out in the tail of D, and random numbers next to 0 and 1",
            {
                "wm": normals(decades(1.0, 1e4)),
                "wi": reflected(decades(1.0, 1e4)),
                "u": uniforms(ends),
                "density": decades(1e-30, 1e-6),
            },
        ),
        Regime(
            "half",
            ("half", "float"),
            "values stored as float16, alpha of 1e-4 to 1",
            {"alpha": alike(decades(1e-4, 1.0)), "wo": direction(decades(1e-3, 1.0))},
            ("wo",),
            half=True,
        ),
    )
}
FIRST = ("alpha", "wo", "w", "wm", "c", "wi", "eta")
"""Arguments that others are drawn by, in this order."""


# --- functions -------------------------------------------------------------------------------------------------------


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
        rows = _rows(cls, choices, values)
        if function.name != "sample_f":
            return getattr(rows, function.name)(**arguments)
        wo, wi = arguments["wo"], arguments["wi"]
        return quotient(rows.f(wo, wi) * np.abs(wi[:, 2:]), rows.pdf(wo, wi)[:, None])

    label = f"{function.name} {cls.name()}"
    return Subject(function.name, label, signature, kinds, source, twin, cls, {}, True)


def _rows(cls, choices, values):
    """A material whose parameters differ from row to row, beyond their ranges too: not checked."""
    rows = object.__new__(cls)
    for name, value in {**choices, **values}.items():
        object.__setattr__(rows, name, value)
    return rows


# --- cells -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Point:
    """Arguments by name, the float32 and float64 values there, the relative error and the condition number."""

    arguments: dict
    value: tuple
    exact: tuple
    error: float
    condition: float


@dataclass(frozen=True)
class Cell:
    """What became of a form of a function in a regime.

    points, nan, infinite, negative   how many, of arguments tried, and of those with such a value
    error         largest relative error where the function is well conditioned, at `worst`
    choices       those that selected the function
    hard          the Point of the largest error where it is ill-conditioned, or None
    reciprocity   largest relative change when light and viewer are exchanged, where it is well conditioned
    gain          largest relative gain of an albedo of more than 1 over the float64 one
    over, under   shares of the float64 values outside of the format's range
    at            the Point that shows the verdict
    """

    row: str
    column: str
    form: str
    choices: dict
    points: int
    nan: int
    infinite: int
    negative: int
    error: float
    limit: float
    worst: Point
    hard: Point | None
    reciprocity: float
    gain: float
    over: float
    under: float
    at: Point

    @property
    def verdict(self):
        """The gravest of what is wrong: nan, infinite, negative, gain, exchange or error; else over, ill or fine."""
        if self.nan or self.infinite or self.negative:
            return "nan" if self.nan else "infinite" if self.infinite else "negative"
        if self.gain > GAIN:
            return "gain"
        if self.error > self.limit:
            return "error"
        if self.reciprocity > 2 * self.limit:
            return "exchange"
        if self.over:
            return "over"
        return "ill" if self.hard and self.hard.error > self.limit else "fine"

    @property
    def kept(self):
        """Whether the promise is kept: no NaN, infinity or negative value, no error where the function is well conditioned."""
        return self.verdict in ("over", "ill", "fine")


@dataclass(frozen=True)
class Batch:
    """Arguments tried, and what a form made of them. k is the number of values that are compared: components, or 1."""

    u: np.ndarray  # (n, arguments, 4), of the cube
    arguments: dict
    value: np.ndarray  # (n, components) float32
    exact: np.ndarray  # (n, components) float64
    error: np.ndarray  # (n, k) relative
    condition: np.ndarray  # (n, k), NaN where the error is too small to ask
    bad: np.ndarray  # (n, 3): NaN, infinite, negative


KNOWN = 1e-6
"""The relative error from which on the condition number is asked for."""


def evaluated(gpu, subject, regime, u, form, arguments):
    """The Batch of a form at arguments drawn at u."""
    value, sampled = subject.single(gpu, arguments, form)
    known, counts = dict(arguments), np.ones(len(value), dtype=bool)
    lost = np.zeros(len(value), dtype=bool)
    if sampled is not None:  # the weight is compared in the direction that was drawn
        lost = ~np.all(np.isfinite(sampled), axis=1)
        counts = ~lost & ((np.abs(sampled[:, 2]) if subject.model.transmits else sampled[:, 2]) > HORIZON)
        known.pop("u")
        known["wi"] = np.where(counts[:, None], sampled, np.float32([0, 0, 1])).astype(float)
    exact = subject.exact(known)
    exact = np.where(counts[:, None], exact, 0.0)
    with np.errstate(all="ignore"):
        value = value.astype(np.float16).astype(float) if regime.half else value.astype(float)
    value = np.where(counts[:, None] | ~np.isfinite(value), value, 0.0)
    within = np.abs(exact) < regime.largest * (1 - 1e-3)
    bad = np.stack(
        [
            np.any(np.isnan(value), axis=1) | lost,
            np.any(np.isinf(value) & within, axis=1),
            np.any(value < 0, axis=1) & (not subject.direction),
        ],
        axis=1,
    )
    floor = regime.tiny
    for name in ("wo", "wi", "w"):  # a factor leaves the range before its quotient by a cosine does
        if name in known and not regime.half:
            floor = floor / np.abs(known[name][:, 2])
    floor = np.reshape(floor, (-1, 1))
    with np.errstate(all="ignore"):
        off, size = np.abs(value - exact), np.abs(exact)
        if subject.direction:
            off, size = length(off)[:, None], length(size)[:, None]
        error = np.maximum(off - floor, 0) / np.maximum(size, floor)
        error = np.where(within | subject.direction, error, 0.0)
    condition = np.full(error.shape, np.nan)
    asked = np.any(error > KNOWN, axis=1)
    if np.any(asked):
        condition[asked] = subject.condition({name: v[asked] for name, v in known.items()})
    return Batch(u, arguments, value, exact, error, condition, bad)


def joined(batches):
    """The Batches of one form as one."""
    arguments = {name: np.concatenate([b.arguments[name] for b in batches]) for name in batches[0].arguments}
    names = ("value", "exact", "error", "condition", "bad")
    parts = {name: np.concatenate([getattr(b, name) for b in batches]) for name in names}
    return Batch(np.concatenate([b.u for b in batches]), arguments, **parts)


def closer(rng, batch, parents=12, children=24):
    """Points of the cube around those of the largest errors that the condition does not explain."""
    with np.errstate(all="ignore"):
        allowed = np.fmax(np.nan_to_num(batch.condition * UNIT, nan=0.0) / WELL, 1.0)
        score = np.max(np.where(np.isfinite(batch.error), batch.error, 0.0) / allowed, axis=1)
    best = batch.u[np.argsort(score)[-parents:]].repeat(children, axis=0)
    step = 10.0 ** rng.uniform(-5, -0.5, (len(best), 1, 1))
    moved = rng.random(best.shape) < 0.5
    return np.clip(best + moved * step * rng.normal(size=best.shape), 0.0, 1.0)


def examine(gpu, subject, regime, count=512, rounds=3, seed=1):
    """{form: Cell} of a function in a regime: `count` points, then `rounds` of points closer to the worst of each form."""
    rng = np.random.default_rng([seed, *map(ord, subject.label + regime.name)])
    u = rng.random((count, len(subject.arguments), 4))
    batches = {form: [] for form in subject.forms}
    for step in range(rounds + 1):
        arguments = subject.draw(regime, u)
        for form in subject.forms:
            batches[form].append(evaluated(gpu, subject, regime, u, form, arguments))
        if step < rounds:
            u = np.concatenate([closer(rng, joined(batches[form])) for form in subject.forms])
    return {form: cell(gpu, subject, regime, form, joined(batches[form])) for form in subject.forms}


def cell(gpu, subject, regime, form, batch):
    """The Cell of a form's Batch."""

    def point(i):
        j = int(np.argmax(np.nan_to_num(batch.error[i], nan=-1.0)))
        condition = float(batch.condition[i, j])
        return Point(
            {name: v[i].tolist() for name, v in batch.arguments.items()},
            tuple(batch.value[i].tolist()),
            tuple(batch.exact[i].tolist()),
            float(batch.error[i, j]),
            condition,
        )

    error = np.where(np.isfinite(batch.error), batch.error, 0.0)
    well = ~(batch.condition * UNIT > WELL)
    easy, tough = np.max(np.where(well, error, 0.0), axis=1), np.max(np.where(well, 0.0, error), axis=1)
    nan, infinite, negative = (int(n) for n in batch.bad.sum(axis=0))
    worst, hard = int(np.argmax(easy)), int(np.argmax(tough))
    at = (
        int(np.argmax(batch.bad[:, np.argmax([nan, infinite, negative] if not nan else [1, 0, 0])]))
        if batch.bad.any()
        else worst
    )
    exchange, exchanged = reciprocity(gpu, subject, form, batch) if not regime.half else (0.0, worst)
    gain, gaining = energy(gpu, subject, form, batch) if not regime.half else (0.0, worst)
    if not batch.bad.any() and easy[worst] <= regime.limit:
        if gain > GAIN:
            at = gaining
        elif exchange > 2 * regime.limit:
            at = exchanged
        elif tough[hard] > regime.limit:
            at = hard
    size = np.abs(batch.exact)
    return Cell(
        subject.label,
        regime.name,
        form,
        subject.choices,
        len(batch.u),
        nan,
        infinite,
        negative,
        float(easy[worst]),
        regime.limit,
        point(worst),
        point(hard) if tough[hard] > 0 else None,
        exchange,
        gain,
        float(np.mean(np.any(size > regime.largest, axis=1))),
        float(np.mean(np.any((size > 0) & (size < regime.tiny), axis=1))),
        point(at),
    )


SWAPPED = {"wo": "wi", "wi": "wo", "Lambda_o": "Lambda_i", "Lambda_i": "Lambda_o"}


def reciprocity(gpu, subject, form, batch):
    """Largest relative change under an exchange of light and viewer, beyond that of the float64 value, where f or G2 is well
    conditioned, and at which point."""
    if subject.name not in ("f", "G2"):
        return 0.0, 0
    arguments = {name: batch.arguments[SWAPPED.get(name, name)] for name in batch.arguments}
    there = batch.value
    back = subject.single(gpu, arguments, form)[0].astype(float)
    if subject.name == "f" and subject.model.transmits:  # radiance dims by n^2 as it leaves a medium
        back = back * np.where(batch.arguments["wi"][:, 2] < 0, batch.arguments["eta"] ** -2.0, 1.0)[:, None]
    with np.errstate(all="ignore"):
        size = np.maximum(np.abs(there), np.abs(back))
        floor = TINY / np.abs(batch.arguments["wo"][:, 2] * batch.arguments["wi"][:, 2])[:, None]
        change = np.maximum(np.abs(there - back) - floor, 0) / np.maximum(size, floor)
        change = np.where(np.isfinite(change), change, 0.0)
    asked = np.flatnonzero(np.max(change, axis=1) > LIMIT)
    if len(asked):  # of these the condition may not be known yet
        condition = subject.condition({name: v[asked] for name, v in batch.arguments.items()})
        exact = subject.exact({name: v[asked] for name, v in arguments.items()})
        own = np.abs(batch.exact[asked] - exact) / np.maximum(size, floor)[asked]
        change[asked] = np.where(condition * UNIT > WELL, 0.0, np.maximum(change[asked] - own, 0.0))
    change = np.max(change, axis=1)
    k = int(np.argmax(change))
    return float(change[k]), k


def energy(gpu, subject, form, batch):
    """Largest relative gain of an albedo of more than 1 over the float64 one on the same grid, and at which point."""
    if subject.name != "f":
        return 0.0, 0
    error = np.max(np.where(np.isfinite(batch.error), batch.error, 0.0), axis=1)
    chosen = np.unique(np.concatenate([np.arange(3), np.argsort(error)[-3:]]))
    arguments, cosine, weight = [], [], []
    for i in chosen:
        one = {name: v[i] for name, v in batch.arguments.items()}
        alpha = _rows(subject.model, {}, {**_defaults(subject.model), **one}).slopes()
        grid, solid = quadrature(one["wo"], tuple(alpha), NODES)
        wi = grid.wi.reshape(-1, 3).astype(np.float32).astype(float)
        wi[:, 2] = np.maximum(wi[:, 2], 1e-9)
        arguments.append(
            {name: wi if name == "wi" else np.broadcast_to(v, (len(wi), *np.shape(v))) for name, v in one.items()}
        )
        cosine.append(wi[:, 2])
        weight.append(solid.ravel())
    arguments = {name: np.concatenate([a[name] for a in arguments]) for name in batch.arguments}
    single = subject.single(gpu, arguments, form)[0].astype(float)
    exact = subject.exact(arguments)
    shape = (len(chosen), NODES * NODES, -1)
    with np.errstate(all="ignore"):
        share = (np.concatenate(cosine) * np.concatenate(weight)).reshape(shape)
        single, exact = (np.nansum(v.reshape(shape) * share, axis=1) for v in (single, exact))
        gain = np.max(np.where(single > 1, single / np.maximum(exact, 1.0) - 1, 0.0), axis=1)
    gain = np.nan_to_num(gain, nan=0.0, posinf=0.0)
    k = int(np.argmax(gain))
    return float(gain[k]), int(chosen[k])


def _defaults(cls):
    return {name: p.default for name, p in declared(cls, Param).items()}


# --- the map ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Map:
    """The cells so far: {(row, column, form): Cell}, for rows and columns in order; `progress` is in [0, 1]."""

    rows: tuple[str, ...]
    cells: dict
    progress: float

    @property
    def broken(self):
        """Our cells that break their promise."""
        return [c for c in self.cells.values() if c.form == "stable" and not c.kept]


EFFORTS = ((192, 0), (512, 3))
"""Points and rounds of search of each pass: coarse cells first."""
PAUSE = 0.05
"""Seconds between two Maps."""
_kept = {}


def stability(gpu, model, efforts=EFFORTS, everything=False):
    """Yield the Maps of a material's functions as they grow, in passes of growing effort; of its choices, not its parameters.

    everything: the functions of all options of its choices too, with the other choices as they are. Cells are kept by the text
    of their shaders.
    """
    rows = all_subjects(model) if everything else subjects(model)
    todo = [
        (subject, regime, *effort)
        for effort in efforts
        for subject in rows
        for regime in REGIMES.values()
        if regime.concerns(subject)
    ]
    labels, cells = tuple(s.label for s in rows), {}
    last = time.perf_counter()
    for n, (subject, regime, count, rounds) in enumerate(todo, 1):
        key = (gpu.device, subject.texts, subject.label, regime.name, count, rounds)
        if key not in _kept:
            _kept[key] = examine(gpu, subject, regime, count, rounds)
        for form, found in _kept[key].items():
            cells[subject.label, regime.name, form] = found
        if n == len(todo) or time.perf_counter() - last > PAUSE:
            yield Map(labels, dict(cells), n / len(todo))
            last = time.perf_counter()


def all_subjects(model):
    """The Subjects of a material and of every other option of each of its choices."""
    found = {s.label: s for s in subjects(model) if not s.is_model}
    for name, c in declared(model, Choice).items():
        for option in c.options:
            found |= {s.label: s for s in subjects(replace(model, **{name: option})) if not s.is_model}
    return sorted(found.values(), key=lambda s: s.name) + [s for s in subjects(model) if s.is_model]

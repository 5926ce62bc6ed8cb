"""The declaration of a parameter, once, and everything that is derived from it as text.

`param`, `choice` and `text` declare a dataclass field with its range, unit and meaning. Sliders, uniforms, command-line
flags, preset checks, the README's table and the tests are loops over `declared(cls)`.
"""

import difflib
import re
from dataclasses import dataclass, field, fields

import numpy as np


class Invalid(ValueError):
    """Input that cannot be used. Its message is one line: what, where, and what would be right."""


@dataclass(frozen=True)
class Param:
    """A number, or two or three, that may move while a shader runs: a uniform and a slider."""

    default: float | int | tuple
    low: float
    high: float
    doc: str
    scale: str = "linear"  # "log": the slider and the tests walk over decades
    unit: str = ""
    color: bool = False  # a linear RGB triple, edited as a colour

    @property
    def size(self):
        return len(self.default) if isinstance(self.default, tuple) else 1

    @property
    def glsl(self):
        return "int" if isinstance(self.default, int) else ("float", "vec2", "vec3")[self.size - 1]


@dataclass(frozen=True)
class Choice:
    """One of several names, fixed when a shader is assembled: it fills a slot in a path."""

    default: str
    options: tuple[str, ...]
    doc: str


@dataclass(frozen=True)
class Text:
    """Free text, such as a file's name."""

    default: str
    doc: str


def param(default, low, high, doc, *, scale="linear", unit="", color=False):
    return _declare(Param(default, low, high, doc, scale, unit, color))


def choice(default, options, doc):
    return _declare(Choice(default, tuple(options), doc))


def text(default, doc):
    return _declare(Text(default, doc))


def _declare(declaration):
    return field(default=declaration.default, metadata={"declared": declaration})


def declared(cls, kind=(Param, Choice, Text)):
    """The declarations of a class or instance by field name, of one kind if asked."""
    found = {f.name: f.metadata["declared"] for f in fields(cls) if "declared" in f.metadata}
    return {name: d for name, d in found.items() if isinstance(d, kind)}


def shown(value):
    """A value as a message shows it: on one line, and not for ever."""
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."


def nearest(name, names):
    """'; did you mean X?' for a name that is close to one of `names`, else the list of them."""
    close = difflib.get_close_matches(str(name), names, n=1, cutoff=0.5)
    return f"; did you mean {close[0]}?" if close else f"; there are: {', '.join(names)}"


def checked(where, name, declaration, value):
    """`value` as the declared type, or Invalid: "conductor: alpha = 3 is outside [0.0001, 1.0]"."""
    what = f"{where}: {name} = {shown(value)}"
    if isinstance(declaration, Text):
        if not isinstance(value, str):
            raise Invalid(f"{what} is not text")
        return value
    if isinstance(declaration, Choice):
        if value not in declaration.options:
            raise Invalid(f"{what} is not a choice{nearest(value, declaration.options)}")
        return str(value)
    size = declaration.size
    if isinstance(value, np.ndarray | np.number):
        value = value.tolist()
        what = f"{where}: {name} = {shown(value)}"
    values = list(value) if isinstance(value, tuple | list) else [value] * size
    if len(values) != size:
        raise Invalid(f"{what} has {len(values)} values; {size} expected")
    number = int if isinstance(declaration.default, int) else int | float
    if not all(isinstance(v, number) and not isinstance(v, bool) for v in values):
        raise Invalid(f"{what} is not {'a whole number' if number is int else 'a number'}" + " each" * (size > 1))
    if not all(declaration.low <= v <= declaration.high for v in values):  # NaN is not
        unit = f" {declaration.unit}" if declaration.unit else ""
        raise Invalid(f"{what} is outside [{declaration.low}, {declaration.high}]{unit}")
    if number is not int:
        values = [float(v) for v in values]
    return tuple(values) if size > 1 else values[0]


@dataclass(frozen=True)
class Declared:
    """A frozen value whose fields are declared; making one checks them. A single number fills a pair or a triple."""

    def __post_init__(self):
        for name, declaration in declared(self).items():
            object.__setattr__(self, name, checked(self.name(), name, declaration, getattr(self, name)))

    @classmethod
    def name(cls):
        """The class's name in lower case: LambertSphere is lambert_sphere."""
        return re.sub(r"(?<!^)(?=[A-Z])", "_", cls.__name__).lower()

    def choices(self):
        return {name: getattr(self, name) for name in declared(self, Choice)}


@dataclass(frozen=True)
class Model(Declared):
    """A reflection model; an instance is a material.

    Directions are unit vectors in the local frame (normal +z), away from the surface, float64 arrays (..., 3); a
    direction below the surface gives 0, unless the model transmits.

    f(wo, wi)        BSDF in 1/sr, cosine not included, (..., 3) linear RGB
    pdf(wo, wi)      density of sample_f per solid angle, (...)
    sample_f(wo, u)  u (..., 2) in the unit square -> wi (..., 3), weight = f |cos theta_i| / pdf (..., 3);
                     a weight of 0 marks a direction below the horizon, which carries no energy

    A model that transmits takes wo and wi on either side, f being radiance at the viewer: with the index n of each
    direction's side, 1 above and index() below, f(wo, wi) / n(wo)^2 = f(wi, wo) / n(wi)^2. A wi that carries no energy lies on
    the horizon, wi.z = 0.
    """

    transmits = False
    """True: f is also non-zero where wo and wi are on opposite sides; directions below the horizon count."""
    stochastic = False
    """True: f returns an unbiased estimate."""

    def slots(self):
        """What fills the slots in the paths of its shader, by name: its choices."""
        return self.choices()

    stochastic = False
    """True: f returns an unbiased estimate, another one at each call."""

    def slopes(self):
        """(alpha_x, alpha_y): scale of the half vectors' slopes over which f varies; grids and quadrature follow it."""
        return (1.0, 1.0)

    def index(self):
        """Index of the medium below over that above, by which lobes below bend; None for a material that transmits nothing."""
        return 1.0 if self.transmits else None

    def parts(self):
        """{name: model} of models whose f add up to this one's, where a diagram shows them each; else {}."""
        return {}

    def exceptions(self):
        """Laws of measure/laws.py that this material is known to break, by name, each with the limit that it keeps instead."""
        return {}

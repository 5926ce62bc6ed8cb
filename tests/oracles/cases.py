"""Every material that the declarations allow, for tests that are loops over MODELS."""

from itertools import product

import numpy as np

from brdf_explorer.model import Choice, Param, declared
from brdf_explorer.models import MODELS


def combinations(cls):
    """Every set of choices of a model, as dicts."""
    choices = declared(cls, Choice)
    return [dict(zip(choices, values, strict=True)) for values in product(*(c.options for c in choices.values()))]


CASES = [(cls, choices) for cls in MODELS.values() for choices in combinations(cls)]


def case_label(value):
    return value.name() if isinstance(value, type) else "-".join(value.values())


def material(cls, choices, rng):
    """The model at random parameters, over decades where the slider is: half of the pairs and triples are of one number."""
    drawn = {}
    for name, p in declared(cls, Param).items():
        u = rng.random(p.size)
        values = p.low * (p.high / p.low) ** u if p.scale == "log" else p.low + (p.high - p.low) * u
        drawn[name] = np.clip(values if rng.random() < 0.5 else values[:1].repeat(p.size), p.low, p.high)
        drawn[name] = tuple(drawn[name].tolist()) if p.size > 1 else float(drawn[name][0])
    return cls(**choices, **drawn)


def corners(cls, choices):
    """The model at the ends of its parameters: all low, all high, and alternating."""
    params = declared(cls, Param)

    def at(first, second):
        ends = [(p.low, p.high) for p in params.values()]
        return cls(
            **choices,
            **{
                name: tuple(e[(first, second)[i % 2]] for i in range(p.size)) if p.size > 1 else e[first]
                for (name, p), e in zip(params.items(), ends, strict=True)
            },
        )

    return [at(0, 0), at(1, 1), at(0, 1), at(1, 0)]


def white(cls, choices):
    """Whether the choices leave the facets a reflectance of 1, for any parameter: then an energy law is about shadowing alone."""
    return "one" in choices.values()

"""Materials that the declarations allow, for tests that are loops over MODELS: every option of every choice beside every option
of every other choice."""

from itertools import combinations, product

import numpy as np

from brdf_explorer.model import Choice, Param, declared
from brdf_explorer.models import MODELS


def pairwise(options):
    """A small list of dicts, one option of each name, in which each pair of options of two names occurs.

    Greedy: a case begins with a pair that is missing, and takes of each further name the option that adds most pairs.
    """
    pairs = [(a, x, b, y) for a, b in combinations(options, 2) for x in options[a] for y in options[b]]
    missing = dict.fromkeys(frozenset(((a, x), (b, y))) for a, x, b, y in pairs)  # in order, unlike a set
    cases = [] if missing else [dict(zip(options, chosen, strict=True)) for chosen in product(*options.values())]
    while missing:
        case = dict(sorted(next(iter(missing))))
        for name in options:
            if name not in case:
                new = {o: sum(frozenset(((name, o), old)) in missing for old in case.items()) for o in options[name]}
                case[name] = max(new, key=new.get)
        for pair in combinations(case.items(), 2):
            missing.pop(frozenset(pair), None)
        cases.append({name: case[name] for name in options})
    return cases


TABLES = {"spectrum": ("none", "gold")}
"""Options that stand for all of a choice, where they differ in tables of numbers alone; each is a chunk with tests of its own."""


def choices_of(cls):
    """The options of a class's choices by name."""
    return {name: TABLES.get(name, c.options) for name, c in declared(cls, Choice).items()}


def once(options):
    """A smaller list of dicts, in which each option of a name occurs."""
    count = max(map(len, options.values()))
    # names go out of step: with i // len(o) * j, the first and the second name of two options meet in each pair
    return [{n: o[(i + i // len(o) * j) % len(o)] for j, (n, o) in enumerate(options.items())} for i in range(count)]


SLOW = {"nonspecular"}
"""Models whose f takes a hundred times as long, and is a product of what each choice gives: no pairs of options."""


def cases_of(cls):
    return (once if cls.name() in SLOW else pairwise)(choices_of(cls))


CASES = [(cls, choices) for cls in MODELS.values() for choices in cases_of(cls)]


def case_label(value):
    return value.name() if isinstance(value, type) else "-".join(value.values())


def typed(p, values):
    """Numbers as a Param takes them: whole where it is; a tuple, or the first."""
    values = [round(float(v)) if isinstance(p.default, int) else float(v) for v in np.atleast_1d(values)]
    return tuple(values) if len(values) > 1 else values[0]


def material(cls, choices, rng):
    """The model at random parameters, over decades where the slider is: half of the pairs and triples are of one number."""
    drawn = {}
    for name, p in declared(cls, Param).items():
        u = rng.random(p.size)
        values = p.low * (p.high / p.low) ** u if p.scale == "log" else p.low + (p.high - p.low) * u
        values = values if rng.random() < 0.5 else values[:1].repeat(p.size)
        drawn[name] = typed(p, np.clip(values, p.low, p.high))
    if cls.stochastic:  # most walks have not one of the later orders
        drawn["lowest"] = 1
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

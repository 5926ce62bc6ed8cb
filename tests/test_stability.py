"""No NaN, infinity or negative value from either twin, at the directions, parameters and random numbers where formulas fail."""

import math
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.cases import CASES, case_label, corners, material, typed

from brdf_explorer.glsl import of_model
from brdf_explorer.measure.adversary import adversarial
from brdf_explorer.model import Param, declared
from brdf_explorer.models import MODELS

EVALUATIONS = 10_000_000
"""Of f, pdf and sample_f together, over all cases, of each twin."""


def extremes(cls, choices, rng, count=8):
    """Materials at the ends of their parameters, at those ends and the default mixed, next to a neutral index, and anywhere."""
    found = corners(cls, choices)
    for _ in range(count - len(found) - 2):
        drawn = {}
        for name, p in declared(cls, Param).items():
            special = [p.low, p.high, 1.0] if p.low <= 1.0 <= p.high else [p.low, p.high]
            near = [v for v in (1 - 1e-7, 1 + 1e-7) if p.low <= v <= p.high]
            drawn[name] = typed(p, rng.choice(special + near, p.size))
        found.append(cls(**choices, **drawn))
    return found + [material(cls, choices, rng) for _ in range(2)]


def wrong(*values):
    """How many are no number, not finite or negative."""
    return sum(int(np.sum(~(np.isfinite(v) & (v >= 0)))) for v in values)


def rows(cls, choices):
    """Materials and adversarial arguments for each, so that all cases together make EVALUATIONS."""
    rng = np.random.default_rng(len(cls.name()) + sum(map(ord, case_label(choices))))
    found = extremes(cls, choices, rng)
    count = math.ceil(EVALUATIONS / (3 * len(CASES) * len(found)))
    return [(model, *adversarial(rng, count)) for model in found]


@pytest.mark.parametrize(("cls", "choices"), CASES, ids=case_label)
def test_float64_is_finite_and_not_negative(cls, choices):
    for model, wo, wi, u in rows(cls, choices):
        sampled, weight = model.sample_f(wo, u)
        assert wrong(model.f(wo, wi), model.pdf(wo, wi), weight) == 0, model
        assert np.all(np.isfinite(sampled)), model


ALL = """
vec3 all_of(vec3 wo, vec3 wi, vec2 u, out float density, out vec3 sampled, out vec3 weight) {
  density = pdf(wo, wi);
  weight = sample_f(wo, u, sampled);
  return f(wo, wi);
}
"""


def evaluate(gpu, model, wo, wi, u):
    """f, pdf, sampled direction and weight by one program."""

    def source(call):
        chunk = {"chunk.glsl": f'#include "models/{model.name()}.glsl"\n{ALL}', "call.glsl": call}
        return of_model("views/probe.frag", model, generated=chunk)

    signature = "vec3 all_of(vec3 wo, vec3 wi, vec2 u, out float density, out vec3 sampled, out vec3 weight)"
    with np.errstate(under="ignore"):  # of a number that float32 holds as 0
        return gpu.evaluate(source, signature, wo, wi, u, uniforms={"material": model})


@pytest.mark.parametrize(("cls", "choices"), CASES, ids=case_label)
def test_float32_is_finite_and_not_negative(gpu, cls, choices):
    for model, wo, wi, u in rows(cls, choices):
        f, pdf, sampled, weight = evaluate(gpu, model, wo, wi, u)
        assert wrong(f, pdf, weight) == 0, model
        assert np.all(np.isfinite(sampled)), model


# --- a search for what nobody thought of -----------------------------------------------------------------------------


def numbers(p):
    """Values in a parameter's range, with its ends, 1, and their neighbours."""
    if isinstance(p.default, int):
        return st.integers(p.low, p.high)
    ends = [p.low, p.high] + [v for v in (1.0, np.nextafter(1.0, 0), np.nextafter(1.0, 2)) if p.low <= v <= p.high]
    one = st.one_of(st.sampled_from([float(v) for v in ends]), st.floats(p.low, p.high))
    return one if p.size == 1 else st.tuples(*[one] * p.size)


def materials():
    return st.sampled_from(CASES).flatmap(
        lambda case: st.builds(
            case[0],
            **{name: numbers(p) for name, p in declared(case[0], Param).items()},
            **{name: st.just(v) for name, v in case[1].items()},
        )
    )


COORDINATES = st.one_of(st.sampled_from([0.0, -0.0, 1.0, -1.0, 1e-30, 1e-12, 1e-8]), st.floats(-1, 1))


def unit(x, y, z):
    w = np.array([x, y, z])
    largest = np.abs(w).max()
    if largest < 1e-100:
        return np.array([0.0, 0.0, 1.0])
    with np.errstate(under="ignore"):
        w = w / largest
        return w / np.sqrt(np.sum(w * w))


DIRECTIONS = st.builds(unit, COORDINATES, COORDINATES, COORDINATES)
PAIRS = st.one_of(
    st.tuples(DIRECTIONS, DIRECTIONS),
    DIRECTIONS.map(lambda w: (w, w)),
    DIRECTIONS.map(lambda w: (w, -w)),
    DIRECTIONS.map(lambda w: (w, w * [-1, -1, 1])),
)
POINTS = st.tuples(
    *[st.one_of(st.sampled_from([0.0, 2.0**-53, 0.5, 1 - 2.0**-53]), st.floats(0, 1, exclude_max=True))] * 2
)


@settings(max_examples=800, deadline=None, derandomize=True)
@given(materials(), PAIRS, POINTS)
def test_search_float64(model, pair, u):
    wo, wi = pair
    sampled, weight = model.sample_f(wo, np.array(u))
    assert wrong(model.f(wo, wi), model.pdf(wo, wi), weight) == 0 and np.all(np.isfinite(sampled))


@pytest.mark.parametrize("cls", MODELS.values(), ids=lambda cls: cls.name())
def test_search_float32(gpu, cls):
    """Many directions at a time for one material, as a draw costs more than a direction."""
    model = st.sampled_from([choices for c, choices in CASES if c is cls][:12]).flatmap(
        lambda choices: st.builds(
            cls,
            **{name: numbers(p) for name, p in declared(cls, Param).items()},
            **{name: st.just(v) for name, v in choices.items()},
        )
    )

    @settings(max_examples=60, deadline=None, derandomize=True)
    @given(model, st.lists(st.tuples(PAIRS, POINTS), min_size=1, max_size=64))
    def law(model, rows):
        wo, wi = (np.array([pair[k] for pair, _ in rows]) for k in (0, 1))
        u = np.minimum([u for _, u in rows], 1 - 2.0**-24)
        f, pdf, sampled, weight = evaluate(gpu, model, wo, wi, u)
        assert wrong(f, pdf, weight) == 0 and np.all(np.isfinite(sampled))

    law()


# --- the tests themselves --------------------------------------------------------------------------------------------

BARE = {
    "half vector": lambda wo, wi: (wo + wi) / np.linalg.norm(wo + wi, axis=-1, keepdims=True),
    "tangent": lambda wo, wi: np.sqrt(1 - wo[:, 2] ** 2) / wo[:, 2],
    "cosines below": lambda wo, wi: 1 / (4 * wo[:, 2] * wi[:, 2]),
}


@pytest.mark.parametrize("formula", BARE)
def test_adversary_breaks_a_careless_formula(formula):
    wo, wi, _ = adversarial(np.random.default_rng(1), 5000)
    with np.errstate(all="ignore"):
        assert wrong(BARE[formula](wo, wi)) > 0


def test_adversary_covers_its_corners():
    wo, wi, u = adversarial(np.random.default_rng(1), 20_000)
    for w in (wo, wi):
        z = w[:, 2]
        assert np.any(z == 0) and np.any(z == 1) and np.any(z < 0)
        assert np.any((z > 0) & (z < 1e-29)) and np.any((z > 1e-13) & (z < 1e-11))
        assert np.all(np.abs(np.linalg.norm(w, axis=1) - 1) < 1.1e-6)
    cross = np.linalg.norm(np.cross(wo, wi), axis=1)
    same = np.sum(wo * wi, axis=1)
    for sign in (1, -1):
        assert np.any((cross == 0) & (same * sign > 0)) and np.any((cross < 1e-6) & (cross > 0) & (same * sign > 0))
    assert np.any(np.all(wo * [-1, -1, 1] == wi, axis=1))
    assert u.min() == 0 and u.max() == 1 - 2.0**-24


@pytest.mark.parametrize("cls", MODELS.values(), ids=lambda cls: cls.name())
def test_extremes_reach_the_ends_of_every_parameter(cls):
    choices = next(choices for c, choices in CASES if c is cls)
    found = extremes(cls, choices, np.random.default_rng(1))
    for f in fields(cls):
        p = f.metadata["declared"]
        if isinstance(p, Param):
            values = np.ravel([getattr(m, f.name) for m in found])
            assert p.low in values and p.high in values

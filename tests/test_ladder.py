"""Ladders are true to the models they are about."""

from dataclasses import replace

import numpy as np
import pytest

from brdf_explorer.ladder import LADDERS
from brdf_explorer.measure.grid import direction
from brdf_explorer.model import declared
from brdf_explorer.models import MODELS
from brdf_explorer.models.diffuse import r_of_sigma
from brdf_explorer.state import Light, Material, State

STATES = [State((Material("", MODELS["microfacet"](ndf=ndf, k=k)),)) for ndf in ("ggx", "beckmann") for k in (0.0, 3.0)]
STATES.append(State((Material("", MODELS["diffuse"]()),), light=Light(environment="studio")))
STATES += [State((Material("", MODELS[name]()),)) for name in ("nonspecular", "dielectric", "multiscatter")]


@pytest.mark.parametrize("ladder", LADDERS.values(), ids=LADDERS)
def test_every_method_can_be_chosen_and_is_recognised(ladder):
    for state in (s for s in STATES if ladder.applies(s)):
        for method in ladder.methods:
            if method.changes is not None:
                assert ladder.current(ladder.at(state, method)) is method
        assert not ladder.reference(state).outside(state)
    assert any(ladder.applies(state) for state in STATES)


def test_ladders_of_choices_name_every_option():
    """A new option joins a ladder, or is `one`, which is not an answer to the ladder's question."""
    for name in ("smith", "shadowing", "masking", "fresnel", "diffuse", "sampling", "nodes", "energy"):
        options = {o for model in MODELS.values() for n, d in declared(model).items() if n == name for o in d.options}
        every = [m for ladder in LADDERS.values() for m in ladder.methods]
        methods = [m for m in every if m.changes and name in m.changes and set(m.changes) <= {name, "model"}]
        assert {m.name for m in methods} == options - {"one"}


def test_reference_follows_the_domain():
    ladder = LADDERS["fresnel"]
    (dielectric,) = (m for m in ladder.methods if m.name == "dielectric")
    assert [dielectric.outside(s) != "" for s in STATES[:4]] == [False, True, False, True]
    gold = STATES[1].with_model(replace(STATES[1].model, spectrum="gold"))
    assert [ladder.reference(s).name for s in (STATES[0], STATES[1], gold)] == ["conductor", "conductor", "spectral"]


def test_a_method_that_changes_the_model_keeps_what_both_have():
    """And what one does not have takes its default: the walk's shadowing is correlated."""
    ladder = LADDERS["energy"]
    given = MODELS["microfacet"](
        alpha=(0.3, 0.7), eta=1.3, k=2.0, ndf="beckmann", fresnel="schlick", shadowing="separable"
    )
    walked = ladder.at(State((Material("", given),)), ladder.methods[-1]).model
    assert walked.name() == "multiscatter" and walked.stochastic
    for name in ("alpha", "eta", "k", "ndf", "fresnel"):
        assert getattr(walked, name) == getattr(given, name)
    back = ladder.at(State((Material("", walked),)), ladder.methods[0]).model
    assert back == MODELS["microfacet"](alpha=(0.3, 0.7), eta=1.3, k=2.0, ndf="beckmann", fresnel="schlick")


def test_fresnel_is_a_question_about_facets_that_are_mirrors_of_metal():
    asked = {name: LADDERS["fresnel"].applies(State().with_model(model())) for name, model in MODELS.items()}
    assert asked["microfacet"] and not asked["diffuse"] and not asked["dielectric"]


def test_the_diffuse_laws_are_compared_at_one_roughness():
    """eon's r has the shape of oren_nayar; it is nearly the r that is nearest to facets; and it goes there and back."""
    Diffuse, ladder = MODELS["diffuse"], LADDERS["diffuse"]
    law = {m.name: m for m in ladder.methods}
    z, phi = np.sqrt(np.random.default_rng(1).random((2, 2000))), np.random.default_rng(2).random((2, 2000)) * 2 * np.pi
    wo, wi = direction(np.arccos(z), phi)
    for sigma in (0.0, 0.01, 0.1, 0.3, 0.6, 1.0):
        rough = State((Material("", Diffuse(albedo=1e-6, sigma=sigma, r=0.123, diffuse="oren_nayar")),))
        eon = ladder.at(rough, law["eon"]).model
        for name in ("lambert", "oren_nayar", "facets"):
            back = ladder.at(rough.with_model(eon), law[name])
            assert back.model.sigma == pytest.approx(sigma, rel=1e-12) and back.model.diffuse == name
            assert ladder.at(back, law[name]) == back
        facing = np.sum(wo[:, :2] * wi[:, :2], axis=1) > 0
        ratio = (eon.f(wo, wi) / rough.model.f(wo, wi))[facing, 0]
        np.testing.assert_allclose(ratio, ratio[0], rtol=2e-6)
    assert ladder.at(State((Material("", Diffuse(diffuse="eon", r=1.0)),)), law["facets"]).model.sigma == pytest.approx(
        1
    )
    for sigma in (0.1, 0.2, 0.3, 0.4):
        truth = Diffuse(sigma=sigma, diffuse="facets").f(wo, wi)
        r = np.linspace(0.01, 1, 100)
        off = [np.mean((Diffuse(r=float(x), diffuse="eon").f(wo, wi) - truth) ** 2) for x in r]
        assert r[np.argmin(off)] == pytest.approx(r_of_sigma(sigma), rel=0.15)

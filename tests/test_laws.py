"""The laws that `check` prints: materials keep them and broken ones do not; and the quadrature's error is what it says."""

from dataclasses import dataclass
from functools import partial
from importlib import import_module

import numpy as np
import pytest
from oracles.cases import CASES, SLOW, case_label, corners, material
from test_sampling import SAMPLERS

from brdf_explorer.measure import albedo, albedo_with_error, laws
from brdf_explorer.measure.albedo import integral, shares
from brdf_explorer.measure.grid import direction
from brdf_explorer.measure.laws import energy, finite, reciprocity
from brdf_explorer.measure.microsurface import G1, projected_area
from brdf_explorer.models import MODELS

Microfacet, Diffuse, Nonspecular = (MODELS[name] for name in ("microfacet", "diffuse", "nonspecular"))
measured = import_module("brdf_explorer.measure.laws")  # whose name in the package is a function's


@pytest.mark.parametrize(("cls", "choices"), CASES, ids=case_label)
def test_reciprocal_finite_and_not_negative(cls, choices):
    rng = np.random.default_rng(1)
    for model in [cls(**choices), *corners(cls, choices), material(cls, choices, rng)]:
        count = 1000 if model.stochastic else 2000
        for law in (reciprocity(model, rng, count), finite("finite", model, model, rng, count)):
            assert law.measured <= model.exceptions().get(law.name, law.limit), (model, law)


@pytest.mark.parametrize(("cls", "choices"), [c for c in CASES if c[1].get("fresnel", "one") == "one"], ids=case_label)
def test_energy(cls, choices):
    """Albedo is at most 1, or what the material says of itself, where facets or the body reflect all."""
    whitest = {"albedo": 1.0} if "albedo" in cls.__dataclass_fields__ else {}
    for k in range(2):
        drawn = material(cls, choices, np.random.default_rng(k))
        model = type(drawn)(**{n: getattr(drawn, n) for n in drawn.__dataclass_fields__} | whitest)
        law = energy(model)
        assert law.measured <= model.exceptions().get(law.name, law.limit), (model, law)


@pytest.mark.parametrize(("cls", "choices"), [s for s in SAMPLERS if s[0].name() not in SLOW], ids=case_label)
def test_all_laws_hold_for_both_twins(gpu, cls, choices):
    found = list(laws(cls(**choices), gpu))
    assert all(law.ok for law in found), [law for law in found if not law.ok]
    names = [law.name for law in found]
    assert len(set(names)) == len(names) >= 11
    assert all(law.note and np.isfinite(law.measured) for law in found)


@pytest.mark.parametrize("facet", ["lambert", "lobe"])
def test_laws_hold_for_both_twins_of_slow_models(gpu, facet, monkeypatch):
    """All laws of the integral over facets, for one viewer, in small batches and by few nodes."""
    for name in ("reciprocity", "finite", "twins"):
        monkeypatch.setattr(measured, name, partial(getattr(measured, name), n=1000))
    monkeypatch.setattr(measured, "THETAS", (70.0,))
    monkeypatch.setattr(measured, "shares", lambda model, wo, **_: shares(model, wo, tolerance=1e-3, most=32))
    found = list(laws(Nonspecular(facet=facet, nodes="8", albedo=1.0, fresnel="one"), gpu))
    assert len(found) >= 13 and all(law.ok for law in found), found


def test_laws_without_a_gpu_leave_the_glsl_out():
    names = [law.name for law in laws(Diffuse())]
    assert len(names) == 6 and not any("GLSL" in name or "float32" in name for name in names)


def law_of(model, name):
    return next(law for law in laws(model) if law.name == name)


def test_known_exceptions_are_shown_and_not_hidden():
    law = law_of(Microfacet(shadowing="none", fresnel="one", alpha=0.5), "energy")
    assert law.measured > 2 and law.limit == np.inf and law.ok and "known" in law.note
    law = law_of(Diffuse(albedo=1, diffuse="oren_nayar", sigma=0.2), "energy")
    assert 1 < law.measured < law.limit == pytest.approx(1.01518, abs=1e-5)
    law = law_of(Microfacet(ndf="beckmann", smith="rational", alpha=0.5), "weak white furnace")
    assert 1e-3 < law.measured < law.limit == 3.2e-3


def test_exceptions_name_laws(gpu):
    """A misspelt name would leave the law as it is."""
    names = {law.name for law in laws(Microfacet(), gpu)}
    assert all(set(cls(**choices).exceptions()) <= names for cls, choices in CASES)


# --- the quadrature --------------------------------------------------------------------------------------------------

SHAPES = [(1.0, 1.0), (0.1, 0.1), (1e-4, 1e-4), (0.05, 0.9), (1e-3, 1.0)]


@pytest.mark.parametrize("theta", [30.0, 89.0, 89.99])
@pytest.mark.parametrize("ndf", ["ggx", "beckmann"])
def test_albedo_is_exact_to_nine_digits(ndf, theta):
    wo = direction(np.radians(theta), 0.7)
    for alpha in SHAPES:
        value, error = albedo_with_error(Microfacet(alpha=alpha, ndf=ndf, fresnel="one"), wo, 1e-9)
        more, _ = albedo_with_error(Microfacet(alpha=alpha, ndf=ndf, fresnel="one"), wo, 0.0, 512)
        assert np.all(np.abs(value - more) < 1e-9) and np.all(error < 1e-7), (alpha, error)


def albedo_error_in_estimates(shadowing):
    """The errors of albedos by few rays, in units of their estimates (and 1e-11), over shapes, viewers and numbers of rays.

    Below 1e-11 the estimate says little: at alpha = 1e-4 the layer along the horizon in which G falls holds alpha^2 of the
    albedo, and is too thin for two grids in a row to differ in it by more than a thousandth.
    """
    ratios = []
    for alpha in SHAPES:
        model = Microfacet(alpha=alpha, shadowing=shadowing, fresnel="one")
        for theta in (45.0, 70.0, 85.0):
            wo = direction(np.radians(theta), 0.3)
            best = albedo(model, wo, 0.0, 512)
            for most in (64, 128):
                value, error = albedo_with_error(model, wo, 0.0, most)
                ratios.append(np.max(np.abs(value - best) / (error + 1e-11)))
    return np.array(ratios)


@pytest.mark.parametrize("shadowing", ["none", "correlated", "directional"])
def test_albedo_errs_by_less_than_it_says(shadowing):
    assert albedo_error_in_estimates(shadowing).max() <= 3


def test_albedo_estimates_its_error_across_a_kink():
    """Where the smaller of two terms changes, errors fall as n^-2 but unevenly: a difference may be small by chance."""
    ratios = albedo_error_in_estimates("full")
    assert np.quantile(ratios, 0.8) <= 1 and ratios.max() < 30


def test_albedo_takes_any_shape_and_the_dark_side():
    wo = np.array([[[0.0, 0.6, 0.8], [0.0, 0.6, -0.8]], [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]])
    values = albedo(Diffuse(albedo=(1.0, 0.5, 0.25)), wo)
    assert values.shape == wo.shape
    np.testing.assert_allclose(values[:, 0], [[1.0, 0.5, 0.25]] * 2, rtol=1e-12)
    assert np.all(values[:, 1] == 0)


@pytest.mark.parametrize("theta", [0.0, 50.0, 89.0])
@pytest.mark.parametrize("alpha", SHAPES, ids=str)
def test_solid_angle_and_projected_solid_angle_of_the_hemisphere(alpha, theta):
    """On any lobe's grid: 2 pi and pi."""
    wo = direction(np.radians(theta), 0.7)
    found = integral(lambda o, i: np.stack([np.ones(i.shape[:-1]), i[..., 2]], axis=-1), wo, alpha, most=512)
    np.testing.assert_allclose(found.value, [2 * np.pi, np.pi], rtol=1e-6)


@pytest.mark.parametrize("alpha", SHAPES, ids=str)
@pytest.mark.parametrize("ndf", ["ggx", "beckmann"])
def test_weak_white_furnace_at_any_alpha(ndf, alpha):
    """Normals and not wi are integrated over, from the smoothest to the roughest, for all heights of the viewer."""
    model = Microfacet(alpha=alpha, ndf=ndf)
    assert projected_area(model, (0.0, 0.0, 1.0)) == pytest.approx(1, abs=1e-8)
    for theta in (20.0, 70.0, 89.0, 89.99):
        wo = direction(np.radians(theta), 0.9)
        assert G1(model, wo) * projected_area(model, wo) / wo[2] == pytest.approx(1, abs=1e-6)


# --- broken materials ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Broken(Microfacet):
    """A microfacet model with a fault, whose GLSL has none."""

    @classmethod
    def name(cls):
        return "microfacet"


def scaled(method, factor):
    return lambda self, wo, x: getattr(Microfacet, method)(self, wo, x) * factor(np.asarray(wo), np.asarray(x))


def heavier(self, wo, u):
    wi, weight = Microfacet.sample_f(self, wo, u)
    return wi, 1.01 * weight


def rougher(self, wo, u):
    return Microfacet(alpha=[1.1 * a for a in self.alpha]).sample_f(wo, u)


FAULTS = {
    "not reciprocal": ({"f": scaled("f", lambda o, i: 1 + 1e-6 * o[..., 2:])}, {"reciprocity"}),
    "not a number": ({"f": scaled("f", lambda o, i: np.where(i[..., 2:] == 1, np.nan, 1))}, {"finite, not negative"}),
    "negative": ({"pdf": scaled("pdf", lambda o, i: np.where(i[..., 2] < 1e-9, -1, 1))}, {"finite, not negative"}),
    "shining": ({"f": scaled("f", lambda o, i: 1.5)}, {"energy", "mean weight is albedo", "float32 is float64"}),
    "lost pi": ({"f": scaled("f", lambda o, i: 1 / np.pi)}, {"mean weight is albedo", "float32 is float64"}),
    "a last digit": ({"f": scaled("f", lambda o, i: 1 + 3e-5)}, {"float32 is float64"}),
    "pdf too large": (
        {"pdf": scaled("pdf", lambda o, i: 1.05)},
        {"samples follow pdf", "pdf integrates to the share above the horizon", "float32 is float64"},
    ),
    "weights too large": ({"sample_f": heavier}, {"mean weight is albedo"}),
    "samples too rough": ({"sample_f": rougher}, {"samples follow pdf"}),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_laws_find_a_fault(gpu, fault):
    methods, expected = FAULTS[fault]
    model = type("Broken", (Broken,), methods)(fresnel="one", alpha=0.3)
    broken = {law.name for law in laws(model, gpu) if not law.ok}
    assert expected <= broken

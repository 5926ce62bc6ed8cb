"""The estimator of the reflection equation: its moments, its error in many runs, and the view that shows both."""

from collections import deque
from dataclasses import replace

import numpy as np
import pytest
from fontTools.ttLib import TTFont
from test_views import check_labels, last

from brdf_explorer.environment import environment
from brdf_explorer.export import font_path, save_view
from brdf_explorer.lib.srgb import luminance
from brdf_explorer.measure.albedo import albedo, integral
from brdf_explorer.measure.estimator import (
    RUNS,
    Runs,
    Surroundings,
    contribution,
    moments,
    rms_error,
    samplers,
    slope,
    surroundings,
)
from brdf_explorer.measure.grid import direction
from brdf_explorer.models import MODELS
from brdf_explorer.state import Directions, Light, Look, State
from brdf_explorer.views.sampling import FACETS, PANELS, expected, profile

MICROFACET, DIFFUSE = MODELS["microfacet"], MODELS["diffuse"]
WO = direction(np.radians(55.0), np.radians(25.0))
GRAZING = direction(np.radians(80.0), 0.3)
ROUGH = MICROFACET(alpha=0.5, fresnel="one")
# Student's t with 15 degrees of freedom, as there are 16 rotations: beyond 6 lie 2.4e-5
STANDARD_ERRORS = 6.0


def best(found):
    return [m for m in found if m][-1]


def in_studio(wo, **light):
    return surroundings(Light(irradiance=0.0, environment="studio", **light), wo)


def test_samplers_that_draw_the_same_are_one():
    names = ["uniform", "cosine", "ndf", "visible", "caps", "bounded"]
    found, own = samplers(MICROFACET(sampling="bounded"))
    assert list(found) == names and own == "bounded" and all(m.sampling == name for name, m in found.items())
    found, own = samplers(MICROFACET(ndf="beckmann", sampling="caps"))
    assert list(found) == names[:4] and own == "visible"
    assert samplers(DIFFUSE()) == ({"its own": DIFFUSE()}, "its own")


# --- moments ---------------------------------------------------------------------------------------------------------


def test_variances_are_the_known_ones():
    """GGX with F = 1 and alpha = 0.5 at 80 degrees: section 4 of the models' sheet, by samples, gives three digits at most."""
    models, _ = samplers(ROUGH)
    found = best(moments(list(models.values()), GRAZING))
    variance = dict(zip(models, found.variance, strict=True))
    assert found.mean == pytest.approx(albedo(ROUGH, GRAZING)[0], abs=1e-12)
    assert variance["ndf"] == pytest.approx(1.57, abs=0.005)
    assert variance["visible"] == variance["caps"] == pytest.approx(0.085, abs=5e-4)
    assert variance["bounded"] == pytest.approx(0.039, abs=5e-4)
    assert variance["bounded"] < variance["caps"] < variance["uniform"] < variance["ndf"]
    assert np.all(found.second_error < 1e-12)


def test_samples_of_one_weight_have_no_variance():
    found = best(moments([DIFFUSE(albedo=0.5)], WO))
    assert found.mean == pytest.approx(0.5, abs=1e-14) and found.variance[0] < 1e-14


@pytest.mark.parametrize("ndf", ["ggx", "beckmann"])
def test_moments_in_a_furnace_are_those_by_quadrature(ndf):
    models = list(samplers(replace(ROUGH, ndf=ndf))[0].values())
    known = best(moments(models, GRAZING))
    found = best(moments(models, GRAZING, Surroundings(environment("furnace"), np.eye(3)), most=64))
    assert abs(found.mean - known.mean) < STANDARD_ERRORS * found.mean_error
    assert np.all(np.abs(found.second - known.second) < STANDARD_ERRORS * found.second_error)
    assert found.mean_error < 1e-3


@pytest.mark.parametrize("model", [MICROFACET(alpha=0.3), DIFFUSE(diffuse="oren_nayar")], ids=lambda m: m.name())
def test_reference_in_the_studio_is_that_by_quadrature(model):
    """Over a grid that follows the lobe, which knows no sampler and no density."""
    light = in_studio(WO, rotation=40.0, gain=2.0)
    known = integral(lambda o, i: contribution(model, o, i, light)[..., None], WO, model.slopes(), 1e-7, 256)
    found = best(moments([model], WO, light, most=64))
    assert abs(found.mean - known.value[0]) < STANDARD_ERRORS * found.mean_error + known.error[0]
    assert found.mean_error < 2e-3 * found.mean


def test_surroundings_of_a_direction_are_those_of_its_place_on_the_sphere(gpu):
    """The viewer is at the eye, and what the reflection equation gives is what the sphere's picture has there."""
    light = Light(irradiance=0.0, environment="studio", rotation=70.0, gain=1.5)
    model, view, size = (
        MICROFACET(alpha=0.4),
        State().with_view("sphere", samples=1024, noise=1e-3).views["sphere"],
        (65, 65),
    )
    state = replace(State(light=light).with_model(model), views=State().views | {"sphere": view})
    pixels = gpu.pixels(last(view.pictures(gpu, state, size)).target)[::-1]
    for theta, phi in ((20.0, 30.0), (50.0, 160.0), (60.0, -100.0)):
        wo = direction(np.radians(theta), np.radians(phi))
        around = surroundings(replace(light, rotation=0.0), wo)
        np.testing.assert_allclose(around.frame @ wo, [0, 0, 1], atol=1e-14)
        np.testing.assert_allclose(around.frame @ around.frame.T, np.eye(3), atol=1e-14)
        normal = around.frame[:, 2]
        x, y = np.round(32.0 + view.radius(size) * normal[:2]).astype(int)
        seen = np.mean(luminance(pixels[y - 1 : y + 2, x - 1 : x + 2, :3]))
        found = best(moments([model], wo, surroundings(light, wo), most=32))
        # a place is known to half a pixel, of which the sphere's radius has 30
        assert found.mean == pytest.approx(seen, rel=0.05)


def test_no_environment_is_no_light_to_sample():
    assert surroundings(Light(), WO) is None and surroundings(Light(environment="sky", gain=0.0), WO) is None


# --- runs ------------------------------------------------------------------------------------------------------------


def drawn(model, wo, samples, light=None, seed=1):
    runs = Runs(model, wo, light, seed)
    while not runs.counts or runs.counts[-1] < samples:
        deque(runs.double(), 0)
    return runs


@pytest.mark.parametrize("name", samplers(ROUGH)[0])
@pytest.mark.parametrize("light", [None, "studio"])
def test_error_is_that_of_the_variance_and_falls_as_one_over_the_root(name, light):
    light = light and in_studio(GRAZING)
    model = samplers(ROUGH)[0][name]
    known = best(moments([model], GRAZING, light, most=64 if light else 128))
    runs = drawn(model, GRAZING, 4096, light, seed=2)
    assert runs.counts == [16 * 2**k for k in range(9)] and runs.estimates.shape == (9, RUNS)
    sigma = np.sqrt(known.variance[0] / (4096 * RUNS))
    assert abs(runs.estimates[-1].mean() - known.mean) < 4.5 * np.hypot(sigma, known.mean_error)
    error = rms_error(runs.estimates, known.mean)
    by_variance = np.sqrt(known.variance[0] / np.array(runs.counts)) / known.mean
    assert np.all(np.abs(error.value - by_variance) < 6 * error.error)
    fit = slope(runs.counts, runs.estimates, known.mean)
    assert abs(fit.value + 0.5) < 4 * fit.error and fit.error < 0.1


def test_slope_of_a_known_law():
    counts = 16 * 2 ** np.arange(9)
    sign = np.where(np.arange(RUNS) % 2, 1, -1)
    for power in (-0.5, -1.0):
        fit = slope(counts, 2 * (1 + 0.1 * counts[:, None] ** power * sign), 2.0)
        assert fit.value == pytest.approx(power, abs=1e-12) and fit.error == pytest.approx(0, abs=1e-12)


def test_error_of_a_slope_is_its_spread():
    """Of runs of normal samples: errors of slopes over their jackknife's."""
    rng, counts, z = np.random.default_rng(5), 16 * 2 ** np.arange(9), []
    for _ in range(200):
        sums = np.cumsum(rng.normal(size=(9, RUNS)) * np.sqrt(np.diff(counts, prepend=0))[:, None], axis=0)
        fit = slope(counts, 1 + 0.1 * sums / counts[:, None], 1.0)
        z.append((fit.value + 0.5) / fit.error)
    # 200 values: the mean is known to 0.07 and the deviation to 0.05 of it; the jackknife may be up to 10 % off
    assert abs(np.mean(z)) < 0.3 and 0.85 < np.std(z) < 1.3


def test_error_of_an_error():
    """Root mean squares of RUNS normal errors spread by 1 / sqrt(2 RUNS)."""
    found = rms_error(1 + 0.01 * np.random.default_rng(6).normal(size=(500, RUNS)), 1.0)
    assert np.sqrt(np.mean(found.value**2)) == pytest.approx(0.01, rel=0.02)
    assert found.value.std() == pytest.approx(0.01 / np.sqrt(2 * RUNS), rel=0.15)
    assert found.error.mean() == pytest.approx(0.01 / np.sqrt(2 * RUNS), rel=0.15)


# --- the view --------------------------------------------------------------------------------------------------------


def measured(gpu, state):
    return [news for news in state.views["sampling"].measure(gpu, state, timed=False) if news][-1]


def test_view_measures_all_samplers(gpu):
    state = State(directions=Directions(70.0)).with_model(ROUGH).with_view("sampling", samples=1024)
    found = measured(gpu, state)
    assert (
        list(found.tests) == list(found.runs) == list(found.models) and len(found.models) == 6 and found.own == "caps"
    )
    assert all(runs.counts[-1] == 1024 for runs in found.runs.values())
    least = min(test.p for test in found.tests.values())
    assert -np.expm1(6 * np.log1p(-least)) > 1e-3  # Sidak
    assert all(test.samples == 20_000 for test in found.tests.values())
    for name, runs in found.runs.items():
        assert runs.weight.mean() == pytest.approx(
            found.moments.mean, abs=5 * np.sqrt(found.variance(name) / len(runs.weight))
        )
        assert runs.weight.max() <= 1 + 1e-12 or name in ("uniform", "cosine", "ndf")
    lost = {name: np.mean(runs.weight == 0) for name, runs in found.runs.items()}
    assert lost["bounded"] < lost["caps"] < lost["ndf"] and lost["uniform"] == 0


def test_expected_histogram_is_of_probability_one_less_what_is_lost():
    theta, mass = map(np.concatenate, zip(*expected(replace(ROUGH, sampling="cosine"), WO), strict=True))
    assert mass.sum() == pytest.approx(1, abs=1e-6)
    assert mass[theta < np.radians(30)].sum() == pytest.approx(0.25, abs=0.01)  # sin^2


def test_pictures_get_better_and_end(gpu):
    state = State().with_model(ROUGH).with_view("sampling", show="error", samples=256)
    pictures = list(state.views["sampling"].pictures(gpu, state, (330, 460)))
    assert [p.done for p in pictures] == [False] * (len(pictures) - 1) + [True]
    assert pictures[0].note == f"16 samples in each of {RUNS} runs"
    assert pictures[-1].note == f"256 samples in each of {RUNS} runs"


def test_table_holds_errors_over_samples(gpu, tmp_path):
    state = State().with_model(ROUGH).with_view("sampling", samples=128)
    curves = state.views["sampling"].table_of(gpu, state)
    assert curves.x.tolist() == [16, 32, 64, 128] and len(curves.y) == 18
    sigma = curves.y["caps sigma / sqrt(N)"]
    assert sigma[0] / sigma[2] == pytest.approx(2)
    assert np.all(np.abs(curves.y["caps relative error"] - sigma) < 6 * curves.y["caps standard error of it"])
    save_view(gpu, state, "sampling", tmp_path / "a.csv", (300, 200))
    assert "uniform relative error" in (tmp_path / "a.csv").read_text(encoding="utf-8")


@pytest.mark.parametrize("environment", ["none", "studio"])
def test_panels_have_room_for_their_labels(gpu, environment):
    state = State(directions=Directions(60.0), light=Light(environment=environment)).with_view("sampling", samples=256)
    found, glyphs = measured(gpu, state), set(TTFont(font_path()).getBestCmap())
    for cost in ({}, {name: np.full(9, 3e-9) for name in found.models}):
        found.costs = cost
        for show in ("all", *PANELS):
            view = state.with_view("sampling", show=show).views["sampling"]
            for size, scale in [
                ((330, 460), 1.0),
                ((600, 500), 1.0),
                ((250, 300), 1.0),
                ((2400, 1600), 2.0),
                ((900, 2000), 1.5),
            ]:
                drawing = view.drawing(state, found, size, scale)
                check_labels(drawing, size, scale)
                words = " ".join(label.text for label in drawing.labels)
                assert {ord(c) for c in words} <= glyphs, words
                if show != "all":
                    assert PANELS[show] in words
                elif size[0] > 2000:
                    assert all(title in words for title in PANELS.values())
                if size[0] > 300:
                    light = (
                        "L: studio, without the directional light" if environment == "studio" else "L = 1: the albedo"
                    )
                    assert light in words and "bounded" in words


@pytest.mark.parametrize(
    "model", [DIFFUSE(), DIFFUSE(albedo=0.0), MICROFACET(alpha=1e-4)], ids=["diffuse", "black", "sharp"]
)
@pytest.mark.parametrize("size", [(1, 1), (40, 30), (1200, 800)])
def test_any_material_and_size_is_drawn(gpu, model, size):
    state = State(look=Look(theme="dark")).with_model(model).with_view("sampling", samples=64)
    picture = last(state.views["sampling"].pictures(gpu, state, size))
    assert picture.done and picture.target.size == size
    words = [label.text for label in picture.labels]
    if model == DIFFUSE(albedo=0.0):
        assert words == ["Nothing to estimate: the material is black"]
    elif size[0] > 1000 and model == DIFFUSE():
        assert "all samples have the same weight: no error" in words


@pytest.mark.parametrize("theta_o", [0.0, 45.0, 80.0])
def test_facets_that_are_seen_face_the_viewer(theta_o):
    model, theta = MICROFACET(alpha=0.6, ndf="beckmann"), np.radians(theta_o)
    x, h, seen = profile(model, theta, 0.4)
    slopes = np.diff(h) / np.diff(x)
    facing = np.cos(theta) - np.sin(theta) * slopes > 0
    both = seen[1:] & seen[:-1]
    assert not np.any(both & ~facing)
    assert np.all(seen) if theta_o == 0 else 0.05 < seen.mean() <= 1 - 0.1 * (theta_o > 60)
    # Gaussian slopes along a line: half of them are below 0.4769 alpha
    facets = np.sort(np.abs(slopes.reshape(FACETS, -1)[:, 0]))
    assert facets[FACETS // 2 - 1] < 0.4769 * 0.6 < facets[FACETS // 2]

"""Errors and costs of methods: what the chart prints is found again by other means."""

from dataclasses import replace

import numpy as np
import pytest

from brdf_explorer.measure import albedo, cost
from brdf_explorer.measure.error import METRICS, between, brightening, flip, itp, picture_rmse, rmse_of_halves, values
from brdf_explorer.measure.grid import direction
from brdf_explorer.measure.itp import delta_e_itp, ictcp
from brdf_explorer.measure.laws import viewers
from brdf_explorer.model import Invalid
from brdf_explorer.models import MODELS
from brdf_explorer.state import State

MICROFACET = MODELS["microfacet"]
WHITE = MICROFACET(alpha=1.0, fresnel="one")
GLASS = MICROFACET(alpha=0.05, eta=1.5, k=0.0, fresnel="dielectric")


def by_chance(model, reference, wo, n=100_000):
    """The squares of RMSE and the difference of albedo for one viewer, by wi even over the hemisphere, and standard errors."""
    rng = np.random.default_rng(3)
    wi = direction(np.arccos(rng.random(n)), rng.uniform(0, 2 * np.pi, n))
    a, b = (m.f(wo, wi) * wi[:, 2:] for m in (model, reference))
    square, whole = ((v**2).sum(axis=-1) for v in (a - b, b))
    ratio = square.mean() / whole.mean()
    difference = 2 * np.pi * (a - b)[:, 0]
    errors = (square - ratio * whole).std() / whole.mean() / np.sqrt(n), difference.std() / np.sqrt(n)
    return (ratio, abs(difference.mean())), errors


@pytest.mark.parametrize(
    "changes",
    [
        {"shadowing": "separable"},
        {"shadowing": "full"},
        {"fresnel": "dielectric"},
        {"fresnel": "constant"},
        {"fresnel": "f82"},
        {"fresnel": "spectral", "spectrum": "gold"},
    ],
    ids=lambda changes: next(iter(changes.values())),
)
def test_errors_of_values_are_those_of_random_directions(changes):
    reference = MICROFACET(alpha=(0.3, 0.6))
    model = replace(reference, **changes)
    found = [by_chance(model, reference, wo) for wo in viewers()]
    squares, sigmas = zip(*((f[0][0], f[1][0]) for f in found), strict=True)
    rmse = between(METRICS["rmse"], model, reference, reference.slopes())
    assert rmse.value**2 == pytest.approx(np.mean(squares), abs=5 * np.hypot.reduce(sigmas) / len(sigmas))
    differences, sigmas = zip(*((f[0][1], f[1][1]) for f in found), strict=True)
    if "fresnel" not in changes:  # of which the first colour is not the one that errs most
        energy = between(METRICS["energy"], model, reference, reference.slopes())
        assert energy.value == pytest.approx(max(differences), abs=5 * max(sigmas))


def test_separable_shadowing_loses_a_fifth_of_rough_white_facets():
    """Correlated heights at cos 0.1, alpha 1: an albedo of 0.56 against 0.36, by the integral of this package's albedo."""
    wo = direction(np.arccos([0.1]), 0.0)
    separable = replace(WHITE, shadowing="separable")
    pair = [values(m, (1.0, 1.0), wo=wo) for m in (separable, WHITE)]
    lost = METRICS["energy"].function(*pair)
    assert lost == pytest.approx((albedo(WHITE, wo) - albedo(separable, wo))[0, 0], abs=1e-6)
    assert lost == pytest.approx(0.2, abs=0.02)


def test_known_errors():
    """Walter's fit errs by 3.1e-3 of G1, Schlick's by 0.036 of the reflectance of glass at 85 degrees."""
    wo = direction(np.radians([85.0]), 0.0)
    schlick = replace(GLASS, fresnel="schlick", alpha=1e-3)
    pair = [values(m, (1e-3, 1e-3), wo=wo) for m in (schlick, replace(GLASS, alpha=1e-3))]
    assert METRICS["energy"].function(*pair) == pytest.approx(0.036, abs=0.001)
    beckmann = MICROFACET(ndf="beckmann", alpha=0.6, fresnel="one", shadowing="separable")
    error = between(METRICS["maximum"], replace(beckmann, smith="rational"), beckmann, beckmann.slopes())
    assert 2e-3 < error.value < 2.01 * 3.1e-3  # of the product of two


def test_an_error_of_a_method_from_itself_is_zero_and_is_known_to_rounding():
    for name, metric in METRICS.items():
        if metric.compares == "values":
            error = between(metric, WHITE, WHITE, WHITE.slopes())
            assert error.value <= 1e-12 and error.error < 1e-11, name


def test_noise_adds_nothing_to_the_rmse_of_halves():
    """Of estimates of one f it is near 0, where that of their mean is the noise; of others it is how far these are apart."""
    rng, true = np.random.default_rng(1), values(MICROFACET(alpha=0.5, fresnel="one"), (0.5, 0.5))

    def estimates(factor):
        return [replace(true, f=true.f * (factor + 0.3 * rng.normal(size=true.f.shape))) for _ in range(2)]

    for factor in (1.0, 1.2):
        halves = list(zip(estimates(1.0), estimates(factor), strict=True))
        mean = [replace(true, f=(one.f + other.f) / 2) for one, other in zip(*halves, strict=True)]
        assert rmse_of_halves(*halves) == pytest.approx(
            factor - 1, abs=0.08
        )  # the root of noise squared over that of 5000
        assert METRICS["rmse"].function(*mean[::-1]) > 0.25


def test_an_error_of_reciprocity_is_found():
    class Crooked:
        def f(self, wo, wi):
            return WHITE.f(wo, wi) * (1 + 0.1 * wo[..., 2:])

    error = between(METRICS["reciprocity"], Crooked(), WHITE, WHITE.slopes())
    assert error.value == pytest.approx(1 - 1 / 1.1, rel=0.02)


# --- pictures --------------------------------------------------------------------------------------------------------


def picture(seed=1, n=48):
    """A random disc, premultiplied."""
    y, x = np.mgrid[:n, :n] - (n - 1) / 2
    inside = (np.hypot(x, y) < 0.4 * n).astype(np.float32)[..., None]
    return np.concatenate([np.random.default_rng(seed).random((n, n, 3), np.float32) * inside, inside], axis=-1)


def test_errors_of_pictures():
    a = picture()
    b = a * [1.1, 1.1, 1.1, 1]
    lit = a[a[..., 3] > 0][:, :3].astype(float)
    assert brightening(b, a) == pytest.approx(0.1) and brightening(a, b) == pytest.approx(-0.1 / 1.1)
    assert METRICS["brightness"].function(a, b) == pytest.approx(0.1 / 1.1)
    assert picture_rmse(b, a) == pytest.approx(0.1 * np.sqrt(np.mean(lit**2)) / lit.mean())
    for metric in METRICS.values():
        if metric.compares == "pictures":
            assert metric.function(a, a) == 0
            assert 0 < metric.function(a * [1.01, 1.01, 1.01, 1], a) < metric.function(b, a)


def test_flip_chooses_exposures_by_what_is_lit():
    """Where all is lit they are FLIP's own; a dark half, whose median is 0, leaves the error of a lit pixel as it is."""
    import flip_evaluator

    n = 128
    a = np.ones((n, n, 4), np.float32)
    a[..., :3] = np.random.default_rng(1).random((n, n, 3))
    b = a * np.float32([1.1, 1.1, 1.1, 1])
    own = flip_evaluator.evaluate(a[..., :3].copy(), b[..., :3].copy(), "HDR", applyMagma=False)[1]
    assert flip(b, a) == pytest.approx(own, rel=1e-4)
    a[: n // 2, :, :3] = b[: n // 2, :, :3] = 0
    assert flip(b, a) == pytest.approx(own / 2, rel=0.1)  # the edge of the dark is seen a few pixels far


@pytest.mark.parametrize(
    "wrong, words",
    [
        (lambda a: (a * 0, a * 0), "black"),
        (lambda a: (a[:4], a), "shapes"),
        (lambda a: (a[..., :3], a[..., :3]), "shapes"),
        (lambda a: (np.where(a > 0.9, np.nan, a), a), "the picture .* NaN"),
        (lambda a: (a, np.where(a > 0.9, np.inf, a)), "the reference .* infinite"),
        (lambda a: (a - 0.5, a), "below 0"),
    ],
)
def test_pictures_that_cannot_be_compared_are_told(wrong, words):
    for metric in METRICS.values():
        if metric.compares == "pictures":
            with pytest.raises(Invalid, match=words):
                metric.function(*wrong(picture()))


def test_itp_is_that_of_colour_science():
    """colour-science 0.4.7: RGB_to_ICtCp(..., method="ITU-R BT.2100-2 PQ") of 203 cd/m2 times BT.2020's RGB, delta_E ITP."""
    rgb = np.array([[1, 1, 1], [0.5, 0.5, 0.5], [1, 0.2, 0.1], [0.02, 0.3, 0.9], [12, 8, 3], [0.001, 0.002, 0.0005]])
    known = [
        [5.80688881e-01, 0, 0],
        [5.09573444e-01, 0, 0],
        [4.78785488e-01, -7.14956253e-02, 1.44024739e-01],
        [4.57421351e-01, 1.16816609e-01, -9.79039097e-02],
        [8.10073761e-01, -1.10274483e-01, 5.14887071e-02],
        [1.00628262e-01, -5.00042645e-02, -5.28253393e-03],
    ]
    # its matrix between the primaries has more digits than BT.2087's four
    np.testing.assert_allclose(ictcp(rgb), known, atol=1e-4)
    differences = [3.6390282, 3.49738297, 4.80288703, 2.1390296, 4.70867157, 1.15272717]
    np.testing.assert_allclose(delta_e_itp(rgb, rgb * [1.05, 0.97, 1.02]), differences, rtol=5e-3)
    assert itp(picture() * 0, picture()) > 100


# --- costs -----------------------------------------------------------------------------------------------------------


def test_runs_take_turns():
    order = []
    runs = {name: lambda name=name: order.append(name) for name in "ab"}
    times = cost.interleaved(runs, 3)
    assert {name: len(t) for name, t in times.items()} == {"a": 3, "b": 3}
    assert order == list("aabb" + "ab" * 3)


def works(gpu, size=(32, 32)):
    bare = cost.fill(gpu, size)
    models = {shadowing: replace(WHITE, shadowing=shadowing) for shadowing in ("none", "correlated")}
    return {name: cost.evaluation(gpu, model, bare, size) for name, model in models.items()}


def last(steps):
    *_, found = steps
    return found


def test_costs_are_measured_once(gpu):
    gpu.costs.clear()
    steps = list(cost.costs(gpu, works(gpu), least=3, most=3))
    assert steps[0] == {} and [len(v) for v in steps[-1].values()] == [3, 3]
    again = last(cost.costs(gpu, works(gpu), least=3, most=3))
    assert all(np.array_equal(again[name], samples) for name, samples in steps[-1].items())
    assert len(gpu.costs) == 1
    last(cost.costs(gpu, works(gpu, (33, 32)), least=3, most=3))
    assert len(gpu.costs) == 2  # another size is another question


def test_methods_of_one_shader_cost_the_same(gpu):
    both = {"one": works(gpu)["none"], "other": works(gpu)["none"]}
    found = last(cost.costs(gpu, both, least=2, most=2))
    assert np.array_equal(found["one"], found["other"])


def test_every_kind_of_work_is_timed(gpu):
    bare, size = cost.fill(gpu, (32, 32)), (32, 32)
    kinds = {
        "evaluation": cost.evaluation(gpu, WHITE, bare, size),
        "sample": cost.sample(gpu, WHITE, bare, size),
        "pass": cost.one_pass(gpu, State(), size),
        "numpy": cost.in_numpy(WHITE, 64),
    }
    found = last(cost.costs(gpu, kinds, least=3, most=5))
    assert all(3 <= len(samples) <= 5 and np.isfinite(samples).all() for samples in found.values())
    median, low, high, repeats = cost.summary(np.array([3.0, 1.0, 2.0]))
    assert (median, low, high, repeats) == (2.0, 1.5, 2.5, 3)

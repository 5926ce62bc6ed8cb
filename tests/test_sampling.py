"""Samples follow their density, and their weights estimate the albedo: both twins, every model, every choice."""

import numpy as np
import pytest
from oracles.cases import CASES, SLOW, case_label, corners, material
from scipy.stats import binomtest

from brdf_explorer.lib import slot
from brdf_explorer.lib.common import HORIZON
from brdf_explorer.lib.random import seeded
from brdf_explorer.measure.adversary import above
from brdf_explorer.measure.albedo import albedo_with_error, integral
from brdf_explorer.measure.grid import direction, grid, place, spread
from brdf_explorer.measure.sampling import bins, chi_square, mean_weight, pooled
from brdf_explorer.model import Choice, declared
from brdf_explorer.models import MODELS

Microfacet = MODELS["microfacet"]
SAMPLING = declared(Microfacet, Choice)["sampling"].options
UP = np.array([0.0, 0.0, 1.0])
ALPHAS = ((0.01, 0.01), (0.3, 0.3), (1.0, 1.0), (0.05, 0.6))
THETAS = (0.0, 30.0, 60.0, 85.0)
LEVEL = 1e-3
"""Chance of a false alarm of a whole test."""


def samplers():
    """Of each model, one set of choices for every way of sampling that there is: those whose samples and pdf differ."""
    rng = np.random.default_rng(0)
    wo, wi, u = above(rng, 100), above(rng, 100), rng.random((100, 2))
    found = {}
    for cls, choices in CASES:
        model = cls(**choices)
        key = (cls, model.pdf(wo, wi).tobytes(), model.sample_f(wo, u)[0].tobytes())
        found.setdefault(key, (cls, choices))
    return list(found.values())


SAMPLERS = samplers()


def shapes(cls, choices):
    """The model at the alphas, where it has them. A walk need not be a long one to show where it is sent."""
    choices = choices | ({"orders": 2} if cls.stochastic else {})
    alphas = ALPHAS[1:2] if cls.name() in SLOW else ALPHAS
    return [cls(alpha=a, **choices) if "alpha" in cls.__dataclass_fields__ else cls(**choices) for a in alphas]


def viewers():
    return [direction(np.radians(theta), np.radians(20.0 + theta)) for theta in THETAS]


def least(tests):
    """The Sidak-corrected chance of a p as small as the smallest, and which test it is."""
    p = [t.p for t in tests]
    k = int(np.argmin(p))
    return -np.expm1(len(p) * np.log1p(-min(p[k], 1 - 1e-16))), k


def test_samplers_are_told_apart():
    assert {c["sampling"] for cls, c in SAMPLERS if cls is Microfacet and c["ndf"] == "ggx"} == set(SAMPLING)
    # with light lost kulla_conty has a lobe of its own
    alone = [
        c for cls, c in SAMPLERS if cls is Microfacet and (c["energy"] != "kulla_conty" or c["shadowing"] == "none")
    ]
    assert len([c for c in alone if c["ndf"] == "beckmann"]) == 2  # ndf and visible


@pytest.mark.parametrize("twin", ["float64", "float32"])
@pytest.mark.parametrize(("cls", "choices"), SAMPLERS, ids=case_label)
def test_samples_follow_pdf(gpu, cls, choices, twin):
    tests, about = [], []
    for model in shapes(cls, choices):
        sample = model.sample_f if twin == "float64" else lambda wo, u, m=model: gpu.sample_f(m, wo, u)
        for wo in viewers():
            tests.append(chi_square(model, wo, n=20_000, seed=len(tests), sample=sample))
            about.append((model, wo))
    p, k = least(tests)
    assert p > LEVEL, (about[k], tests[k])


@pytest.mark.parametrize(("cls", "choices"), SAMPLERS, ids=case_label)
def test_pdf_integrates_to_the_share_above_the_horizon(cls, choices):
    p = []
    rng = np.random.default_rng(3)
    for model in shapes(cls, choices):
        for wo in viewers():
            mass = integral(lambda o, i, m=model: m.pdf(o, i)[..., None], wo, model.slopes(), index=model.index())
            # where facets refract on edge, pdf has a kink or ends by a step: more than 10 000 samples tell is enough
            known, binned = (1e-3, 3e-3) if model.transmits else (1e-8, 5e-6)
            assert mass.error[0] < known and mass.value[0] < 1 + 1e-9
            assert bins(model, wo).sum() == pytest.approx(mass.value[0], abs=binned)
            height = model.sample_f(wo, rng.random((10_000, 2)))[0][:, 2]
            up = (np.abs(height) if model.transmits else height) > HORIZON
            p.append(binomtest(int(up.sum()), up.size, min(mass.value[0], 1.0)).pvalue)
    assert -np.expm1(len(p) * np.log1p(-min(min(p), 1 - 1e-16))) > LEVEL


def mean_weight_error(model, wo, sample=None):
    """|mean weight - albedo| in standard errors."""
    value, error = albedo_with_error(model, wo, tolerance=1e-6, most=256)
    mean = mean_weight(model, wo, points=512, rotations=16, sample=sample)
    return np.max(np.abs(mean.value - value) / (mean.error + error))


# Student's t with 15 degrees of freedom, as there are 16 rotations: beyond 7.5 lies 2e-6, for 3 colours and 90 cases 5e-4
STANDARD_ERRORS = 7.5


@pytest.mark.parametrize(("cls", "choices"), CASES, ids=case_label)
def test_mean_weight_is_albedo(cls, choices):
    rng = np.random.default_rng(4)
    model, (wo,) = material(cls, choices, rng), above(rng, 1, 0.05)
    assert mean_weight_error(model, wo) < STANDARD_ERRORS, (model, wo)


@pytest.mark.parametrize(("cls", "choices"), SAMPLERS, ids=case_label)
def test_mean_weight_is_albedo_in_float32(gpu, cls, choices):
    for k, model in enumerate(shapes(cls, choices)):
        wo = viewers()[-1 - k]
        assert mean_weight_error(model, wo, lambda o, u, m=model: gpu.sample_f(m, o, u)) < STANDARD_ERRORS, (model, wo)


@pytest.mark.parametrize(("cls", "choices"), CASES, ids=case_label)
def test_weight_is_f_cos_over_pdf(cls, choices):
    rng = np.random.default_rng(5)
    wo, u = above(rng, 2000), rng.random((2000, 2))
    with np.errstate(under="ignore"):
        for model in [material(cls, choices, rng), *corners(cls, choices)]:
            with seeded(1):
                wi, weight = model.sample_f(wo, u)
            pdf = model.pdf(wo, wi)
            height = np.abs(wi[:, 2]) if model.transmits else wi[:, 2]
            known = (pdf > 1e-200) & (height > 1e-6)
            with seeded(1):
                expected = model.f(wo, wi)[known] * height[known, None] / pdf[known, None]
            np.testing.assert_allclose(weight[known], expected, rtol=1e-11, atol=1e-290)  # below, float64 runs out
            assert np.all(weight[height <= HORIZON] == 0)


VISIBLE = [("ggx", "visible"), ("ggx", "caps"), ("ggx", "bounded"), ("beckmann", "visible")]


@pytest.mark.parametrize("shadowing", ["separable", "correlated"])
@pytest.mark.parametrize(("ndf", "sampling"), VISIBLE)
def test_weights_of_visible_normals_are_at_most_one(gpu, ndf, sampling, shadowing):
    """G2 / G1(wo), which is G1(wi) or (1 + Lambda_o) / (1 + Lambda_o + Lambda_i); less for a bounded cap."""
    rng = np.random.default_rng(6)
    wo, u = above(rng, 20_000), rng.random((20_000, 2))
    for alpha in ALPHAS:
        model = Microfacet(alpha=alpha, ndf=ndf, sampling=sampling, shadowing=shadowing, fresnel="one")
        assert 0 < model.sample_f(wo, u)[1].max() <= 1 + 1e-14
        assert 0 < gpu.sample_f(model, wo, u)[1].max() <= 1 + 10 * 2.0**-24  # ten operations in a row


def test_a_bounded_cap_rejects_less():
    """And no direction above the horizon that it could have drawn: its weights still have the albedo for a mean."""
    rng = np.random.default_rng(8)
    u = rng.random((20_000, 2))
    for alpha, theta, least in [((1.0, 1.0), 0.0, 0.4), ((1.0, 1.0), 1.4, 0.1), ((0.5, 0.9), 1.2, 0.03)]:
        wo = np.broadcast_to(direction(theta, 0.5), (len(u), 3))
        caps, bounded = (
            np.mean(Microfacet(alpha=alpha, sampling=s).sample_f(wo, u)[0][:, 2] <= HORIZON)
            for s in ("caps", "bounded")
        )
        assert caps - bounded > least, (alpha, theta, caps, bounded)


@pytest.mark.parametrize("sampling", ["ndf", "visible", "caps"])
@pytest.mark.parametrize("ndf", ["ggx", "beckmann"])
def test_samples_along_the_normal_invert_the_cdf(ndf, sampling):
    """Seen along the normal tan^2(theta_m) is alpha^2 u / (1 - u) for GGX and -alpha^2 ln(1 - u) for Beckmann."""
    u = np.random.default_rng(7).random((50_000, 2))
    up = np.broadcast_to(UP, (len(u), 3))
    wm = up + slot("sampling", ndf, sampling).sample_wi(up, u, np.array([0.3, 0.3]))
    t = np.sort(np.sum(wm[:, :2] ** 2, axis=-1) / wm[:, 2] ** 2 / 0.09)
    cdf = t / (1 + t) if ndf == "ggx" else -np.expm1(-t)
    steps = np.arange(len(t) + 1) / len(t)
    distance = max(np.max(cdf - steps[:-1]), np.max(steps[1:] - cdf))
    assert distance < 1.95 / np.sqrt(len(t))  # Kolmogorov and Smirnov: a chance of 1e-3


def test_place_inverts_grid():
    rng = np.random.default_rng(8)
    for alpha in (*ALPHAS, (1e-4, 1.0)):
        for wo in above(rng, 10, 1e-3):
            wi = grid(wo, alpha, rng.uniform(0.01, 0.99, 5), rng.uniform(0, 2 * np.pi, 5)).wi.reshape(-1, 3)
            again = [grid(wo, alpha, [t], [psi]).wi[0, 0] for t, psi in zip(*place(wo, alpha, wi), strict=True)]
            # wo + wi rounds to 1e-16, and is divided by its z for the slope
            assert np.max(np.abs(again - wi)) < 2e-15 / np.min(wo[2] + wi[:, 2])


def test_spread_is_an_even_map_of_the_turn():
    fraction = np.linspace(0, 1, 4001)
    for wo, alpha in [(UP, (0.3, 0.3)), (direction(1.5, 2.0), (0.3, 0.3)), (direction(1.57, -2.0), (1e-4, 1.0))]:
        psi, turn = spread(wo, alpha, fraction)
        assert psi[0] == 0 and psi[-1] == pytest.approx(2 * np.pi, abs=1e-13) and np.all(np.diff(psi) > 0)
        assert np.mean(turn[:-1]) == pytest.approx(2 * np.pi, rel=1e-12)  # the trapezoidal rule
        steps = np.diff(psi) * 4000
        np.testing.assert_allclose(steps, 0.5 * (turn[:-1] + turn[1:]), rtol=1e-3)


# --- the tests themselves --------------------------------------------------------------------------------------------


def test_pooled_counts_keep_their_sum():
    rng = np.random.default_rng(9)
    expected = 10 ** rng.uniform(-12, 3, 500)
    observed = rng.poisson(expected).astype(float)
    o, e = pooled(observed, expected)
    assert o.sum() == observed.sum() and e.sum() == pytest.approx(expected.sum(), rel=1e-13)
    assert e.min() >= 5


def tilted(wi, by):
    wi = wi + by * np.array([1.0, 0.0, 0.0])
    return wi / np.linalg.norm(wi, axis=-1, keepdims=True)


WRONG = {
    "alpha off by 5 %": lambda wo, u: Microfacet(alpha=0.315).sample_f(wo, u),
    "alpha exchanged": lambda wo, u: Microfacet(alpha=(0.3, 0.33)).sample_f(wo, u),
    "wo mirrored": lambda wo, u: Microfacet(alpha=0.3).sample_f(wo * [1, -1, 1], u),
    "other distribution": lambda wo, u: Microfacet(alpha=0.3, ndf="beckmann").sample_f(wo, u),
    "tilted by two degrees": lambda wo, u: (tilted(Microfacet(alpha=0.3).sample_f(wo, u)[0], 0.035), None),
    "u not even": lambda wo, u: Microfacet(alpha=0.3).sample_f(wo, u**1.06),
    "all the same": lambda wo, u: Microfacet(alpha=0.3).sample_f(wo, u[:1].repeat(len(u), axis=0)),
}


@pytest.mark.parametrize("fault", WRONG)
def test_chi_square_finds_a_wrong_sampler(fault):
    found = chi_square(Microfacet(alpha=0.3), direction(0.9, 0.5), n=100_000, sample=WRONG[fault])
    assert found.p < 1e-6


@pytest.mark.parametrize("shadowing", ["none", "separable", "full"])
def test_mean_weight_finds_a_wrong_weight(shadowing):
    wrong = Microfacet(alpha=0.5, shadowing=shadowing)
    assert mean_weight_error(Microfacet(alpha=0.5), direction(1.2, 0.5), wrong.sample_f) > STANDARD_ERRORS

"""The walk over the microsurface: energy, known answers by quadrature, and that both twins walk alike."""

from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np
import pytest
from scipy.stats import chi2

from brdf_explorer.lib import slot
from brdf_explorer.lib.common import PI, dot, normalize, quotient, vec
from brdf_explorer.lib.random import Draws, pcg3d, random_states, seeded
from brdf_explorer.lib.walk import depth_below, flight, meets, passage
from brdf_explorer.measure.estimator import surroundings
from brdf_explorer.measure.grid import direction
from brdf_explorer.measure.laws import Shader
from brdf_explorer.measure.noise import Running, mean_f
from brdf_explorer.models import MODELS
from brdf_explorer.models.multiscatter import MOST
from brdf_explorer.state import Light

Multiscatter, Microfacet = MODELS["multiscatter"], MODELS["microfacet"]
NDFS = ("ggx", "beckmann")
WHITE = {
    "conductor": {"fresnel": "one"},
    "dielectric": {"facets": "dielectric", "eta_below": 1.5},
    "diffuse": {"facets": "diffuse", "albedo": 1.0},
}


def sees(theta, phi=20.0):
    return direction(np.radians(theta), np.radians(phi))


def pairs(rng, n, least=0.1):
    """Directions wo and wi (n, 3) with cosines from `least` on."""
    return [direction(np.arccos(rng.uniform(least, 1, n)), rng.uniform(0, 2 * PI, n)) for _ in range(2)]


def dense(model, wo, wi):
    """n^2 of the side of wi over that of wo, (..., 1): what makes energy of radiance."""
    n = model.index() or 1.0
    return n ** ((wo[..., 2:] > 0) * 2.0 - (wi[..., 2:] > 0) * 2.0)


def energy(evaluator, model, wo, error, seed=1, n=100_000):
    """The share of the energy along wo that is scattered: a Mean, of as many samples as make its error at most that.

    evaluator(model) is it or its Shader. Half of the directions are drawn by the sampler of facets three times as rough: where
    its own draws few, in skirts of lobes, a walk that finds sharp facets by chance weighs up to 1e4 times as much as the mean.
    """
    rng, running, of = np.random.default_rng(seed), Running(), evaluator(model)
    rougher = tuple(np.minimum(3 * np.array(model.alpha), 1.0))
    lobes = [evaluator(replace(model, alpha=a, lowest=1, orders=1)) for a in dict.fromkeys([model.alpha, rougher])]
    while running.count < 2 * n or np.any(running.mean().error > error):
        u = rng.integers(0, 2**24, (len(lobes), n // len(lobes), 2)) * 2.0**-24
        with np.errstate(under="ignore"):
            wi = np.concatenate([lobe.sample_f(wo, points)[0] for lobe, points in zip(lobes, u, strict=True)])
            density = np.mean([lobe.pdf(wo, wi) for lobe in lobes], axis=0)
            weight = of.f(wo, wi)[:, :1] * np.abs(wi[:, 2:]) * dense(model, wo, wi)
            running.add(quotient(weight, density[:, None]))
    return running.mean()


# --- energy ----------------------------------------------------------------------------------------------------------

FURNACES = [*product((0.1, 0.3, 1.0), (0.0, 60.0, 85.0)), ((0.1, 1.0), 60.0)]


@pytest.mark.parametrize("ndf", NDFS)
@pytest.mark.parametrize("facets", WHITE)
def test_white_furnace(gpu, facets, ndf):
    """Where facets lose nothing the surface loses nothing: within 3 standard errors of at most 1e-3.

    Of the 60 numbers of all facets 0.16 would be beyond 3; the random numbers were chosen once. That the errors are neither too
    small nor too large: the mean of 10 squares is outside of these quantiles by a chance of 0.002.
    """
    off = []
    with seeded(1):
        for alpha, theta in FURNACES:
            model = Multiscatter(alpha=alpha, ndf=ndf, **WHITE[facets])
            found = energy(partial(Shader, gpu), model, sees(theta), 1e-3)
            off.append(((found.value - 1) / found.error)[0])
    print(f"largest {np.abs(off).max():.2f}, root mean square {np.sqrt(np.mean(np.square(off))):.2f}")
    low, high = chi2.ppf([0.001, 0.999], len(off)) / len(off)
    assert np.abs(off).max() <= 3 and low < np.mean(np.square(off)) < high, dict(zip(FURNACES, off, strict=True))


@pytest.mark.parametrize(
    ("facets", "alpha", "theta"), [("conductor", 0.1, 0.0), ("dielectric", 0.1, 0.0), ("diffuse", 0.3, 85.0)]
)
@pytest.mark.parametrize("ndf", NDFS)
def test_white_furnace_in_float64(facets, alpha, theta, ndf):
    """As that of the shaders, where few walks are enough."""
    model = Multiscatter(alpha=alpha, ndf=ndf, **WHITE[facets])
    with seeded(2):
        found = energy(lambda model: model, model, sees(theta), 1e-3, n=20_000)
    assert np.abs(found.value[0] - 1) <= 3 * found.error[0], found


@pytest.mark.parametrize("facets", WHITE)
def test_a_walk_leaves_before_its_last_order(gpu, facets):
    """The energy of eight orders falls by more than 10 from 17 on, so beyond 64 lies less than 1e-9."""
    energies = []
    for first in (17, 25):
        model = Multiscatter(alpha=1.0, lowest=first, orders=8, **WHITE[facets])
        energies.append(energy(partial(Shader, gpu), model, sees(0.0), np.inf).value[0])
    assert energies[0] < 1e-3 and energies[1] < 0.15 * energies[0] + 1e-9
    assert MOST == 64 and 0.15 ** ((MOST - 32) / 8) * energies[1] < 1e-7


@pytest.mark.parametrize("facets", WHITE)
def test_orders_add_up(facets):
    """By the same random numbers, walks to order 1, of order 2, and from order 3 on are what the whole walk is."""
    wo, wi = pairs(np.random.default_rng(3), 500)
    found = []
    for first, orders in ((1, 1), (2, 1), (3, MOST), (1, MOST)):
        with seeded(3):
            found.append(Multiscatter(alpha=0.7, lowest=first, orders=orders, **WHITE[facets]).f(wo, wi))
    np.testing.assert_allclose(sum(found[:3]), found[3], rtol=1e-12, atol=1e-300)
    assert np.all(found[0].mean(axis=0) > 0) and np.all(found[2].mean(axis=0) > 0)


# --- samples ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ndf", NDFS)
@pytest.mark.parametrize("facets", WHITE)
def test_samples_serve_beside_those_of_light(gpu, facets, ndf):
    """In the studio, by the BSDF's samples, the light's, and both (Veach and Guibas 1995, Eq. 14): equal means, to 4.5 standard
    errors of 36 differences. Of as many samples both have at most twice the variance of the light's alone; where lobes are
    sharp, a tenth.
    """
    rng, n = np.random.default_rng(2), 30_000
    for alpha, theta, sharp in ((0.1, 30.0, facets != "diffuse"), (0.5, 60.0, False), (1.0, 80.0, False)):
        shader, wo = Shader(gpu, Multiscatter(alpha=alpha, ndf=ndf, **WHITE[facets])), sees(theta)
        light = surroundings(Light(irradiance=0.0, environment="studio"), wo)
        u = rng.integers(0, 2**24, (2, n, 2)) * 2.0**-24
        with np.errstate(under="ignore"), seeded(3):
            drawn = shader.sample_f(wo, u[0])[0].astype(float), light.sample(u[1])
            value = [shader.f(wo, wi)[:, 0] * np.abs(wi[:, 2]) * light.radiance(wi) for wi in drawn]
            of_f, of_light = ([pdf(wi) for wi in drawn] for pdf in (partial(shader.pdf, wo), light.pdf))
            both = sum(quotient(*parts) for parts in zip(value, np.add(of_f, of_light), strict=True))
            estimates = np.stack([quotient(value[0], of_f[0]), quotient(value[1], of_light[1]), both])
        mean, variance = estimates.mean(axis=1), estimates.var(axis=1)
        error = np.sqrt(variance[:2] / n + variance[2] / n)
        assert np.all(np.abs(mean[:2] - mean[2]) < 4.5 * error), (alpha, mean, error)
        assert 2 * variance[2] < (0.1 if sharp else 2) * variance[1], (alpha, variance)


@pytest.mark.parametrize("ndf", NDFS)
@pytest.mark.parametrize("facets", WHITE)
def test_weights_have_a_variance(gpu, facets, ndf):
    """f is bounded, and so are weights, but at the horizon. What a decade of cosines adds there to the mean of their squares
    falls by more than 10 from one to the next but one, so that the sum is finite.

    It is the integral of (f cos)^2 / pdf, here at one cosine each.
    """
    rng = np.random.default_rng(8)
    for alpha in (0.1, 1.0):
        shader, adds = Shader(gpu, Multiscatter(alpha=alpha, ndf=ndf, **WHITE[facets])), []
        for z in (1e-2, 1e-4):
            wi = direction(np.arccos(z), rng.uniform(0, 2 * PI, 100_000))
            wi = wi * [1, 1, -1] if shader.model.transmits else wi
            with seeded(4):
                weight = z * shader.f(sees(60.0), wi)[:, 0].astype(float)
            adds.append(z * np.mean(weight**2 / shader.pdf(sees(60.0), wi)))
        assert adds[1] <= 0.1 * adds[0], (alpha, adds)


# --- known answers ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("fresnel", ["conductor", "dielectric", "schlick", "one"])
@pytest.mark.parametrize("ndf", NDFS)
@np.errstate(under="ignore")
def test_order_1_of_mirrors_is_microfacet(gpu, ndf, fresnel):
    """With correlated masking and shadowing, at any alpha, and without noise."""
    wo, wi = pairs(np.random.default_rng(4), 1000, 0.01)
    for alpha in ((0.5, 0.5), (0.2, 0.9), (0.05, 0.05)):
        walk = Multiscatter(alpha=alpha, ndf=ndf, fresnel=fresnel, orders=1)
        known = Microfacet(alpha=alpha, ndf=ndf, fresnel=fresnel, shadowing="correlated").f(wo, wi)
        np.testing.assert_allclose(walk.f(wo, wi), known, rtol=1e-12, atol=1e-300)
        np.testing.assert_allclose(gpu.f(walk, wo, wi), known, rtol=1e-4, atol=1e-30)


@pytest.mark.parametrize("ndf", NDFS)
def test_order_1_of_dielectric_facets_is_dielectric_with_the_beta_function(ndf):
    """What is reflected without noise, what is transmitted, either way, within 4.5 standard errors of 24 means."""
    rng = np.random.default_rng(10)
    wo, wi = pairs(rng, 12)
    for alpha, eta in [((0.6, 0.6), 1.5), ((0.3, 0.9), 0.7)]:
        walk = Multiscatter(alpha=alpha, ndf=ndf, facets="dielectric", eta_below=eta, orders=1)
        known = MODELS["dielectric"](alpha=alpha, ndf=ndf, eta=eta, masking="beta")
        np.testing.assert_allclose(walk.f(wo, wi), known.f(wo, wi), rtol=1e-11)
        for side in (1, -1):
            # nearly through the flat surface, where facets do refract
            below = normalize(-wo * [1 / eta, 1 / eta, 1] + rng.normal(0, 0.2, wo.shape)) * side
            above = wo * side
            below[:, 2] = -side * np.abs(below[:, 2])
            found, exact = mean_f(walk, above, below, 4096), known.f(above, below)
            assert np.all(np.abs(found.value - exact) <= 4.5 * found.error + 1e-9 * exact), (found, exact)
            assert np.mean(exact > 0) > 0.5


@pytest.mark.parametrize("up", [False, True])
def test_passage_is_the_mean_over_flights(up):
    """By the midpoint rule over the flight's random number."""
    rng, n = np.random.default_rng(5), 20_000
    u = np.stack([(np.arange(n) + 0.5) / n] * 2, axis=-1)
    for depth in (0.05, 0.7, 3.0) if up else (0.0, 0.3, 3.0):
        w, wi = normalize([0.3, 0.2, 0.8 if up else -0.8]), sees(60.0)
        area, hidden = rng.uniform(0.2, 1.0, 2)
        ends = flight(depth, w, area, u)
        met = ends >= 0
        known = np.mean(np.exp(-np.where(met, ends, 0.0) * hidden / wi[2]) * met) / wi[2]
        assert passage(depth, w, area, wi, hidden) == pytest.approx(known, rel=1e-3)
        assert meets(depth, w, area) == pytest.approx(np.mean(met), abs=1 / n)
        np.testing.assert_allclose(np.exp(-depth_below(0.1 + depth)), -np.expm1(-0.1 - depth), rtol=1e-12)


def facet_integral(model, wo, wi, n=200):
    """Single scattering of white diffuse facets: the integral of D G2 (wi . wm)+ (wo . wm)+ over the normals, over pi cos cos.

    Over slopes alpha tan(b), which makes GGX's density smooth up to the ends; b by the midpoint rule.
    """
    b = ((np.arange(n) + 0.5) / n - 0.5) * PI
    x, y = np.meshgrid(np.tan(b), np.tan(b), indexing="ij")
    alpha = np.array(model.alpha)
    wm = vec(-alpha[0] * x, -alpha[1] * y, np.ones_like(x))
    jacobian = alpha[0] * alpha[1] * (1 + x * x) * (1 + y * y) * (PI / n) ** 2
    density = (
        model.D(wm) * jacobian / dot(wm, wm) ** 2
    )  # d omega = cos^3 d slope, and each cosine of wm has its length left over
    Lambda = slot("smith", model.ndf, "exact").Lambda
    G2 = 1 / (1 + Lambda(wo, alpha) + Lambda(wi, alpha))
    facing = np.maximum(dot(wm, wi), 0.0) * np.maximum(dot(wm, wo), 0.0) / np.sqrt(dot(wm, wm))
    return G2 * np.sum(density * facing) / (PI * wo[2] * wi[2])


@pytest.mark.parametrize("ndf", NDFS)
@np.errstate(under="ignore")
def test_order_1_of_diffuse_facets_is_the_integral_over_facets(ndf):
    for alpha, wo, wi in [
        ((0.5, 0.5), sees(40.0), sees(60.0, 200.0)),
        ((1.0, 1.0), sees(75.0), sees(70.0, 190.0)),
        ((0.2, 0.8), sees(60.0, 80.0), sees(80.0, 110.0)),
    ]:
        model = Multiscatter(alpha=alpha, ndf=ndf, orders=1, **WHITE["diffuse"])
        found = mean_f(model, wo, wi, 20_000)
        assert found.error[0] < 0.03 * found.value[0]
        assert np.abs(found.value[0] - facet_integral(model, wo, wi)) < 4.5 * found.error[0], (model, found)


@pytest.mark.parametrize("ndf", NDFS)
@pytest.mark.parametrize("facets", WHITE)
def test_f_is_reciprocal(gpu, facets, ndf):
    """By the shader's walks, 24 pairs of means: 5 standard errors are a chance of 1e-5."""
    wo, wi = pairs(np.random.default_rng(6), 12)
    for alpha in ((0.8, 0.8), (0.2, 0.6)):
        model = Multiscatter(alpha=alpha, ndf=ndf, **WHITE[facets])
        if model.transmits:  # some from below, some through
            wo, wi = wo * np.where(np.arange(12) % 3 == 0, [[1], [1], [-1]], 1).T, wi * [1, 1, -1]
        shader, n2 = Shader(gpu, model), dense(model, wo, wi)
        there, back = mean_f(shader, wo, wi, 8192), mean_f(shader, wi, wo, 8192)
        off, spread = np.abs(n2 * there.value - back.value), np.hypot(n2 * there.error, back.error)
        assert np.all(off <= 5 * spread + 1e-5 * there.value), (
            off,
            spread,
            there.value,
        )  # float32 rounds tails to 1e-5


# --- the twins' random numbers ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("ndf", NDFS)
@pytest.mark.parametrize("facets", WHITE)
def test_walks_of_float32_and_float64_agree(gpu, facets, ndf):
    """Independent ones in their means, and those by the same numbers in the mean of their difference: by z-tests."""
    wo, wi = pairs(np.random.default_rng(7), 12)
    model = Multiscatter(alpha=(0.4, 0.9), ndf=ndf, **WHITE[facets])
    one, other = mean_f(Shader(gpu, model), wo, wi, 4096), mean_f(model, wo, wi, 1024)
    assert np.all(np.abs(one.value - other.value) < 5 * np.hypot(one.error, other.error) + 1e-5 * one.value)
    pair = []
    for evaluator in (Shader(gpu, model), model):
        with seeded(9):
            pair.append(evaluator.f(np.broadcast_to(wo, (256, *wo.shape)), wi))
    off = Running()
    off.add(pair[0] - pair[1])
    assert np.all(np.abs(off.mean().value) < 5 * off.mean().error + 1e-5 * pair[1].mean(axis=0))
    assert np.mean(off.mean().error) < 1e-2 * np.mean(other.error)  # nearly all walks are the same


def test_each_call_draws_other_numbers(gpu):
    model, wo, wi = Multiscatter(alpha=0.8), sees(30.0), sees(50.0, 170.0)
    for evaluator in (model, Shader(gpu, model)):
        assert not np.array_equal(evaluator.f(wo, wi), evaluator.f(wo, wi))
        with seeded(4):
            first = evaluator.f(wo, wi)
        with seeded(4):
            again, other = evaluator.f(wo, wi), evaluator.f(wo, wi)
        np.testing.assert_array_equal(first, again)
        assert not np.array_equal(again, other)


def test_draws_are_hashes_of_place_and_pass():
    states = random_states(2000, 5)
    np.testing.assert_array_equal(states[1030], [6, 1, 2**32 - 6])
    draws = Draws(states)
    u = draws.drawn()
    np.testing.assert_array_equal(u[1030], (pcg3d([6, 1, 2**32 - 6]) >> 8) * 2.0**-24)
    draws.keep(np.arange(2000) == 7)
    assert draws.drawn().shape == (1, 3) and 0 <= u.min() and u.max() < 1 and abs(u.mean() - 0.5) < 0.02

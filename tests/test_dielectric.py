"""A rough dielectric against oracles of other kinds: the walk on its microsurface, 50 digits, another renderer, flat glass."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import erfc
from scipy.stats import chi2

from brdf_explorer.lib import slot
from brdf_explorer.lib.beta import beta_one_plus
from brdf_explorer.lib.common import vec
from brdf_explorer.lib.fresnel import F_dielectric
from brdf_explorer.measure import shares
from brdf_explorer.measure.adversary import above
from brdf_explorer.measure.albedo import gauss
from brdf_explorer.measure.grid import direction
from brdf_explorer.models import MODELS
from brdf_explorer.state import Material, load

Dielectric = MODELS["dielectric"]
GLASS = 1.5
FLIP = np.array([1.0, 1.0, -1.0])


# --- the walk --------------------------------------------------------------------------------------------------------


def smith(ndf, alpha, w):
    """Lambda (n,) of directions w (n, 3) above the surface, as printed: Walter et al. 2007, Eqs. 26 and 34."""
    slope = np.sqrt((alpha[0] * w[:, 0]) ** 2 + (alpha[1] * w[:, 1]) ** 2)
    a = w[:, 2] / np.maximum(slope, 1e-12)
    if ndf == "ggx":
        return 0.5 * (np.sqrt(1 + 1 / a**2) - 1)
    a = np.minimum(a, 20.0)
    return np.maximum(np.exp(-(a**2)) / (2 * a * np.sqrt(np.pi)) - 0.5 * erfc(a), 0.0)


@np.errstate(under="ignore")
def first_order(ndf, alpha, eta, wo, n, seed):
    """Shares of the energy along wo that leave a Smith microsurface after one collision, above and below: means and errors (2,).

    Heitz et al. 2016, height-free: a ray that comes down from the highest height, C = 1, collides where the share C of all
    heights lies below it, C = U^(1 / (1 + Lambda)), at a facet that it sees; a direction upwards escapes with the chance
    C^Lambda, one downwards with (1 - C)^Lambda. Facets are drawn by D cos and weighed by (wo . m)+.
    """
    rng = np.random.default_rng(seed)
    u = rng.random((3, n))
    slope = np.sqrt(u[0] / (1 - u[0]) if ndf == "ggx" else -np.log(1 - u[0]))
    m = vec(alpha[0] * slope * np.cos(2 * np.pi * u[1]), alpha[1] * slope * np.sin(2 * np.pi * u[1]), np.ones(n))
    m /= np.linalg.norm(m, axis=1)[:, None]
    own = smith(ndf, alpha, wo[None])[0]
    c = m @ wo
    seen = np.maximum(c, 0.0) / (m[:, 2] * wo[2] * (1 + own))
    c = np.clip(c, 1e-12, 1.0)
    C = u[2] ** (1 / (1 + own))
    ct = np.sqrt(np.maximum(1 - (1 - c**2) / eta**2, 0.0))
    F = np.where(ct > 0, (((c - eta * ct) / (c + eta * ct)) ** 2 + ((eta * c - ct) / (eta * c + ct)) ** 2) / 2, 1.0)
    up = 2 * c[:, None] * m - wo
    down = (c / eta - ct)[:, None] * m - wo / eta
    found = np.zeros((2, n))
    for side, (w, share, below) in enumerate(((up, F, C), (down * [1, 1, -1], 1 - F, 1 - C))):
        leaves = w[:, 2] > 1e-9
        found[side, leaves] = (seen * share)[leaves] * below[leaves] ** smith(ndf, alpha, w[leaves])
    return found.mean(axis=1), np.hypot(found.std(axis=1) / np.sqrt(n), 1 / n)  # what is rarer may not have been seen


WALKS = [
    (ndf, alpha, eta, theta)
    for ndf in ("ggx", "beckmann")
    for alpha in ((0.1, 0.1), (0.6, 0.6), (1.0, 0.3))
    for eta in (GLASS, 1 / GLASS)
    for theta in (0.0, 45.0, 80.0)
]


def facets_towards(wo, eta, turn, n):
    """Normals m (k, 3) that face wo, their cosines to wo, and their solid angles in quadrature, sr (k,).

    In polar coordinates about wo, so that total reflection sets in at the end of an interval. They are those for which a
    direction `turn` times as far from wo is above the surface: 1, m itself, or 2, the mirrored wo.
    """
    x, dx = gauss(n)
    theta, right = np.arccos(wo[2]), np.pi / 2
    last = min((right + theta) / turn, right)
    breaks = np.sort([0, (right - theta) / turn, min(np.arcsin(min(eta, 1.0)), last), last])
    t = (breaks[:-1, None] + np.diff(breaks)[:, None] * x * x * (3 - 2 * x)).ravel()  # roots at ends become smooth
    dt = (np.diff(breaks)[:, None] * 6 * x * (1 - x) * dx).ravel()
    slope, y = np.tan(turn * t) * np.tan(theta), 2 * x - 1
    half = np.arccos(np.clip(-1 / np.where(np.abs(slope) > 1e-99, slope, 1e-99 * np.cos(turn * t)), -1, 1))[:, None]
    phi, dphi = half * (y + 4 * y**3) / 5, half * (1 + 12 * y**2) / 5 * 2 * dx  # denser towards the surface's normal
    across = direction(right, np.arctan2(wo[1], wo[0]) + right)
    tilted = np.cross(wo, across)
    t = t[:, None, None]
    m = np.cos(t) * wo + np.sin(t) * (np.cos(phi)[..., None] * tilted + np.sin(phi)[..., None] * across)
    return m.reshape(-1, 3), np.repeat(np.cos(t), n), (np.sin(t[..., 0]) * dt[:, None] * dphi).ravel()


@np.errstate(under="ignore")
def leaving(model, wo, n):
    """Shares (2,) of the energy along wo that the model reflects and transmits: its f, integrated over facets.

    To a facet of normal m belong one direction above and one below the surface, whose solid angles are 4 (wo . m) and
    (wo . m - eta ct)^2 / (eta^2 ct) times that of m: Walter et al. 2007, Eqs. 14 and 17.
    """
    eta = model.eta
    m, c, solid_angle = facets_towards(wo, eta, 2, n)
    wi = 2 * c[:, None] * m - wo
    R = np.sum(model.f(wo, wi)[:, 0] * np.maximum(wi[:, 2], 0.0) * 4 * c * solid_angle)
    m, c, solid_angle = facets_towards(wo, eta, 1, n)
    passes = 1 - c**2 < eta**2
    m, c, solid_angle = m[passes], c[passes], solid_angle[passes]
    ct = np.sqrt(1 - (1 - c**2) / eta**2)
    wi = (c / eta - ct)[:, None] * m - wo / eta
    stretch = (c - eta * ct) ** 2 / ct  # times the eta^2 that radiance lacks
    T = np.sum(model.f(wo, wi)[:, 0] * np.maximum(-wi[:, 2], 0.0) * stretch * solid_angle)
    return np.array([R, T])


def test_reflection_and_transmission_are_the_first_order_of_the_walk():
    """Each of 72 numbers within 3 standard errors of the walk's; quadrature errs by less than a twentieth of one.

    Of 72 normal numbers 0.2 are beyond 3; the seeds were chosen once. That the errors are neither too small nor too large is
    asked of those that many rays make: pairs of R and T are worth one independent square at least, whose mean is beyond these
    quantiles by a chance of 0.002.
    """
    off, own, common, rays = [], [], [], 300_000
    for k, (ndf, alpha, eta, theta) in enumerate(WALKS):
        wo = direction(np.radians(theta), 0.5)
        mean, error = first_order(ndf, alpha, eta, wo, rays, seed=100 + k)
        model = Dielectric(alpha=alpha, eta=eta, ndf=ndf)
        value, coarse = leaving(model, wo, 64), leaving(model, wo, 48)
        off.append((value - mean) / error)
        own.append((value - coarse) / error)
        common.append(error > 3 / rays)
    squares = np.square(off)[common]
    print(f"largest {np.abs(off).max():.2f}, root mean square {np.sqrt(squares.mean()):.2f} of {len(squares)}")
    low, high = chi2.ppf([0.001, 0.999], len(squares) // 2) / (len(squares) // 2)
    assert np.abs(off).max() <= 3 and low < squares.mean() < high
    assert np.abs(own).max() < 0.05


def test_what_other_maskings_err_by():
    """The figures that their files state, for GGX at the worst: R and T less those of beta."""
    found = {}
    for alpha, eta, theta in ((1.0, GLASS, 85.0), (0.6, GLASS, 80.0), (1.0, 1 / GLASS, 85.0)):
        wo = direction(np.radians(theta), 0.5)
        for name in ("beta", "correlated", "separable"):
            model = Dielectric(alpha=alpha, eta=eta, masking=name)
            found[name, alpha, eta] = shares(model, wo, 1e-4, 64).value[:, 0]
    for (name, alpha, eta), (dR, dT) in {
        ("correlated", 1.0, GLASS): (0.0, 0.601),
        ("correlated", 0.6, GLASS): (0.0, 0.232),
        ("separable", 1.0, GLASS): (-0.021, 0.260),
        ("separable", 1.0, 1 / GLASS): (-0.123, 0.020),
    }.items():
        assert found[name, alpha, eta] - found["beta", alpha, eta] == pytest.approx([dR, dT], abs=1e-3)


# --- limits ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("eta", [GLASS, 1 / GLASS, 2.42, 1.01])
@pytest.mark.parametrize("ndf", ["ggx", "beckmann"])
def test_smooth_glass_is_flat_glass(ndf, eta):
    """R is Fresnel's, and R + T is 1 but for the facets that send light to the wrong side or hide each other.

    Their share goes as (alpha tan theta)^2. Fresnel's curve changes R by as much, times its curvature, which is below 100 where
    angles are 2 degrees from the critical one, and for GGX times 10 for the logarithm of its slopes' variance.
    """
    alpha = 1e-4
    theta = np.radians([t for t in (0.0, 30.0, 60.0, 80.0, 85.0) if abs(np.sin(np.radians(t)) - eta) > 0.02])
    wo = direction(theta, 0.7)
    value, error = shares(Dielectric(alpha=alpha, eta=eta, ndf=ndf), wo, 1e-9, 256)
    R, T = value[..., 0].T
    scale = alpha**2 * (1 + np.tan(theta) ** 2)
    assert np.all(np.abs(R + T - 1) <= scale + error.max())
    assert np.all(np.abs(R - F_dielectric(np.cos(theta), eta)) <= 1000 * scale + error.max())


def test_an_index_of_one_passes_all():
    """It is not a delta but a lobe of an index that is 1 + 2^-16: nothing is reflected, nothing turns by more than 3e-4."""
    model = Dielectric(alpha=0.1, eta=1.0)
    wo = direction(np.radians([0.0, 50.0]), 0.7)
    value, error = shares(model, wo, 1e-6, 256)
    assert np.all(value[:, 0] < 1e-9) and np.all(np.abs(value[0, 1] - 1) < 1e-6 + error[0, 1])
    wi, weight = model.sample_f(wo[1], np.random.default_rng(1).random((1000, 2)))
    assert np.linalg.norm((wi + wo[1])[weight[:, 0] > 0], axis=1).max() < 3e-4


def test_the_surface_from_below_is_that_of_the_inverse_index():
    rng = np.random.default_rng(2)
    wo, wi, u = above(rng, 2000, both=True), above(rng, 2000, both=True), rng.random((2000, 2))
    for masking in ("beta", "separable"):
        model = Dielectric(alpha=(0.3, 0.1), eta=GLASS, masking=masking)
        inverse = Dielectric(alpha=(0.3, 0.1), eta=1 / GLASS, masking=masking)
        np.testing.assert_allclose(inverse.f(wo * FLIP, wi * FLIP), model.f(wo, wi), rtol=1e-8, atol=1e-12)
        np.testing.assert_allclose(inverse.pdf(wo * FLIP, wi * FLIP), model.pdf(wo, wi), rtol=1e-8, atol=1e-12)
        for one, other in zip(model.sample_f(wo, u), inverse.sample_f(wo * FLIP, u), strict=True):
            np.testing.assert_allclose(np.abs(other), np.abs(one), rtol=1e-9, atol=1e-12)


# --- 50 digits -------------------------------------------------------------------------------------------------------


def refracted_pairs(alpha, eta, n=60):
    """Directions (m, 3) above and below the surface, near the lobe and down to grazing."""
    rng = np.random.default_rng(3)
    model = Dielectric(alpha=alpha, eta=eta)
    wo = above(rng, 20 * n, 1e-3)
    wi = model.sample_f(wo, rng.random((20 * n, 2)))[0]
    passes = np.flatnonzero(wi[:, 2] < -1e-3)[:n]
    return wo[passes], wi[passes]


@pytest.mark.parametrize("eta", [GLASS, 0.6, 1.001])
@pytest.mark.parametrize("alpha", [(0.2, 0.2), (1.0, 0.05), (1e-3, 1e-3)], ids=str)
@np.errstate(under="ignore")
def test_transmission_at_50_digits(alpha, eta):
    """Walter et al. 2007, Eqs. 16 and 21, with dot products, in numbers of 50 digits.

    A direction's own length errs by 1e-16, so cosines at a facet and slopes over alpha by that over |eta - 1|.
    """
    mp = pytest.importorskip("mpmath").mp
    wo, wi = refracted_pairs(alpha, eta)
    assert len(wo) > 20
    expected = {name: [] for name in ("beta", "correlated", "separable")}
    with mp.workdps(50):
        ax, ay, n = mp.mpf(alpha[0]), mp.mpf(alpha[1]), mp.mpf(eta)
        for o, i in zip(wo, wi, strict=True):
            o, i = ([mp.mpf(float(x)) / mp.norm([mp.mpf(float(y)) for y in w]) for x in w] for w in (o, i))
            h = [-(a + n * b) for a, b in zip(o, i, strict=True)]
            h = [x / mp.norm(h) for x in h]
            h = [-x for x in h] if h[2] < 0 else h
            ho, hi = mp.fdot(o, h), mp.fdot(i, h)
            ct = mp.sqrt(1 - (1 - ho**2) / n**2)
            F = (((ho - n * ct) / (ho + n * ct)) ** 2 + ((n * ho - ct) / (n * ho + ct)) ** 2) / 2
            D = 1 / (mp.pi * ax * ay * ((h[0] / ax) ** 2 + (h[1] / ay) ** 2 + h[2] ** 2) ** 2)
            x, y = ((mp.sqrt(1 + ((ax * w[0]) ** 2 + (ay * w[1]) ** 2) / w[2] ** 2) - 1) / 2 for w in (o, i))
            bare = abs(ho * hi / (o[2] * i[2])) * (1 - F) * D / (ho + n * hi) ** 2
            G = {"beta": mp.beta(1 + x, 1 + y), "correlated": 1 / (1 + x + y), "separable": 1 / ((1 + x) * (1 + y))}
            for name, g in G.items():
                expected[name].append(float(bare * g))
    tolerance = 1e-11 + 2e-14 / abs(eta - 1) ** 2 / min(alpha)
    for name, values in expected.items():
        model = Dielectric(alpha=alpha, eta=eta, masking=name)
        np.testing.assert_allclose(model.f(wo, wi)[:, 0], values, rtol=tolerance)
        np.testing.assert_allclose(model.f(wi, wo)[:, 0], eta**2 * np.array(values), rtol=tolerance)


def test_beta_function_of_both_twins(gpu):
    mp = pytest.importorskip("mpmath").mp
    rng = np.random.default_rng(4)
    x, y = (np.where(rng.random(3000) < 0.1, 0.0, 10 ** rng.uniform(-6, 6, 3000)) for _ in range(2))
    y[::2] = rng.uniform(0, 60, 1500)
    x, y = (np.float32(v).astype(float) for v in (x, y))
    with mp.workdps(40):
        expected = np.array([float(mp.beta(1 + mp.mpf(a), 1 + mp.mpf(b))) for a, b in zip(x, y, strict=True)])
    known = expected > 1e-290
    assert np.max(np.abs(beta_one_plus(x, y)[known] / expected[known] - 1)) < 5e-14
    value = gpu.evaluate_chunk("lib/beta.glsl", "float beta_one_plus(float x, float y)", x, y)[0]
    known = expected > 1.2e-38
    assert np.max(np.abs(value[known] / expected[known] - 1)) < 3e-6
    assert np.all(value[~known] < 2e-38)


# --- another renderer ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("eta", [GLASS, 1 / GLASS])
@pytest.mark.parametrize("alpha", [(0.1, 0.1), (0.3, 0.3), (0.7, 0.2)], ids=str)
@pytest.mark.parametrize("ndf", ["ggx", "beckmann"])
@np.errstate(under="ignore")
def test_mitsuba_roughdielectric(ndf, alpha, eta):
    """Mitsuba 3's G is separable, its G1 of Beckmann Walter's fit, in its pdf too; its eval includes the cosine.

    From both sides, and in the same radiance. Float32: slopes that err by 6e-8 / (alpha |eta - 1| cos) of alpha.
    """
    mi = pytest.importorskip("mitsuba")
    mi.set_variant("scalar_rgb")
    names = {
        "type": "roughdielectric",
        "distribution": ndf,
        "alpha_u": alpha[0],
        "alpha_v": alpha[1],
        "sample_visible": True,
    }
    other = mi.load_dict(names | {"int_ior": eta, "ext_ior": 1.0})
    model = Dielectric(alpha=alpha, eta=eta, ndf=ndf, masking="separable")
    rng = np.random.default_rng(5)
    wo = direction(np.arccos(rng.uniform(0.1, 1, 300)), rng.uniform(0, 2 * np.pi, 300))
    wo = wo * np.where(rng.random((300, 1)) < 0.5, 1.0, FLIP)
    wi = model.sample_f(wo, rng.random((300, 2)))[0]
    fit, exact = (slot("smith", ndf, name).Lambda for name in ("rational", "exact"))
    a = np.array(alpha)
    keep = np.abs(wi[:, 2]) > 0.1
    for w in (wo, wi):  # where the fit of G1 exceeds 1, Mitsuba's does
        steep = np.abs(w[:, 2]) / np.hypot(alpha[0] * w[:, 0], alpha[1] * w[:, 1])
        keep &= (ndf == "ggx") | (steep < 1.548) | (steep > 1.6)
    wo, wi = (np.float32(w[keep]).astype(float) for w in (wo, wi))
    assert len(wo) > 80 and np.mean(wo[:, 2] * wi[:, 2] < 0) > 0.2
    context, at = mi.BSDFContext(), mi.SurfaceInteraction3f()
    values, pdf = [], []
    for o, i in zip(wo, wi, strict=True):
        at.wi = mi.Vector3f(o)
        values.append(np.array(other.eval(context, at, mi.Vector3f(i)))[0])
        pdf.append(other.pdf(context, at, mi.Vector3f(i)))
    shadow_o, shadow_i = ((1 + exact(np.abs(w), a)) / (1 + fit(np.abs(w), a)) for w in (wo, wi))
    np.testing.assert_allclose(values, model.f(wo, wi)[:, 0] * np.abs(wi[:, 2]) * shadow_o * shadow_i, rtol=1e-4)
    np.testing.assert_allclose(pdf, model.pdf(wo, wi) * shadow_o, rtol=1e-4)


# --- the ball --------------------------------------------------------------------------------------------------------


def test_a_smooth_ball_is_not_seen_in_a_white_furnace(gpu):
    """What dims as 1 / eta^2 at the way in brightens by eta^2 at the way out, and all that is reflected is there again."""
    state = load("gold", load("white_furnace"))
    state = state.with_view("sphere", samples=64, noise=1e-6)
    for model in (Dielectric(alpha=1e-3, eta=GLASS), Dielectric(alpha=1e-3, eta=2.42)):
        seen = replace(state, materials=(Material("ball", model),), active=0)
        *_, last = seen.views["sphere"].pictures(gpu, seen, (48, 48))
        pixels = gpu.pixels(last.target)
        inside = pixels[..., 3] == 1
        mean = pixels[inside][:, 0].mean() / state.light.gain
        assert mean == pytest.approx(1, abs=3e-3)

"""Laws of reflection and answers known in closed form, in float64; and each figure that the formulas' headers state."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from oracles.cases import CASES

from brdf_explorer.lib import fresnel, schlick, slot
from brdf_explorer.lib.colormap import diverging, viridis
from brdf_explorer.lib.common import PI, dot, length, normalize, vec
from brdf_explorer.lib.spectrum import F_spectral
from brdf_explorer.measure.albedo import albedo
from brdf_explorer.measure.grid import direction
from brdf_explorer.model import Choice, declared
from brdf_explorer.models import MODELS

Microfacet, Diffuse = MODELS["microfacet"], MODELS["diffuse"]
NDFS = declared(Microfacet, Choice)["ndf"].options
ALPHAS = [(1e-4, 1e-4), (1e-2, 1e-2), (0.3, 0.3), (1.0, 1.0), (1e-4, 1.0), (0.8, 0.05)]
WHITE = {"fresnel": "one"}


def upper(rng, n, lowest=1e-4):
    """n directions above the horizon, their cosines over decades."""
    z = np.where(rng.random(n) < 0.5, lowest ** rng.random(n), rng.random(n))
    return direction(np.arccos(z), rng.uniform(0, 2 * PI, n))


def nodes(low, high, n):
    """Gauss-Legendre: points and weights on [low, high]."""
    x, dx = leggauss(n)
    return low + 0.5 * (high - low) * (x + 1), 0.5 * (high - low) * dx


def sees(cosine):
    return np.array([np.sqrt(1 - cosine**2), 0.0, cosine])


# --- distributions of normals ----------------------------------------------------------------------------------------


@np.errstate(under="ignore")
def seen_area(D, w, alpha, n=160):
    """The integral of D (w . wm)+ over normals, in slopes p along the view and q across it, in units of alpha.

    p = tan b and q = sqrt(1 + p^2) tan c make GGX's integrand a polynomial in sines and cosines; p ends where facets turn away.
    """
    ax, ay = alpha
    v = np.array([ax * w[0], ay * w[1], w[2]])
    s = np.hypot(v[0], v[1])
    along = v[:2] / s if s > 0 else np.array([1.0, 0.0])
    b, db = nodes(-PI / 2, np.arctan2(v[2], s), n)
    c, dc = nodes(-PI / 2, PI / 2, n)
    p, root = np.tan(b)[:, None], (1 / np.cos(b))[:, None]
    q = root * np.tan(c)
    slope_x, slope_y = ax * (p * along[0] - q * along[1]), ay * (p * along[1] + q * along[0])
    wm = vec(-slope_x, -slope_y, np.ones_like(slope_x))
    density = D(wm, np.array(alpha)) / length(wm) ** 4  # d omega = cos^3 d slope, and wm = cos (-slope, 1)
    jacobian = ax * ay * root**3 / np.cos(c) ** 2
    return np.einsum("bc,b,c->", density * jacobian * (v[2] - p * s), db, dc)


@pytest.mark.parametrize("alpha", ALPHAS, ids=str)
@pytest.mark.parametrize("ndf", NDFS)
def test_D_projects_to_unit_area(ndf, alpha):
    assert seen_area(slot("ndf", ndf).D, np.array([0.0, 0.0, 1.0]), alpha) == pytest.approx(1, rel=1e-8)


@pytest.mark.parametrize("alpha", ALPHAS, ids=str)
@pytest.mark.parametrize("ndf", NDFS)
def test_visible_area_is_projected_area(ndf, alpha):
    module, Lambda = slot("ndf", ndf), slot("smith", ndf, "exact").Lambda
    for w in direction(np.arccos([1e-4, 0.05, 0.4, 0.9])[:, None], np.array([0.0, 0.7, PI / 2])).reshape(-1, 3):
        seen = seen_area(module.D, w, alpha)
        assert module.visible_area(w, np.array(alpha)) == pytest.approx(seen, rel=1e-8)
        assert w[2] * (1 + Lambda(w, np.array(alpha))) == pytest.approx(seen, rel=1e-8)


@pytest.mark.parametrize("alpha", [(0.3, 0.3), (1.0, 1.0), (0.8, 0.2)], ids=str)
@pytest.mark.parametrize("ndf", NDFS)
@np.errstate(under="ignore")
def test_weak_white_furnace(ndf, alpha):
    """Without shadowing of the light that leaves, nothing is lost: polar coordinates of the normals about wo."""
    alpha = np.array(alpha)
    D, Lambda = slot("ndf", ndf).D, slot("smith", ndf, "exact").Lambda
    for cosine in (0.1, 0.5, 0.95):
        wo = sees(cosine)
        frame = np.array([[wo[2], 0, -wo[0]], [0, 1, 0], wo])
        total = 0.0
        for start in (-PI / 2, PI / 2):  # the normals' horizon has a corner at the quarter turns
            phi, dphi = nodes(start, start + PI, 200)
            last = np.minimum(np.arctan2(wo[2], wo[0] * np.cos(phi)), PI / 2)
            x, dx = nodes(0.0, 1.0, 200)
            theta = last[:, None] * x
            wm = direction(theta, phi[:, None]) @ frame
            G1 = slot("shadowing", "correlated").G2(wo, wo, Lambda(wo, alpha), 0.0)
            integrand = G1 * dot(wm, wo) * D(wm, alpha) / wo[2] * np.sin(theta)
            total += np.einsum("pt,p,t,p->", integrand, dphi, dx, last)
        assert total == pytest.approx(1, abs=1e-6)


# --- models ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("cls", [cls for cls in MODELS.values() if not cls.stochastic], ids=lambda cls: cls.name())
@np.errstate(under="ignore")
def test_reciprocity(cls):
    rng = np.random.default_rng(1)
    wo, wi = upper(rng, 200), upper(rng, 200)
    shapes = [{"alpha": a} for a in ALPHAS] if cls is Microfacet else [{}]
    for choices, values in product([choices for c, choices in CASES if c is cls], shapes):
        model = cls(**values, **choices)
        forth, back = model.f(wo, wi), model.f(wi, wo)
        limit = model.exceptions().get("reciprocity", 1e-12)
        assert np.all(np.abs(forth - back) <= limit * np.maximum(forth, back)), model


def excess(model, cosines=(0.02, 0.2, 0.7)):
    return float(np.max(albedo(model, np.array([sees(c) for c in cosines]), tolerance=1e-7, most=256))) - 1


GAIN = {("beckmann", "rational"): 3.2e-3}
"""What the fit may create: its G1 exceeds the exact one by up to 3.1e-3 / 0.99, the share of the facets that are visible."""
SHADOWED = [s for s in declared(Microfacet, Choice)["shadowing"].options if s != "none"]


@pytest.mark.parametrize("ndf, smith", list(product(NDFS, ("exact", "rational"))))
def test_energy_is_not_created(ndf, smith):
    for alpha, shadowing in product([(0.05, 0.05), (0.4, 0.4), (1.0, 1.0), (1.0, 0.1)], SHADOWED):
        model = Microfacet(alpha=alpha, ndf=ndf, smith=smith, shadowing=shadowing, **WHITE)
        assert excess(model) <= GAIN.get((ndf, smith), 1e-7), model


@pytest.mark.parametrize("ndf, smith", list(product(NDFS, ("exact", "rational"))))
@np.errstate(under="ignore")
def test_weights_of_visible_normals_are_at_most_1(ndf, smith):
    """The weight is F G2 / G1, and G2 is at most G1."""
    rng = np.random.default_rng(9)
    wo, u = upper(rng, 1000), rng.random((1000, 2))
    for alpha, shadowing in product(ALPHAS, SHADOWED):
        weight = Microfacet(alpha=alpha, ndf=ndf, smith=smith, shadowing=shadowing, **WHITE).sample_f(wo, u)[1]
        assert weight.max() <= 1 + GAIN.get((ndf, smith), 1e-14), (alpha, shadowing)


@pytest.mark.parametrize("ndf", NDFS)
def test_without_shadowing_energy_is_created(ndf):
    assert excess(Microfacet(alpha=(1, 1), ndf=ndf, shadowing="none", **WHITE)) > 0.5


def test_lambert_reflects_its_albedo():
    model = Diffuse(albedo=(1.0, 0.5, 0.0))
    assert albedo(model, sees(0.3)) == pytest.approx(np.array(model.albedo), abs=1e-8)


def test_ggx_at_alpha_1_seen_along_the_normal():
    """Single scattering, F = 1: the albedo is 1 - ln 2, so that 0.69 of the light is lost."""
    up = np.array([0.0, 0.0, 1.0])
    for shadowing in ("separable", "correlated", "full"):
        value = albedo(Microfacet(alpha=(1, 1), shadowing=shadowing, **WHITE), up)
        assert value == pytest.approx(1 - np.log(2), abs=1e-8)
    assert 1 - value[0] == pytest.approx(0.69, abs=5e-3)


@np.errstate(under="ignore")
def test_shadowing_is_ordered_by_correlation():
    rng = np.random.default_rng(2)
    wo, wi = upper(rng, 2000), upper(rng, 2000)
    for ndf, smith, alpha in product(NDFS, ("exact", "rational"), ALPHAS):
        Lambda = slot("smith", ndf, smith).Lambda
        L = [Lambda(w, np.array(alpha)) for w in (wo, wi)]
        G = {
            name: slot("shadowing", name).G2(wo, wi, *L)
            for name in ("separable", "correlated", "directional", "full", "none")
        }
        for less, more in [
            ("separable", "correlated"),
            ("correlated", "full"),
            ("separable", "directional"),
            ("directional", "full"),
            ("full", "none"),
        ]:
            assert np.all(G[less] <= G[more] * (1 + 1e-15)), (less, more, ndf, alpha)


def test_directional_shadowing_at_its_ends():
    wo = direction(1.2, 0.3)
    for turn, name in [(0.0, "full"), (PI / 2, "separable"), (PI, "separable")]:
        wi = direction(0.9, 0.3 + turn)
        expected = slot("shadowing", name).G2(wo, wi, 1.3, 0.6)
        assert slot("shadowing", "directional").G2(wo, wi, 1.3, 0.6) == pytest.approx(expected, rel=2e-8)
    assert 1 / (2 * np.radians(15) ** 2) == pytest.approx(7.3, abs=0.05)


def test_separable_shadowing_loses():
    for cosine, lost in [(0.5, 0.04), (0.1, 0.20)]:
        values = [
            albedo(Microfacet(alpha=(1, 1), shadowing=s, **WHITE), sees(cosine))[0] for s in ("correlated", "separable")
        ]
        assert values[0] - values[1] == pytest.approx(lost, abs=5e-3)


# --- diffuse ---------------------------------------------------------------------------------------------------------


def oren_nayar_albedo(sigma, theta):
    """Closed form of the white facets' albedo, and A + B / 2."""
    A = 1 - 0.5 * sigma**2 / (sigma**2 + 0.33)
    B = 0.45 * sigma**2 / (sigma**2 + 0.09)
    s, c = np.sin(theta), np.cos(theta)
    return A + 2 * B / PI * s * (0.5 * (theta - s * c) + (1 - s**3) / (3 * c)), A + B / 2


def albedo_between_corners(model, theta_o):
    """Albedo by quadrature between the corners that s / max(cos, cos) has at the viewer's angle and at the quarter turns."""
    value = 0.0
    for low, high in [(0, theta_o), (theta_o, PI / 2)]:
        theta, dtheta = nodes(low, high, 32)
        for start in (-PI / 2, PI / 2):
            phi, dphi = nodes(start, start + PI, 32)
            f = model.f(direction(theta_o, 0.0), direction(theta[:, None], phi))[..., 0]
            value += np.einsum("tp,t,p->", f, np.sin(theta) * np.cos(theta) * dtheta, dphi)
    return value


@pytest.mark.parametrize("sigma", [0.0, 0.2, 1.0])
def test_oren_nayar_albedo(sigma):
    model = Diffuse(albedo=(1, 1, 1), sigma=sigma, diffuse="oren_nayar")
    for theta_o in (0.4, 1.2, PI / 2 - 1e-6):
        expected, bound = oren_nayar_albedo(sigma, theta_o)
        value = albedo_between_corners(model, theta_o)
        assert value == pytest.approx(expected, abs=1e-10)
        assert value <= bound + 1e-10


def test_oren_nayar_gains_at_most():
    sigma = np.linspace(0, 1, 10_001)
    grazing, bound = oren_nayar_albedo(sigma, PI / 2 - 1e-7)
    assert grazing == pytest.approx(bound, abs=1e-6)
    assert bound.max() == pytest.approx(1.0152, abs=5e-5)
    assert sigma[bound.argmax()] == pytest.approx(0.20, abs=5e-3)
    assert np.all(oren_nayar_albedo(sigma[:, None], np.linspace(0, 1.57, 300))[0] <= bound[:, None] + 1e-12)


@pytest.mark.parametrize("r", [0.0, 0.3, 1.0])
def test_eon_keeps_energy(r):
    for theta_o in (0.0, 0.4, 1.2, PI / 2 - 1e-6):
        assert albedo_between_corners(Diffuse(albedo=1, r=r, diffuse="eon"), theta_o) == pytest.approx(1, abs=1e-10)


# --- Fresnel ---------------------------------------------------------------------------------------------------------

ETA = np.concatenate([np.geomspace(0.05, 6, 60), 1 + np.array([-1e-3, -1e-9, 0, 1e-9, 1e-3])])
K = np.array([0.0, 1e-8, 1e-3, 0.1, 1.0, 4.0, 15.0])
COSINES = np.linspace(0, 1, 2001)


def test_fresnel_along_the_normal():
    eta, k = ETA[:, None], K
    np.testing.assert_allclose(fresnel.F_conductor(1.0, eta, k), fresnel.F0(eta, k), rtol=1e-13)
    np.testing.assert_allclose(fresnel.F_dielectric(1.0, ETA), fresnel.F0(ETA, 0.0), rtol=1e-13)
    np.testing.assert_allclose(schlick.F_schlick(1.0, 0.3), 0.3)


def test_fresnel_grazing():
    off = ETA != 1
    np.testing.assert_allclose(fresnel.F_dielectric(0.0, ETA[off]), 1, rtol=1e-13)
    np.testing.assert_allclose(fresnel.F_conductor(0.0, ETA[:, None], K), 1, rtol=1e-13)
    np.testing.assert_allclose(schlick.F_schlick(0.0, 0.3), 1)


def test_fresnel_total_internal_reflection():
    for eta in (0.05, 0.5, 0.9, 1 - 1e-9):
        critical = np.sqrt((1 - eta) * (1 + eta))
        assert np.all(fresnel.F_dielectric(critical * np.linspace(0, 1 - 1e-6, 50), eta) == 1)
        assert np.all(fresnel.F_dielectric(critical * 1.01, eta) < 1)


def test_fresnel_conserves_energy():
    """What is not reflected goes through: n cos_t / cos times the squared amplitudes of transmission."""
    c, eta = COSINES[1:, None], ETA
    sin2_t = (1 - c * c) / eta**2
    ct = np.sqrt(np.maximum(1 - sin2_t, 0))
    through = eta * ct / c * 0.5 * ((2 * c / (c + eta * ct)) ** 2 + (2 * c / (eta * c + ct)) ** 2)
    np.testing.assert_allclose(np.where(sin2_t < 1, through, 0) + fresnel.F_dielectric(c, eta), 1, atol=1e-12)


def test_fresnel_conductor_without_absorption_is_dielectric():
    c, eta = COSINES[1:, None], ETA
    np.testing.assert_allclose(fresnel.F_conductor(c, eta, 0.0), fresnel.F_dielectric(c, eta), rtol=1e-11, atol=1e-30)


def test_fresnel_is_a_share():
    values = fresnel.F_conductor(COSINES[:, None, None], ETA[:, None], K)
    assert values.min() >= 0 and values.max() <= 1 + 1e-15


def test_fresnel_is_a_share_in_float32(gpu):
    """Also where light is all reflected but for a trace of absorption, and everything but that cancels."""
    rng = np.random.default_rng(5)
    c, k = 10 ** rng.uniform(-12, 0, 300_000), 10 ** rng.uniform(-20, 1, 300_000)
    eta = np.where(rng.random(c.shape) < 0.5, 0.05 * 120 ** rng.random(c.shape), 1 + 10 ** rng.uniform(-7, 0, c.shape))
    for beside in (eta, 2 - np.minimum(eta, 1.95)):
        (value,) = gpu.evaluate_chunk(
            "lib/fresnel.glsl", "float F_conductor(float c, float eta, float k)", c, beside, k
        )
        assert value.min() >= 0 and value.max() <= 1 + 14 * 2.0**-24  # Rs has 9 roundings, Rp 10 more; their mean


def test_fresnel_rises_towards_grazing_after_one_dip():
    """The pseudo-Brewster dip; a dielectric has none up to eta = 2 + sqrt(3)."""
    slopes = np.diff(fresnel.F_conductor(COSINES[::-1, None, None], ETA[:, None], K), axis=0)
    slopes = np.where(np.abs(slopes) < 1e-13, 0, slopes)
    rising = np.maximum.accumulate(slopes > 0, axis=0)
    assert not np.any(rising & (slopes < 0))
    no_dip = ETA[(ETA > 1.01) & (ETA < 2 + np.sqrt(3))]
    assert np.all(np.diff(fresnel.F_dielectric(COSINES[:, None], no_dip), axis=0) <= 1e-15)
    assert np.any(np.diff(fresnel.F_dielectric(COSINES, 3.8)) > 0)


@pytest.mark.parametrize(
    "eta, k, error", [(1.5, 0.0, 0.036), (1.05, 0.0, 0.32), (3.5, 0.0, 0.17), (5.6, 1.2, 0.29)], ids=str
)
def test_schlick_error(eta, k, error):
    off = np.abs(schlick.F_schlick(COSINES, fresnel.F0(eta, k)) - fresnel.F_conductor(COSINES, eta, k))
    assert off.max() == pytest.approx(error, abs=0.5 * 10 ** np.floor(np.log10(error) - 1))
    if eta == 1.5:
        assert np.degrees(np.arccos(COSINES[off.argmax()])) == pytest.approx(85, abs=0.5)


@pytest.mark.parametrize(
    "eta, k, error",
    [(1.5, 0.0, 0.028), (1.05, 0.0, 0.058), (3.5, 0.0, 0.032), (5.6, 1.2, 0.074), (0.143, 3.98, 0.0039)],
    ids=str,
)
def test_f82_error(eta, k, error):
    """It meets the exact curve along the normal, at a cosine of 1/7 and at the horizon."""
    exact = [fresnel.F_conductor(c, eta, k) for c in (COSINES, 1 / 7)]
    off = np.abs(schlick.F_f82(COSINES, fresnel.F0(eta, k), exact[1]) - exact[0])
    assert off.max() == pytest.approx(error, abs=0.5 * 10 ** np.floor(np.log10(error) - 1))
    ends = schlick.F_f82(np.array([1.0, 1 / 7, 0.0]), fresnel.F0(eta, k), exact[1])
    np.testing.assert_allclose(ends, [fresnel.F0(eta, k), exact[1], 1.0], rtol=1e-13)
    if eta == 1.5:
        assert np.degrees(np.arccos(COSINES[off.argmax()])) == pytest.approx(68, abs=0.5)


def test_f82_is_a_share():
    """Indices next to 1 would make it negative, and those below 1 larger than 1."""
    eta = np.concatenate([ETA, np.linspace(1.0, 1.1, 50)])[:, None]
    values = schlick.F_f82(COSINES[:, None, None], fresnel.F0(eta, K), fresnel.F_conductor(1 / 7, eta, K))
    assert values.min() == 0 and values.max() <= 1 + 1e-15


@pytest.mark.parametrize("eta, k, error", [(1.5, 0.0, 0.96), (0.05, 3.613, 0.014)], ids=str)
def test_constant_error(eta, k, error):
    assert 1 - slot("fresnel", "constant").F(0.5, np.array([eta] * 3), np.array([k] * 3))[0] == pytest.approx(
        error, abs=5e-4
    )


def spectral(eta, k, table):
    """Reflectance (90, 3) in linear RGB at 0, 1, ... 89 degrees by complex numbers, from observer and light at 5 nm."""
    nm, observer, light = table[:, 0], table[:, 1:4], table[:, 4]
    n = np.interp(nm, *eta) + 1j * np.interp(nm, *k)
    c = np.cos(np.radians(np.arange(90)))[:, None]
    t = np.sqrt(1 - (1 - c * c) / n**2)
    R = (np.abs((c - n * t) / (c + n * t)) ** 2 + np.abs((n * c - t) / (n * c + t)) ** 2) / 2
    xyz, white = (np.einsum("an,n,nc->ac", r, light, observer) for r in (R, np.ones((1, len(nm)))))
    # Rec. 709: chromaticities of the primaries, scaled so that their sum is white
    primaries = np.array([[0.64, 0.33, 0.03], [0.30, 0.60, 0.10], [0.15, 0.06, 0.79]]).T
    return np.linalg.solve(primaries * np.linalg.solve(primaries, white[0]), xyz.T).T


@pytest.mark.parametrize("metal", ["gold", "copper"])
def test_spectral_error(metal):
    """The 16 wavelengths against the whole spectrum, from published tables of the observer, the light and the metal."""
    folder = Path(__file__).parent / "oracles"
    table = np.loadtxt(folder / "observer.csv", delimiter=",")
    points = np.loadtxt(folder / f"{metal}.csv", delimiter=",").T
    module = slot("fresnel", "spectral", metal)
    c = np.cos(np.radians(np.arange(90)))
    off = np.abs(module.F(c, None, None) - spectral(points[[0, 1]], points[[0, 2]], table))
    assert 0.5 * module.ERROR < off.max() <= module.ERROR <= 9.3e-4
    if metal == "gold":
        assert module.F(c, None, None).max() == pytest.approx(1.037, abs=5e-4)


def test_a_spectrum_without_features_is_its_index():
    """The wavelengths' weights are those of white: at each of them the same index, it is that of a conductor."""
    for eta, k in ((1.5, 0.0), (0.2, 4.0)):
        flat = F_spectral(COSINES, np.full(16, eta), np.full(16, k))
        np.testing.assert_allclose(flat, fresnel.F_conductor(COSINES, eta, k)[:, None].repeat(3, 1), atol=1.1e-6)


def test_schlick_knows_no_total_internal_reflection():
    eta = 1 / 1.5
    critical = np.sqrt(1 - eta**2)
    assert 1 - schlick.F_schlick(critical, fresnel.F0(eta, 0.0)) == pytest.approx(0.96, abs=5e-3)


# --- fits and roundings ----------------------------------------------------------------------------------------------


def test_walter_rational_fit():
    a = np.linspace(1e-3, 1.7, 20_000)
    w = vec(np.ones_like(a), 0.0 * a, a)
    w, alpha = normalize(w), np.ones(2)
    exact, fit = (1 / (1 + slot("smith", "beckmann", s).Lambda(w, alpha)) for s in ("exact", "rational"))
    off = np.abs(fit - exact)
    assert off.max() == pytest.approx(3.1e-3, abs=5e-5)
    assert a[off.argmax()] == pytest.approx(1.34, abs=5e-3)
    bare = (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a)
    above = (bare > 1) & (a < 1.6)
    assert a[above][0] == pytest.approx(1.548, abs=5e-4)
    assert bare[above].max() - 1 == pytest.approx(6e-5, abs=5e-6)
    assert np.all(fit[a >= 1.5485] == 1)
    assert np.max(np.abs(1 - (1 / fit - 1) / (1 / exact - 1))[a < 1.6]) == pytest.approx(1, abs=0.01)


def stated(value, expected, limit):
    """The largest relative error is at most the figure, and the figure no more than three times it."""
    worst = np.max(np.abs(np.asarray(value, dtype=float) - expected) / np.abs(expected))
    assert limit / 3 <= worst <= limit, worst


def test_float32_fits(gpu):
    from scipy.special import erfcx

    from brdf_explorer.lib.beckmann import h_beckmann

    def chunk(name, signature, *arguments):
        return gpu.evaluate_chunk(f"lib/{name}.glsl", signature, *arguments)[0]

    a = np.float32(np.linspace(0, 9.4, 100_000))
    stated(chunk("beckmann", "float h_beckmann(float a)", a), h_beckmann(a.astype(float)), 6.1e-7)
    x = np.float32(np.linspace(0, 6.5, 100_000))
    stated(chunk("transcendental", "float erfcx_precise(float x)", x), erfcx(x.astype(float)), 5.1e-7)
    x = np.float32(np.linspace(-86.9, 88, 400_000))
    stated(chunk("transcendental", "float exp_precise(float x)", x), np.exp(x.astype(float)), 2.5e-7)
    rng = np.random.default_rng(3)
    y = np.float32(rng.normal(size=400_000))
    x = np.float32(y * rng.choice((-1, 1), y.shape) * 10 ** rng.uniform(-3, 3, y.shape))
    stated(chunk("transcendental", "float atan2_precise(float y, float x)", y, x), np.arctan2(y.astype(float), x), 3e-7)


def test_viridis_is_off_by():
    colormaps = pytest.importorskip("matplotlib").colormaps
    x = np.linspace(0, 1, 256)
    assert np.abs(viridis(x) - colormaps["viridis"](x)[:, :3]).max() == pytest.approx(0.0225, abs=1.1e-4)


def test_diverging_is_colorbrewer(gpu):
    x = np.linspace(-1, 1, 256)
    known = pytest.importorskip("matplotlib").colormaps["RdBu_r"](np.arange(256))[:, :3]
    np.testing.assert_allclose(diverging(x), known, atol=1e-3)  # whose colours are entries of a table


def test_stable_forms_in_float32(gpu):
    """The errors that comments state for the forms that were not taken, and for those that were."""
    from scipy.special import erf

    from brdf_explorer.lib.beckmann import h_beckmann

    one, two = np.float32(1), np.float32(2)
    # GGX's Lambda
    t = np.float32(np.geomspace(1e-3, 1, 300_000))
    square = t.astype(float) ** 2
    off = (np.sqrt(one + t * t) - one) / two / (0.5 * square / (1 + np.sqrt(1 + square))) - 1
    assert np.max(np.abs(off) * square) == pytest.approx(2e-7, rel=0.1)
    # the spherical cap's radius
    q = np.float32(np.geomspace(1e-4, 1.5, 300_000))
    exact = np.sqrt(q.astype(float) * (2 - q.astype(float)))
    stated(np.sqrt(q * (two - q)), exact, 1.1e-7)
    z = one - q
    assert np.max((np.abs(np.sqrt(one - z * z) / exact - 1) * q)[q < 0.1]) == pytest.approx(2.5e-8, rel=0.1)
    # Beckmann's Lambda
    a = np.float32(np.linspace(2, 6, 100_000))
    naive = (np.exp(-a * a) / (a * np.float32(np.sqrt(PI))) - (one - erf(a))) / two
    exact = h_beckmann(a.astype(float)) * np.exp(-(a.astype(float) ** 2)) / a
    assert np.max(np.abs(naive / exact)) == pytest.approx(75, abs=0.5)
    # a dielectric of nearly no contrast
    c, eta = np.float32(np.linspace(0.05, 1, 300_000)), np.float32(1.001)
    exact = fresnel.F_dielectric(c.astype(float), float(eta))
    stable = gpu.evaluate_chunk("lib/fresnel.glsl", "float F_dielectric(float c, float eta)", c, eta)[0]
    stated(stable, exact, 8e-7)
    ct = np.sqrt(one - (one - c * c) / (eta * eta))
    stated(0.5 * (((c - eta * ct) / (c + eta * ct)) ** 2 + ((eta * c - ct) / (eta * c + ct)) ** 2), exact, 2e-4)


def test_dielectric_next_to_the_critical_angle_in_float32(gpu):
    rng, one = np.random.default_rng(7), np.float32(1)
    c, eta = np.float32(10 ** rng.uniform(-4, 0, 300_000)), np.float32(1 - 10 ** rng.uniform(-7.2, -0.6, 300_000))
    exact = fresnel.F_dielectric(c.astype(float), eta.astype(float))
    t = np.sqrt(np.maximum(eta * eta - (one - c) * (one + c), 0))
    rs, s2 = (eta - one) * (eta + one) / (c + t) ** 2, (one - c) * (one + c)
    naive = np.where(t > 0, (rs**2 + (rs * (c * t - s2) / (c * t + s2)) ** 2) / 2, 1)
    assert np.max(naive / exact) > 20
    value = gpu.evaluate_chunk("lib/fresnel.glsl", "float F_dielectric(float c, float eta)", c, eta)[0]
    # t^2 = c^2 + (eta^2 - 1) is off by 3 roundings of c^2, t by 1.5 c^2 / t, F by at most 6 / c times that: 9 c / t of them
    room = np.abs(c.astype(float) ** 2 - (1 - eta.astype(float)) * (1 + eta.astype(float))) > 1e-3 * c**2
    assert np.max(np.abs(value / exact - 1)[room]) < 9 / np.sqrt(1e-3) * 2**-24


def test_D_beckmann_in_float32(gpu):
    rng, n = np.random.default_rng(8), 200_000
    alpha = np.float32(10 ** rng.uniform(-4, 0, (n, 2)))
    rho, psi = 9.2 * np.sqrt(rng.random(n)), rng.uniform(0, 2 * PI, n)
    slope = alpha * vec(rho * np.cos(psi), rho * np.sin(psi))
    wm = np.float32(vec(*slope.T, np.ones(n)) * rng.uniform(0.1, 1.1, (n, 1)))
    exact = slot("ndf", "beckmann").D(wm.astype(float), alpha.astype(float))
    stated(gpu.evaluate_chunk("lib/ndf_beckmann.glsl", "float D(vec3 wm, vec2 alpha)", wm, alpha)[0], exact, 1e-6)
    slope = wm[:, :2] / (alpha * wm[:, 2:])
    exponent = -np.sum(slope * slope, axis=1)
    gauss = gpu.evaluate_chunk("lib/transcendental.glsl", "float exp_precise(float x)", exponent)[0]
    c2 = wm[:, 2] ** 2 / np.sum(wm * wm, axis=1)
    stated(gauss / (np.float32(PI) * alpha[:, 0] * alpha[:, 1] * c2 * c2), exact, 2.4e-5)


def test_figures_of_comments():
    from scipy.special import erfc

    assert erfc(6) / 2 == pytest.approx(
        1e-17, rel=0.1
    )  # of the visible area beyond a slope of 6, seen along the normal
    root = max(np.roots([1, 0, 0, 0, 0, 0, -1, -1]).real)
    assert np.min(np.abs(root ** -np.arange(1.0, 7) - 15 / 23)) == pytest.approx(9e-6, rel=0.05)  # of the sequence R_6
    curve, x = np.float32(slot("tonemap", "agx").CURVE), np.float32(np.linspace(0.9, 1, 100_000))
    exact = np.polyval(curve.astype(float), x.astype(float))
    powers = sum(c * x ** np.float32(6 - n) for n, c in enumerate(curve[:-1])) + curve[-1]
    matrix = (
        np.abs(slot("tonemap", "agx").OUTPUT).sum(axis=1).max()
    )  # may add the errors of its inputs, 2.2 times in the power
    assert 2.2 * matrix * np.max(np.abs(powers / exact - 1)) == pytest.approx(2e-5, rel=0.2)

"""Facets that are no mirrors: the rule against the integral as the lecture prints it, its limits, and what the view says of
them.
"""

from dataclasses import replace

import numpy as np
import pytest
from test_physics import nodes

from brdf_explorer.lib import slot
from brdf_explorer.lib.common import INV_PI, PI, dot, mirror, normalize, vec
from brdf_explorer.lib.facets import facets
from brdf_explorer.lib.warp import uniform_hemisphere
from brdf_explorer.measure.albedo import albedo
from brdf_explorer.measure.grid import direction
from brdf_explorer.measure.mirror_limit import differences, mirrors, sharpened
from brdf_explorer.model import Invalid
from brdf_explorer.models import MODELS
from brdf_explorer.state import Directions, Material, State, load
from brdf_explorer.views.facets import curve

Nonspecular, Microfacet, Diffuse = (MODELS[name] for name in ("nonspecular", "microfacet", "diffuse"))
NDFS = ("ggx", "beckmann")
WHITE = {"albedo": 1.0, "fresnel": "one"}


def pairs(n, seed=1):
    rng = np.random.default_rng(seed)
    return (direction(np.arccos(rng.uniform(0.1, 1, n)), rng.uniform(0, 2 * PI, n)) for _ in range(2))


@np.errstate(under="ignore")
def as_printed(model, wo, wi, n=240):
    """The lecture's integral, over the normals above the surface in slopes of up to any height, with f_mf as it is defined."""
    alpha = np.array(model.alpha)
    b, db = nodes(0, PI / 2, n)
    phi = 2 * PI * (np.arange(2 * n) + 0.5) / (2 * n)
    slope = np.tan(b)[:, None, None] * alpha * vec(np.cos(phi), np.sin(phi))
    wm = normalize(np.concatenate([slope, np.ones((n, 2 * n, 1))], axis=-1))
    # d wm = cos^3 d slope, d slope = alpha_x alpha_y tan b / cos^2 b db dphi
    solid_angle = wm[..., 2] ** 3 * alpha.prod() * (np.tan(b) / np.cos(b) ** 2 * db)[:, None] * (PI / n)
    D, Lambda = slot("ndf", model.ndf).D(wm, alpha), slot("smith", model.ndf, model.smith).Lambda
    G = slot("shadowing", model.shadowing).G2(wo, wi, Lambda(wo, alpha), Lambda(wi, alpha))
    if model.facet == "lambert":
        f_mf = model.albedo[0] * INV_PI
    else:
        R, c, kappa = mirror(wo, wm), 0.5 * np.linalg.norm(wo + wi), model.kappa
        F = slot("fresnel", model.fresnel).F(c, np.array(model.eta), np.array(model.k))[..., 0]
        f_mf = F / c * kappa * INV_PI / 2 / (1 - np.exp(-2 * kappa)) * np.exp(kappa * (dot(wi, R) - 1))
    seen = np.maximum(dot(wm, wo), 0) * np.maximum(dot(wm, wi), 0)
    return np.sum(D * G * f_mf * seen * solid_angle) / (wo[2] * wi[2])


@pytest.mark.parametrize("facet", ["lambert", "lobe"])
@pytest.mark.parametrize("ndf", NDFS)
def test_f_is_the_integral_as_printed(ndf, facet):
    """A rule of another kind, whose error across the planes where facets turn away is below 1e-5 here."""
    for alpha, kappa in (((0.4, 0.4), 20.0), ((0.9, 0.3), 5.0), ((0.2, 0.2), 200.0)):
        for wo, wi in zip(*pairs(2), strict=True):
            model = Nonspecular(alpha=alpha, kappa=kappa, facet=facet, ndf=ndf, nodes="16")
            if facet == "lobe":  # where the lobe is
                wi = mirror(wo, normalize(vec(0.1, 0.05, 1.0)))
                if wi[2] < 0.1:
                    continue
            assert model.f(wo, wi)[0] == pytest.approx(as_printed(model, wo, wi), rel=1e-3), (model, wo, wi)


ERRORS = {  # median and largest, by facet, ndf and nodes: the header of facets.glsl
    ("lambert", "ggx"): {"8": (3e-5, 1e-3), "12": (4e-6, 2e-4), "16": (4e-7, 7e-5)},
    ("lambert", "beckmann"): {"8": (1e-2, 2e-2), "12": (6e-4, 2e-3), "16": (4e-5, 1e-4)},
    ("lobe", "ggx"): {"8": (5e-3, 0.3), "12": (7e-4, 0.1), "16": (9e-5, 0.03)},
    ("lobe", "beckmann"): {"8": (7e-3, 0.3), "12": (8e-4, 0.1), "16": (1e-4, 0.03)},
}


@pytest.mark.parametrize(("facet", "ndf"), ERRORS)
def test_errors_are_those_that_the_header_states(facet, ndf):
    from brdf_explorer.measure.mirror_limit import gauss

    found = {n: [] for n in ERRORS[facet, ndf]}
    rng = np.random.default_rng(2)
    for alpha in ((1.0, 1.0), (0.3, 0.3), (0.05, 0.05), (0.6, 0.05)):
        for kappa in (1.0, 30.0, 1e3, 1e5) if facet == "lobe" else (1.0,):
            wo, wi = pairs(60)
            wider = np.sqrt(np.square(alpha) + 0.5 / kappa) if facet == "lobe" else np.ones(2)
            slope = np.sqrt(-np.log(rng.random((60, 1)))) * wider * direction(PI / 2, rng.uniform(0, 2 * PI, 60))[:, :2]
            wi = mirror(wo, normalize(np.concatenate([slope, np.ones((60, 1))], axis=1)))
            up = wi[:, 2] > 0.1
            sharp = slot("facet", facet).facet_sharpness(kappa)
            D, scale = slot("ndf", ndf).D, slot("facets", ndf).NODE_SCALE

            def fine(i):
                return vec(*(part[i] for part in np.polynomial.legendre.leggauss(64)))

            exact = facets(wo[up], wi[up], np.array(alpha), sharp, scale, 64, D, fine)
            again = facets(wo[up], wi[up], np.array(alpha), sharp, scale, 24, D, gauss)
            assert np.quantile(np.abs(again / exact - 1), 0.9) < 1e-4
            for n in found:
                rule = slot("gauss", n)
                value = facets(wo[up], wi[up], np.array(alpha), sharp, scale, rule.NODES, D, rule.gauss)
                found[n].append(np.abs(value / exact - 1))
    for n, (median, largest) in ERRORS[facet, ndf].items():
        errors = np.concatenate(found[n])
        assert np.median(errors) <= median and errors.max() <= largest, (n, np.median(errors), errors.max())


@pytest.mark.parametrize("ndf", NDFS)
def test_lambertian_facets_of_a_flat_surface_are_lambert(ndf):
    """GGX has steep facets at any alpha: of a share of alpha^2 log(1 / alpha), over cosines of 0.1 and more here."""
    wo, wi = pairs(50)
    model = Nonspecular(alpha=0.01, albedo=0.5, ndf=ndf, nodes="16")
    np.testing.assert_allclose(model.f(wo, wi), 0.5 * INV_PI, rtol=1e-2 if ndf == "ggx" else 2e-3)
    np.testing.assert_allclose(Diffuse(albedo=0.5, sigma=0.0, diffuse="facets").f(wo, wi), 0.5 * INV_PI, rtol=2e-3)


def test_facets_of_diffuse_are_those_of_nonspecular():
    wo, wi = pairs(50)
    alpha = np.sqrt(2) * np.tan(0.3)
    other = Nonspecular(alpha=alpha, ndf="beckmann", albedo=0.7, nodes="12")
    np.testing.assert_allclose(Diffuse(albedo=0.7, sigma=0.3, diffuse="facets").f(wo, wi), other.f(wo, wi), rtol=1e-12)


@pytest.mark.parametrize("ndf", NDFS)
@pytest.mark.parametrize("shadowing", ["correlated", "separable"])
def test_sharp_lobes_are_mirrors(ndf, shadowing):
    """MODELS: within 2e-5 at kappa = 1e5, and as 1 / kappa, which is the width of the lobe squared."""
    for fresnel in ("one", "conductor"):
        model = Microfacet(alpha=1.0, ndf=ndf, shadowing=shadowing, fresnel=fresnel)
        off = differences(model, np.radians(50), kappas=(1e3, 1e4, 1e5))
        assert off[2] < 4e-5 and off[0] / off[1] == pytest.approx(10, rel=0.1), off


def test_without_F_the_limit_is_D_G_over_4_cos_cos():
    model = Microfacet(alpha=0.5)
    wo = direction(0.9, 0.0)
    wi = mirror(wo, np.array([0.0, 0.0, 1.0]))[None]
    bare = Microfacet(alpha=0.5, fresnel="one").f(wo, wi)
    np.testing.assert_allclose(sharpened(model, 1e6, wo, wi, reflectance=False), bare, rtol=1e-4)
    np.testing.assert_allclose(sharpened(model, 1e6, wo, wi), mirrors(model).f(wo, wi), rtol=1e-4)
    assert np.all(sharpened(model, 1e6, wo, wi) < 0.97 * bare)


def test_a_sharp_nonspecular_is_the_microfacet_of_its_parameters():
    """To what the rule's cut leaves out, exp(-9), and 1 / (kappa alpha^2)."""
    wo, _ = pairs(40)
    wi = mirror(wo, normalize(vec(0.1, -0.1, 1.0) * np.ones((40, 1))))
    model = Nonspecular(alpha=0.5, facet="lobe", kappa=1e6, nodes="16")
    up = wi[:, 2] > 0.1
    np.testing.assert_allclose(model.f(wo[up], wi[up]), mirrors(model).f(wo[up], wi[up]), rtol=3e-4)


@pytest.mark.parametrize(("kappa", "share"), [(1.0, 0.462), (10.0, 0.921), (100.0, 0.9925)])
def test_a_facet_with_a_lobe_reflects_what_its_header_states(kappa, share):
    def reflected(theta, n=160):
        w, dw = nodes(0, 1, n)
        cosine = 1 + np.log(w + (1 - w) * np.exp(-2 * kappa)) / kappa  # drawn as von Mises and Fisher's
        phi = 2 * PI * (np.arange(n) + 0.5) / n
        sine = np.sqrt((1 - cosine) * (1 + cosine))[:, None]
        wo, R = direction(theta, PI), direction(theta, 0.0)
        across = direction(theta - PI / 2, 0.0)
        wi = cosine[:, None, None] * R + (sine * np.cos(phi))[..., None] * across
        wi = wi + (sine * np.sin(phi))[..., None] * np.array([0.0, 1.0, 0.0])
        return np.sum(dw[:, None] / n * np.maximum(wi[..., 2], 0) / (0.5 * np.linalg.norm(wo + wi, axis=-1)))

    assert reflected(0.0) == pytest.approx(share, abs=1e-3)
    assert max(reflected(np.radians(theta)) for theta in (30, 60, 80, 89)) < 1


@pytest.mark.parametrize(("sigma", "lost"), [(0.1, 0.010), (0.3, 0.08), (0.5, 0.18), (1.0, 0.52)])
def test_lambertian_facets_lose_what_their_header_states(sigma, lost):
    model = Diffuse(albedo=1, sigma=sigma, diffuse="facets")
    assert 1 - albedo(model, np.array([0.0, 0.0, 1.0]), 1e-4, 64)[0] == pytest.approx(lost, abs=6e-3)


def test_reciprocity_is_kept_by_the_rule():
    wo = uniform_hemisphere(np.random.default_rng(3).random((400, 2)))
    wi = uniform_hemisphere(np.random.default_rng(4).random((400, 2)))
    for model in (Nonspecular(), Nonspecular(facet="lobe", alpha=(0.8, 0.05), ndf="beckmann", kappa=50.0)):
        there, back = model.f(wo, wi), model.f(wi, wo)
        big = there > 1e-6 * there.max()
        np.testing.assert_allclose(there[big], back[big], rtol=1e-9)


# --- the view --------------------------------------------------------------------------------------------------------


def words(gpu, state, size=(900, 480)):
    *_, picture = state.views["facets"].pictures(gpu, state, size)
    return picture, [label.text for label in picture.labels]


def test_the_view_tells_the_limit_and_what_F_does(gpu):
    picture, text = words(gpu, load("gold"))
    assert any("0.99994 of it along ωr" in t for t in text) and any("without F" in t for t in text)
    assert "largest difference at κ = 30" in picture.note
    sharp = load("gold").with_view("facets", sharpness=1e6)
    assert float(words(gpu, sharp)[0].note.split(": ")[1].split()[0]) < 1e-4


def test_the_view_says_when_there_are_no_facets(gpu):
    reasons = {
        "chalk": "Chalk: it has no distribution of facets",
        "frosted_glass": "Frosted glass: its facets let light through",
        "rough_gold": "its light meets several facets",
    }
    for name, why in reasons.items():
        state = load(name)
        assert any(why in text for text in words(gpu, state)[1])
        with pytest.raises(Invalid, match=why):
            state.views["facets"].table_of(gpu, state)


@pytest.mark.parametrize(("size", "scale"), [((430, 350), 1), ((860, 700), 2), ((900, 480), 1), ((800, 600), 2)])
def test_the_view_has_room_for_both_plots_and_the_legend(gpu, size, scale):
    *_, picture = load("gold").views["facets"].pictures(gpu, load("gold"), size, scale)
    text = [label.text for label in picture.labels]
    assert {"θi in the plane of incidence", "sharpness κ", "κ = 30", "κ = 1e4"} <= set(text)


def test_the_view_shows_smooth_facets_at_grazing_and_black_ones(gpu):
    for model, theta_o in (
        (Microfacet(alpha=0.01), 82.0),
        (Microfacet(alpha=1e-4), 89.9),
        (Microfacet(fresnel="dielectric", eta=1.0, k=0.0), 40.0),
    ):
        state = replace(State((Material("", model),)), directions=Directions(theta_o=theta_o))
        assert "of the peak" in words(gpu, state)[0].note


def test_curves_follow_the_slopes_within_the_plane_of_incidence():
    """Of facets much rougher across it than within, the peak of their mirrors is met, and some directions lie on its sides."""
    for alpha, phi_o in (((0.01, 1.0), 0.0), ((1.0, 0.01), 90.0)):
        theta, f = curve(Microfacet(alpha=alpha), np.inf, 40.0, phi_o)
        assert theta[f.argmax()] == pytest.approx(np.radians(-40), abs=1e-3)
        assert np.count_nonzero(f > 0.5 * f.max()) > 20


KAPPAS = ("10", "33", "100", "1000", "1e4")


def test_the_window_sees_curves_as_they_become_known(gpu):
    """None before the first, then mirrors and the thick curve; the last picture is that of a run without a time to keep."""
    state = load("gold")
    view = replace(state.views["facets"], sharpness=33.0)
    steps = [step for step in view.drawings(gpu.paced(0.02), state, (430, 350)) if step]
    assert steps[0][0] is None and all(drawing for drawing, _, _ in steps[2:])
    first = next(drawing for drawing, _, _ in steps if drawing)
    *_, (alone, note, done) = view.drawings(gpu, state, (430, 350))
    assert len(first.items) < len(alone.items)
    assert [label.text for label in first.labels if "κ =" in label.text] == [f"κ = {k}" for k in KAPPAS]
    assert steps[-1][0].labels == alone.labels and steps[-1][1:] == (note, done)


def test_table_of_the_view(gpu):
    state = replace(State((Material("", Nonspecular(facet="lobe")),)), directions=Directions(theta_o=50.0))
    curves = state.views["facets"].table_of(gpu, state)
    assert "Torrance-Sparrow" in curves.y and all(len(v) == len(curves.x) for v in curves.y.values())
    peak = curves.y["Torrance-Sparrow"].max()
    off = [np.max(np.abs(curves.y[f"kappa {k:g}"] - curves.y["Torrance-Sparrow"])) / peak for k in (10, 100, 1e3, 1e4)]
    assert off[0] > 3 * off[2] > 9 * off[3]

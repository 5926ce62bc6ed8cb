"""The maps over the hemisphere show the model's values, integrate to what they should, and keep sharp lobes visible."""

from collections import deque
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binomtest

from brdf_explorer.lib.colormap import viridis
from brdf_explorer.measure import albedo
from brdf_explorer.measure.grid import direction
from brdf_explorer.models import MODELS
from brdf_explorer.state import Directions, Look, State
from brdf_explorer.views.diagram import radius
from brdf_explorer.views.hemisphere import NARROW, QUANTITIES, Hemisphere, Map, Peak, disc, of_disc
from brdf_explorer.views.picture import PALETTES, rgb

MICROFACET, DIFFUSE = MODELS["microfacet"], MODELS["diffuse"]
WO = direction(np.radians(55.0), np.radians(25.0))


def last(pictures):
    return deque(pictures, maxlen=1)[0]


def test_disc_keeps_areas():
    rng = np.random.default_rng(1)
    w = direction(np.arccos(rng.random(100)), rng.uniform(0, 7, 100))
    np.testing.assert_allclose(of_disc(disc(w)), w, atol=1e-15)
    np.testing.assert_allclose(
        np.linalg.norm(disc(w), axis=-1), np.sqrt(2) * np.sin(np.arccos(w[:, 2]) / 2), atol=1e-15
    )
    # the Jacobian: a small square on the disc is twice its area in sr
    p, h = disc(w[w[:, 2] > 0.01]), 1e-5
    edges = [(of_disc(p + step) - of_disc(p - step)) / (2 * h) for step in ([h, 0.0], [0.0, h])]
    np.testing.assert_allclose(np.linalg.norm(np.cross(*edges), axis=-1), 2.0, rtol=1e-6)


def map_of(view, gpu, state, wo, up, peak, side, middle, pixel):
    """Colours (side, side, 3) of a map."""
    shown = Map(view, gpu, state, wo, up, peak, "test", (side, side), middle, pixel)
    deque(shown.passes(1), 0)
    return gpu.pixels(shown.painted(view, peak.value, PALETTES["light"]["paper"]))[..., :3] / 255.0


@pytest.mark.parametrize("scale", ["linear", "log"])
@pytest.mark.parametrize("quantity", QUANTITIES)
@np.errstate(under="ignore")
def test_map_shows_the_models_values(gpu, quantity, scale):
    """Colours of the shader's map are those of float64 values at the pixels' points nearest to the peak."""
    view, side = Hemisphere(quantity=quantity, colors=scale), 64
    for model in (MICROFACET(alpha=(0.15, 0.4)), MODELS["dielectric"](alpha=(0.15, 0.4), ndf="beckmann")):
        state = State(directions=Directions(55.0, 25.0)).with_model(model)
        for up in view.hemispheres(model):
            peak = view.peak(model, WO, up)
            pixel = 2 / side
            pixels = map_of(view, gpu, state, WO, up, peak, side, (0.0, 0.0), pixel)[::-1]
            y, x = np.mgrid[:side, :side]
            p = (np.stack([x, y], axis=-1) + 0.5 - side / 2) * pixel
            r = np.linalg.norm(p, axis=-1)
            p = p + np.clip(disc(peak.w) - p, -pixel / 2, pixel / 2)
            inside = (r < 1 - pixel) & (np.linalg.norm(p, axis=-1) < 1)
            share = view.values(model, WO, of_disc(p[inside]) * [1.0, 1.0, up]) / peak.value
            np.testing.assert_allclose(pixels[inside], viridis(radius(share, scale, view.decades)), atol=1.5 / 255)
            outside = pixels[r > 1 + pixel]
            np.testing.assert_allclose(outside, np.broadcast_to(rgb(PALETTES["light"]["paper"]), outside.shape))


@pytest.mark.parametrize(
    "model", [MICROFACET(alpha=(0.2, 0.5)), MICROFACET(alpha=0.4, ndf="beckmann")], ids=["ggx", "beckmann"]
)
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_integral_is_the_sum_over_the_disc(quantity, model):
    view, n = Hemisphere(quantity="f_cos" if quantity == "f" else quantity), 700
    y, x = (np.mgrid[:n, :n] + 0.5) * 2 / n - 1
    p = np.stack([x, y], axis=-1)[np.hypot(x, y) < 1]
    w = of_disc(p)
    with np.errstate(under="ignore"):
        values = view.values(model, WO, w) * (w[:, 2] if quantity == "D" else 1.0)
    # the sum errs by the pixels on the rim, of which a disc of n pixels has about pi n that count half wrong at random
    assert Hemisphere(quantity=quantity).mass(model, WO) == pytest.approx(values.sum() * 2 * (2 / n) ** 2, abs=1e-3)


@pytest.mark.parametrize("alpha", [(1e-4, 1e-4), (0.05, 0.4), (1.0, 1.0)])
@pytest.mark.parametrize("ndf", ["ggx", "beckmann"])
def test_known_integrals(ndf, alpha):
    model = MICROFACET(alpha=alpha, ndf=ndf)
    assert Hemisphere(quantity="D").mass(model, WO) == pytest.approx(1, abs=1e-9)
    assert Hemisphere(quantity="D_visible").mass(model, WO) == pytest.approx(1, abs=1e-9)
    found = Hemisphere(quantity="f").mass(model, WO)
    assert found == pytest.approx(albedo(model, WO) @ [0.2126, 0.7152, 0.0722], abs=1e-4)
    up = model.sample_f(WO, np.random.default_rng(1).random((20_000, 2)))[0][:, 2] > 0
    assert binomtest(int(up.sum()), up.size, min(Hemisphere(quantity="pdf").mass(model, WO), 1.0)).pvalue > 1e-4


def test_peaks_are_the_known_ones():
    """GGX's D at the normal; Beckmann's for alpha > 1 / sqrt(2) where 1 + tan^2 is 2 alpha^2."""
    up = np.array([0.0, 0.0, 1.0])
    for alpha in (1e-4, 0.3):
        peak = Hemisphere(quantity="D").peak(MICROFACET(alpha=alpha), WO)
        assert peak.value == pytest.approx(1 / (np.pi * alpha**2), rel=1e-9)
        np.testing.assert_allclose(peak.w, up, atol=1e-5 * alpha)
    peak = Hemisphere(quantity="D").peak(MICROFACET(alpha=1.0, ndf="beckmann"), WO)
    assert peak.value == pytest.approx(4 * np.exp(-1) / np.pi, rel=1e-9)
    assert np.degrees(np.arccos(peak.w[2])) == pytest.approx(45, abs=0.01)
    # in the plane of incidence, and above what 20 000 samples found
    for quantity in QUANTITIES:
        view, model = Hemisphere(quantity=quantity), MICROFACET(alpha=0.3)
        peak = view.peak(model, WO)
        assert peak.w @ [-np.sin(np.radians(25)), np.cos(np.radians(25)), 0] == pytest.approx(0, abs=1e-4)
        w = replace(view, samples=2000).drawn(model, WO)
        assert view.values(model, WO, w[w[:, 2] > 0]).max() <= peak.value * (1 + 1e-12)


@pytest.mark.parametrize("alpha", [1e-4, 1e-3, 1e-2])
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_sharp_lobes_do_not_vanish_between_pixels(gpu, quantity, alpha):
    """One pixel of the map has the peak's colour, wherever the peak lies in it, and the inset shows the lobe's width."""
    state = State().with_model(MICROFACET(alpha=alpha, ndf="beckmann"))
    view = Hemisphere(quantity=quantity, colors="linear")
    for theta_o in (10.0, 33.3, 70.0):
        wo = direction(np.radians(theta_o), 0.4)
        peak = view.peak(state.model, wo)
        assert peak.reach < NARROW
        shown = (view, gpu, state, wo, 1.0, peak, 100)
        whole = map_of(*shown, (0.0, 0.0), 0.02)
        assert 1 <= np.all(np.abs(whole - viridis(1.0)) < 0.02, axis=-1).sum() <= 4
        near = map_of(*shown, disc(peak.w), 2 * peak.reach / 100)
        bright = np.mean(np.linalg.norm(near - viridis(0.0), axis=-1) > 0.5)
        assert 0.02 < bright < 0.6


def test_map_of_walks_is_their_mean(gpu):
    """Its noise, by which neighbours differ, falls as one over the root of the passes; its integral is the albedo."""
    model = MODELS["multiscatter"](alpha=0.8, fresnel="one")
    state = State(directions=Directions(55.0, 25.0)).with_model(model)
    noise = {}
    for passes in (1, 64):
        shown = Map(
            Hemisphere(quantity="f"), gpu, state, WO, 1.0, Peak(1.0, WO, 1.0), "test", (128, 128), (0.0, 0.0), 2 / 128
        )
        deque(shown.passes(passes), 0)
        middle = gpu.pixels(shown.values)[32:96, 32:96, 0]
        noise[passes] = np.diff(middle, axis=1).std()
    assert noise[64] < 1.5 * noise[1] / 8
    note = last(Hemisphere(quantity="f").pictures(gpu, state, (300, 300))).note
    mean, error = map(float, note.rsplit("= ", 1)[1].split(" ± "))
    assert abs(mean - 1) < 4 * error < 0.02


def words(gpu, state, size=(600, 500), scale=1.0):
    return [label.text for label in last(state.views["hemisphere"].pictures(gpu, state, size, scale)).labels]


def test_what_the_picture_says(gpu):
    state = State().with_model(MICROFACET(alpha=1e-3))
    picture = last(state.views["hemisphere"].pictures(gpu, state, (600, 500)))
    assert picture.note.startswith("peak ") and "θ 40°" in picture.note and picture.note.endswith("∫ pdf dω = 1.00000")
    assert "over ωi, the directions to the light" in words(gpu, state)
    assert any("across" in w for w in words(gpu, state)) and {"ωo", "ωr", "30°", "60°", "90°", "x"} <= set(
        words(gpu, state)
    )
    over = words(gpu, state.with_view("hemisphere", quantity="D_visible"))
    assert "over ωm, the normals of the facets" in over and "n" in over
    for quantity in ("D", "D_visible"):
        diffuse = words(gpu, state.with_model(DIFFUSE()).with_view("hemisphere", quantity=quantity))
        assert diffuse == [f"No {quantity} to show:", "diffuse has no distribution of normals"]
    assert not any("across" in w for w in words(gpu, state.with_model(DIFFUSE())))


@pytest.mark.parametrize("size", [(1, 1), (8, 8), (64, 300), (300, 64)])
def test_tiny_and_narrow_pictures_are_drawn(gpu, size):
    for state in (State(), State().with_model(MICROFACET(alpha=1e-4)), State().with_model(DIFFUSE(albedo=0.0))):
        for quantity in ("pdf", "f"):
            dark = replace(state.with_view("hemisphere", quantity=quantity), look=Look(theme="dark"))
            assert last(dark.views["hemisphere"].pictures(gpu, dark, size, 2.0)).target.size == size

"""Pictures of each view against goldens: pixel for pixel on llvmpipe, by mean colours on other renderers.

Labels are left out: their letters belong to Pillow, and test_export checks where they are.
"""

from dataclasses import replace

import pytest

from brdf_explorer.export import render
from brdf_explorer.models import MODELS
from brdf_explorer.state import Material, State, load

SIZE = (320, 240)
COMPARED = tuple(load(name).material for name in ("gold", "copper", "chalk"))
SHARP = Material("Sharp", MODELS["microfacet"](alpha=0.001))
NARROW = Material(
    "Narrow", MODELS["microfacet"](alpha=0.03)
)  # thinner ones cover a sample of a pixel or not by a rounding
ROUGH = Material("Rough", MODELS["microfacet"](alpha=0.5, ndf="beckmann", sampling="visible"))
BRUSHED = State((load("brushed_aluminium").material,))


def state(name, scene=None, **look):
    found = load(name, load(scene) if scene else None)
    return replace(found, look=replace(found.look, **look))


def at(state, **directions):
    return replace(state, directions=replace(state.directions, **directions))


def rough(state, alpha, light):
    """The state with another alpha and angle between light and eye."""
    model = replace(state.model, alpha=(alpha, alpha))
    return replace(state.with_model(model), light=replace(state.light, theta=light))


SCREENS = {
    "sphere-light": ("sphere", state("gold")),
    "sphere-dark": ("sphere", state("copper", theme="dark", exposure=-1.0, tonemap="aces")),
    "sphere-chalk": ("sphere", state("chalk", tonemap="agx")),
    "sphere-studio": ("sphere", state("chrome", "studio").with_view("sphere", samples=64)),
    "sphere-sky": ("sphere", state("brushed_aluminium", "sky").with_view("sphere", samples=64)),
    "sphere-furnace": ("sphere", state("white_microfacets", "white_furnace").with_view("sphere", samples=64)),
    "sphere-glass": ("sphere", state("glass", "studio").with_view("sphere", samples=32)),
    "lobe-light": ("lobe", state("gold")),
    "lobe-glass": ("lobe", at(state("frosted_glass"), theta_o=55.0).with_view("lobe", radius="log")),
    "lobe-dark-log": ("lobe", state("copper", theme="dark").with_view("lobe", radius="log", quantity="f_cos")),
    "lobe-sharp": ("lobe", State((NARROW,)).with_view("lobe", zoom=2.0)),
    "lobe-anisotropic": ("lobe", at(BRUSHED, theta_o=65.0, phi_o=30.0).with_view("lobe", azimuth=20.0, elevation=50.0)),
    "compare-light": ("compare", replace(state("gold"), materials=COMPARED)),
    "factors-light": ("factors", state("gold")),
    "factors-glass": ("factors", at(state("frosted_glass"), theta_o=55.0)),
    "factors-dark": ("factors", at(state("chrome", theme="dark"), theta_o=70.0).with_view("factors", axis="linear")),
    "hemisphere-light": ("hemisphere", state("gold")),
    "hemisphere-dark": (
        "hemisphere",
        at(replace(state("gold", theme="dark"), materials=BRUSHED.materials), theta_o=70.0, phi_o=20.0).with_view(
            "hemisphere", quantity="D_visible"
        ),
    ),
    "hemisphere-glass": ("hemisphere", at(state("frosted_glass", theme="dark"), theta_o=55.0)),
    "hemisphere-sharp": ("hemisphere", at(State((SHARP,)), theta_o=60.0).with_view("hemisphere", quantity="f")),
    "sampling-light": ("sampling", state("gold").with_view("sampling", show="error", samples=256)),
    "sampling-facets": (
        "sampling",
        at(State((ROUGH,)), theta_o=75.0).with_view("sampling", show="facets", samples=64),
    ),
    "sampling-weights": (
        "sampling",
        at(replace(state("gold", "studio", theme="dark"), materials=(ROUGH,)), theta_o=75.0).with_view(
            "sampling", show="weights", samples=64
        ),
    ),
    "polar-light": ("polar", state("gold").with_view("polar", curves="rgb")),
    "polar-dark-log": (
        "polar",
        replace(state("gold", theme="dark").with_view("polar", radius="log"), materials=COMPARED),
    ),
    "polar-glass": ("polar", at(state("frosted_glass"), theta_o=55.0).with_view("polar", radius="log")),
    "polar-grazing": ("polar", at(state("gold"), theta_o=80.0).with_view("polar", quantity="f_cos")),
    "polar-sharp": ("polar", State((SHARP,)).with_view("polar", radius="log", decades=8)),
    "microsurface-light": (
        "microsurface",
        rough(at(state("gold"), theta_o=65.0), 0.7, light=140.0).with_view(
            "microsurface", show="surface", surface="gaussian"
        ),
    ),
    "microsurface-profile": ("microsurface", rough(at(state("copper", theme="dark"), theta_o=65.0), 0.5, light=110.0)),
}


@pytest.mark.parametrize("name", SCREENS)
def test_screen(gpu, picture_regression, name):
    view, shown = SCREENS[name]
    rendered = render(gpu, shown, view, SIZE)
    picture_regression.check(rendered.pixels, name, exact="llvmpipe" in gpu.device)


def test_linear_values(gpu, picture_regression):
    rendered = render(gpu, SCREENS["sphere-light"][1], "sphere", (128, 96))
    picture_regression.check(rendered.linear, "sphere-linear", exact="llvmpipe" in gpu.device)


@pytest.mark.parametrize("view", ["lobe", "polar"])
def test_twice_the_scale_is_the_same_picture_with_more_pixels(gpu, view):
    small = render(gpu, load("gold"), view, SIZE, 1.0)
    large = render(gpu, load("gold"), view, (2 * SIZE[0], 2 * SIZE[1]), 2.0)
    for a, b in zip(small.labels, large.labels, strict=True):
        assert (a.text, a.size, a.anchor, a.color) == (b.text, b.size, b.anchor, b.color)
        assert (2 * a.x, 2 * a.y) == pytest.approx((b.x, b.y), abs=1.0)
    halved = large.pixels.reshape(SIZE[1], 2, SIZE[0], 2, 3).mean(axis=(1, 3))
    assert abs(halved - small.pixels).mean() < 1.5  # of 255

"""What the views draw: the table finds the peak, pictures show what the model says, labels have room."""

from collections import deque
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from brdf_explorer.export import font
from brdf_explorer.glsl import Source
from brdf_explorer.lib.srgb import srgb_decode, srgb_encode
from brdf_explorer.measure import albedo
from brdf_explorer.measure.grid import direction
from brdf_explorer.model import Invalid
from brdf_explorer.models import MODELS
from brdf_explorer.state import Directions, Light, Look, Material, State, load
from brdf_explorer.ui.gestures import linked, swipe
from brdf_explorer.views import VIEWS
from brdf_explorer.views.compare import ESTIMATES, both_lobes, differences_of_values
from brdf_explorer.views.develop import develop
from brdf_explorer.views.drawing import Drawing
from brdf_explorer.views.lines import Stroke
from brdf_explorer.views.picture import PALETTES, Picture, rgb
from brdf_explorer.views.polar import FEW
from brdf_explorer.views.sphere import toward
from brdf_explorer.views.table import noise, progressive, table

MICROFACET, DIFFUSE = MODELS["microfacet"], MODELS["diffuse"]


def last(pictures):
    return deque(pictures, maxlen=1)[0]


def true_peak(model, wo):
    """Largest value of f over wi above a cosine of 1e-5: the best of many directions, refined by steps that shrink."""
    rng = np.random.default_rng(1)
    turn = rng.uniform(0, 2 * np.pi, 20000)
    starts = [
        model.sample_f(wo, rng.random((20000, 2)))[0],
        direction(np.arccos(10 ** rng.uniform(-5, 0, 20000)), turn),
        (wo * [-1, -1, 1])[None],
    ]
    tries, step, value = np.concatenate(starts), 0.1, 0.0
    while step > 1e-9:
        tries[:, 2] = np.maximum(tries[:, 2], 1e-5)
        tries /= np.linalg.norm(tries, axis=-1, keepdims=True)
        values = model.f(wo, tries)[..., 0]
        if values.max() > value:
            best, value = tries[values.argmax()], float(values.max())
        else:
            step *= 0.7
        tries = best + step * rng.normal(size=(400, 3))
    return value


@pytest.mark.parametrize("ndf", ["ggx", "beckmann"])
@pytest.mark.parametrize("alpha", [(1e-4, 1e-4), (1e-3, 1e-3), (0.1, 0.1), (0.5, 0.5), (1e-3, 0.5), (0.7, 0.05)])
@pytest.mark.parametrize("theta_o", [0.0, 40.0, 75.0])
def test_table_finds_the_peak(gpu, ndf, alpha, theta_o):
    model = MICROFACET(alpha=alpha, ndf=ndf, fresnel="one")
    t = table(gpu, model, Directions(theta_o=theta_o, phi_o=25.0))
    # f may rise to the horizon, where the table ends at 1 - 1e-5 of the ray and the search at a cosine of 1e-5
    assert t.f[..., 0].max() == pytest.approx(true_peak(model, t.wo), rel=0.01)


@pytest.mark.parametrize("model", [MICROFACET(alpha=0.3), MICROFACET(alpha=1e-3), DIFFUSE(diffuse="oren_nayar")])
def test_table_gives_the_albedo(gpu, model):
    t = table(gpu, model, Directions(theta_o=50.0))
    np.testing.assert_allclose(t.albedo, albedo(model, t.wo), atol=2e-3)


def test_a_shader_that_gives_nan_is_told_not_drawn(gpu, monkeypatch):
    text = "#version 330 core\nout vec4 value;\nvoid main() { value = vec4(sqrt(-gl_FragCoord.x)); }\n"
    monkeypatch.setattr("brdf_explorer.views.table.of_model", lambda *_: Source(text, (), ()))
    for view in ("lobe", "polar"):
        with pytest.raises(Invalid, match="f is not a finite number"):
            next(State().views[view].pictures(gpu, State(), (64, 64)))


def test_plane_runs_from_horizon_to_horizon_through_the_mirror_direction(gpu):
    theta, wi, f = table(gpu, MICROFACET(alpha=(0.02, 0.3)), Directions(theta_o=40.0, phi_o=110.0)).plane()
    assert np.all(np.diff(theta) > 0)
    assert np.degrees(theta[[0, -1]]) == pytest.approx([-90, 90], abs=0.1)
    across = wi @ [-np.sin(np.radians(110)), np.cos(np.radians(110)), 0]
    np.testing.assert_allclose(across, 0, atol=1e-12)
    assert np.degrees(theta[f[:, 0].argmax()]) == pytest.approx(-40, abs=0.5)


def test_slice_of_float32_and_float64_agree(gpu):
    state = State(materials=(Material("a", MICROFACET(alpha=1e-3)), Material("b", DIFFUSE())))
    for _, _, _, f32, f64, _ in state.views["polar"].slices(gpu, state):
        np.testing.assert_allclose(f32, f64, rtol=1e-4, atol=1e-6 * f64.max())


def test_sphere_under_a_directional_light_is_f_cos_irradiance(gpu):
    state = State(light=Light(theta=40.0, phi=60.0, irradiance=2.0))
    view = state.views["sphere"]
    size = (256, 256)
    picture = next(view.pictures(gpu, state, size))
    pixels = gpu.pixels(picture.target)[::-1]
    y, x = np.mgrid[:256, :256]
    p = (np.stack([x, y], axis=-1) + 0.5 - 128) / view.radius(size)
    inside = np.linalg.norm(p, axis=-1) < 0.98
    n = np.concatenate([p, np.sqrt(np.maximum(1 - (p**2).sum(-1, keepdims=True), 0))], axis=-1)[inside]
    t = np.stack([n[:, 2], 0 * n[:, 2], -n[:, 0]], axis=-1)
    t /= np.linalg.norm(t, axis=-1, keepdims=True)
    frame = np.stack([t, np.cross(n, t), n], axis=-2)
    wo, wi = frame @ [0, 0, 1], frame @ toward(state.light)
    expected = state.model.f(wo, wi) * np.maximum(wi[:, 2:], 0) * 2.0
    np.testing.assert_allclose(pixels[inside][:, :3], expected, rtol=2e-4, atol=1e-5)


@pytest.mark.parametrize("model", [MICROFACET(alpha=0.4, fresnel="one", ndf="beckmann"), DIFFUSE(diffuse="oren_nayar")])
def test_sphere_in_a_furnace_is_the_albedo(gpu, model):
    """Environment, its sampling, the BSDF's and their weights together estimate the integral that quadrature gives."""
    state = State(light=Light(irradiance=0.0, environment="furnace")).with_model(model)
    state = state.with_view("sphere", noise=0.001, samples=1024)
    view, size = state.views["sphere"], (64, 64)
    pixels = gpu.pixels(last(view.pictures(gpu, state, size)).target)
    for row in (32, 20, 8):
        cos = np.sqrt(1 - ((31.5 - row) ** 2 + 0.25) / view.radius(size) ** 2)
        expected = albedo(model, direction(np.arccos(cos), 0.0))
        block = pixels[row, 31:33, :3]
        # a pixel's standard error after 1024 samples is below 0.01; its two neighbours average
        np.testing.assert_allclose(block.mean(axis=0), expected, atol=0.02)


def test_sphere_stops_when_its_noise_is_low_enough(gpu):
    state = State(light=Light(irradiance=0.0, environment="furnace")).with_view("sphere", noise=0.05)
    pictures = list(state.views["sphere"].pictures(gpu, state, (64, 64)))
    assert pictures[-1].done and not pictures[0].done
    assert 32 <= len(pictures) < 1024
    assert "noise" in pictures[-1].note


def test_develop_is_exact_srgb_over_the_backdrop_and_shows_nan(gpu):
    values = np.linspace(0, 1.2, 256, dtype=np.float32)
    image = np.zeros((2, 256, 4), np.float32)
    image[0, :, :3], image[0, :, 3] = values[:, None], 1.0
    image[1, :4] = [[np.nan, 0, 0, 1], [np.inf, 0, 0, 1], [0, 0, 0, 0], [0.5, 0.5, 0.5, 0.5]]
    target = gpu.ctx.framebuffer([gpu.texture(image)])
    out = gpu.pixels(develop(gpu, Picture(target, linear=True), Look()))[::-1]
    expected = np.round(255 * srgb_encode(np.minimum(values.astype(float), 1.0)))
    np.testing.assert_allclose(out[0, :, 0], expected, atol=1)
    assert np.mean(out[0, :, 0] == expected) > 0.98  # the others lie within float32 of a rounding edge
    assert out[1, 0, :3].tolist() == out[1, 1, :3].tolist() == [255, 0, 255]
    backdrop = np.array(rgb(PALETTES["light"]["backdrop"]))
    np.testing.assert_allclose(out[1, 2, :3], 255 * backdrop, atol=0.6)
    half = srgb_encode(0.5 * srgb_decode(backdrop) + 0.5)  # 0.5 covered by radiance 0.5 / 0.5 = 1
    np.testing.assert_allclose(out[1, 3, :3], 255 * half, atol=1.1)


def check_links(links, state):
    """Every click keeps what was changed since its picture was drawn and what it is not about."""
    later = replace(
        state,
        materials=(*state.materials[: state.active], replace(state.material, name="Mine"), load("chalk").material),
        light=replace(state.light, rotation=77.0, phi=-33.0),
        look=replace(state.look, exposure=1.25),
        directions=replace(state.directions, phi_o=12.0),
    ).with_view("lobe", zoom=2.0)
    clicks = [link.change for link in links if link.change]
    assert clicks
    for change in clicks:
        after = change(later)
        assert (after.look, after.materials[1:], after.material.name) == (later.look, later.materials[1:], "Mine")
        assert (after.light.rotation, after.light.phi) == (77.0, -33.0) and after.views["lobe"] == later.views["lobe"]


def check_labels(picture, size, scale):
    """Every label is inside of the picture, and no two overlap."""
    boxes = []
    for label in picture.labels:
        left, top, right, bottom = font(label.size * scale).getbbox(label.text)
        x, y = label.x - label.anchor[0] * (right - left), label.y - label.anchor[1] * (bottom - top)
        boxes.append((x, y, x + right - left, y + bottom - top, label.text))
    for box in boxes:
        assert box[0] >= 0 and box[1] >= 0 and box[2] <= size[0] and box[3] <= size[1], box
    for a, b in combinations(boxes, 2):
        assert a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1], (a, b)


@pytest.mark.parametrize("name", VIEWS)
@pytest.mark.parametrize("size, scale", [((676, 210), 1.0), ((282, 215), 1.0), ((400, 300), 1.0), ((1000, 900), 2.0)])
@pytest.mark.parametrize("theta_o", [0.0, 40.0, 85.0])
def test_labels_have_room(gpu, name, size, scale, theta_o):
    state = State(directions=Directions(theta_o=theta_o)).with_view("sampling", samples=256)
    check_labels(last(state.views[name].pictures(gpu, state, size, scale)), size, scale)


def test_a_picture_depends_on_what_its_view_says_it_shows():
    state = State()
    for view in state.views.values():
        assert view.shows(state) == view.shows(State())
    darker = replace(state, look=replace(state.look, exposure=-1.0))
    assert state.views["sphere"].shows(state) == state.views["sphere"].shows(darker)
    moved = replace(state, directions=Directions(theta_o=10.0))
    assert state.views["lobe"].shows(state) != state.views["lobe"].shows(moved)


@pytest.mark.parametrize("theta_o", [0.0, 40.0, 89.9])
def test_legend_of_the_slice_names_every_curve_that_has_room(gpu, theta_o):
    names = "Gold", "Iron", "Titanium", "Chalk", "White microfacets", "Brushed aluminium, across"
    state = State(tuple(Material(name, MICROFACET()) for name in names), directions=Directions(theta_o=theta_o))
    view = state.views["polar"]

    def words(*size):
        return [label.text for label in last(view.pictures(gpu, state, size)).labels]

    assert set(names) <= set(words(900, 600))
    assert all(any(w[:6] == name[:6] for w in words(420, 320)) for name in names)
    assert any(w.startswith("+ ") and w.endswith(" more") for w in words(280, 210))
    assert not set(names) & set(words(200, 150))


def test_a_drawing_draws_fills_lines_and_pictures_in_order(gpu):
    inner = gpu.target("test raster", (20, 10), 4, "f1")
    inner.clear(0.0, 0.0, 1.0, 1.0)
    drawing = Drawing((100, 60), theme="light")
    drawing.fill((10, 10, 60, 50), "#ff0000")
    drawing.raster((20, 20), inner)
    drawing.stroke([(0, 25), (100, 25)], "#00ff00", 4.0)
    drawing.text("words", (50, 55), "muted")
    drawing.link((10, 10, 60, 50), "tip", State)
    picture = drawing.picture(gpu, "test")
    pixels = gpu.pixels(picture.target)[..., :3]
    assert pixels[59 - 45, 15].tolist() == [255, 0, 0] and pixels[59 - 28, 30].tolist() == [0, 0, 255]
    assert pixels[59 - 25, 15].tolist() == [0, 255, 0] and pixels[59 - 55, 80].tolist() == [255, 255, 255]
    assert (picture.labels[0].x, picture.labels[0].y) == (50, 5)
    assert linked(picture.links, (30, 20)).change is State and linked(picture.links, (30, 5)) is None


@pytest.mark.parametrize("name", ["gold", "ceramic", "glass", "frosted_glass", "brushed_aluminium"])
def test_factors_multiply_to_f(gpu, name):
    state = load(name)
    theta, values = state.views["factors"].curves(gpu, state)
    phi = np.radians(state.directions.phi_o)
    wo, wi = direction(np.radians(state.directions.theta_o), phi), direction(theta, phi)
    factors = state.model.factors(wo, wi)
    product = factors["D"] * factors["G"] * factors["jacobian"]
    np.testing.assert_allclose(product[:, None] * factors["F"], state.model.f(wo, wi), rtol=1e-13)
    np.testing.assert_allclose(
        values["D"] * values["G"] * values["F"] * values["jacobian"], values["product"], rtol=1e-4
    )


def test_factors_say_that_d_cos_integrates_to_1_and_when_there_are_none(gpu):
    def words(name):
        state = load(name)
        return [label.text for label in last(state.views["factors"].pictures(gpu, state, (700, 450))).labels]

    assert "∫ D cos θ dω = 1.0000000000" in words("gold")
    assert any("No factors to show" in w for w in words("chalk"))
    with pytest.raises(Invalid, match="is no product of D, G and F"):
        load("chalk").views["factors"].table_of(gpu, load("chalk"))


@pytest.mark.parametrize("name", ["glass", "mirror_chrome", "gold", "frosted_glass"])
def test_the_axis_of_factors_shows_each_curve(gpu, name):
    state = load(name)
    for drawing, *_ in state.views["factors"].drawings(gpu, state, (700, 450)):
        lines = [item for _, item in drawing.items if isinstance(item, Stroke)]
        for color in (*drawing.colors["curves"][:4], drawing.colors["ink"]):
            heights = np.concatenate([line.points[:, 1] for line in lines if line.color == color])
            assert heights.max() > 70, color  # over the foot of the axes, which is at 62


def two(**models):
    return State(tuple(Material(name, model) for name, model in models.items()))


GREY = two(dark=DIFFUSE(albedo=0.4), bright=DIFFUSE(albedo=0.8))


def words_of(picture):
    return [label.text for label in picture.labels]


def test_compare_tells_how_far_two_materials_are_apart(gpu):
    words = words_of(last(GREY.views["compare"].pictures(gpu, GREY, (900, 700))))
    assert {"relative RMSE of f cos θ: 1", "largest relative error of f: 1", "largest error of albedo: 0.4"} <= set(
        words
    )
    assert "sphere's mean: +1e+02 %" in words
    same = two(one=MICROFACET(), other=MICROFACET())
    words = words_of(last(same.views["compare"].pictures(gpu, same, (900, 700))))
    assert {"relative RMSE of f cos θ: 0", "relative RMSE of the sphere: 0"} <= set(words)


def test_compare_shows_a_left_of_the_line_and_b_right_of_it(gpu):
    state = GREY.with_view("compare", show="sphere", swipe=0.3)
    picture = last(state.views["compare"].pictures(gpu, state, (400, 400)))
    pixels = gpu.pixels(picture.target)[..., :3].astype(int)
    (left, bottom, right, top), side = state.views["compare"].boxes((400, 400))[0]["sphere"], 0
    side = int(min(right - left, top - bottom))
    for active, share in ((0, 0.2), (1, 0.5)):
        one = replace(state, active=active)
        sphere = last(one.views["sphere"].pictures(gpu, one, (side, side)))
        expected = gpu.pixels(develop(gpu, sphere, one.look))[side // 2, int(share * side), :3]
        x = round((left + right - side) / 2) + int(share * side)
        assert pixels[400 - round((bottom + top - side) / 2) - side + side // 2, x].tolist() == expected.tolist()


def test_compare_takes_the_material_it_is_told_or_the_next(gpu):
    state = State((Material("a"), Material("b"), Material("c")), active=1)
    for other, expected in ((1, 0), (2, 2), (3, 2), (9, 2)):
        assert state.with_view("compare", other=other).views["compare"].against(state) == expected
    assert State().views["compare"].against(State()) is None
    assert "Nothing to compare with:" in words_of(last(State().views["compare"].pictures(gpu, State(), (300, 200))))


@pytest.mark.parametrize("size", [(1200, 480), (600, 640), (330, 460)])
def test_compare_has_room_for_its_words(gpu, size):
    picture = last(GREY.views["compare"].pictures(gpu, GREY, size))
    boxes = []
    for label in picture.labels:
        width, height = font(label.size).getlength(label.text), label.size
        x, y = label.x - label.anchor[0] * width, label.y - label.anchor[1] * height
        boxes.append((x, y, x + width, y + height, label.text))
    for box in boxes:
        assert box[0] >= 0 and box[1] >= 0 and box[2] <= size[0] and box[3] <= size[1], box
    for a, b in combinations(boxes, 2):
        assert a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] + 2 or b[3] <= a[1] + 2, (a, b)


def test_compare_of_walks_goes_on_and_tells_no_noise_of_a_copy(gpu):
    """Of a walk and its like by other parameters of no effect the halves' products are 0; of others they are the difference."""
    walk = MODELS["multiscatter"](alpha=0.5, fresnel="one")
    near, far = MODELS["microfacet"](alpha=0.5, fresnel="one"), replace(walk, orders=1)
    (*_, one) = differences_of_values(gpu, walk, near)
    (*_, other) = differences_of_values(gpu, far, near)
    lost, none = (float(lines[0].split(": ")[1]) for lines in (one, other))
    assert none < 0.02 < 0.05 < lost  # order 1 is the microfacet model; the others add some percent
    assert one[-1] == f"f by {ESTIMATES} walks a direction" and not any("relative error of f" in line for line in one)


@pytest.mark.parametrize("alpha, apart", [(0.3, False), (0.01, True)])
def test_lobes_of_unlike_peaks_are_each_over_its_own(gpu, alpha, apart):
    """Then both are seen: the colours of A and of B cover many pixels."""
    state = two(a=MICROFACET(alpha=0.3, fresnel="one"), b=MICROFACET(alpha=alpha, fresnel="one"))
    (*_, (target, _, found)) = both_lobes(gpu, (state, replace(state, active=1)), (0, 0, 300, 300), 1.0)
    assert found == apart
    pixels = gpu.pixels(target)[..., :3].astype(int)
    for b, color in enumerate(PALETTES["light"]["curves"][: 2 * apart]):
        near = np.linalg.norm(pixels / 255.0 - rgb(color), axis=-1) < 0.35
        assert near.sum() > 30, b


@pytest.mark.parametrize("size, parts", [((900, 640), 4), ((400, 300), 4), ((282, 215), 2)])
def test_compare_shows_as_many_parts_as_have_room(size, parts):
    boxes, columns, rows = GREY.views["compare"].boxes(size)
    assert len(boxes) == parts
    assert columns * rows >= 2
    assert all(min(right - left, top - bottom) >= 70 for left, bottom, right, top in boxes.values())


def test_a_drag_moves_the_line(gpu):
    view = GREY.views["compare"]
    left, _, right, _ = view.boxes((600, 640))[0]["sphere"]
    assert swipe(GREY, view, ((left + right) / 2, 100), (600, 640), 1.0).views["compare"].swipe == 0.5
    assert swipe(GREY, view, (-50, 100), (600, 640), 1.0).views["compare"].swipe == 0.0


def test_a_lobe_too_thin_to_be_seen_is_a_line_with_its_width(gpu):
    """GGX's D is half its peak at the slope alpha sqrt(sqrt(2) - 1), and wi turns by twice the facet's angle."""
    for name, words in (("glass", "drawn as lines"), ("mirror_chrome", "drawn as a line"), ("gold", "")):
        state = load(name)
        text = " ".join(words_of(last(state.views["lobe"].pictures(gpu, state, (430, 350)))))
        assert ("too thin" in text) == bool(words) and words in text
    chrome = replace(load("mirror_chrome"), directions=Directions(theta_o=0.0))
    text = next(w for w in words_of(last(chrome.views["lobe"].pictures(gpu, chrome, (430, 350)))) if "too thin" in w)
    wide = np.degrees(4 * chrome.model.alpha[0] * np.sqrt(np.sqrt(2) - 1))
    assert float(text.split(": ")[1].split("°")[0]) == pytest.approx(wide, rel=0.02)


def test_slices_of_estimates_have_no_corners(gpu):
    """Not even of a refracted lobe near total internal reflection, which is far narrower than its grid takes it for."""
    model = replace(load("etched_glass").model, eta_below=0.6667)
    found, _ = next(progressive(gpu, model, Directions(theta_o=60.0), 2, FEW))
    for one in found:
        assert np.max(np.diff(np.degrees(one.plane()[0]))) < 2.5


def test_nothing_found_is_not_taken_for_no_noise(gpu):
    model = replace(load("rough_gold").model, lowest=64)
    found, done = next(progressive(gpu, model, Directions(theta_o=89.9), 2, FEW))
    assert not done and noise(found) == np.inf

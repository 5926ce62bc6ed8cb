"""Files out: pixels and presets come back exactly, damaged files are refused, and what fails leaves no trace."""

import os
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import OpenEXR
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image

from brdf_explorer.export import (
    KEY,
    MOST_PIXELS,
    READERS,
    embedded,
    font,
    labelled,
    render,
    save_table,
    save_view,
    write_exr,
    write_png,
)
from brdf_explorer.lib.srgb import srgb_decode
from brdf_explorer.measure import albedo
from brdf_explorer.measure.grid import direction
from brdf_explorer.model import Invalid
from brdf_explorer.models import MODELS
from brdf_explorer.state import CARRIERS, Material, State, dumps, load, loads
from brdf_explorer.views import VIEWS

SIZE = (96, 64)
AWKWARD = "Größe \"x\" <&> \\ 'ω'\n\t\r\x7f #| \u2028 ]]> 金"


@pytest.fixture(scope="module")
def state():
    """A state whose text every format must quote with care."""
    materials = (
        Material(AWKWARD, MODELS["microfacet"](alpha=(0.3, 0.1)), AWKWARD * 5),
        Material("Chalk", MODELS["diffuse"]()),
    )
    return replace(load("one_light"), materials=materials)


@pytest.fixture(scope="module")
def files(gpu, state, tmp_path_factory):
    """A file of each kind that carries a preset, by suffix."""
    folder = tmp_path_factory.mktemp("files")
    made = {suffix: folder / f"x{suffix}" for suffix in READERS}
    for suffix in (".png", ".exr"):
        save_view(gpu, state, "sphere", made[suffix], SIZE)
    save_view(gpu, state, "polar", made[".svg"], SIZE)
    save_table(gpu, state, made[".csv"], rays=8, steps=5)
    save_table(gpu, state, made[".npz"], rays=8, steps=5)
    return made


def read_csv(path):
    """The columns of a CSV file by name."""
    lines = [line for line in path.read_text().split("\n") if not line.startswith("#")]
    return np.genfromtxt(lines, delimiter=",", names=True, deletechars="")


def refused(path):
    with pytest.raises(Invalid) as caught:
        embedded(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ") and "\n" not in message
    return message


# --- the preset travels ----------------------------------------------------------------------------------------------


def test_readers_are_those_that_load_knows():
    assert tuple(READERS) == CARRIERS


@pytest.mark.parametrize("suffix", READERS)
def test_the_preset_comes_back_exactly(files, state, suffix):
    assert embedded(files[suffix]) == dumps(state)
    assert load(files[suffix]) == state


def test_other_files_that_are_written_carry_it_too(gpu, state, tmp_path):
    save_view(gpu, state, "polar", tmp_path / "curves.csv", SIZE)
    save_table(gpu, state, tmp_path / "table.exr", rays=8, steps=5)
    save_view(gpu, state, "lobe", tmp_path / "LOBE.PNG", SIZE)
    for file in tmp_path.iterdir():
        assert loads(embedded(file)) == state


def test_a_preset_behind_the_pixels_of_a_png_is_found(files, state, tmp_path):
    data = files[".png"].read_bytes()
    chunks, at = [], 8
    while at < len(data):
        length = int.from_bytes(data[at : at + 4], "big")
        chunks.append(data[at : at + 12 + length])
        at += 12 + length
    chunks.sort(key=lambda chunk: [b"IHDR", b"IDAT", b"sRGB", b"iTXt", b"IEND"].index(chunk[4:8]))
    (tmp_path / "x.png").write_bytes(data[:8] + b"".join(c for c in chunks if c[4:8] != b"sRGB"))
    assert embedded(tmp_path / "x.png") == dumps(state)


def test_files_without_a_preset_are_refused(tmp_path):
    Image.new("RGB", (3, 3)).save(tmp_path / "x.png")
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": np.zeros((3, 3, 3), np.float32)}).write(str(tmp_path / "x.exr"))
    (tmp_path / "x.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    (tmp_path / "x.csv").write_text("# one\na,b\n1,2\n")
    np.savez(tmp_path / "x.npz", a=np.zeros(3))
    for suffix in READERS:
        assert "carries no preset" in refused(tmp_path / f"x{suffix}")
    (tmp_path / "x.jpg").write_text("x")
    assert ".png, .exr, .svg, .csv, .npz" in refused(tmp_path / "x.jpg")


@pytest.mark.parametrize("suffix", READERS)
def test_what_is_no_file_of_that_kind_is_refused(tmp_path, suffix):
    path = tmp_path / f"x{suffix}"
    assert "No such file" in refused(path)
    path.write_bytes(b"")
    assert "empty" in refused(path)
    path.write_bytes(b"hello, I am no picture\n" * 50 + b"\xff\xfe")
    refused(path)
    path.unlink()
    path.mkdir()
    assert "a folder" in refused(path)


@pytest.mark.parametrize("suffix", [".png", ".exr", ".svg", ".npz"])
def test_truncated_files_are_refused_in_silence(files, tmp_path, capfd, suffix):
    data = files[suffix].read_bytes()
    path = tmp_path / f"x{suffix}"
    for length in [*range(1, 40, 3), *np.linspace(40, len(data) - 6, 40).astype(int)]:
        path.write_bytes(data[:length])
        refused(path)
    assert capfd.readouterr() == ("", "")


@settings(deadline=None, max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(suffix=st.sampled_from(list(READERS)), place=st.floats(0, 1, exclude_max=True), bits=st.integers(1, 255))
def test_a_corrupt_byte_never_gives_more_than_a_refusal(files, state, tmp_path, suffix, place, bits):
    data = bytearray(files[suffix].read_bytes())
    data[int(place * len(data))] ^= bits
    path = tmp_path / f"x{suffix}"
    path.write_bytes(data)
    try:
        text = embedded(path)
    except Invalid as error:
        assert str(error).startswith(f"{path}: ") and "\n" not in str(error)
        return
    if suffix in (".png", ".npz"):  # these have check sums
        assert text == dumps(state)


def test_a_preset_as_large_as_no_real_one_is_refused(tmp_path):
    np.savez_compressed(tmp_path / "x.npz", **{KEY: np.array("x" * 2_000_000)})
    assert "too large" in refused(tmp_path / "x.npz")
    (tmp_path / "x.csv").write_text("#| " + "x" * 5_000_000)
    assert "too large" in refused(tmp_path / "x.csv")
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, KEY: "x" * 2_000_000}
    OpenEXR.File(header, {"RGB": np.zeros((3, 3, 3), np.float32)}).write(str(tmp_path / "x.exr"))
    assert "too large" in refused(tmp_path / "x.exr")


# --- pictures --------------------------------------------------------------------------------------------------------


def test_exr_pixels_are_the_shaders_to_the_bit_and_upright(gpu, state, tmp_path):
    rendered = render(gpu, state, "sphere", SIZE)
    write_exr(rendered, tmp_path / "x.exr")
    with OpenEXR.File(str(tmp_path / "x.exr")) as file:
        pixels = file.channels()["RGBA"].pixels.copy()
    assert pixels.dtype == np.float32 and pixels.shape == (SIZE[1], SIZE[0], 4)
    np.testing.assert_array_equal(pixels.view(np.uint32), rendered.linear.view(np.uint32))
    np.testing.assert_array_equal(pixels, gpu.pixels(gpu.targets["sphere"][0]))
    luminance = pixels[..., 1]  # the light is at the upper left
    row, column = np.unravel_index(luminance.argmax(), luminance.shape)
    assert row < SIZE[1] / 2 and column < SIZE[0] / 2


def test_png_pixels_are_the_developed_ones(gpu, state, tmp_path):
    rendered = render(gpu, state, "sphere", SIZE)
    write_png(rendered, tmp_path / "x.png")
    with Image.open(tmp_path / "x.png") as image:
        assert image.mode == "RGB" and image.size == SIZE and "srgb" in image.info
        np.testing.assert_array_equal(np.asarray(image), rendered.pixels)


def test_exr_of_a_diagram_is_its_decoded_srgb(gpu, state):
    rendered = render(gpu, state, "polar", SIZE)
    assert rendered.linear.dtype == np.float32 and (rendered.linear[..., 3] == 1).all()
    np.testing.assert_allclose(rendered.linear[..., :3], srgb_decode(rendered.pixels / 255.0), rtol=1e-6)


@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize("view", ["lobe", "polar"])
def test_labels_are_drawn_where_they_belong(gpu, view, scale):
    size = (int(400 * scale), int(300 * scale))
    rendered = render(gpu, load("gold"), view, size, scale)
    assert rendered.labels
    changed = (np.asarray(labelled(rendered)) != rendered.pixels).any(axis=-1)
    outside = np.ones_like(changed)
    for label in rendered.labels:
        face = font(label.size * scale)
        width, height = face.getlength(label.text), label.size * scale
        left, top = label.x - label.anchor[0] * width, label.y - label.anchor[1] * height
        assert left >= 0 and top >= 0 and left + width <= size[0] and top + height <= size[1], label
        box = np.s_[int(top) - 2 : int(top + height) + 3, int(left) - 2 : int(left + width) + 3]
        assert changed[box].any(), label
        outside[box] = False
    assert not (changed & outside).any()


def test_the_font_has_every_glyph_of_the_labels(gpu):
    from fontTools.ttLib import TTFont

    from brdf_explorer.export import font_path

    glyphs = TTFont(font_path()).getBestCmap()
    for view in VIEWS:
        state = load("gold").with_view("sampling", samples=256)
        for label in render(gpu, state, view, (400, 300)).labels:
            assert {ord(c) for c in label.text} <= set(glyphs), label.text
    assert {ord(c) for c in "°θφωαπμ²"} <= set(glyphs)


@pytest.mark.parametrize("view", VIEWS)
def test_pictures_of_any_size_are_drawn(gpu, view):
    state = load("gold").with_view("sampling", samples=64)
    for size in ((1, 1), (1, 300), (300, 1), (17, 33)):
        rendered = render(gpu, state, view, size, 2.0)
        assert rendered.pixels.shape == (size[1], size[0], 3)
        assert np.isfinite(rendered.linear).all()
        labelled(rendered)


@pytest.mark.parametrize(
    "size", [(0, 5), (5, -1), (10**6, 1), (10**9, 10**9), (1.5, 2), (16384, MOST_PIXELS // 16384 + 1)]
)
def test_sizes_that_cannot_be_drawn_are_refused(gpu, size):
    with pytest.raises(Invalid, match="size = .* cannot be drawn"):
        render(gpu, State(), "sphere", size)


def test_render_watches_and_stops_in_time(gpu):
    state = load("studio").with_view("sphere", noise=0.001, samples=65536)
    seen = []
    render(gpu, state, "sphere", SIZE, seconds=0.0)  # its shader is compiled now
    rendered = render(gpu, state, "sphere", SIZE, seconds=0.2, watch=seen.append)
    assert 1 < len(seen) < 65536
    assert seen[-1].note == rendered.note and not seen[-1].done
    seen.clear()
    render(gpu, state, "sphere", SIZE, seconds=0.0, watch=seen.append)
    assert len(seen) == 1


# --- curves and tables -----------------------------------------------------------------------------------------------


def test_svg_holds_a_curve_a_material_and_is_the_same_again(gpu, files, state, tmp_path):
    tree = ElementTree.parse(files[".svg"])
    assert tree.getroot().get("width") == f"{SIZE[0]}pt"
    save_view(gpu, state, "polar", tmp_path / "x.svg", SIZE)
    assert (tmp_path / "x.svg").read_bytes() == files[".svg"].read_bytes()
    assert state.look.theme == "light" and b"#2563eb" in files[".svg"].read_bytes()


@pytest.mark.parametrize("options", [{"radius": "log"}, {"curves": "rgb"}, {"quantity": "f_cos", "reference": "off"}])
@pytest.mark.parametrize("name", ["gold", "mirror_chrome", "rubber"])
def test_pdf_is_written_for_all_options(gpu, tmp_path, name, options):
    save_view(gpu, load(name).with_view("polar", **options), "polar", tmp_path / "x.pdf", (300, 200))
    assert (tmp_path / "x.pdf").read_bytes().startswith(b"%PDF")


def test_curves_as_csv_agree_with_the_model(gpu, tmp_path):
    state = load("chalk")
    save_view(gpu, state, "polar", tmp_path / "x.csv", SIZE)
    table = read_csv(tmp_path / "x.csv")
    theta = np.radians(table["theta_i_[deg]"])
    wo = direction(np.radians(state.directions.theta_o), 0.0)
    f = state.model.f(wo, direction(theta, 0.0 * theta)) @ [0.2126, 0.7152, 0.0722]
    np.testing.assert_allclose(table["Chalk_float64"], f, rtol=1e-8)
    np.testing.assert_allclose(table["Chalk_float32"], f, rtol=1e-5)


@pytest.mark.parametrize("name", ["gold", "brushed_aluminium", "chalk"])
def test_tables_hold_f_pdf_and_weights(gpu, tmp_path, name):
    state = load(name)
    for suffix in (".csv", ".npz", ".exr"):
        save_table(gpu, state, tmp_path / f"x{suffix}")
    rows = read_csv(tmp_path / "x.csv")
    assert rows.dtype.names == ("theta_i", "phi_i", "f_r", "f_g", "f_b", "pdf", "weight")
    wo = direction(np.radians(state.directions.theta_o), np.radians(state.directions.phi_o))
    wi = direction(np.radians(rows["theta_i"]), np.radians(rows["phi_i"]))
    f = np.stack([rows[f"f_{c}"] for c in "rgb"], axis=-1)
    inside = rows["theta_i"] < 89.9  # nearer to the horizon nine digits of an angle are too few for its cosine
    np.testing.assert_allclose(f[inside], state.model.f(wo, wi)[inside], rtol=2e-4)
    np.testing.assert_allclose(rows["pdf"][inside], state.model.pdf(wo, wi)[inside], rtol=2e-4)
    energy = (f * (rows["weight"] * np.cos(np.radians(rows["theta_i"])))[:, None]).sum(axis=0)
    np.testing.assert_allclose(energy, albedo(state.model, wo, 1e-5), rtol=2e-3)

    with np.load(tmp_path / "x.npz") as arrays:
        for column in rows.dtype.names:
            np.testing.assert_allclose(arrays[column].ravel(), rows[column], rtol=1e-8)
        assert "theta_o" in str(arrays["about"])
    with OpenEXR.File(str(tmp_path / "x.exr"), separate_channels=True) as file:
        channels = {n: c.pixels.copy() for n, c in file.channels().items()}
    assert set(channels) == {"theta_i", "phi_i", "R", "G", "B", "pdf", "weight"}
    np.testing.assert_array_equal(channels["G"].ravel(), rows["f_g"].astype(np.float32))


@pytest.mark.parametrize("view", ["factors", "facets", "microsurface"])
def test_a_table_has_rows_or_a_reason(gpu, tmp_path, view):
    for name, model in MODELS.items():
        path = tmp_path / f"{name}.csv"
        try:
            save_view(gpu, State((Material(name, model()),)), view, path, (64, 64))
        except Invalid as error:
            assert name in str(error) and not path.exists()
        else:
            assert len(read_csv(path)) > 9


@pytest.mark.parametrize(("rays", "steps"), [(3, 49), (0, 49), (10**6, 49), (96, 48), (96, 1), (96, 10**6 + 1)])
def test_tables_that_cannot_be_are_refused(gpu, tmp_path, rays, steps):
    with pytest.raises(Invalid, match="rays|steps"):
        save_table(gpu, State(), tmp_path / "x.csv", rays, steps)


# --- nothing is lost -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["x", "x.jpg", "x.tiff", ".png", "x.png/"])
def test_unknown_suffixes_are_refused_with_the_known_ones(gpu, tmp_path, name):
    with pytest.raises(Invalid, match=r"\.png, \.exr, \.svg, \.pdf, \.csv") as caught:
        save_view(gpu, State(), "polar", f"{tmp_path}/{name.rstrip('/')}" if name != "x.png/" else tmp_path, SIZE)
    assert "\n" not in str(caught.value)
    with pytest.raises(Invalid, match=r"there are: \.png, \.exr$"):
        save_view(gpu, State(), "sphere", tmp_path / "x.svg", SIZE)
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("suffix", [".png", ".exr", ".svg", ".csv"])
def test_a_write_that_fails_leaves_the_old_file_and_no_other(gpu, tmp_path, monkeypatch, suffix):
    path = tmp_path / f"x{suffix}"
    path.write_text("old")
    view = "polar" if suffix in (".svg", ".csv") else "sphere"
    fails = {
        ".png": "PIL.Image.Image.save",
        ".exr": "OpenEXR.File.write",
        ".svg": "matplotlib.figure.Figure.savefig",
        ".csv": "numpy.savetxt",
    }

    def fail(*arguments, **options):
        raise OSError(28, "No space left on device") if suffix != ".exr" else RuntimeError("No space left on device")

    monkeypatch.setattr(fails[suffix], fail)
    with pytest.raises(Invalid, match="cannot write: No space left on device"):
        save_view(gpu, State(), view, path, SIZE)
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == [path.name]

"""The commands: what they print and write, and that bad input is one clear line with exit status 2 and nothing lost."""

import json
import os
import re
import signal
import subprocess
import sys
from itertools import product
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import OpenEXR
import pytest
from click.testing import CliRunner
from PIL import Image

from brdf_explorer import __version__
from brdf_explorer.bench import Figure
from brdf_explorer.cli import main
from brdf_explorer.cli.flags import Flag, after, flags_of, number, split
from brdf_explorer.gallery import save_gallery
from brdf_explorer.measure import albedo, shares
from brdf_explorer.measure.grid import direction
from brdf_explorer.model import Choice, Param, Text, declared
from brdf_explorer.models import MODELS
from brdf_explorer.state import Material, State, dumps, load, presets
from brdf_explorer.views import VIEWS
from brdf_explorer.views.drawing import Drawn

SECTIONS = ("material", "directions", "light", "look")


@pytest.fixture
def run(gpu, tmp_path, monkeypatch):
    """Runs a command in an empty folder, on the tests' own GL context."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)

    def invoke(*args):
        return CliRunner().invoke(main, [str(a) for a in args])

    return invoke


@pytest.fixture
def fine(run):
    """Runs a command that must succeed; its output."""

    def invoke(*args):
        result = run(*args)
        assert result.exit_code == 0, result.output + str(result.exception)
        return result.stdout

    return invoke


@pytest.fixture
def refused(run):
    """Runs a command that must refuse its input; its one line."""

    def invoke(*args):
        before = {path: path.read_bytes() for path in Path(".").rglob("*") if path.is_file()}
        result = run(*args)
        assert result.exit_code == 2, f"{args}: {result.output} {result.exception!r}"
        assert result.stdout == ""
        assert re.fullmatch(r"brdf-explorer: [^\n]+\n", result.stderr)
        assert {path: path.read_bytes() for path in Path(".").rglob("*") if path.is_file()} == before
        return result.stderr[15:-1]

    return invoke


def process(*args, **options):
    command = [sys.executable, "-m", "brdf_explorer", *map(str, args)]
    options = {"capture_output": True, "text": True, "timeout": 100} | options
    root = str(Path(__file__).parents[1])
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")} | {
        "PYTHONPATH": root
    }
    return subprocess.run(command, env=environment | options.pop("env", {}), **options)


# --- commands --------------------------------------------------------------------------------------------------------


def test_version_and_help(fine):
    assert fine("--version") == f"brdf-explorer {__version__}\n"
    text = fine("--help")
    assert text == fine("-h")
    for command in main.commands:
        assert f"\n  {command} " in text
        assert "Usage:" in fine(command, "--help")


def test_help_does_not_cut_sentences(fine):
    assert "..." not in fine("--help").split("Commands:")[1]


def test_render_writes_each_view(fine):
    for view in VIEWS:
        out = fine("render", "gold", "--view", view, "--size", "80x60", "-o", f"{view}.png")
        assert out.startswith(f"{view}.png: 80 x 60")
        with Image.open(f"{view}.png") as image:
            assert image.size == (80, 60) and np.asarray(image).std() > 1


def test_render_writes_each_format(fine):
    for suffix, begins in (
        (".png", b"\x89PNG"),
        (".exr", b"v/1\x01"),
        (".svg", b"<?xml"),
        (".pdf", b"%PDF"),
        (".csv", b"# "),
    ):
        fine("render", "gold", "--view", "polar", "--size", "80x60", "-o", f"x{suffix}")
        assert Path(f"x{suffix}").read_bytes().startswith(begins)


def test_a_picture_is_a_preset(fine):
    fine("render", "gold", "--alpha", "0.5", "0.25", "--theta-o", "60", "--size", "40x30", "-o", "a.png")
    fine("render", "a.png", "--size", "40x30", "-o", "b.exr")
    fine("render", "b.exr", "--size", "40x30", "-o", "c.png")
    assert Path("a.png").read_bytes() == Path("c.png").read_bytes()
    assert load("c.png").model.alpha == (0.5, 0.25)
    assert load("c.png").directions.theta_o == 60


def test_scene_lies_under_the_preset(fine):
    fine("render", "gold", "--scene", "white_furnace", "--samples", "16", "--size", "40x30", "-o", "x.png")
    state = load("x.png")
    assert state.light == load("white_furnace").light
    assert state.material == load("gold").material


def test_a_models_name_is_a_preset_of_its_defaults(fine):
    fine("render", "diffuse", "--size", "40x30", "-o", "x.png")
    assert load("x.png").materials == (Material("diffuse", MODELS["diffuse"]()),)


def test_paths_are_those_of_where_the_user_is(fine, tmp_path):
    (tmp_path / "deep").mkdir()
    light = np.ones((2, 4, 3), np.float32)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": light}).write("deep/light.exr")
    fine(
        "render",
        "gold",
        "--environment",
        "file",
        "--file",
        "deep/light.exr",
        "--size",
        "9x9",
        "--time",
        "0",
        "-o",
        "deep/x.png",
    )
    assert load("deep/x.png").light.file == str(tmp_path / "deep" / "light.exr")


@pytest.mark.parametrize("side", [40, 140])
def test_eval_prints_what_glass_reflects_and_transmits(fine, side):
    place = ("eval", "glass", "--wo", f"{side},30", "--wi", "20,200")
    answer = json.loads(fine(*place, "--json"))
    assert "albedo" not in answer
    wo = direction(*np.radians([side, 30]))
    np.testing.assert_allclose([answer["R"], answer["T"]], shares(load("glass").model, wo).value, atol=1e-6)
    np.testing.assert_allclose(np.add(answer["R"], answer["T"]), 1, atol=1e-5)
    text = fine(*place)
    assert f"reflected    {answer['R'][0]:.17g}" in text and f"transmitted  {answer['T'][0]:.17g}" in text


def test_eval_prints_f_pdf_and_albedo(fine):
    model = load("gold").model
    wo, wi = direction(*np.radians([40, 30])), direction(*np.radians([20, 200]))
    answer = json.loads(fine("eval", "gold", "--wo", "40,30", "--wi", "20,200", "--json"))
    assert list(answer) == ["material", "model", "parameters", "precision", "wo", "wi", "f", "pdf", "albedo"]
    assert answer["material"] == "Gold" and answer["model"] == "microfacet" and answer["precision"] == "float64"
    assert answer["wo"] == {"theta": 40.0, "phi": 30.0, "direction": wo.tolist()}
    assert answer["f"] == model.f(wo, wi).tolist() and answer["pdf"] == model.pdf(wo, wi)
    np.testing.assert_allclose(answer["albedo"], albedo(model, wo), atol=1e-7)
    assert set(answer["parameters"]) == set(declared(model))
    shader = json.loads(fine("eval", "gold", "--wo", "40,30", "--wi", "20,200", "--json", "--gpu"))
    assert shader["precision"] == "float32"
    np.testing.assert_allclose(shader["f"], answer["f"], rtol=1e-5)
    text = fine("eval", "gold", "--wo", "40,30", "--wi", "20,200")
    for value in (*answer["f"], answer["pdf"], *answer["albedo"]):
        assert f"{value:.17g}" in text
    beyond = json.loads(fine("eval", "gold", "--wo", "40,30", "--wi", "120,0", "--json"))
    assert beyond["f"] == [0.0, 0.0, 0.0] and beyond["pdf"] == 0.0


@pytest.mark.parametrize("suffix", [".csv", ".npz", ".exr"])
def test_table_is_written(fine, suffix):
    out = fine("table", "gold", "--theta-o", "60", "--rays", "8", "--steps", "5", "-o", f"x{suffix}")
    assert "8 x 5 directions, theta_o = 60 deg" in out
    assert load(f"x{suffix}").directions.theta_o == 60


def test_presets_lists_all(fine):
    out = fine("presets")
    for name, path in presets().items():
        assert re.search(rf"^ *{name} +{path.parent.name} ", out, re.MULTILINE)


def test_models_lists_all_parameters(fine):
    for out in (fine("models"), fine("models", "--markdown")):
        for name, cls in MODELS.items():
            assert name in out
            for parameter, declaration in declared(cls).items():
                assert re.search(rf"^[| `]*{parameter}[ `|].*{re.escape(declaration.doc)}", out, re.MULTILINE)
    assert "| `alpha` | 0.0001 to 1 | 0.2, 0.2 |" in out


def of_module(monkeypatch, name, **members):
    """Put a module with these members in place of one of the package."""
    monkeypatch.setitem(sys.modules, name, SimpleNamespace(**members))


@pytest.mark.parametrize("ok", [True, False])
def test_check_prints_laws_and_fails_if_one_is_broken(run, monkeypatch, ok):
    found = []

    def laws(model, gpu):
        found.append(model)
        yield SimpleNamespace(name="reciprocity", measured=1e-16, limit=1e-12, ok=True, note="")
        yield SimpleNamespace(name="albedo", measured=1.5, limit=1.0, ok=ok, note="[brackets] stay")

    of_module(monkeypatch, "brdf_explorer.measure.laws", laws=laws)
    result = run("check", "gold", "--alpha", "0.5")
    assert result.exit_code == (0 if ok else 1), result.output
    assert found == [MODELS["microfacet"](**vars(load("gold").model) | {"alpha": 0.5})]
    assert re.search(r"reciprocity +1e-16 +1e-12 +ok", result.stdout)
    assert re.search(rf"albedo +1.5 +1 +{'ok' if ok else 'broken'} +\[brackets\] stay", result.stdout)


@pytest.mark.parametrize("median", [1.0, 2.0])
def test_bench_prints_figures_and_fails_if_one_is_over(run, monkeypatch, median):
    figures = [Figure("fill", 2e-3, 1e-3, 3e-3, "ms"), Figure("sphere / fill", median, 0.9, 2.1, "", 1.5)]
    of_module(monkeypatch, "brdf_explorer.bench", report=lambda: iter(figures))
    result = run("bench")
    assert result.exit_code == (0 if median < 1.5 else 1), result.output
    assert re.search(r"fill +0.002 ms +0.001 to 0.003", result.stdout)
    assert re.search(rf"sphere / fill +{median:g} +0.9 to 2.1 +1.5 +{'ok' if median < 1.5 else 'over'}", result.stdout)


GALLERY = [name for name, view in VIEWS.items() if not view.instrument]


def test_gallery_is_a_page_with_all_its_pictures(fine):
    fine("gallery", "gold", "chalk", "gold", "--size", "40x30", "--time", "0", "-o", "deep/g")
    page = Path("deep/g/index.html").read_text(encoding="utf-8")
    shown = set(re.findall(r'src="([^"]+)"', page))
    assert shown == {f"{name}-{view}.png" for name in ("gold", "chalk", "gold-2") for view in GALLERY}
    assert {path.name for path in Path("deep/g").iterdir()} == {
        *shown, "index.html", "gold.toml", "chalk.toml", "gold-2.toml"
    }  # fmt: skip
    for link in re.findall(r'href="([^"#]+)"', page):
        assert load(f"deep/g/{link}").light == load("studio").light
    assert "http" not in page


def test_gallery_is_a_page_from_the_start(gpu, tmp_path):
    states = [(name, load(name)) for name in ("gold", "chalk")]
    for i, _, _ in save_gallery(gpu, states, tmp_path, (8, 8), 0.0):
        page = (tmp_path / "index.html").read_text(encoding="utf-8")
        shown = set(re.findall(r'src="([^"]+)"', page))
        assert len(shown) == (i - 1) // len(GALLERY) * len(GALLERY)
        assert all((tmp_path / name).exists() for name in shown) and "2 materials are drawn so far" in page
    assert "so far" not in (tmp_path / "index.html").read_text(encoding="utf-8")


def test_gallery_holds_each_material_preset(fine):
    fine("gallery", "--size", "8x8", "--time", "0")
    made = {path.stem for path in Path("gallery").glob("*.toml")}
    assert made == {name for name, path in presets().items() if path.parent.name == "materials"}


def test_without_a_display_a_gallery_is_drawn(fine):
    out = fine("chalk")
    assert "No display" in out and "gallery/" in out
    assert {path.name for path in Path("gallery").iterdir()} >= {"index.html", "chalk-sphere.png"}


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only there is the display found by the environment")
def test_with_a_display_the_window_opens_on_the_preset(run, monkeypatch):
    opened = []
    monkeypatch.setitem(sys.modules, "brdf_explorer.ui", type(sys)("ui"))
    sys.modules["brdf_explorer.ui"].run = lambda state, path=None: opened.append((state, path))
    monkeypatch.setenv("WAYLAND_DISPLAY", "wayland-0")
    Path("mine.toml").write_text(dumps(load("chalk")))
    assert run().exit_code == run("gold", "--exposure", "2").exit_code == run("mine.toml").exit_code == 0
    run("render", "gold", "--size", "9x9", "-o", "x.png")
    assert run("x.png").exit_code == run("--alpha", "0.5").exit_code == 0
    assert [path for _, path in opened] == [None, None, "mine.toml", None, None]
    assert opened[0][0] == load("gold", load("studio"))
    assert opened[1][0].look.exposure == 2 and opened[1][0].material == load("gold").material
    assert (
        opened[1][0].light == load("studio").light and opened[3][0] == load("x.png") and opened[2][0] == load("chalk")
    )
    assert opened[4][0].model.alpha == (0.5, 0.5)


# --- flags -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("name", MODELS)
def test_each_parameter_is_a_flag_with_its_doc_range_and_unit(fine, name, view):
    text = " ".join(fine("render", name, "--view", view, "--help").split())
    state = State()
    for section in (MODELS[name](), state.directions, state.light, state.look, state.views[view]):
        for parameter, declaration in declared(section).items():
            assert f"--{parameter.replace('_', '-')} " in text
            assert f"{declaration.doc} " in f"{text} "
            if isinstance(declaration, Param):
                assert (
                    f"({declaration.low:g} to {declaration.high:g}{declaration.unit and ' '}{declaration.unit})" in text
                )
            if isinstance(declaration, Choice):
                assert f"({', '.join(declaration.options)})" in text


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("name", MODELS)
def test_each_flag_sets_its_parameter(fine, name, view):
    """Also that no two sections share a name: then one of them would need its section before it."""
    state = State((Material(name, MODELS[name]()),))
    args = []
    wanted = {}
    for key, flag in flags_of(state, [*SECTIONS, view]).items():
        assert key == f"--{flag.name.replace('_', '-')}"
        if isinstance(flag.declaration, Param):
            size = flag.declaration.size
            wanted[key] = (flag.declaration.low,) * size if size > 1 else flag.declaration.low
            args += [key, *[repr(flag.declaration.low)] * size]
        elif isinstance(flag.declaration, Choice) and flag.name != "environment":
            wanted[key] = flag.declaration.options[-1]
            args += [key, wanted[key]]
    fine("render", name, *args, "--view", view, "--size", "9x9", "--time", "0", "-o", "x.png")
    for key, flag in flags_of(load("x.png"), [*SECTIONS, view]).items():
        if key in wanted:
            assert flag.value == wanted[key]


def test_help_of_render_names_the_views_by_format():
    words = " ".join(main.commands["render"].help.split())
    assert f"of all views but {listed(v for v in VIEWS if not issubclass(VIEWS[v], Drawn))} also an .svg" in words
    assert f"of {listed(v for v in VIEWS if hasattr(VIEWS[v], 'table_of'))} also a .csv" in words


def listed(names):
    *first, last = names
    return f"{', '.join(first)} and {last}"


@pytest.mark.parametrize("name", main.commands)
def test_no_flag_of_a_parameter_hides_an_option(name):
    command = main.commands[name]
    own = {word for option in command.params for word in option.opts} | {"-h", "--help"}
    for model, view in product(MODELS.values(), VIEWS):
        sections = [view if section == "view" else section for section in getattr(command, "sections", ())]
        assert not own & set(flags_of(State((Material("x", model()),)), sections))


def test_flags_stand_anywhere_and_in_all_forms(fine):
    size = ("--size", "9x9")
    for i, args in enumerate(
        [
            ("gold", "--alpha", "0.5", "0.25", *size, "--phi-o", "-30"),
            (*size, "gold", "--phi-o=-30", "--alpha=0.5,0.25"),
            ("gold", "--phi-o", "-3e1", *size, "--alpha", "0.5,0.25"),
            ("--size=9x9", "gold", "--alpha", ".5", "+0.25", "--phi-o", "-30."),
        ]
    ):
        fine("render", *args, "-o", f"{i}.png")
        assert load(f"{i}.png").model.alpha == (0.5, 0.25)
        assert load(f"{i}.png").directions.phi_o == -30
    fine("render", "gold", "--alpha", "0.5", *size, "-o", "x.png")
    assert load("x.png").model.alpha == (0.5, 0.5)


def test_a_name_of_two_sections_gets_its_section_in_front():
    state = State()
    flags = flags_of(state, ["light", "light"])
    assert "--theta" in flags and flags["--light-theta"].section == "light"


def test_words_are_split_from_the_arguments():
    flags = {
        "--a": Flag("x", "a", Param((0.0, 0.0), -1, 1, ""), (0.0, 0.0)),
        "--n": Flag("x", "n", Choice("u", ("u",), ""), "u"),
        "--t": Flag("x", "t", Text("", ""), ""),
    }
    args = "p --a -1 .5 1e-3 q --n u v --t -3 --other 5 --t=-x".split()
    assert split(args, flags) == (
        ["p", "q", "v", "--other", "5"],
        {"--a": ["-1", ".5", "1e-3"], "--n": ["u"], "--t": ["-x"]},
    )
    assert after(["--view", "lobe"], "--view") == after(["x", "--view=lobe"], "--view") == "lobe"
    assert after(["--view"], "--view") is None
    assert number("3") == 3 and isinstance(number("3"), int) and number("3.0") == 3.0 and number("x") is None


# --- bad input -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("args", "says"),
    [
        (("rneder", "gold"), "rneder: no such preset, model, command or file; did you mean render?"),
        (("gould",), "did you mean gold?"),
        (("render",), "Missing argument 'PRESET'"),
        (("render", "gold"), "Missing option '-o'"),
        (("render", "gold", "copper", "-o", "x.png"), "unexpected extra argument"),
        (("render", "none.toml", "-o", "x.png"), "none.toml: no such preset or file"),
        (("render", "", "-o", "x.png"), "no such preset"),
        (("render", ".", "-o", "x.png"), "a folder"),
        (("render", "gold", "--scene", "stduio", "-o", "x.png"), "did you mean studio?"),
        (("render", "gold", "--view", "spere", "-o", "x.png"), "'spere' is no view; did you mean sphere?"),
        (("render", "gold", "--alhpa", "1", "-o", "x.png"), "no flag --alhpa; did you mean --alpha?"),
        (("render", "chalk", "--alpha", "1", "-o", "x.png"), "no flag --alpha"),
        (("render", "gold", "--zoom", "1", "-o", "x.png"), "no flag --zoom"),
        (("render", "gold", "--exposrue=1", "-o", "x.png"), "no flag --exposrue; did you mean --exposure?"),
        (("render", "--alpha", "0.5", "gold", "-o", "x.png"), "gold must come before the flags of its parameters"),
        (("render", "-o", "x.png", "--alpha", "0.5", "gold"), "gold must come before the flags of its parameters"),
        (("gold", "copper"), "unexpected extra argument"),
        (("render", "gold", "-o", "x.png", "--view"), "--view"),
        (("render", "gold", "-o", "x.png", "--scene"), "--scene"),
        (("render", "gold", "-x", "-o", "x.png"), "no flag -x"),
        (("render", "gold", "--alpha", "-o", "x.png"), "--alpha needs a value"),
        (("render", "gold", "-o", "x.png", "--alpha"), "--alpha needs a value"),
        (("render", "gold", "--alpha", "rough", "-o", "x.png"), "alpha = rough is not a number"),
        (("render", "gold", "--alpha", "3", "-o", "x.png"), "alpha = 3 is outside [0.0001, 1.0]"),
        (("render", "gold", "--alpha", "nan", "-o", "x.png"), "alpha = nan is outside"),
        (("render", "gold", "--alpha", "1e999", "-o", "x.png"), "alpha = inf is outside"),
        (("render", "gold", "--alpha", "9" * 400, "-o", "x.png"), "is outside"),
        (("render", "gold", "--alpha", ".1", ".2", ".3", "-o", "x.png"), "has 3 values; 2 expected"),
        (("render", "gold", "--ndf", "bekmann", "-o", "x.png"), "did you mean beckmann?"),
        (("render", "gold", "--samples", "20.5", "-o", "x.png"), "not a whole number"),
        (("render", "gold", "--environment", "file", "-o", "x.png"), "no file given"),
        (("render", "gold", "--environment", "file", "--file", "none.exr", "-o", "x.png"), "none.exr: no such file"),
        (("render", "gold", "--size", "0x5", "-o", "x.png"), "size = 0x5 cannot be drawn"),
        (("render", "gold", "--size", "99999x99999", "-o", "x.png"), "cannot be drawn"),
        (("render", "gold", "--size", "-5x5", "-o", "x.png"), "not a size"),
        (("render", "gold", "--size", "512", "-o", "x.png"), "not a size"),
        (("render", "gold", "--size", "٣x٣", "-o", "x.png"), "not a size"),
        (("render", "gold", "--scale", "0", "-o", "x.png"), "scale"),
        (("render", "gold", "--scale", "nan", "-o", "x.png"), "scale"),
        (("render", "gold", "--time", "-1", "-o", "x.png"), "time"),
        (("render", "gold", "-o", "x"), "a name without suffix"),
        (("render", "gold", "-o", "x.jpg"), "there are: .png, .exr"),
        (("render", "gold", "-o", "none/x.png"), "none/x.png: cannot write: no folder none"),
        (("render", "gold", "-o", "folder.png"), "folder.png: a folder"),
        (("render", "gold", "-o", "kept.toml"), "kept.toml: the suffix .toml"),
        (("eval", "gold", "--wo", "40,0"), "Missing option '--wi'"),
        (("eval", "gold", "--wo", "40", "--wi", "0,0"), "'40' is not a direction"),
        (("eval", "gold", "--wo", "nan,0", "--wi", "0,0"), "is no direction"),
        (("eval", "gold", "--wo", "-1,0", "--wi", "0,0"), "is no direction"),
        (("eval", "gold", "--wo", "40,0", "--wi", "0,1e9"), "is no direction"),
        (("table", "gold", "-o", "x.png"), "there are: .csv, .npz, .exr"),
        (("table", "gold", "--rays", "7", "-o", "x.csv"), "rays = 7"),
        (("table", "gold", "--steps", "x", "-o", "x.csv"), "steps"),
        (("gallery", "gould"), "did you mean gold?"),
        (("gallery", "gold", "-o", "kept.toml"), "kept.toml: cannot make this folder"),
        (("gallery", "--scene", "none"), "none"),
        (("check", "gould"), "did you mean gold?"),
        (("models", "--markdwon"), "No such option"),
        (("presets", "x"), "unexpected extra argument"),
    ],
)
def test_bad_input_is_refused_with_its_cause(refused, args, says):
    Path("folder.png").mkdir()
    Path("kept.toml").write_text("precious")
    assert says in refused(*args)


PRESET = dumps(State())


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("x.toml", b"", "empty"),
        ("x.toml", PRESET.encode()[:300], "not a TOML preset"),
        ("x.toml", b"\x00\xff" * 100, "not UTF-8"),
        ("x.toml", b"#" * 2_000_000, "too large"),
        (
            "x.toml",
            PRESET.replace("theta_o = 40.0", 'theta_o = "40"').encode(),
            "directions: theta_o = '40' is not a number",
        ),
        ("x.toml", PRESET.replace("theta_o", "tehta_o").encode(), "unknown key 'tehta_o'; did you mean theta_o?"),
        ("x.png", b"", "empty"),
        ("x.png", b"no picture", "not a PNG picture"),
        ("x.exr", b"no picture", "not an EXR picture"),
        ("x.svg", b"<svg>", "not an SVG drawing"),
        ("x.npz", b"PK", "not an NPZ file"),
    ],
)
@pytest.mark.parametrize("command", ["open", "render", "eval", "table", "check", "gallery"])
def test_bad_files_are_refused_by_each_command(refused, command, name, content, says):
    Path(name).write_bytes(content)
    message = refused(command, name)
    assert message.startswith(f"{name}: ") and says in message


def test_pictures_without_a_preset_are_refused(refused):
    Image.new("RGB", (4, 4)).save("x.png")
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": np.zeros((4, 4, 3), np.float32)}).write("x.exr")
    for name in ("x.png", "x.exr"):
        assert refused("render", name, "-o", "y.png") == f"{name}: it carries no preset of brdf_explorer"


def test_an_output_that_cannot_be_written_is_kept_as_it_was(refused, monkeypatch):
    Path("x.png").write_text("old")

    def full(*arguments, **options):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("PIL.Image.Image.save", full)
    assert refused("render", "gold", "--size", "9x9", "-o", "x.png") == "x.png: cannot write: No space left on device"


# --- as a process ----------------------------------------------------------------------------------------------------


def test_the_command_starts_from_another_folder(tmp_path):
    done = process("render", "gold", "--size", "64x48", "-o", "x.png", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("x.png: 64 x 48")
    assert load(tmp_path / "x.png").material.name == "Gold"


def test_a_process_refuses_in_one_line(tmp_path):
    done = process("render", "gold", "--alpha", "3", "-o", "x.png", cwd=tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr == "brdf-explorer: microfacet: alpha = 3 is outside [0.0001, 1.0]\n"


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="elsewhere the system brings OpenGL")
def test_no_opengl_at_all_is_one_line_that_names_the_packages(tmp_path):
    missing = (
        "import ctypes, sys\n"
        "def none(*a, **k): raise OSError('libOSMesa.so.8: cannot open shared object file')\n"
        "ctypes.CDLL = none\n"
        "from brdf_explorer.cli import main\n"
        "main(sys.argv[1:])\n"
    )
    (tmp_path / "start.py").write_text(missing)
    environment = os.environ | {"GLCONTEXT_LINUX_LIBEGL": "nonexistent", "PYTHONPATH": str(Path(__file__).parents[1])}
    command = [sys.executable, "start.py", "render", "gold", "-o", "x.png"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=100)
    assert done.returncode == 2 and done.stdout == ""
    assert re.fullmatch(r"brdf-explorer: no OpenGL 3.3 without a window \(EGL: .*\n", done.stderr)
    assert "apt install libegl1" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["start.py"]


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no full device")
def test_output_that_cannot_be_printed_is_one_line():
    with open("/dev/full", "w") as full:
        done = process("models", stdout=full, stderr=subprocess.PIPE, capture_output=False)
    assert done.returncode == 2
    assert done.stderr == "brdf-explorer: output: No space left on device\n"


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_a_reader_that_leaves_and_an_interrupt_are_quiet(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-m", "brdf_explorer", "models"],
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as left:
        left.stdout.close()
        assert left.stderr.read() == b""
    command = [sys.executable, "-m", "brdf_explorer", "render", "gold", "--scene", "studio", "--noise", "0.001"]
    with subprocess.Popen(
        [*command, "--samples", "65536", "--size", "512x512", "-o", "x.png"],
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])},
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as stopped:
        with pytest.raises(subprocess.TimeoutExpired):
            stopped.wait(3)
        stopped.send_signal(signal.SIGINT)
        out, errors = stopped.communicate(timeout=60)
    assert stopped.returncode == 130
    assert out == "" and errors.strip() == ""
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("form", [[], ["--json"]], ids=["text", "json"])
def test_a_pipe_that_lacks_a_letter_gets_the_rest(tmp_path, form):
    place = tmp_path / "omega.toml"
    place.write_text(dumps(State((Material("ω"),))), encoding="utf-8")
    done = process("eval", place, "--wo", "40,0", "--wi", "40,180", *form, env={"PYTHONIOENCODING": "cp1252"})
    assert (done.returncode, done.stderr) == (0, "")
    assert "\\u03c9" in done.stdout


def test_help_and_version_need_neither_numpy_nor_opengl():
    code = (
        "import sys; from brdf_explorer.cli import main\ntry: main(['--help'])\nexcept SystemExit: print(*sys.modules)"
    )
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=60)
    assert not {"numpy", "moderngl", "PIL", "OpenEXR", "rich", "imgui_bundle"} & set(done.stdout.split())


def test_readme_holds_the_models_as_they_are(fine):
    readme = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
    table = readme.split("<!-- models: begin -->")[1].split("<!-- models: end -->")[0]
    assert table.strip() == fine("models", "--markdown").strip()

"""The real window, driven by imgui's test engine on glfw's null platform: no screen is needed.

The window runs in a process of its own, `python tests/test_ui.py FOLDER acts` or `... FOLDER SCALE`. In the first each function
of ACTS plays the user; the second only looks, at a size that fits the null platform's monitor, 1920x1080, up to twice as large.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import traceback
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from brdf_explorer.model import Choice, declared
from brdf_explorer.models import MODELS

ROOT = Path(__file__).resolve().parent.parent
SIZE = (1280, 800)
SMALL = (960, 530)  # twice as large it still fits the screen that the null platform has
ACTS = {}


def act(function):
    ACTS[function.__name__] = function
    return function


# --- what the user does ------------------------------------------------------------------------------------------------


@act
def a_slider_is_one_step_of_undo(user):
    before, start = user.pictures(), user.state
    user.ctx.item_drag_with_delta("//Material/alpha/##0", (-60, 0))
    assert user.state.model.alpha[0] == user.state.model.alpha[1] < start.model.alpha[0]
    assert replace(user.state.model, alpha=start.model.alpha) == start.model
    after, moved = user.pictures(), user.state
    assert all(not np.array_equal(before[name], after[name]) for name in before)
    assert len(user.window.history.past) == 1
    user.keys("ctrl", "z")
    assert user.state == start
    assert all(np.array_equal(before[name], picture) for name, picture in user.pictures().items())
    user.keys("ctrl", "y")
    assert user.state == moved
    user.item("undo")
    user.item("redo")
    assert user.state == moved


@act
def a_value_is_typed_and_reset(user):
    slider = "//Material/alpha/##0"
    user.ctx.item_input_value(slider, 0.0001)
    assert user.state.model.alpha == (0.0001, 0.0001)
    user.ctx.item_input_value(slider, 7.0)
    assert user.state.model.alpha == (1.0, 1.0)
    user.ctx.sleep_no_skip(0.5, 0.1)  # longer than between the clicks of a double one
    user.ctx.item_double_click(slider)
    user.yield_()
    assert user.state.model.alpha == type(user.state.model)().alpha
    user.keys("ctrl", "z")  # the first click of the two is no step of its own
    assert user.state.model.alpha == (1.0, 1.0)


@act
def a_link_moves_components_together_or_apart(user):
    user.item("//Material/alpha/###link")
    user.ctx.item_input_value("//Material/alpha/##1", 0.5)
    assert user.state.model.alpha[0] != user.state.model.alpha[1] == 0.5
    user.item("//Material/alpha/###link")
    assert user.state.model.alpha[0] == user.state.model.alpha[1]


@act
def a_choice_is_made(user):
    before = user.pictures()
    user.item("//Material/ndf/beckmann")
    assert user.state.model.ndf == "beckmann"
    assert not np.array_equal(before["lobe"], user.pictures()["lobe"])
    assert reads(user.state.model) >= {"alpha", "eta", "smith", "sampling"}
    user.item("//Material/fresnel/##choice")
    user.item("//$FOCUSED/one")
    assert user.state.model.fresnel == "one"
    assert "alpha" in reads(user.state.model) and not reads(user.state.model) & {"eta", "k"}
    user.item("//Material/ndf/ggx")
    assert "smith" not in reads(user.state.model), "GGX has one form of Smith's Lambda"


def reads(model):
    from brdf_explorer.ui.inspector import matters

    return matters(type(model), tuple(model.choices().items()))


@act
def every_preset_of_a_material_opens(user):
    from brdf_explorer.model import Invalid
    from brdf_explorer.state import presets
    from brdf_explorer.ui.canvas import Canvas

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Canvas, "panel", lambda canvas, gpu, state, *_: state)  # what views draw is tested elsewhere
        for name, path in presets().items():
            try:
                user.window.state = user.window.preset(name, False)
            except Invalid as error:
                raise AssertionError(name) from error
            user.yield_(1)
            if path.parent.name == "materials":
                assert reads(user.state.model) <= set(vars(user.state.model)) and not user.window.notice, name


@act
def another_model_keeps_the_name_given_to_the_material(user):
    user.window.state = replace(user.state, materials=(replace(user.state.material, name="mine"),))
    user.item("//Material/##choice")
    user.item("//$FOCUSED/diffuse")
    assert user.state.model.name() == "diffuse" and user.state.material.name == "mine"
    user.ctx.item_click("//Material/albedo/##swatch")
    user.yield_()
    user.ctx.popup_close_all()


@act
def materials_are_copied_renamed_and_removed(user):
    user.item("//Material/###copy")
    assert len(user.state.materials) == 2 and user.state.active == 1
    assert user.state.materials[0].model == user.state.materials[1].model
    first = user.state.materials[0].name
    user.item("//Material/###copy")
    assert [m.name for m in user.state.materials] == [first, f"{first} 2", f"{first} 3"]
    user.item("//Material/$$2/###remove")
    user.item("//Material/$$1/###rename")
    user.ctx.key_chars_replace_enter("rough one")
    user.yield_()
    assert user.state.material.name == "rough one"
    user.item("//Material/$$0/##row")
    assert user.state.active == 0
    user.item("//Material/$$0/###remove")
    assert [m.name for m in user.state.materials] == ["rough one"]


@act
def drags_on_pictures_move_light_camera_and_viewer(user):
    start = user.state
    user.ctx.item_drag_with_delta("//Sphere/picture", (100, -50))
    light = user.state.light
    assert abs(light.phi - np.degrees(np.arctan2(50, 100))) < 1 and 0 < light.theta < 90
    assert len(user.window.history.past) == 1
    user.ctx.item_drag_with_delta("//Lobe/picture", (50, 20))
    assert user.state.views["lobe"].azimuth != start.views["lobe"].azimuth
    assert user.state.views["lobe"].elevation > start.views["lobe"].elevation
    user.ctx.mouse_wheel_y(2)
    user.yield_()
    assert user.state.views["lobe"].zoom > start.views["lobe"].zoom
    user.ctx.item_drag_with_delta("//Polar slice/picture", (60, 40))
    assert user.state.directions.theta_o != start.directions.theta_o
    assert replace(user.state, light=start.light, views=start.views, directions=start.directions) == start


@act
def every_view_has_a_tab_and_comes_to_the_front_from_the_menu(user):
    from imgui_bundle import imgui

    from brdf_explorer.ui.canvas import Canvas
    from brdf_explorer.ui.window import FRONT
    from brdf_explorer.views import VIEWS

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Canvas, "panel", lambda canvas, gpu, state, *_: state)  # what views draw is tested elsewhere
        for name in (*VIEWS, *FRONT):
            user.item("views")
            user.item(f"//$FOCUSED/{VIEWS[name].title}")
            bar = imgui.internal.find_window_by_name(VIEWS[name].title).dock_node.tab_bar
            assert bar.width_all_tabs_ideal <= bar.bar_rect.get_width(), "tabs are hidden"
            assert name in user.window.front
    assert user.window.front == FRONT


@act
def options_of_a_view_change_the_view_alone(user):
    user.ctx.window_focus("//Sphere")
    start = user.state
    user.window.state = start.with_view("polar", curves="rgb")
    user.yield_()
    before = user.pictures()
    user.window.state = start
    after = user.pictures()
    assert np.array_equal(before["lobe"], after["lobe"]) and not np.array_equal(before["polar"], after["polar"])


@act
def presets_of_materials_keep_the_scene_and_scenes_the_material(user):
    start = user.state
    user.ctx.window_focus("//Presets")
    user.yield_()
    user.item("//Presets/copper/###preset")
    copper = user.state
    assert copper.materials != start.materials
    assert replace(copper, materials=start.materials) == start
    user.ctx.mouse_move("//Presets/gold/###preset")
    user.item("//Presets/gold/###add")
    assert len(user.state.materials) == 2 and user.state.materials[0] == copper.material
    user.item("//Presets/sky/###preset")
    assert user.state.light != start.light and len(user.state.materials) == 2
    user.ctx.item_input_value("//Presets/##search", "no such thing")
    user.ctx.item_input_value("//Presets/##search", "")


@act
def what_is_copied_is_pasted(user):
    from imgui_bundle import imgui

    from brdf_explorer.state import loads

    start = user.state
    user.keys("ctrl", "c")
    assert loads(imgui.get_clipboard_text()) == start
    user.ctx.item_input_value("//Material/alpha/##0", 0.7)
    assert user.state != start
    user.keys("ctrl", "v")
    assert user.state == start


@act
def a_bad_preset_is_refused_in_words(user):
    from imgui_bundle import imgui

    start = user.state
    imgui.set_clipboard_text("format = 1\nmaterial = 3\n")
    user.keys("ctrl", "v")
    assert user.state == start
    assert "did you mean materials" in user.window.notice and user.window.notice_error
    user.ctx.sleep_no_skip(5.0, 0.5)
    assert user.window.notice, "an error stays until it is closed"
    user.item("//##notice/###dismiss")
    assert not user.window.notice
    user.window.dropped.append(str(user.folder / "missing.toml"))
    user.yield_()
    assert "missing.toml" in user.window.notice and user.state == start
    (user.folder / "broken.exr").write_bytes(b"v/1\x01")
    for name in ("broken.exr", "missing.hdr"):
        user.window.dropped.append(str(user.folder / name))
        user.yield_()
        assert name in user.window.notice and user.window.notice_error and user.state == start


@act
def escape_closes_what_popped_up(user):
    from imgui_bundle import imgui

    start = user.state
    user.item("more")
    assert any_popup(imgui)
    user.keys("escape")
    assert not any_popup(imgui) and user.state == start
    user.window.ask_open()
    user.yield_()
    user.keys("escape")
    assert user.window.dialog is None and not any_popup(imgui)


def any_popup(imgui):
    return imgui.is_popup_open("", imgui.PopupFlags_.any_popup)


@act
def a_dropped_file_is_opened_and_saved_again(user):
    from brdf_explorer.state import dumps, load

    path = user.folder / "dropped.toml"
    wanted = replace(user.state, directions=replace(user.state.directions, theta_o=61.0))
    path.write_text(dumps(wanted))
    user.window.dropped.append(str(path))
    user.yield_()
    assert user.state == wanted
    user.window.state = user.state.with_model(replace(user.state.model, alpha=0.6))
    user.keys("ctrl", "s")
    assert load(path) == user.state


@act
def a_picture_is_saved_with_its_preset(user):
    from brdf_explorer.state import load

    user.pictures()
    for name, suffix in (("sphere", ".png"), ("polar", ".csv")):
        path = user.folder / f"saved{suffix}"
        user.window.export(name, (300, 200), 1.0)
        user.yield_()
        user.ctx.item_input_value("//$FOCUSED/##path", str(path))
        user.yield_()
        assert load(path) == user.state, user.window.notice
        user.pictures()
    user.window.export("lobe", (300, 200), 1.0)
    user.yield_()
    user.item("//$FOCUSED/Cancel")
    assert user.window.dialog is None


@act
def the_theme_is_switched(user):
    below = slice(50, None)  # the toolbar shows what can be undone
    before = user.screen()[below]
    user.item("theme")
    assert user.state.look.theme == "dark"
    after = user.screen()[below]
    assert np.median(before) > 200 > 80 > np.median(after)
    user.item("theme")
    assert np.array_equal(before, user.screen()[below])


@act
def shaders_are_read_again_and_a_broken_one_keeps_the_picture(user):
    from brdf_explorer import glsl

    before, shaders = user.pictures(), glsl.SHADERS
    with tempfile.TemporaryDirectory() as folder:
        edited = glsl.SHADERS = Path(shutil.copytree(shaders, folder, dirs_exist_ok=True))
        fresnel = edited / "lib/fresnel.glsl"
        good = fresnel.read_text(encoding="utf-8")
        fresnel.write_text("this is no GLSL\n" + good, encoding="utf-8")
        user.keys("f5")
        after = user.pictures()
        assert all(np.array_equal(before[name], after[name]) for name in before)
        assert all("lib/fresnel.glsl:1" in canvas.error for canvas in user.window.canvases.values() if canvas.shown)
        dark = (edited / "lib/fresnel_conductor.glsl").read_text(encoding="utf-8").replace("return ", "return 0.5 * ")
        (edited / "lib/fresnel_conductor.glsl").write_text(dark, encoding="utf-8")
        fresnel.write_text(good, encoding="utf-8")
        user.keys("f5")
        after = user.pictures()
        assert not any(canvas.error for canvas in user.window.canvases.values())
        assert not np.array_equal(before["sphere"], after["sphere"])
    glsl.SHADERS = shaders
    user.keys("f5")
    assert np.array_equal(before["sphere"], user.pictures()["sphere"])


@act
def an_environment_that_is_not_there_is_told_on_the_sphere(user):
    user.window.state = replace(user.state, light=replace(user.state.light, environment="file", file="/no/such.exr"))
    user.pictures()
    assert "/no/such.exr" in user.window.canvases["sphere"].error
    assert not user.window.canvases["lobe"].error


@act
def a_finished_window_draws_nothing_anew(user):
    user.pictures()
    drawn = {name: canvas.picture for name, canvas in user.window.canvases.items()}
    user.ctx.mouse_move("//Material/alpha/##0")
    user.yield_(10)
    assert all(canvas.picture is drawn[name] for name, canvas in user.window.canvases.items())


# --- the window's process ------------------------------------------------------------------------------------------------


class User:
    """The hands of an act: the test engine's context, and pictures read on the thread that draws."""

    def __init__(self, window, folder):
        self.window, self.folder = window, folder
        self.wanted, self.got = None, None
        self.ctx = None

    @property
    def state(self):
        return self.window.state

    def yield_(self, frames=3):
        self.ctx.yield_(frames)

    def item(self, name):
        """Click an item: a path, or a button of the toolbar."""
        self.ctx.item_click(name if name.startswith("//") else f"**/###{name}")
        self.yield_()

    def keys(self, *names):
        from imgui_bundle import imgui

        self.ctx.mouse_move_to_pos((SIZE[0] / 2, 10))
        modifiers = {"ctrl": imgui.Key.mod_ctrl, "shift": imgui.Key.mod_shift}
        chord = 0
        for name in names:
            chord |= modifiers[name] if name in modifiers else getattr(imgui.Key, name)
        self.ctx.key_press(chord)
        self.yield_()

    def pictures(self):
        """The finished pictures by view, uint8 (H, W, 4)."""
        self.yield_()
        while any(self.window.canvases[name].busy for name in self.window.front):
            self.yield_(1)
        return self.read("pictures")

    def screen(self):
        """The window's own pixels, uint8 (H, W, 3), its pictures finished and the mouse away from all widgets."""
        self.ctx.mouse_move_to_pos((SIZE[0] / 2, 10))
        self.window.notice = ""
        self.pictures()
        return self.read("screen")

    def read(self, what):
        self.wanted = what
        for _ in range(20):
            self.yield_(1)
            if self.wanted is None:
                return self.got
        raise AssertionError("no frame was read back")

    def deliver(self):
        """Called between drawing and swapping."""
        gpu = self.window.gpu
        assert gpu.ctx.error == "GL_NO_ERROR"
        if self.wanted == "pictures":
            self.got = {name: gpu.pixels(canvas.shown) for name, canvas in self.window.canvases.items() if canvas.shown}
        elif self.wanted == "screen":
            from imgui_bundle import imgui

            width, height = map(int, imgui.get_io().display_size)
            target = gpu.target("screen", (width, height), 4, "f1")
            gpu.ctx.copy_framebuffer(target, gpu.ctx.screen)
            self.got = gpu.pixels(target)[..., :3]
            gpu.ctx.screen.use()
        self.wanted = None


def play(folder, what):
    """Run the window with the "acts" of a user, or as it is when "opened", or at a "single" or "doubled" scale.

    Writes a screenshot, and outcomes.json: name of an act -> "" or what went wrong.
    """
    from imgui_bundle import hello_imgui, imgui
    from imgui_bundle.immapp import testing  # isort: skip, before glfw
    import glfw
    from PIL import Image

    from brdf_explorer.state import State, load
    from brdf_explorer.ui.history import History
    from brdf_explorer.ui.window import Window

    glfw.init_hint(glfw.PLATFORM, glfw.PLATFORM_NULL)
    glfw.init()
    glfw.window_hint(glfw.CONTEXT_CREATION_API, glfw.EGL_CONTEXT_API)
    start = load("gold", load("studio")).with_view("sphere", samples=48) if what == "opened" else State()
    window = Window(start)
    user = User(window, folder)
    scale = 2.0 if what == "doubled" else 1.0
    parameters = window.parameters(SIZE if what in ("acts", "opened") else tuple(int(n * scale) for n in SMALL))
    geometry = parameters.app_window_params.window_geometry
    geometry.window_size_measure_mode = hello_imgui.WindowSizeMeasureMode.screen_coords  # its surface is never resized
    parameters.ini_disable = True
    parameters.fps_idling.enable_idling = False
    parameters.dpi_aware_params.dpi_window_size_factor = scale
    parameters.callbacks.before_swap = user.deliver
    outcomes = {}

    def acts(ctx):
        user.ctx = ctx
        engine = imgui.test_engine.get_io(hello_imgui.get_imgui_test_engine())
        engine.config_watchdog_kill_test = engine.config_watchdog_kill_app = (
            280.0  # seconds, on a machine that does much else
        )
        user.yield_(5)
        user.pictures()
        for name, function in ACTS.items() if what == "acts" else ():
            window.state, window.history, window.notice, window.memory = start, History(start), "", {}
            ctx.window_focus("//Material")
            user.yield_()
            try:
                function(user)
                outcomes[name] = "the test engine failed, see its log" if ctx.is_error() else ""
            except Exception:
                outcomes[name] = traceback.format_exc()
            if ctx.is_error():
                break

    try:
        testing.run(None, acts, runner_params=parameters)
    finally:
        (folder / "outcomes.json").write_text(json.dumps(outcomes))
    Image.fromarray(hello_imgui.final_app_window_screenshot()).convert("RGB").save(folder / f"screen-{what}.png")


@pytest.fixture(scope="module")
def played(tmp_path_factory):
    """played(what) -> (folder, log) of one run of the window."""
    runs = {}

    def run(what):
        if what not in runs:
            folder = tmp_path_factory.mktemp("window")
            environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
            environment |= {"PYTHONPATH": str(ROOT), "HOME": str(folder), "PATH": ""}  # no system dialogs
            command = [sys.executable, __file__, str(folder), what]
            done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
            runs[what] = (folder, f"exit {done.returncode}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
        return runs[what]

    return run


@pytest.mark.parametrize("name", ACTS)
def test_user(played, name):
    folder, log = played("acts")
    path = folder / "outcomes.json"
    outcomes = json.loads(path.read_text()) if path.exists() else {}
    assert name in outcomes, f"not reached\n{log}"
    assert not outcomes[name], f"{outcomes[name]}\n{log}"


def test_thumbnails_get_better_in_small_steps(gpu, monkeypatch):
    from brdf_explorer.ui import thumbnails as module

    monkeypatch.setattr(module, "ROUGH", 0.05)
    thumbnails, names, took = module.Thumbnails(gpu), ("gold", "etched_glass", "white_plaster"), []
    for idle in [False] * 40 + [True] * 20:
        for name in names:
            thumbnails.get(name, "light", 64)
        assert thumbnails.busy
        start = time.perf_counter()
        thumbnails.advance(idle)
        took.append(time.perf_counter() - start)
        spent = [thumbnails.drawn[name, "light"].took for name in names]
        assert idle or max(spent) < module.ROUGH + max(took)
    assert np.median(took) < 0.02 and max(spent) > module.ROUGH
    for name in names:
        assert gpu.pixels(thumbnails.get(name, "light", 64))[32, 32].any()


@pytest.mark.parametrize("name", MODELS)
def test_every_parameter_matters_by_some_choice(name):
    model, found = MODELS[name](), set()
    for choice, declaration in declared(model, Choice).items():
        tried = [replace(model, **{choice: option}) for option in declaration.options]
        found |= set().union(*map(reads, tried))
        model = max(tried, key=lambda m: len(reads(m)))  # the next choice may matter to some options of this one
    assert found == set(declared(model))


def test_parameters_of_other_facets_do_not_matter():
    of = {"conductor": {"eta", "k", "fresnel"}, "dielectric": {"eta_below"}, "diffuse": {"albedo"}}
    for facets, own in of.items():
        others = set().union(*of.values()) - own
        found = reads(MODELS["multiscatter"](facets=facets))
        assert found >= own | {"alpha", "ndf", "lowest", "orders"} and not found & others, facets


def test_scale(played):
    """The window at 200 % is the one at 100 %, twice as large: nothing is clipped or moved."""
    from PIL import Image

    screens = []
    for what in ("single", "doubled"):
        folder, log = played(what)
        path = folder / f"screen-{what}.png"
        assert path.exists(), log
        screens.append(Image.open(path))
    assert screens[0].size == SMALL and screens[1].size == tuple(2 * n for n in SMALL)
    small = [np.asarray(image.resize((240, 132), Image.Resampling.BOX), float) for image in screens]
    difference = np.abs(small[0] - small[1])
    assert difference.mean() < 1.5 and np.quantile(difference, 0.99) < 30


def test_window(gpu, played, picture_regression):
    """The picture at the top of README.md."""
    folder, log = played("opened")
    assert (folder / "screen-opened.png").exists(), log
    picture_regression.check(folder / "screen-opened.png", "window", exact="llvmpipe" in gpu.device)


@pytest.mark.parametrize("display", ["", ":987654"])
def test_no_screen_is_told_in_a_line(display):
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    environment |= {"PYTHONPATH": str(ROOT)} | ({"DISPLAY": display} if display else {})
    command = "from brdf_explorer.state import State; from brdf_explorer.ui import run; run(State())"
    done = subprocess.run([sys.executable, "-c", command], env=environment, capture_output=True, text=True, timeout=60)
    assert done.returncode and "Invalid: no " in done.stderr.splitlines()[-1]


def test_nothing_is_left_in_the_working_directory(played):
    folder, log = played("single")
    assert {p.name for p in folder.iterdir() if not p.name.startswith(".")} <= {"screen-single.png", "outcomes.json"}, (
        log
    )


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    play(Path(sys.argv[1]), sys.argv[2])

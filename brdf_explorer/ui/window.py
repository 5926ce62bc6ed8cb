"""The window: its loop, layout, toolbar and shortcuts. `Window.state` is what is shown; panels map it to the next."""

import os
import sys
import time
from dataclasses import replace
from pathlib import Path

from imgui_bundle import hello_imgui, imgui  # before glfw: one libglfw is loaded, and it must be imgui's
from imgui_bundle.immapp import icons_fontawesome_6 as icons

from .. import glsl, gpu
from ..environment import environment
from ..model import Invalid
from ..state import PRESETS, SECTIONS, dumps, load, loads, save
from ..views import VIEWS
from . import files, inspector, theme, widgets
from .canvas import Canvas
from .history import History
from .theme import points, vec
from .thumbnails import Thumbnails

TITLE = "BRDF Explorer"
DOCKS = {  # the views beside that of the sphere, where all others are
    "Right": ("lobe", "hemisphere", "sampling"),
    "Right foot": ("polar", "factors", "facets", "readings"),
}
FRONT = {"sphere", "lobe", "polar"}
SIZE = (1280, 800)
BAR = 2.8  # height of the toolbar, in heights of type
COLUMN = 348  # points of the inspector's column
SAVING = 10.0  # most seconds that a picture to be saved may get better in
LASTS = 3.0  # seconds that a notice stays, if it is no error
FIRST = 10  # frames in which the system may still change the window's size
IDLE = 0.2  # frames a second while nothing happens; input wakes the window at once
C = imgui.Key


class Window:
    """The window on a state."""

    def __init__(self, state, path=None):
        self.state, self.path = state, path
        self.history = History(state)
        self.canvases = {name: Canvas(name) for name in VIEWS}
        self.memory = {}  # what widgets remember: links, text being typed
        self.notice, self.notice_error, self.notice_since = "", False, 0.0
        self.dialog = None
        self.dropped = []
        self.gpu, self.thumbnails = None, None
        self.theme = None
        self.front = set()  # views that are seen
        self.behind = set()  # views that are to come in front of the others in their place
        self.fresh, self.width = True, 0  # whether no layout was saved, and the width that it was made for

    def run(self):
        """Show the window until it is closed. Raises Invalid where there is no screen or no OpenGL 3.3."""
        if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
            raise Invalid("no screen: neither DISPLAY nor WAYLAND_DISPLAY is set, so no window can open")
        try:
            hello_imgui.run(self.parameters())
        except RuntimeError as error:
            if self.gpu is not None:
                raise
            raise Invalid(f"no window with OpenGL 3.3 opens on this screen: {error}") from None

    def parameters(self, size=SIZE):
        """hello_imgui's description of this window."""
        p = hello_imgui.RunnerParams()
        p.app_window_params.window_title = TITLE
        p.app_window_params.window_geometry.size = size
        p.app_window_params.restore_previous_geometry = True
        p.imgui_window_params.default_imgui_window_type = (
            hello_imgui.DefaultImGuiWindowType.provide_full_screen_dock_space
        )
        p.imgui_window_params.remember_theme = False
        p.ini_folder_type = hello_imgui.IniFolderType.app_user_config_folder
        p.ini_filename = "brdf-explorer/window.ini"
        p.ini_filename_use_app_window_title = False
        p.renderer_backend_options.open_gl_options.anti_aliasing_samples = 0
        p.fps_idling.fps_idle = IDLE
        p.fps_idling.time_active_after_last_event = 0.8
        self.fresh = not hello_imgui.has_ini_settings(p)
        p.docking_params = self.docking()
        p.callbacks.load_additional_fonts = theme.load_fonts
        p.callbacks.setup_imgui_style = theme.set_sizes
        p.callbacks.post_init = self.begin
        p.callbacks.pre_new_frame = self.before_frame
        p.callbacks.show_gui = self.frame
        p.callbacks.before_imgui_render = self.settle
        options = hello_imgui.EdgeToolbarOptions()
        options.size_em, options.window_padding_em = BAR, (1.0, 0.5)
        p.callbacks.add_edge_toolbar(hello_imgui.EdgeToolbarType.top, self.toolbar, options)
        return p

    def docking(self):
        """The inspector's column at the left, the sphere large, lobe and polar slice at the right."""
        split, direction = hello_imgui.DockingSplit, imgui.Dir
        layout = hello_imgui.DockingParams()
        layout.main_dock_space_node_flags = imgui.DockNodeFlags_.none
        layout.docking_splits = [
            split("MainDockSpace", "Inspector", direction.left, 0.25),  # see `restore_layout`
            split("MainDockSpace", "Right", direction.right, 0.46),
            split("Right", "Right foot", direction.down, 0.5),
        ]
        panels = [("Material", "Inspector", self.material), ("Scene", "Inspector", self.scene)]
        panels.append(("Presets", "Inspector", self.presets))
        for dock, names in docks().items():
            panels += [(VIEWS[name].title, dock, lambda name=name: self.view(name)) for name in names]
        windows = [hello_imgui.DockableWindow(*panel) for panel in panels]
        for window in windows:
            window.can_be_closed = window.call_begin_end = False
        layout.dockable_windows = windows
        return layout

    def begin(self):
        """Attach to the window's OpenGL, and take files that are dropped on it."""
        import glfw
        from imgui_bundle.glfw_utils import glfw_window_hello_imgui

        self.gpu = gpu.window()
        self.glfw_window = glfw_window_hello_imgui()
        glfw.set_drop_callback(self.glfw_window, lambda _, paths: self.dropped.extend(paths))

    def before_frame(self):
        """Colours, which the toolbar needs first, and at first a layout for the window's width."""
        if self.theme != self.state.look.theme:
            self.theme = self.state.look.theme
            theme.set_colors(self.theme)
        if self.fresh and imgui.get_frame_count() < FIRST and self.width != (width := self.window_width()):
            self.width = width  # on a dense screen the window grows after its first frame
            self.restore_layout()

    def window_width(self):
        import glfw

        return glfw.get_window_size(self.glfw_window)[0]

    def restore_layout(self):
        layout = hello_imgui.get_runner_params().docking_params
        splits = layout.docking_splits
        splits[0].ratio = min(points(COLUMN) / self.window_width(), 0.5)
        layout.docking_splits = splits
        layout.layout_reset = True
        self.behind = set(FRONT)

    # --- a frame ---------------------------------------------------------------------------------------------------------

    def frame(self):
        """What comes before the panels: shortcuts, dialogs, files."""
        self.shortcuts()
        while self.dropped:
            self.open(self.dropped.pop(0))
        if wanted := self.memory.pop("browse", None):
            self.ask_file(*wanted)
        if self.dialog:
            answer = self.dialog.ask()
            if answer is not None:
                dialog, self.dialog = self.dialog, None
                if answer:
                    self.attempt(dialog.then, answer)
        self.show_notice()
        waiting = self.dialog or (self.notice and not self.notice_error)
        hello_imgui.get_runner_params().fps_idling.fps_idle = 10.0 if waiting else IDLE

    def settle(self):
        """One step of undo for each action that ended: a drag when the mouse is let go, a click when it is no double one."""
        io = imgui.get_io()
        dragged = io.mouse_drag_max_distance_sqr[0] > io.mouse_drag_threshold**2
        since = imgui.get_time() - io.mouse_clicked_time[0]
        clicked = since < io.mouse_double_click_time and io.mouse_clicked_last_count[0] == 1 and not dragged
        if not imgui.is_any_item_active() and not imgui.is_mouse_down(0) and not clicked:
            self.history.settle(self.state)

    def attempt(self, action, *arguments):
        """Do what may find its input Invalid, and say so in the window."""
        try:
            return action(*arguments)
        except Invalid as error:
            self.say(str(error), error=True)

    def say(self, words, error=False):
        self.notice, self.notice_error, self.notice_since = words, error, time.monotonic()

    def show_notice(self):
        """The notice under the toolbar: an error stays until it is closed or something else is said."""
        if not self.notice:
            return
        if not self.notice_error and time.monotonic() - self.notice_since > LASTS:
            self.notice = ""
            return
        area = imgui.get_main_viewport()
        at = (area.work_pos.x + area.work_size.x / 2, area.work_pos.y + imgui.get_font_size() * BAR + points(40))
        imgui.set_next_window_pos(at, imgui.Cond_.always, (0.5, 0.0))
        F = imgui.WindowFlags_
        imgui.push_style_color(imgui.Col_.window_bg, vec("error_back" if self.notice_error else "raised"))
        imgui.push_style_color(imgui.Col_.text, vec("error" if self.notice_error else "ink"))
        imgui.push_style_var(imgui.StyleVar_.window_rounding, points(8))
        flags = F.no_decoration | F.always_auto_resize | F.no_docking | F.no_saved_settings | F.no_focus_on_appearing
        imgui.begin("##notice", None, flags | F.no_nav | F.no_move)
        imgui.internal.bring_window_to_display_front(imgui.internal.get_current_window())
        imgui.push_text_wrap_pos(min(points(640), area.work_size.x * 0.7))
        imgui.align_text_to_frame_padding()
        imgui.text(self.notice)
        imgui.pop_text_wrap_pos()
        imgui.same_line()
        if widgets.icon(icons.ICON_FA_XMARK, "dismiss"):
            self.notice = ""
        imgui.end()
        imgui.pop_style_var()
        imgui.pop_style_color(2)

    # --- panels ----------------------------------------------------------------------------------------------------------

    def material(self):
        if begin("Material"):
            self.state = inspector.material(self.state, self.memory)
        imgui.end()

    def scene(self):
        if begin("Scene"):
            self.state = inspector.scene(self.state, self.memory)
        imgui.end()

    def presets(self):
        if begin("Presets"):
            self.thumbnails = self.thumbnails or Thumbnails(self.gpu)
            # before they are shown: a frame holds the textures that it shows
            self.thumbnails.advance(not any(self.canvases[name].busy for name in self.front))
            self.gpu.ctx.screen.use()
            self.state = inspector.browse(self.state, self.memory, self.preset, self.thumbnail)
            if self.thumbnails.busy:
                hello_imgui.request_refresh()
        imgui.end()

    def thumbnail(self, name, side):
        drawn = self.thumbnails.get(name, self.theme, int(side * imgui.get_io().display_framebuffer_scale.x))
        return drawn and imgui.ImTextureRef(drawn.color_attachments[0].glo)

    def view(self, name):
        imgui.push_style_var(imgui.StyleVar_.window_padding, (0, 0))
        imgui.push_style_color(imgui.Col_.window_bg, vec("backdrop" if name == "sphere" else "paper"))
        flags = imgui.WindowFlags_.no_scrollbar | imgui.WindowFlags_.no_scroll_with_mouse
        shown = imgui.begin(VIEWS[name].title, None, flags)[0]
        imgui.pop_style_color()
        imgui.pop_style_var()
        (self.front.add if shown else self.front.discard)(name)
        if name in self.behind and imgui.is_window_docked():
            self.behind.remove(name)
            imgui.set_window_focus()
        if shown and imgui.is_window_docked():  # not before the layout is made: the panel's size would be another
            self.state = self.canvases[name].panel(self.gpu, self.state, self.memory, self.export)
        imgui.end()

    def toolbar(self):
        """The bar at the top: what is open, and what can be done."""
        imgui.push_font(theme.fonts["bold"], theme.TEXT + 1)
        imgui.align_text_to_frame_padding()
        imgui.text(TITLE)
        imgui.pop_font()
        imgui.same_line(0, points(14))
        imgui.text_disabled(self.state.material.name)
        dark = self.state.look.theme == "dark"
        history = self.history
        pending = self.state is not history.settled and self.state != history.settled
        buttons = [
            (icons.ICON_FA_ROTATE_LEFT, "undo", "Undo", "Ctrl+Z", self.undo, bool(history.past) or pending),
            (icons.ICON_FA_ROTATE_RIGHT, "redo", "Redo", "Ctrl+Shift+Z or Ctrl+Y", self.redo, bool(history.future)),
            None,
            (
                icons.ICON_FA_FOLDER_OPEN,
                "open",
                "Open a preset, or a picture that carries one",
                "Ctrl+O",
                self.ask_open,
                True,
            ),
            (icons.ICON_FA_FLOPPY_DISK, "save", "Save as a preset", "Ctrl+S", self.save, True),
            None,
            (icons.ICON_FA_COPY, "copy state", "Copy the state as text", "Ctrl+C", self.copy, True),
            (icons.ICON_FA_PASTE, "paste state", "Paste a state", "Ctrl+V", self.paste, True),
            None,
            (
                icons.ICON_FA_SUN if dark else icons.ICON_FA_MOON,
                "theme",
                f"{'Light' if dark else 'Dark'} theme",
                "",
                self.switch_theme,
                True,
            ),
            (icons.ICON_FA_ELLIPSIS, "more", "More", "", lambda: imgui.open_popup("more"), True),
        ]
        side, space = imgui.get_frame_height(), points(14)
        count, breaks = sum(b is not None for b in buttons), buttons.count(None)
        views = f"Views  {icons.ICON_FA_CHEVRON_DOWN}"
        width = imgui.calc_text_size(views).x + 2 * imgui.get_style().frame_padding.x
        right = imgui.get_window_width() - count * (side + points(2)) - breaks * space - points(10)
        imgui.same_line(right - width - space)
        if imgui.button(f"{views}###views", (width, side)):
            imgui.open_popup("views")
        self.views_menu(imgui.get_item_rect_min().x)
        imgui.same_line(right)
        for button in buttons:
            if button is None:
                imgui.same_line(0, space)
                continue
            symbol, name, words, keys, action, enabled = button
            if widgets.icon(symbol, name, enabled, size=side):
                action()
            widgets.hint(words, *[keys] * bool(keys))
            imgui.same_line(0, points(2))
        self.menu()

    def views_menu(self, left):
        """All views, by where they are: one that is clicked comes to the front."""
        imgui.set_next_window_pos((left, imgui.get_window_height()))
        if imgui.begin_popup("views"):
            for i, names in enumerate(docks().values()):
                if i:
                    imgui.separator()
                for name in names:
                    view = VIEWS[name]
                    if imgui.menu_item(view.title, "", name in self.front)[0]:
                        self.behind.add(name)
                    widgets.hint(" ".join(view.__doc__.split("\n\n")[0].split()))
            imgui.end_popup()

    def menu(self):
        imgui.set_next_window_pos((imgui.get_window_width() - points(10), imgui.get_window_height()), 0, (1.0, 0.0))
        if imgui.begin_popup("more"):
            if imgui.menu_item("Save as ...", "Ctrl+Shift+S", False)[0]:
                self.ask_save()
            if imgui.menu_item("Reload shaders", "F5", False)[0]:
                self.reload()
            if imgui.menu_item("Restore the layout", "", False)[0]:
                self.restore_layout()
            imgui.end_popup()

    def shortcuts(self):
        io = imgui.get_io()
        pressed = imgui.is_key_chord_pressed
        ctrl, shift = C.mod_ctrl, C.mod_shift
        if pressed(C.f5):
            self.reload()
        if pressed(ctrl | C.o):
            self.ask_open()
        if pressed(ctrl | C.s):
            self.save()
        if pressed(ctrl | shift | C.s):
            self.ask_save()
        if io.want_text_input:
            return
        if pressed(C.escape) and not self.dialog:  # which closes itself
            imgui.internal.close_popups_except_modals()
        if pressed(ctrl | C.z):
            self.undo()
        if pressed(ctrl | shift | C.z) or pressed(ctrl | C.y):
            self.redo()
        if pressed(ctrl | C.c):
            self.copy()
        if pressed(ctrl | C.v):
            self.paste()

    # --- actions -----------------------------------------------------------------------------------------------------------

    def undo(self):
        self.state = self.history.undo(self.state)

    def redo(self):
        self.state = self.history.redo(self.state)

    def copy(self):
        imgui.set_clipboard_text(dumps(self.state))
        self.say("The state is on the clipboard, as text")

    def paste(self):
        def take(text):
            self.state = loads(text, "clipboard", self.state)
            self.say("Pasted")

        text = imgui.get_clipboard_text()
        if text:
            self.attempt(take, text)
        else:
            self.say("The clipboard holds no text", error=True)

    def open(self, path):
        """A preset, a picture that carries one, or else an environment's picture."""

        def take(path):
            suffix = Path(path).suffix.lower()
            try:
                if suffix == ".hdr":
                    raise Invalid(f"{path}: carries no preset")
                self.state = load(path, self.state)
            except Invalid:
                if suffix not in (".hdr", ".exr"):
                    raise
                environment("file", str(path))  # or what is wrong with it
                self.state = replace(self.state, light=replace(self.state.light, environment="file", file=str(path)))
            self.path = path if str(path).endswith(".toml") else None
            self.say(f"Opened {path}")

        self.attempt(take, path)

    def preset(self, name, add):
        """The state with a preset of the package: a material in place of the active one, or beside it; or a scene."""
        new = self.attempt(load, name, self.state)
        if new is None or new.materials is self.state.materials:
            return new or self.state
        old, active = self.state.materials, self.state.active
        found = new.materials
        if add:
            return replace(new, materials=old + found, active=len(old))
        return replace(new, materials=old[:active] + found + old[active + 1 :], active=active)

    def save(self):
        """Save where the preset came from, but not over the package's own."""
        path = Path(self.path or "")
        if path.suffix != ".toml" or path.resolve().is_relative_to(PRESETS.resolve()):
            self.ask_save()
        else:
            self.attempt(self.save_to, path)

    def save_to(self, path):
        path = path if path.suffix == ".toml" else path.with_name(path.name + ".toml")
        save(self.state, path)
        self.path = path
        self.say(f"Saved {path}")

    def ask_open(self):
        self.dialog = self.dialog or files.Dialog("Open a preset", self.open)

    def ask_file(self, cls, name):
        """Ask for the file that a text of a section of the state names."""

        def take(path):
            for section in SECTIONS:
                if type(value := getattr(self.state, section)) is cls:
                    self.state = replace(self.state, **{section: replace(value, **{name: str(path)})})

        self.dialog = self.dialog or files.Dialog("Choose a picture", take, filters=["Pictures", "*.exr *.hdr"])

    def ask_save(self):
        name = f"{self.state.material.name}.toml".replace("/", "-")
        self.dialog = self.dialog or files.Dialog("Save the preset", self.save_to, name, ["Presets", "*.toml"])

    def export(self, name, size, scale):
        """Ask where to save the picture of a view, as large as it is in its panel, and save it."""

        def write(path):
            from ..export import save_view

            try:
                note = save_view(self.gpu, self.state, name, path, size, scale, seconds=SAVING)
            finally:
                self.gpu.ctx.screen.use()
                self.reload()  # the pictures' targets were drawn over
            self.say(f"Saved {path}" + f" ({note})" * bool(note))

        proposal = f"{self.state.material.name}-{name}.png".replace("/", "-").replace(" ", "-")
        filters = ["Pictures and curves", "*.png *.exr *.svg *.pdf *.csv"]
        self.dialog = self.dialog or files.Dialog("Save the picture", write, proposal, filters)

    def reload(self):
        """Draw all pictures anew, from the shaders as they are on disk now."""
        glsl.reload()
        self.gpu.errors.clear()  # of pictures that other shaders drew
        self.gpu.evidence.clear()
        for canvas in self.canvases.values():
            canvas.restart()

    def switch_theme(self):
        other = "light" if self.state.look.theme == "dark" else "dark"
        self.state = replace(self.state, look=replace(self.state.look, theme=other))


def docks():
    """Names of the views by their place in the layout."""
    beside = {name for names in DOCKS.values() for name in names}
    return {"MainDockSpace": tuple(name for name in VIEWS if name not in beside)} | DOCKS


def begin(label):
    """Begin a panel of the inspector; whether it is seen."""
    return imgui.begin(label)[0]

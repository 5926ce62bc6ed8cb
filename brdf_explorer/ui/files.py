"""Files and the clipboard: dialogs that do not stop the window, a path typed where the system has no dialog."""

import shutil
import sys
from pathlib import Path

from imgui_bundle import imgui
from imgui_bundle import portable_file_dialogs as pfd

from .theme import points, vec

PRESETS = ["Presets and pictures that carry one", "*.toml *.png *.exr", "All files", "*"]


class Dialog:
    """A question for a path; `ask` it each frame until it answers."""

    def __init__(self, title, then, saving="", filters=PRESETS):
        """then(path): what to do with the answer. saving: the file name to propose; without it, a file is opened."""
        self.title, self.then, self.saving = title, then, saving
        self.text, self.opened = saving, False
        self.system = None
        if not sys.platform.startswith("linux") or any(map(shutil.which, ("zenity", "kdialog", "qarma", "matedialog"))):
            self.system = pfd.save_file(title, saving, filters) if saving else pfd.open_file(title, "", filters)

    def ask(self):
        """The Path that was chosen, "" if none was, None while the question stands."""
        if self.system:
            if not self.system.ready(0):
                return None
            result = self.system.result()
            result = result if isinstance(result, str) else next(iter(result), "")
            return Path(result) if result else ""
        return self._typed()

    def _typed(self):
        answer = None
        name = f"{self.title}###path"
        if not self.opened:
            imgui.open_popup(name)
        imgui.push_style_var(imgui.StyleVar_.window_rounding, points(8))
        imgui.set_next_window_pos(imgui.get_main_viewport().get_center(), imgui.Cond_.appearing, (0.5, 0.5))
        if imgui.begin_popup_modal(name, None, imgui.WindowFlags_.always_auto_resize)[0]:
            if not self.opened:
                imgui.set_keyboard_focus_here()
                self.opened = True
            imgui.set_next_item_width(points(420))
            flags = imgui.InputTextFlags_.enter_returns_true
            entered, self.text = imgui.input_text_with_hint("##path", "path of the file", self.text, flags)
            imgui.push_style_color(imgui.Col_.button, vec("focus"))
            imgui.push_style_color(imgui.Col_.button_hovered, vec("focus", 0.85))
            imgui.push_style_color(imgui.Col_.text, vec("paper"))
            pressed = imgui.button("Save" if self.saving else "Open", (points(90), 0))
            imgui.pop_style_color(3)
            if pressed or entered:
                answer = Path(self.text).expanduser() if self.text.strip() else ""
            imgui.same_line()
            if imgui.button("Cancel", (points(90), 0)) or imgui.is_key_pressed(imgui.Key.escape):
                answer = ""
            if answer is not None:
                imgui.close_current_popup()
            imgui.end_popup()
        imgui.pop_style_var()
        return answer

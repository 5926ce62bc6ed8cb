"""A view's panel: its picture at the panel's size, drawn when what it shows changes, and the mouse on it."""

import time
from dataclasses import replace

from imgui_bundle import ImVec2, hello_imgui, imgui
from imgui_bundle.immapp import icons_fontawesome_6 as icons

from ..model import Invalid
from ..views.develop import develop
from ..views.pace import STEP
from . import gestures, widgets
from .theme import SMALL, colors, fonts, points, u32, vec

BUDGET = 0.008  # seconds a frame that a picture may get better in
END = object()


class Canvas:
    """The picture of one view of the state, and its generator while the picture gets better."""

    def __init__(self, name):
        self.name = name
        self.restart()
        self.picture = None
        self.shown, self.look = None, None

    def restart(self):
        """Draw the picture anew at the next frame, from shaders as they are then."""
        self.key, self.pictures, self.error = None, None, ""

    def advance(self, gpu, state, size, scale):
        """Bring the picture up to date with the state, or one step further; the framebuffer to show, or None."""
        view = state.views[self.name]
        key = (view.shows(state), size, scale)
        fresh = key != self.key
        if fresh:
            self.key, self.error = key, ""
            self.pictures = view.pictures(gpu.paced(STEP), state, size, scale)
        start = time.perf_counter()
        stepped = False
        while self.pictures is not None and time.perf_counter() - start < BUDGET:
            try:
                picture = next(self.pictures, END)
            except Invalid as error:
                self.error, self.pictures = str(error), None
                break
            if picture is END:
                self.pictures = None
            elif picture is not None:  # until then the one before stays
                self.picture, stepped = picture, True
                self.pictures = None if picture.done else self.pictures
            gpu.ctx.finish()
        if self.picture is None:
            return None
        if stepped or self.look != state.look:
            try:
                developed, self.look = develop(gpu, self.picture, state.look), state.look
            except Invalid as error:
                self.error = str(error)
            else:
                # a copy stays as it is when the next drawing fails half way
                self.shown = gpu.target(f"window {self.name}", developed.size, 4, "f1")
                gpu.ctx.copy_framebuffer(self.shown, developed)
        return self.shown

    @property
    def busy(self):
        return self.pictures is not None

    def panel(self, gpu, state, memory, export):
        """The panel's inside; the state with what the user did to it. export(name, size, scale): offer to save the picture."""
        view = state.views[self.name]
        pixel = imgui.get_io().display_framebuffer_scale.x
        origin, room = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()
        size = (max(int(room.x * pixel), 8), max(int(room.y * pixel), 8))
        scale = points(1.0) * pixel
        shown = self.advance(gpu, state, size, scale)
        gpu.ctx.screen.use()
        if self.busy:
            hello_imgui.request_refresh()
        corner = imgui.get_cursor_pos()
        if shown:
            texture = imgui.ImTextureRef(shown.color_attachments[0].glo)
            imgui.image(texture, ImVec2(*room), (0, 1), (1, 0))
            self.labels(origin, pixel, scale)
        imgui.set_cursor_pos(corner)
        imgui.set_next_item_allow_overlap()
        imgui.invisible_button("picture", ImVec2(*room))
        state = self.mouse(state, view, origin, pixel, size, scale)
        if self.name == "sphere" and shown:
            handle(state, view, origin, pixel, size)
        self.note(origin, room)
        imgui.set_cursor_pos(corner)
        return self.buttons(state, view, memory, lambda: export(self.name, size, scale))

    def labels(self, origin, pixel, scale):
        drawing = imgui.get_window_draw_list()
        for label in self.picture.labels:
            height = label.size * scale / pixel
            imgui.push_font(fonts["text"], label.size)
            extent = imgui.calc_text_size(label.text)
            imgui.pop_font()
            x = origin.x + label.x / pixel - label.anchor[0] * extent.x
            y = origin.y + label.y / pixel - label.anchor[1] * extent.y
            drawing.add_text(fonts["text"], height, (round(x), round(y)), u32(label.color), label.text)

    def mouse(self, state, view, origin, pixel, size, scale):
        """The state after this frame's drag or wheel on the picture."""
        io = imgui.get_io()
        hovered = imgui.is_item_hovered()
        at = ((io.mouse_pos.x - origin.x) * pixel, (io.mouse_pos.y - origin.y) * pixel)
        delta = (io.mouse_delta.x * pixel, io.mouse_delta.y * pixel)
        link = hovered and self.picture and gestures.linked(self.picture.links, at)
        if link and link.tip:
            widgets.hint(*link.tip.split("\n"))
        if (hovered or imgui.is_item_active()) and (link and link.change or self.name in gestures.DRAGGED):
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
        if link and link.change and imgui.is_item_clicked():
            return link.change(state)
        moved = imgui.is_item_activated() or any(delta)
        if imgui.is_item_active() and moved:
            if self.name == "sphere" and state.light.irradiance > 0:
                return gestures.light(state, view, at, size)
            if self.name == "sphere":
                return gestures.turn(state, delta, scale)
            if self.name == "lobe":
                return gestures.orbit(state, view, delta, scale)
            if self.name in ("polar", "microsurface"):
                return gestures.viewer(state, view, at, size, scale)
            if self.name == "compare":
                return gestures.swipe(state, view, at, size, scale)
        if hovered and io.mouse_wheel and self.name == "lobe":
            return gestures.zoom(state, view, io.mouse_wheel)
        return state

    def note(self, origin, room):
        """The picture's note in the lower left corner, or what went wrong over the whole foot."""
        if self.error:
            inset, pad = points(10), imgui.get_style().window_padding
            width = room.x - 2 * inset
            text = imgui.calc_text_size(self.error, False, width - 2 * pad.x).y
            height = min(text + 2 * pad.y, room.y / 2)
            imgui.set_cursor_screen_pos((origin.x + inset, origin.y + room.y - height - inset))
            imgui.push_style_color(imgui.Col_.child_bg, vec("error_back"))
            imgui.push_style_color(imgui.Col_.text, vec("error"))
            imgui.push_style_var(imgui.StyleVar_.child_rounding, points(8))
            imgui.begin_child("error", (width, height), imgui.ChildFlags_.always_use_window_padding)
            imgui.text_wrapped(self.error)
            imgui.end_child()
            imgui.pop_style_var()
            imgui.pop_style_color(2)
        elif self.picture and self.picture.note:
            foot = (origin.x + points(8), origin.y + room.y - points(8))
            chip(self.picture.note, foot, room.x - points(16), self.name == "sphere")

    def buttons(self, state, view, memory, export):
        """The view's options and saving the picture: at the end of the panel's tab bar, or in the corner of a panel without."""
        node = imgui.internal.get_window_dock_node()
        here = imgui.get_cursor_screen_pos()
        pressed = {}
        kinds = (
            ("options", icons.ICON_FA_SLIDERS, f"Options of the {view.title.lower()}", ""),
            (
                "export",
                icons.ICON_FA_DOWNLOAD,
                "Save this picture",
                "PNG or EXR with the preset inside; curves also as SVG, PDF or CSV",
            ),
        )
        if node and imgui.internal.dock_node_begin_amend_tab_bar(node):
            imgui.push_style_color(imgui.Col_.text, vec("muted"))
            for name, symbol, words, more in kinds:
                pressed[name] = imgui.tab_item_button(f"{symbol}###{name}", imgui.TabItemFlags_.trailing)
                widgets.hint(words, *[more] * bool(more))
            imgui.pop_style_color()
            imgui.internal.dock_node_end_amend_tab_bar()
        else:
            for name, symbol, words, more in kinds:
                pressed[name] = widgets.icon(symbol, name)
                widgets.hint(words, *[more] * bool(more))
                imgui.same_line(0, points(2))
        if pressed["export"]:
            export()
        if pressed["options"]:
            imgui.open_popup("options")
        imgui.set_next_window_pos((here.x + imgui.get_window_width() - points(8), here.y + points(6)), 0, (1.0, 0.0))
        imgui.set_next_window_size((points(370), 0))
        if imgui.begin_popup("options"):
            widgets.heading(view.title)
            view = widgets.fields(view, memory)
            if view != state.views[self.name]:
                state = replace(state, views={**state.views, self.name: view})
            imgui.end_popup()
        return state


def handle(state, view, origin, pixel, size):
    """The ring that shows where the directional light is."""
    if state.light.irradiance <= 0:
        return
    x, y = gestures.light_position(state, view, size)
    at = (origin.x + x / pixel, origin.y + y / pixel)
    drawing = imgui.get_window_draw_list()
    hot = imgui.is_item_hovered() or imgui.is_item_active()
    radius = points(9 if hot else 7)
    drawing.add_circle(at, radius, u32("#000000", 0.45), 0, points(3.5))
    drawing.add_circle(at, radius, u32(colors["accent"] if hot else "#ffffff"), 0, points(1.8))


def chip(words, foot, room, over_picture):
    """A line of small text whose box has its lower left corner at `foot`; dark glass behind it over a picture."""
    drawing = imgui.get_window_draw_list()
    height = points(SMALL - 0.5)
    pad = points(6)
    imgui.push_font(None, SMALL - 0.5)
    words = cut(words, room - 2 * pad)
    width = imgui.calc_text_size(words).x
    imgui.pop_font()
    top = foot[1] - height - pad
    if over_picture:
        box = (foot[0] + width + 2 * pad, foot[1])
        drawing.add_rect_filled((foot[0], top - pad / 2), box, u32("#000000", 0.45), points(6))
    color = u32("#ffffff", 0.9) if over_picture else u32("muted")
    drawing.add_text(fonts["text"], height, (foot[0] + pad, top), color, words)


def cut(words, room):
    """The words, or what of them is no wider than the room in the font in use."""
    shown = words
    while shown and imgui.calc_text_size(shown).x > room:
        words = words[:-1]
        shown = words.rstrip(" ,;") + "…" if words else ""
    return shown

"""Widgets made from declarations: a loop over the fields of a value that returns the value changed."""

import math
from dataclasses import replace

from imgui_bundle import imgui
from imgui_bundle.immapp import icons_fontawesome_6 as icons

from ..lib.srgb import srgb_decode, srgb_encode
from ..model import Choice, Param, Text, declared
from .theme import SMALL, fonts, points, u32, vec

LABELS = 104  # points of the column of labels
GAP = 6  # points between a widget and a button of its own
GREEK = {"theta": "θ", "phi": "φ", "alpha": "α", "eta": "η", "sigma": "σ", "tau": "τ"}
UNITS = {"deg": "°", "W/m2": " W/m²"}
CHANNELS = ("red", "green", "blue")


def fields(value, memory, used=lambda name: True):
    """A row for each declared field of `value`; the value with what the user changed.

    memory: what widgets remember from frame to frame, a dict. used(name): whether the field matters now; others are dimmed.
    """
    for name, declaration in declared(value).items():
        old = getattr(value, name)
        imgui.push_id(name)
        imgui.begin_disabled(not used(name))
        key = (type(value), name)
        new = declaration.default if label(name, declaration) else old
        if isinstance(declaration, Param):
            new = numbers(declaration, new, key, memory)
        elif isinstance(declaration, Choice):
            new = choose(declaration.options, new, declaration.doc)
        elif isinstance(declaration, Text):
            new = line(new, key, memory, declaration.doc)
        imgui.end_disabled()
        imgui.pop_id()
        if new != old:
            value = replace(value, **{name: new})
    return value


def label(name, declaration):
    """The label of a row, with the cursor after it; True when a double click asks for the default."""
    word, _, rest = name.partition("_")
    imgui.align_text_to_frame_padding()
    start = imgui.get_cursor_pos_x()
    imgui.text(word if word in GREEK else name.replace("_", " "))
    hovered = imgui.is_item_hovered()
    explain(declaration, name)
    if word in GREEK:
        imgui.same_line()
        imgui.text_disabled(GREEK[word] + rest)
    imgui.same_line(start + points(LABELS))
    return hovered and imgui.is_mouse_double_clicked(0)


def explain(declaration, name=""):
    """The tooltip of the last item: what it means, its range, how to set it."""
    if not imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip | imgui.HoveredFlags_.allow_when_disabled):
        return
    lines = []
    if isinstance(declaration, Param):
        unit = UNITS.get(declaration.unit, f" {declaration.unit}" if declaration.unit else "")
        shown = declaration.default if isinstance(declaration.default, tuple) else (declaration.default,)
        lines.append(f"{declaration.low:g} to {declaration.high:g}{unit}, default {', '.join(f'{v:g}' for v in shown)}")
        lines.append("Ctrl + click to type a value, double click to reset")
    elif isinstance(declaration, Choice):
        lines.append("One of " + ", ".join(o.replace("_", " ") for o in declaration.options))
    tooltip(sentence(declaration.doc), *lines, title=name)


def tooltip(text, *muted, title=""):
    """A tooltip of the last item's neighbourhood: a title, words, and lines in a muted colour."""
    imgui.push_style_var(imgui.StyleVar_.window_padding, (points(11), points(9)))
    imgui.push_style_var(imgui.StyleVar_.window_rounding, points(8))
    imgui.begin_tooltip()
    imgui.push_text_wrap_pos(points(300))
    if title:
        imgui.push_font(fonts["bold"], SMALL)
        imgui.text(title)
        imgui.pop_font()
    imgui.push_font(None, SMALL)
    imgui.text(text)
    for words in muted:
        imgui.text_colored(vec("muted"), words)
    imgui.pop_font()
    imgui.pop_text_wrap_pos()
    imgui.end_tooltip()
    imgui.pop_style_var(2)


def hint(text, *muted):
    """A tooltip for the last item."""
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip | imgui.HoveredFlags_.allow_when_disabled):
        tooltip(text, *muted)


def sentence(doc):
    return doc[:1].upper() + doc[1:]


# --- numbers ---------------------------------------------------------------------------------------------------------


def numbers(declaration, value, key, memory):
    """Sliders for a number, or for each of two or three; those of equal values may move as one."""
    if declaration.size == 1:
        return slider("##0", declaration, value, imgui.get_content_region_avail().x)
    gap = points(GAP)
    side = imgui.get_frame_height()
    if declaration.color:
        value = swatch(declaration, value)
        imgui.same_line(0, gap)
        room, linked = imgui.get_content_region_avail().x, False
    else:
        linked = len(set(value)) == 1 and memory.get(("linked", *key), True)
        room = imgui.get_content_region_avail().x - side - gap
    if linked:
        one = slider("##0", declaration, value[0], room)
        value = value if one == value[0] else (one,) * declaration.size
    else:
        width = (room - gap * (declaration.size - 1)) / declaration.size
        values = list(value)
        for i, old in enumerate(value):
            if i:
                imgui.same_line(0, gap)
            mark = CHANNELS[i] if declaration.size == 3 else None
            values[i] = slider(f"##{i}", declaration, old, width, mark)
        value = tuple(values)
    if not declaration.color:
        imgui.same_line(0, gap)
        if icon(icons.ICON_FA_LINK if linked else icons.ICON_FA_LINK_SLASH, "link", faint=not linked):
            memory["linked", *key] = not linked
            value = value if linked else (value[0],) * declaration.size
        hint("Move the components apart" if linked else "Make the components equal and move them together")
    return value


def slider(name, declaration, value, width, mark=None):
    """A bar filled up to the value, which is written in it. mark: colour of the bar."""
    low, high, log = declaration.low, declaration.high, declaration.scale == "log"
    whole = isinstance(declaration.default, int)
    unit = UNITS.get(declaration.unit, f" {declaration.unit}" if declaration.unit else "").replace("%", "%%")
    flags = imgui.SliderFlags_.always_clamp | (imgui.SliderFlags_.logarithmic if log else 0)
    drawing = imgui.get_window_draw_list()
    drawing.channels_split(2)
    drawing.channels_set_current(1)
    imgui.set_next_item_width(width)
    none = vec("frame", 0.0)
    C = imgui.Col_
    for role in (C.frame_bg, C.frame_bg_hovered, C.frame_bg_active, C.slider_grab, C.slider_grab_active):
        imgui.push_style_color(role, none)
    if whole:
        changed, new = imgui.slider_int(name, value, low, high, f"%d{unit}", flags)
    else:
        digits = "%.3g" if log else f"%.{decimals(high - low)}f"
        changed, new = imgui.slider_float(name, value, low, high, digits + unit, flags)
        new = min(max(float(f"{new:.6g}"), low), high)  # what float32 adds to the digits of the text
    imgui.pop_style_color(5)
    typing = imgui.internal.temp_input_is_active(imgui.get_item_id())
    hot = imgui.is_item_hovered() or imgui.is_item_active()
    drawing.channels_set_current(0)
    bar(drawing, value, low, high, log, hot, typing, mark)
    drawing.channels_merge()
    if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(0):
        imgui.internal.clear_active_id()
        default = declaration.default
        return default[int(name[2:])] if isinstance(default, tuple) else default
    if not imgui.is_item_active():
        explain(declaration)
    return new if changed else value


def bar(drawing, value, low, high, log, hot, typing, mark):
    """The last item's frame, filled up to the value from the left, or from 0 where that is inside."""
    a, b = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    rounding = imgui.get_style().frame_rounding
    drawing.add_rect_filled(a, b, u32("frame_hover" if hot else "frame"), rounding)
    if typing:
        drawing.add_rect(a, b, u32("focus"), rounding)
        return
    inset = 2 + imgui.get_style().grab_min_size / 2  # the range that imgui's own grab would cover

    def place(value):
        share = math.log(value / low) / math.log(high / low) if log else (value - low) / (high - low)
        return a.x + inset + min(max(share, 0.0), 1.0) * (b.x - a.x - 2 * inset)

    x, signed = place(value), low < 0 < high
    start = place(0.0) if signed else a.x
    color = u32(mark, 0.42 if hot else 0.32) if mark else u32("fill_hover" if hot else "fill")
    drawing.push_clip_rect((min(start, x), a.y), (max(start, x), b.y), True)
    drawing.add_rect_filled(a, b, color, rounding)
    drawing.pop_clip_rect()
    if hot or signed:
        half = points(1.0)
        top = a.y + half if hot else b.y - points(6)  # short, so as not to strike the number through
        drawing.add_rect_filled(
            (x - half, top), (x + half, b.y - half), u32(mark or "focus", 1.0 if hot else 0.7), half
        )


def decimals(span):
    """Digits after the point that a slider over the span can set."""
    return 1 if span >= 20 else 2 if span >= 10 else 3


def swatch(declaration, value):
    """A linear colour shown as it looks, with a picker behind it."""
    shown = [float(c) for c in srgb_encode(value)]
    side = imgui.get_frame_height()
    flags = imgui.ColorEditFlags_
    if imgui.color_button("##swatch", (*shown, 1.0), flags.no_tooltip | flags.no_drag_drop, (side, side)):
        imgui.open_popup("picker")
    explain(declaration)
    if imgui.begin_popup("picker"):
        options = flags.no_side_preview | flags.no_small_preview | flags.display_rgb | flags.float
        changed, picked = imgui.color_picker3("##picker", shown, options)
        if changed:
            value = tuple(min(max(round(float(c), 6), declaration.low), declaration.high) for c in srgb_decode(picked))
        imgui.end_popup()
    return value


# --- words -----------------------------------------------------------------------------------------------------------


def choose(options, value, doc="", name="##choice"):
    """One of several names: buttons side by side if they fit, else a list that drops down."""
    width = imgui.get_content_region_avail().x
    padding = points(9)
    words = [option.replace("_", " ") for option in options]
    sizes = [imgui.calc_text_size(w).x + 2 * padding for w in words]
    if sum(sizes) <= width:
        return segments(options, words, sizes, value, width)
    imgui.set_next_item_width(width)
    opened = imgui.begin_combo(name, value.replace("_", " "), imgui.ComboFlags_.no_arrow_button)
    if opened:
        for option, word in zip(options, words, strict=True):
            if imgui.selectable(word, option == value)[0]:
                value = option
        imgui.end_combo()
        return value
    a, b = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    mark = icons.ICON_FA_CHEVRON_DOWN
    size = imgui.calc_text_size(mark)
    imgui.get_window_draw_list().add_text((b.x - size.x - padding, (a.y + b.y - size.y) / 2), u32("muted"), mark)
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        tooltip(sentence(doc))
    return value


def segments(options, words, sizes, value, width):
    """Buttons side by side in one frame, the chosen one raised."""
    drawing = imgui.get_window_draw_list()
    a = imgui.get_cursor_screen_pos()
    height = imgui.get_frame_height()
    rounding = imgui.get_style().frame_rounding
    drawing.add_rect_filled(a, (a.x + width, a.y + height), u32("frame"), rounding)
    spare = (width - sum(sizes)) / len(options)
    x, inset = a.x, points(2)
    for option, word, size in zip(options, words, sizes, strict=True):
        if x > a.x:
            imgui.same_line(0, 0)
        if imgui.invisible_button(option, (size + spare, height)):
            value = option
        low, high = (x + inset, a.y + inset), (x + size + spare - inset, a.y + height - inset)
        if option == value:
            drawing.add_rect_filled(low, high, u32("segment"), rounding - inset / 2)
            drawing.add_rect(low, high, u32("border"), rounding - inset / 2)
        text = imgui.calc_text_size(word)
        at = (x + (size + spare - text.x) / 2, a.y + (height - text.y) / 2)
        drawing.add_text(at, u32("ink" if option == value or imgui.is_item_hovered() else "muted"), word)
        x += size + spare
    return value


def line(value, key, memory, doc):
    """A file's name, which takes effect when editing ends; `memory["browse"]` asks the window for a dialog."""
    side = imgui.get_frame_height()
    imgui.set_next_item_width(imgui.get_content_region_avail().x - side - points(GAP))
    text = memory.get(("text", *key), value)
    _, text = imgui.input_text("##text", text)
    if imgui.is_item_active():
        memory["text", *key] = text
    elif memory.pop(("text", *key), None) is not None and imgui.is_item_deactivated_after_edit():
        value = text
    elif imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        tooltip(sentence(doc))
    imgui.same_line(0, points(GAP))
    if icon(icons.ICON_FA_FOLDER_OPEN, "browse"):
        memory["browse"] = key
    hint("Choose a file")
    return value


def icon(symbol, name, enabled=True, faint=False, size=None):
    """A square button without a frame until the mouse is over it; True when pressed."""
    side = size or imgui.get_frame_height()
    imgui.begin_disabled(not enabled)
    imgui.push_style_color(imgui.Col_.button, vec("frame", 0.0))
    imgui.push_style_color(imgui.Col_.text, vec("muted", 0.7 if faint else 1.0))
    imgui.push_style_var(imgui.StyleVar_.frame_padding, (0, imgui.get_style().frame_padding.y))
    pressed = imgui.button(f"{symbol}###{name}", (side, side))
    imgui.pop_style_var()
    imgui.pop_style_color(2)
    imgui.end_disabled()
    return pressed


def heading(text):
    """The title of a section."""
    imgui.push_font(fonts["bold"], SMALL)
    imgui.text_colored(vec("muted"), text.upper())
    imgui.pop_font()


def gap(height):
    imgui.dummy((0, points(height)))

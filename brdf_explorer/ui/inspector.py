"""The panels that show and change the state in words and numbers: material, scene, presets. Each maps state to state."""

import itertools
from dataclasses import replace
from functools import cache, partial

import numpy as np
from imgui_bundle import imgui
from imgui_bundle.immapp import icons_fontawesome_6 as icons

from ..lib.random import seeded
from ..model import Choice, declared
from ..models import MODELS
from ..state import Material, presets
from ..views.picture import PALETTES
from . import widgets
from .theme import SMALL, points, u32, vec

# unit vectors in general position, far from the normal: what matters to f or pdf changes its value at one of them
WO = np.array([0.96, 0.0, 0.28])
WI = np.array([[0.0, 0.8, 0.6], [-0.576, 0.768, 0.28], [-0.96, 0.0, 0.28], [0.0, 0.96, -0.28]])
WALKS = 16  # estimates of a stochastic f at each, of which some meet facets more than once
FIRST = 4  # frames that are not kept waiting for it


def material(state, memory):
    """The list of materials, and the active one's model and parameters."""
    widgets.heading("Materials")
    state = materials(state, memory)
    widgets.gap(2)
    imgui.separator()
    widgets.gap(2)
    widgets.heading("Model")
    name = state.model.name()
    chosen = widgets.choose(tuple(MODELS), name, (type(state.model).__doc__ or "").split("\n\n")[0])
    if chosen != name:
        state = with_other_model(state, MODELS[chosen])
    widgets.gap(2)
    used = declared(state.model)
    if imgui.get_frame_count() > FIRST:
        used = matters(type(state.model), tuple(state.model.choices().items()))
    model = widgets.fields(state.model, memory, used.__contains__)
    if model != state.model:
        state = state.with_model(model)
    if state.material.source:
        widgets.gap(2)
        imgui.push_font(None, SMALL)
        imgui.push_style_color(imgui.Col_.text, vec("muted"))
        imgui.text_wrapped(state.material.source)
        imgui.pop_style_color()
        imgui.pop_font()
    return state


@cache
def matters(cls, choices):
    """Names of the parameters that change f or pdf when these choices are made; with F = 1, say, eta and k do not."""
    wi = np.repeat(WI, WALKS, axis=0) if cls.stochastic else WI

    def values(model):
        with seeded(1):  # a stochastic f by the same random numbers
            return np.column_stack([model.f(WO, wi), model.pdf(WO, wi)])

    model = cls(**dict(choices))  # at its defaults all that is chosen shows
    before = values(model)
    names = set()
    for name, declaration in declared(cls).items():
        others = declaration.options if isinstance(declaration, Choice) else (declaration.low, declaration.high)
        if any(not np.array_equal(values(replace(model, **{name: other})), before) for other in others):
            names.add(name)
    return names


def with_other_model(state, cls):
    """The active material with another model, which keeps the parameters that both declare alike."""
    old, new = state.model, cls()
    kept = {n: getattr(old, n) for n, d in declared(cls).items() if declared(old).get(n) == d}
    name = cls.name() if state.material.name == old.name() else state.material.name
    materials = list(state.materials)
    materials[state.active] = Material(name, replace(new, **kept))
    return replace(state, materials=tuple(materials))


def materials(state, memory):
    """A row for each material: select, rename, remove; and one to add a copy."""
    curves = PALETTES[state.look.theme]["curves"]
    side = imgui.get_frame_height()
    for i, material in enumerate(state.materials):
        imgui.push_id(i)
        start = imgui.get_cursor_pos()
        if memory.get("renaming") == i:
            state = rename(state, i, memory)
            imgui.pop_id()
            continue
        imgui.set_next_item_allow_overlap()
        size = (imgui.get_content_region_avail().x, side)
        if bar("##row", i == state.active, size):
            state = replace(state, active=i)
            if imgui.is_mouse_double_clicked(0):
                memory["renaming"] = i
        a, b = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        inside = over(a, b)
        drawing = imgui.get_window_draw_list()
        drawing.add_circle_filled((a.x + points(13), (a.y + b.y) / 2), points(4.5), u32(curves[i % len(curves)]))
        top = (a.y + b.y - imgui.get_text_line_height()) / 2
        buttons = inside or i == state.active
        drawing.push_clip_rect(a, (b.x - (2 * side if buttons else points(8)), b.y), True)
        drawing.add_text((a.x + points(26), top), u32("ink"), material.name)
        model_at = a.x + points(26) + imgui.calc_text_size(material.name + "  ").x
        drawing.add_text(
            (model_at, top), u32("muted"), material.model.name() * (material.model.name() != material.name)
        )
        drawing.pop_clip_rect()
        if buttons:
            imgui.set_cursor_pos((start.x + size[0] - side * (1 + (len(state.materials) > 1)), start.y))
            if widgets.icon(icons.ICON_FA_PEN, "rename", faint=not inside):
                memory["renaming"] = i
            widgets.hint("Rename")
            if len(state.materials) > 1:
                imgui.same_line(0, 0)
                if widgets.icon(icons.ICON_FA_XMARK, "remove", faint=not inside):
                    state = removed(state, i)
                widgets.hint("Remove")
        imgui.pop_id()
        if i >= len(state.materials) - 1:
            break
    if imgui.button(f"{icons.ICON_FA_PLUS}  Compare with a copy###copy", (imgui.get_content_region_avail().x, 0)):
        state = with_copy(state)
    widgets.hint("Add a copy of the active material", "The polar slice shows all materials over each other")
    return state


def with_copy(state):
    """The state with a copy of the active material, which is "Gold 2" after "Gold", and "Gold 3" after "Gold 2"."""
    name, taken = state.material.name, {material.name for material in state.materials}
    stem, _, last = name.rpartition(" ")
    if not (stem and last.isdecimal() and len(last) < 3):  # not Alloy 7075
        stem = name
    number = next(n for n in itertools.count(2) if f"{stem} {n}" not in taken)
    copy = replace(state.material, name=f"{stem} {number}")
    return replace(state, materials=(*state.materials, copy), active=len(state.materials))


def bar(name, chosen, size):
    """An empty row of a list, as wide as the buttons around it; True when it is clicked."""
    imgui.push_style_var(imgui.StyleVar_.item_spacing, (0, imgui.get_style().item_spacing.y))
    pressed = imgui.selectable(name, chosen, imgui.SelectableFlags_.allow_double_click, size)[0]
    imgui.pop_style_var()
    return pressed


def over(a, b):
    """Whether the mouse is over a rectangle of this panel, also while a button in it is held."""
    flag = imgui.HoveredFlags_.allow_when_blocked_by_active_item
    return imgui.is_window_hovered(flag) and imgui.is_mouse_hovering_rect(a, b)


def rename(state, i, memory):
    """The text field in place of a material's row, until editing ends."""
    if not memory.get("rename focused"):
        imgui.set_keyboard_focus_here()
    imgui.set_next_item_width(imgui.get_content_region_avail().x)
    text = memory.get("rename text", state.materials[i].name)
    _, memory["rename text"] = imgui.input_text("##name", text, imgui.InputTextFlags_.auto_select_all)
    if imgui.is_item_active():
        memory["rename focused"] = True
    elif memory.get("rename focused"):
        text = memory["rename text"].strip()
        for key in ("renaming", "rename focused", "rename text"):
            memory.pop(key, None)
        if text and not imgui.is_key_pressed(imgui.Key.escape):
            changed = replace(state.materials[i], name=text)
            return replace(state, materials=(*state.materials[:i], changed, *state.materials[i + 1 :]))
    return state


def removed(state, i):
    """The state without a material; the active one stays, or the one before it becomes active."""
    rest = state.materials[:i] + state.materials[i + 1 :]
    active = state.active - (i < state.active or state.active == len(rest))
    return replace(state, materials=rest, active=active)


def scene(state, memory):
    """Directions, light and look."""
    for title, section in (("Viewer", "directions"), ("Light", "light"), ("Display", "look")):
        if section != "directions":
            widgets.gap(4)
        widgets.heading(title)
        imgui.push_id(section)
        used = partial(lit, state.light) if section == "light" else lambda name: True
        value = widgets.fields(getattr(state, section), memory, used)
        imgui.pop_id()
        if value != getattr(state, section):
            state = replace(state, **{section: value})
    return state


def lit(light, name):
    """Whether a parameter of the light matters as the others are."""
    if name in ("theta", "phi"):
        return light.irradiance > 0
    if name in ("gain", "rotation"):
        return light.environment != "none"
    return name != "file" or light.environment == "file"


def browse(state, memory, load, thumbnail):
    """The presets of the package, with a search. load(name, add): open one over the state.

    thumbnail(name, side): texture of a material on a sphere, side in points, or None while there is none.
    """
    imgui.set_next_item_width(imgui.get_content_region_avail().x)
    words = memory.get("search", "")
    _, memory["search"] = imgui.input_text_with_hint(
        "##search", f"{icons.ICON_FA_MAGNIFYING_GLASS}  Search presets", words
    )
    wanted = memory["search"].lower().split()
    if "presets" not in memory:
        memory["presets"] = presets()
    found = {"materials": [], "scenes": []}
    for name, path in memory["presets"].items():
        if all(word in name.replace("_", " ").lower() for word in wanted):
            found[path.parent.name].append(name)
    if found["scenes"]:
        widgets.gap(2)
        widgets.heading("Scenes")
    space = points(8)
    half = (imgui.get_content_region_avail().x - space) / 2
    for i, name in enumerate(found["scenes"]):
        if i % 2:
            imgui.same_line(0, space)
        imgui.push_id(name)
        pressed = imgui.button(f"{name.replace('_', ' ')}###preset", (half, 0))
        imgui.pop_id()
        if pressed:
            state = load(name, False)
    if found["materials"]:
        widgets.gap(2)
        widgets.heading("Materials")
    columns = max(int((imgui.get_content_region_avail().x + space) // points(96 + 8)), 1)
    side = (imgui.get_content_region_avail().x - (columns - 1) * space) / columns
    for i, name in enumerate(found["materials"]):
        if i % columns:
            imgui.same_line(0, space)
        if (add := tile(name, side, thumbnail)) is not None:
            state = load(name, add)
    if not any(found.values()):
        widgets.gap(2)
        imgui.text_disabled("No preset has these words in its name.")
    return state


def tile(name, side, thumbnail):
    """A material to click: its sphere over its name. False when pressed, True when it is to be added, else None."""
    drawing = imgui.get_window_draw_list()
    small = imgui.get_frame_height()
    imgui.push_id(name)
    start = imgui.get_cursor_pos()
    imgui.set_next_item_allow_overlap()
    whole = (side, side + points(SMALL + 9))
    answer = False if imgui.invisible_button("###preset", whole) else None
    a, b = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    inside = over(a, b)
    rounding = points(8)
    drawing.add_rect_filled(a, (b.x, a.y + side), u32("backdrop"), rounding)
    if imgui.is_rect_visible(a, b) and (texture := thumbnail(name, side)):
        drawing.add_image_rounded(texture, a, (a.x + side, a.y + side), (0, 1), (1, 0), u32("#ffffff"), rounding)
    if inside:
        drawing.add_rect(a, (b.x, a.y + side), u32("focus"), rounding, points(1.5))
    imgui.push_font(None, SMALL)
    words = name.replace("_", " ")
    width = imgui.calc_text_size(words).x
    drawing.push_clip_rect(a, b, True)
    x = a.x + max((side - width) / 2, 0)
    drawing.add_text((x, a.y + side + points(3)), u32("ink" if inside else "muted"), words)
    drawing.pop_clip_rect()
    imgui.pop_font()
    if inside:
        if width > side:
            widgets.hint(words)
        imgui.set_cursor_pos((start.x + side - small - points(3), start.y + points(3)))
        pad = imgui.get_cursor_screen_pos()
        drawing.add_rect_filled(pad, (pad.x + small, pad.y + small), u32("raised", 0.85), points(6))
        if widgets.icon(icons.ICON_FA_PLUS, "add"):
            answer = True
        widgets.hint("Add to the materials, to compare")
    imgui.set_cursor_pos(start)
    imgui.dummy(whole)
    imgui.pop_id()
    return answer

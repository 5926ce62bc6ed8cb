"""Colours, sizes and fonts of the window. Sizes are in points: hello_imgui scales them to the screen."""

from pathlib import Path

import imgui_bundle
from imgui_bundle import ImVec4, hello_imgui, imgui

from ..views.picture import PALETTES, rgb

FONTS = Path(imgui_bundle.__file__).parent / "assets/fonts"
TEXT, SMALL = 15.0, 13.0  # heights of type

# sRGB colours of the window by role; those of diagrams complete them
COLORS = {
    "light": {
        "canvas": "#f7f8fa",
        "raised": "#ffffff",
        "bar": "#ffffff",
        "tabs": "#f0f2f5",
        "border": "#dfe3e9",
        "frame": "#e9ecf1",
        "frame_hover": "#e0e4eb",
        "frame_active": "#d6dce5",
        "fill": "#c3d6fb",
        "fill_hover": "#b0c9f9",
        "focus": "#2563eb",
        "selected": "#e1eafd",
        "segment": "#ffffff",
        "error": "#b91c1c",
        "error_back": "#fef2f2",
    },
    "dark": {
        "canvas": "#1a1d23",
        "raised": "#23272f",
        "bar": "#1a1d23",
        "tabs": "#14171c",
        "border": "#2f343e",
        "frame": "#272c35",
        "frame_hover": "#2f3540",
        "frame_active": "#373e4a",
        "fill": "#2c4a7c",
        "fill_hover": "#345792",
        "focus": "#60a5fa",
        "selected": "#263650",
        "segment": "#434b59",
        "error": "#fca5a5",
        "error_back": "#3a2226",
    },
}

fonts = {}  # "text" and "bold", after load_fonts
colors = {}  # role -> "#rrggbb" of the theme in use


def load_fonts():
    """Roboto for text, its bold for headings, and icons merged into both."""
    for name, file in (("text", "Roboto/Roboto-Regular.ttf"), ("bold", "Roboto/Roboto-Bold.ttf")):
        fonts[name] = hello_imgui.load_font(str(FONTS / file), TEXT, hello_imgui.FontLoadingParams(inside_assets=False))
        icons = hello_imgui.FontLoadingParams(inside_assets=False, merge_to_last_font=True)
        hello_imgui.load_font(str(FONTS / "Font_Awesome_6_Free-Solid-900.otf"), TEXT - 2, icons)


def vec(color, alpha=1.0):
    """imgui's colour of a role or of "#rrggbb"."""
    return ImVec4(*rgb(colors.get(color, color)), alpha)


def u32(color, alpha=1.0):
    """A colour for imgui's draw lists; it fades with what is disabled."""
    return imgui.get_color_u32(vec(color, alpha))


def set_colors(theme):
    """Give imgui the colours of a theme, "light" or "dark"."""
    colors.clear()
    colors.update(PALETTES[theme] | COLORS[theme])
    C = imgui.Col_
    clear = ImVec4(0, 0, 0, 0)
    roles = {
        "canvas": (C.window_bg, C.docking_empty_bg),
        "raised": (C.popup_bg,),
        "bar": (C.menu_bar_bg,),
        "tabs": (C.title_bg, C.title_bg_active, C.title_bg_collapsed),
        "border": (C.border, C.separator, C.table_border_light, C.table_border_strong),
        "frame": (C.frame_bg, C.button),
        "frame_hover": (C.frame_bg_hovered, C.button_hovered, C.header_hovered, C.tab_hovered),
        "frame_active": (C.frame_bg_active, C.button_active, C.header_active, C.scrollbar_grab),
        "muted": (C.text_disabled, C.scrollbar_grab_hovered, C.scrollbar_grab_active),
        "ink": (C.text, C.input_text_cursor),
        "focus": (C.slider_grab, C.slider_grab_active, C.check_mark, C.docking_preview, C.nav_cursor, C.text_link),
        "selected": (C.header, C.text_selected_bg),
    }
    style = imgui.get_style()
    for role, targets in roles.items():
        for target in targets:
            style.set_color_(target, vec(role))
    for target in (C.separator_hovered, C.separator_active, C.resize_grip_hovered, C.resize_grip_active):
        style.set_color_(target, vec("focus", 0.6))
    for target in (C.border_shadow, C.scrollbar_bg, C.resize_grip, C.child_bg):
        style.set_color_(target, clear)
    for target in (C.tab, C.tab_dimmed):
        style.set_color_(target, vec("tabs"))
    for target in (C.tab_selected, C.tab_dimmed_selected):
        style.set_color_(target, vec("canvas"))
    for target in (C.tab_selected_overline, C.tab_dimmed_selected_overline):
        style.set_color_(target, clear)
    style.set_color_(C.docking_preview, vec("focus", 0.3))
    style.set_color_(C.modal_window_dim_bg, vec("#000000", 0.35))


def set_sizes():
    """Spacing and rounding, in points."""
    style = imgui.get_style()
    style.window_padding = (16, 14)
    style.frame_padding = (9, 6)
    style.item_spacing = (8, 8)
    style.item_inner_spacing = (2, 6)  # also between tabs, of which there are many
    style.frame_rounding = style.grab_rounding = style.tab_rounding = style.selectable_rounding = 6
    style.menu_item_rounding = 5
    style.popup_rounding = 8
    style.window_rounding = style.child_rounding = 0  # of docked panels, whose corners meet
    style.scrollbar_size, style.scrollbar_rounding = 10, 5
    style.window_border_size = style.popup_border_size = 1
    style.frame_border_size = style.child_border_size = style.tab_border_size = 0
    style.tab_bar_border_size = style.tab_bar_overline_size = 0
    style.grab_min_size = 4
    style.docking_separator_size = 1
    style.window_menu_button_position = imgui.Dir.none
    style.window_title_align = (0.0, 0.5)
    style.disabled_alpha = 0.4
    style.hover_delay_normal = 0.5


def points(value):
    """A length in points as imgui's length."""
    return value * hello_imgui.dpi_window_size_factor()

"""What a view gives: a picture with its labels, or named curves. Window, exporter, command line and tests consume these."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from ..model import Declared

# sRGB colours of diagrams by theme and role
PALETTES = {
    "light": {
        "paper": "#ffffff",
        "backdrop": "#e3e7ec",
        "ink": "#1f2937",
        "muted": "#6b7280",
        "grid": "#d5dae1",
        "accent": "#b45309",
        "reference": "#111827",
        "red": "#dc2626",
        "green": "#15803d",
        "blue": "#2563eb",
        "purple": "#7e22ce",
        "curves": ("#2563eb", "#c2410c", "#0f766e", "#a21caf", "#4d7c0f", "#b91c1c"),
    },
    "dark": {
        "paper": "#171a20",
        "backdrop": "#1d2128",
        "ink": "#e5e7eb",
        "muted": "#9aa3af",
        "grid": "#343a45",
        "accent": "#fbbf24",
        "reference": "#f9fafb",
        "red": "#f87171",
        "green": "#4ade80",
        "blue": "#60a5fa",
        "purple": "#c084fc",
        "curves": ("#60a5fa", "#fb923c", "#2dd4bf", "#e879f9", "#a3e635", "#f87171"),
    },
}


# places within a pixel for passes that are averaged: Roberts 2018, the multiples of these fill the square evenly
R2 = np.array([0.7548776662466927, 0.5698402909980532])


def rgb(color):
    """The sRGB components in [0, 1] of a colour "#rrggbb"."""
    return tuple(int(color[i : i + 2], 16) / 255 for i in (1, 3, 5))


@dataclass(frozen=True)
class Label:
    """A line of text over a picture. x, y: pixels from the top left; anchor: the share of the text left of and above (x, y)."""

    text: str
    x: float
    y: float
    color: str  # "#rrggbb"
    anchor: tuple[float, float] = (0.5, 0.5)
    size: float = 13.0  # height in points; a picture's scale turns points into pixels


@dataclass(frozen=True)
class Link:
    """A place in a picture that reacts to the mouse. box: left, top, right, bottom in pixels from the top left.

    tip shows while the mouse is there, line by line; a click makes `change` of the current state the current one. It is a
    function, so that all that the click is not about stays as it is then; None where a click does nothing.
    """

    box: tuple[float, float, float, float]
    tip: str
    change: Callable | None = None


@dataclass
class Picture:
    """A picture on the GPU, drawn once or getting better from one to the next.

    target  framebuffer: scene-linear RGB and coverage (float32) if `linear`, else sRGB colours (8 bits)
    labels  texts to draw over it, for which it left room
    links   places that react to the mouse; where they overlap the last does
    note    one line about the picture, such as its sample count
    done    whether the next one would be the same
    """

    target: object
    linear: bool = False
    labels: list[Label] = field(default_factory=list)
    links: list[Link] = field(default_factory=list)
    note: str = ""
    done: bool = True


@dataclass
class Curves:
    """Named arrays over one axis: columns of a table, lines of a plot. `y` maps a name to values as long as `x`."""

    x_name: str
    x: np.ndarray
    y: dict[str, np.ndarray]


class View(Declared):
    """What to draw, no widgets. A frozen dataclass whose fields are its options; the module's name is its name."""

    title: ClassVar[str] = ""
    instrument: ClassVar[bool] = False  # measures when it is asked to, rather than shows a material

    def shows(self, state):
        """The values that its picture depends on; while they stay equal, so does the picture."""
        raise NotImplementedError

    def pictures(self, gpu, state, size, scale=1.0) -> Iterator[Picture | None]:
        """Pictures of the state, from the first to the best. size: pixels; scale: pixels per point of lines and text.

        Where steps have a time to keep (Gpu.pace), a step that ends before the first picture is there gives None.
        """
        raise NotImplementedError

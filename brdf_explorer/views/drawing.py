"""A diagram as data: fills, lines, pictures and texts in order, which a window draws and a vector file holds."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from ..glsl import assemble
from .lines import Stroke, draw_lines
from .picture import PALETTES, Label, Link, Picture, View, rgb

LETTER = 0.46
"""Width of a letter over the height of its line: in prose it is 0.37 in the mean and 0.44 in one text of a hundred."""


@dataclass(frozen=True)
class Fill:
    """A rectangle of one colour. box: left, bottom, right, top in pixels from the bottom left; color: "#rrggbb"."""

    box: tuple[float, float, float, float]
    color: str


@dataclass(frozen=True)
class Raster:
    """A framebuffer of sRGB colours (8 bits), or a part of it, drawn pixel by pixel with its lower left corner at `corner`.

    part: left, bottom, right, top in pixels of the framebuffer.
    """

    corner: tuple[int, int]
    target: object
    part: tuple[int, int, int, int]

    @property
    def box(self):
        """Where it lies in the drawing."""
        return (*np.add(self.corner, self.part[:2]).tolist(), *np.add(self.corner, self.part[2:]).tolist())


class Drawing:
    """What a view drew so far. Coordinates are pixels from the bottom left, lengths points; colours are roles or "#rrggbb".

    items   Fill, Raster and Stroke, the later over the earlier; neighbouring strokes are one pass, in which the one that
            covers more of a pixel shows: `over` begins another
    labels  texts, over all items
    links   places that react to a click
    """

    def __init__(self, size, scale=1.0, theme="light"):
        self.size, self.scale, self.theme = size, scale, theme
        self.colors = PALETTES[theme]
        self.items, self.labels, self.links = [], [], []
        self.passes = 0

    def color(self, role):
        return self.colors.get(role, role)

    def over(self):
        """What follows is drawn over what there is, joints and crossings too."""
        self.passes += 1

    def fill(self, box, color):
        self.items.append((self.passes, Fill(tuple(map(float, box)), self.color(color))))

    def stroke(self, points, color, width=1.0, opacity=1.0):
        """A polyline through points (n, 2), `width` points wide, with round ends."""
        points = np.asarray(points, dtype=float)
        self.items.append((self.passes, Stroke(points, self.color(color), width * self.scale, opacity)))

    def dot(self, at, color, diameter, opacity=1.0):
        """A disc about `at` (2,), its diameter in points."""
        self.stroke([at, at], color, diameter, opacity)

    def raster(self, corner, target, part=None):
        """A framebuffer, the lower left corner of the whole at `corner`, or the part of it within a box of its pixels."""
        self.items.append(
            (self.passes, Raster((round(corner[0]), round(corner[1])), target, part or (0, 0, *target.size)))
        )

    def text(self, words, at, color="ink", anchor=(0.5, 0.5), size=12.0):
        """A line of text; anchor: the share of it left of and above `at`; size: its height in points."""
        x, y = float(at[0]), self.size[1] - float(at[1])
        self.labels.append(Label(words, x, y, self.color(color), anchor, size))

    def link(self, box, tip, change=None):
        """A place that shows `tip` under the mouse; a click makes change(state) the current state, if given."""
        left, bottom, right, top = map(float, box)
        self.links.append(Link((left, self.size[1] - top, right, self.size[1] - bottom), tip, change))

    def picture(self, gpu, name, note="", done=True):
        """The Picture of all this, in the target of that name."""
        target = gpu.target(name, self.size, 4, "f1")
        target.clear(*rgb(self.colors["paper"]), 1.0)
        for (_, kind), group in groupby(self.items, key=lambda item: (item[0], type(item[1]))):
            items = [item for _, item in group]
            if kind is Stroke:
                draw_lines(gpu, target, items)
                continue
            for item in items:
                if kind is Fill:
                    left, bottom, right, top = (
                        np.clip(np.round(item.box), 0, [*self.size, *self.size]).astype(int).tolist()
                    )
                    if right > left and top > bottom:
                        target.clear(*rgb(item.color), 1.0, viewport=(left, bottom, right - left, top - bottom))
                else:
                    draw_raster(gpu, target, item)
        return Picture(target, labels=self.labels, links=self.links, note=note, done=done)


def width_of(words, size):
    """The width of a line of text `size` high, both in points: about, and rather more than less."""
    return LETTER * size * len(words)


def cut(words, room, size):
    """The words, or what of them has room on a line of `room` points."""
    letters = max(int(room / (LETTER * size)), 1)
    return words if len(words) <= letters else words[: letters - 1].rstrip(" ,;:") + "…"


def wrapped(texts, room, size):
    """Lines of `room` points of some texts, each of which begins a line of its own."""
    lines = []
    for text in texts:
        line = ""
        for word in text.split():
            if line and width_of(f"{line} {word}", size) > room:
                lines.append(line)
                line = word
            else:
                line = f"{line} {word}".strip()
        lines.append(cut(line, room, size))
    return lines


def nothing(size, scale, theme, *texts):
    """A Drawing of a view that has nothing to show: why, in lines about its middle."""
    draw = Drawing(size, scale, theme)
    lines = wrapped(texts, size[0] / scale - 24, 12.0)
    for i, line in enumerate(lines):
        draw.text(line, (size[0] / 2, size[1] / 2 + 18 * ((len(lines) - 1) / 2 - i) * scale), "muted")
    return draw


def draw_raster(gpu, target, raster):
    program = gpu.program(assemble("views/raster.frag"))
    picture = {"picture": raster.target.color_attachments[0]}
    gpu.draw(program, target, {"corner": raster.corner}, picture, box=raster.box)


class Drawn(View):
    """A view whose pictures are drawings, which a vector file can hold."""

    def drawings(self, gpu, state, size, scale=1.0) -> Iterator[tuple[Drawing, str, bool]]:
        """Drawings of the state, from the first to the best, each with its note and whether it is the last.

        The same Drawing again is not drawn again; None is one that is not ready, where steps have a time to keep.
        """
        raise NotImplementedError

    def pictures(self, gpu, state, size, scale=1.0):
        drawn = None
        for drawing, note, done in self.drawings(gpu, state, size, scale):
            if drawing and drawing is not drawn:
                drawn, picture = drawing, drawing.picture(gpu, self.name(), note, done)
            yield drawing and replace(picture, note=note, done=done)

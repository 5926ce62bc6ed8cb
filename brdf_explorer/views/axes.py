"""Axes of a plot in a drawing: from values to pixels, ticks, grid and titles."""

from dataclasses import dataclass

import numpy as np

from ..glsl import assemble
from .diagram import apart, nice_step, number
from .drawing import width_of

TICK = 11.0  # height of a tick's letters, points


@dataclass(frozen=True)
class Axis:
    """The range of an axis and its title, which holds the unit. scale: "linear" or "log", whose ends are above 0."""

    low: float
    high: float
    title: str = ""
    scale: str = "linear"

    def share(self, values):
        """Places along the axis, 0 at its low end and 1 at its high one; what a logarithm does not know lies far below."""
        values = np.asarray(values, dtype=float)
        if self.scale == "linear":
            return (values - self.low) / (self.high - self.low)
        low, high = np.log10(self.low), np.log10(self.high)
        return (np.log10(np.maximum(values, 1e-300)) - low) / (high - low)

    def ticks(self, room, spacing):
        """Values at which the axis has ticks, as many as are `spacing` apart on `room` pixels."""
        count = max(room / spacing, 1.0)
        if self.scale == "linear":
            step = nice_step((self.high - self.low) / count)
            return step * np.arange(np.ceil(self.low / step - 1e-9), np.floor(self.high / step + 1e-9) + 1)
        low, high = np.log10([self.low, self.high])
        if 3 * (high - low) <= count:  # 1, 2 and 5 of each decade, or even steps where those are too few
            found = np.outer(10.0 ** np.arange(np.floor(low), np.ceil(high) + 1), [1, 2, 5]).ravel()
            found = found[(found >= self.low * (1 - 1e-9)) & (found <= self.high * (1 + 1e-9))]
            return found if len(found) > 2 else Axis(self.low, self.high).ticks(room, spacing)
        step = max(int(np.ceil((high - low) / count)), 1)
        return 10.0 ** np.arange(np.ceil(low - 1e-9), np.floor(high + 1e-9) + 1, step)


class Axes:
    """A plot in a box of a drawing. box: left, bottom, right, top of its frame, pixels; ticks and titles lie outside."""

    def __init__(self, drawing, box, x, y):
        self.drawing, self.box, self.x, self.y = drawing, tuple(map(float, box)), x, y

    def place(self, x, y):
        """Pixels (n, 2) of values, also outside the frame."""
        left, bottom, right, top = self.box
        x, y = np.broadcast_arrays(self.x.share(x), self.y.share(y))
        return np.stack([left + x * (right - left), bottom + y * (top - bottom)], axis=-1)

    def frame(self, xs=None, words=None, ys=None):
        """Draw the frame with grid, ticks and titles. xs, ys: ticks other than even ones, and the words at those of x."""
        draw, s = self.drawing, self.drawing.scale
        left, bottom, right, top = self.box
        xs = self.x.ticks(right - left, 62 * s) if xs is None else xs
        ys = self.y.ticks(top - bottom, 34 * s) if ys is None else ys
        for x in xs:
            draw.stroke(self.place(x, [self.y.low, self.y.high]), "grid")
        for y in ys:
            draw.stroke(self.place([self.x.low, self.x.high], y), "grid")
        draw.stroke([(left, top), (left, bottom), (right, bottom)], "muted")
        words = [tick(x) for x in xs] if words is None else words
        places = self.place(xs, self.y.low)[:, 0] if len(xs) else []
        for i in apart(places, [(width_of(w, TICK) + 6) * s for w in words]):
            draw.text(words[i], (places[i], bottom - 10 * s), "muted", size=TICK)
        for y in ys:
            draw.text(tick(y), (left - 6 * s, self.place(self.x.low, y)[1]), "muted", (1.0, 0.5), TICK)
        draw.text(self.x.title, ((left + right) / 2, bottom - 27 * s), "ink", size=12.0)
        draw.text(self.y.title, (left, top + 12 * s), "ink", (0.0, 0.5), 12.0)

    def line(self, x, y, color, width=1.6, opacity=1.0):
        """A polyline through values, cut at the frame's foot and head; NaN ends a piece."""
        points = self.place(x, y)
        out = np.sign(points[:, 1] - np.clip(points[:, 1], self.box[1], self.box[3]))
        hidden = (out != 0) & (np.roll(out, 1) == out) & (np.roll(out, -1) == out)  # both its ends lie beyond the frame
        points[:, 1] = np.clip(points[:, 1], self.box[1], self.box[3])
        known = np.isfinite(points).all(axis=1) & ~hidden
        for piece in np.split(np.arange(len(points)), np.flatnonzero(np.diff(known)) + 1):
            if len(piece) > 1 and known[piece[0]]:
                self.drawing.stroke(points[piece], color, width, opacity)


def colorbar(gpu, drawing, box, axis):
    """The colours of the map from the axis's low end to its high one, with its ticks at the right. box: pixels."""
    s = drawing.scale
    left, bottom, right, top = np.round(box)
    size = (max(int(right - left), 1), max(int(top - bottom), 1))
    target = gpu.target("colorbar", size, 4, "f1")
    gpu.draw(gpu.program(assemble("views/colorbar.frag")), target, {"box": (0.0, 0.0, *map(float, size))})
    drawing.raster((left, bottom), target)
    values = axis.ticks(top - bottom, 30 * s)
    values = np.append(values[values < axis.high], axis.high)
    heights = bottom + axis.share(values) * (top - bottom)
    for i in apart(heights, np.full(len(values), 13 * s)):
        drawing.text(tick(values[i]), (right + 6 * s, heights[i]), "muted", (0.0, 0.5), TICK)


def tick(value):
    """A tick's value in few letters."""
    return number(value, 3) if value else "0"

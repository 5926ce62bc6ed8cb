"""The least sufficient model: the reference's picture, that of the cheapest methods that are enough, and what they differ in."""

import time
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..measure.advice import EXACT, HEADS, amount, factor, of_what, rows, sentences, tone
from ..measure.error import METRICS
from ..measure.least import least
from ..measure.questions import at, questions, settled
from ..model import Invalid, choice, param
from .compare import HEAD, difference_map, layout, side_of
from .develop import develop
from .drawing import Drawing, Drawn, cut, width_of, wrapped
from .pace import REDRAWN

PICTURED = tuple(name for name, metric in METRICS.items() if metric.compares == "pictures")
TITLE, ROW, LINE = 30, 19, 15  # points: the heading, a row of the table, a line of words
MARGIN, GAP = 14, 18  # points beside all, and between the table's columns
WORDS, SMALL = 11.5, 10.5  # height of letters, points
SIDE = 170  # points of a picture's side for which words give way
SPARED = (2, 5, 4, 3)  # columns of the table that a narrow one does without, the first first


@dataclass(frozen=True)
class Least(Drawn):
    """The cheapest methods, jointly, whose sphere stays within a tolerance of the most accurate ones' in this scene."""

    title = "Least"
    instrument = True

    tolerance: float = param(0.01, 1e-9, 10.0, "error of the sphere that is small enough", scale="log")
    metric: str = choice("picture", PICTURED, "measure of the sphere's error")

    def shows(self, state):
        return (self, state.material, state.light, state.views["sphere"], state.look)

    def answer(self, gpu, state):
        """The Sufficient model, as the result of a generator that yields what it does in a few words. Raises Invalid."""
        return least(gpu, state, self.tolerance, self.metric)

    def drawings(self, gpu, state, size, scale=1.0):
        asked, _ = questions(state, self.metric)
        top = [q.top for q in asked]
        reference = Sphere(gpu.beside("least reference"), at(state, asked, top), using(asked, top))
        page = Page(self, gpu, state, size, scale)
        answering, answer = self.answer(gpu, state), None
        drawn, since = None, 0.0
        while answer is None:
            try:
                doing = next(answering)
            except StopIteration as end:
                answer = end.value
                break
            except Invalid as reason:
                yield page.refusal(str(reason)), "", True
                return
            if drawn is None or time.perf_counter() - since > REDRAWN:
                drawn, since = page.progress(asked, reference, doing), time.perf_counter()
            yield drawn, doing, False
        noise = state.views["sphere"].noise  # what is shown may have as much as elsewhere
        chosen = using([s.question for s in answer.steps], [s.question.methods.index(s.chosen) for s in answer.steps])
        reduced = Sphere(gpu.beside("least reduced"), answer.reduced.with_view("sphere", noise=noise), chosen)
        side = page.room(rows(answer), sentences(answer)).side
        drawn, done = None, False
        while not done:
            for sphere in (reference, reduced):
                sphere.better(side)
            done = reference.picture.done and reduced.picture.done
            if done or drawn is None or time.perf_counter() - since > REDRAWN:
                drawn, since = page.answered(answer, (reference, reduced)), time.perf_counter()
            yield drawn, "" if done else reduced.picture.note, done


class Sphere:
    """The picture of a state's sphere, better and better. change: what a click on it does to a state."""

    def __init__(self, gpu, state, change):
        self.gpu, self.state, self.change = gpu, state, change
        self.run, self.picture, self.side = None, None, 0

    def better(self, side):
        """One pass more, or the first one at another size."""
        if side != self.side:
            self.run, self.side = self.state.views["sphere"].pictures(self.gpu, self.state, (side, side)), side
        self.picture = next(self.run, self.picture)

    def pixels(self):
        """Linear (side, side, 4), without what lies behind."""
        return self.gpu.pixels(self.target)

    @property
    def target(self):
        return self.gpu.target("sphere", (self.side, self.side))


class Room(NamedTuple):
    """Boxes and side of the pictures in pixels; in points how high the lines and the table stand, and the table's upper edge
    above that, 0 for no table; the lines with their colours."""

    boxes: list
    side: int
    lift: float
    table: float
    lines: list


class Page:
    """Draws what is known."""

    def __init__(self, view, gpu, state, size, scale):
        self.view, self.gpu, self.state, self.size, self.scale = view, gpu, state, size, scale
        self.width, self.height = np.divide(size, scale)

    def begin(self):
        draw = Drawing(self.size, self.scale, self.state.look.theme)
        tolerance = amount(self.view.tolerance, self.view.metric)
        name = self.state.material.name
        words = f"{name}: the cheapest methods whose sphere stays within {tolerance} of the reference's"
        words = fitting((words, f"{name}: the least within {tolerance}"), self.width - 2 * MARGIN, 13.5)
        self.write(draw, words, MARGIN, self.height - 15, size=13.5)
        return draw

    def write(self, draw, words, x, y, color="ink", anchor=(0.0, 0.5), size=WORDS):
        """Words at a place in points."""
        draw.text(words, (x * self.scale, y * self.scale), color, anchor, size)

    def refusal(self, reason):
        draw = self.begin()
        for i, line in enumerate(wrapped([reason], self.width - 2 * MARGIN, 12.5)):
            if self.height - 44 - 18 * i > 10:
                self.write(draw, line, MARGIN, self.height - 44 - 18 * i, "muted", size=12.5)
        return draw

    def progress(self, asked, reference, doing):
        """The reference and the questions, while the answer is looked for."""
        draw = self.begin()
        found = [(q.ladder.name, "", q.methods[q.top].name, "", "", "") for q in asked]
        room = self.room(found, [f"Looking: {doing}."])
        self.words(draw, room, found)
        reference.better(room.side)
        self.sphere(draw, room.boxes[0], reference, ("Reference",), "the most accurate methods")
        for box, name in zip(room.boxes[1:], ("Reduced", "Difference"), strict=True):
            self.head(draw, box, (name,))
            left, bottom, right, top = box
            draw.text("measuring ...", ((left + right) / 2, (bottom + top) / 2), "muted", size=WORDS)
        return draw

    def answered(self, answer, spheres):
        """All of it."""
        draw = self.begin()
        room = self.room(rows(answer), sentences(answer))
        self.words(draw, room, rows(answer), answer)
        dropped = [s for s in answer.steps if s.dropped]
        faster = f"{factor(answer.ratio.median)} x" if answer.ratio and dropped else ""
        reduced = (f"Reduced, {faster} faster", f"Reduced, {faster}", "Reduced") if faster else ("Reduced",)
        used = [f"{s.question.ladder.name}: {s.reference.name}" for s in answer.steps]
        self.sphere(draw, room.boxes[0], spheres[0], ("Reference",), "\n".join(used))
        used = [f"{s.question.ladder.name}: {s.chosen.name}" for s in answer.steps]
        self.sphere(draw, room.boxes[1], spheres[1], reduced, "\n".join(used))
        self.difference(draw, room.boxes[2], answer, spheres)
        return draw

    def head(self, draw, box, choices):
        """The longest of some titles of a picture that has room."""
        left, _, right, top = box
        words = fitting(choices, (right - left) / self.scale, WORDS)
        draw.text(words, (left, top + 11 * self.scale), "ink", (0.0, 0.5), WORDS)

    def sphere(self, draw, box, sphere, name, methods):
        """A sphere, which a click loads."""
        self.head(draw, box, name)
        left, bottom, right, top = box
        developed = develop(sphere.gpu, sphere.picture, self.state.look)
        width, height = developed.size
        corner = np.round([(left + right - width) / 2, (bottom + top - height) / 2])
        draw.raster(corner, developed)
        draw.link((*corner, *(corner + developed.size)), f"{methods}\nclick: to these methods", sphere.change)

    def difference(self, draw, box, answer, spheres):
        targets = [s.target for s in spheres]
        pixels = [s.pixels() for s in spheres]
        largest = difference_map(self.gpu, draw, "least difference", box, targets, pixels)
        if largest is None or largest < EXACT:
            words = ("Difference: none" if largest else "Difference: the reference is black", "Difference")
        else:
            spread = f"±{amount(largest, 'picture')}"
            words = (
                f"Difference of luminance, {spread} of the mean, red: brighter",
                f"Difference, {spread}",
                f"Δ {spread}",
            )
        self.head(draw, box, words)
        covered = pixels[0][..., 3] > 0
        mean, other = (float(p[covered][:, :3].mean()) for p in pixels)
        tips = [
            "Reduced less reference, of the reference's mean; red where it is brighter",
            f"{of_what(answer)}: {amount(answer.error.value, answer.metric)}",
            f"on average: {tone(other / mean - 1) or 'as bright'}" if mean > 0 else "the reference is black",
        ]
        draw.link(box, "\n".join(tips))

    def room(self, found, told):
        """The Room of a table of rows, of sentences as far as they leave the pictures room, and of those."""
        lines, ends = [], [0]
        for i, sentence in enumerate(told):
            color = "ink" if i < 2 else "muted"
            lines += [(line, color) for line in wrapped([sentence], self.width - 2 * MARGIN, WORDS)]
            ends.append(len(lines))
        above = self.size[0], self.size[1] - TITLE * self.scale
        table = ROW * (len(found) + 1) + 16
        most = side_of(dict(enumerate(layout(above, self.scale, 3, 6))))
        for high, count in [*((table, n) for n in reversed(ends)), (0, 0)]:
            foot = LINE * count + 10 * (count > 0) + 6
            boxes = layout(above, self.scale, 3, high + foot)
            side = side_of(dict(enumerate(boxes)))
            if side >= min(SIDE * self.scale, most):
                break
        heights = len({top for *_, top in boxes}) * (side + HEAD * self.scale) + (high + foot) * self.scale
        lift = max(above[1] - heights, 0.0)  # all stands below the heading, without gaps
        boxes = layout((above[0], above[1] - lift), self.scale, 3, high + foot)
        boxes = [(left, bottom + lift, right, top + lift) for left, bottom, right, top in boxes]
        return Room(boxes, side, lift / self.scale, high and high + foot, lines[:count])

    def words(self, draw, room, found, answer=None):
        """Write the table and the lines."""
        for i, (line, color) in enumerate(room.lines):
            y = room.lift + LINE * (len(room.lines) - i - 0.5) + 6
            self.write(draw, line, MARGIN, y, color)
        if room.table:
            self.table(draw, found, room.lift + room.table - 6, answer)

    def table(self, draw, found, top, answer):
        """The table of ladders with its upper edge at `top`, points."""
        width = self.width
        columns = list(range(len(HEADS)))
        wide = [max(width_of(row[i], WORDS) for row in [HEADS, *found]) + GAP for i in columns]
        for i in (None, *SPARED):
            columns = [c for c in columns if c != i]
            if sum(wide[c] for c in columns) <= width - 2 * MARGIN + GAP:
                break
        s = self.scale
        rule = (top - ROW) * s
        draw.stroke([(MARGIN * s, rule), ((width - MARGIN) * s, rule)], "grid")
        for j, row in enumerate([HEADS, *found]):
            x, y = MARGIN, top - ROW * (j + 0.5) - 2 * (j > 0)
            for c in columns:
                dropped = j > 0 and answer and answer.steps[j - 1].dropped
                color = "muted" if j == 0 else "green" if dropped and c == 1 else "ink"
                self.write(draw, row[c], x, y, color, size=SMALL if j == 0 else WORDS)
                x += wide[c]
            if j > 0 and answer:
                question = answer.steps[j - 1].question
                tip = f"{question.ladder.question}\n{', '.join(m.name for m in question.methods)}"
                draw.link((MARGIN * s, (y - ROW / 2) * s, (width - MARGIN) * s, (y + ROW / 2) * s), tip)


def fitting(choices, room, size):
    """The first of some words that has `room` points, or what of the last has."""
    return next((w for w in choices if width_of(w, size) <= room), cut(choices[-1], room, size))


def using(asked, combination):
    """A function that gives a state the methods of a combination, and all the samples that it says."""
    return lambda state: settled(at(state, asked, combination))

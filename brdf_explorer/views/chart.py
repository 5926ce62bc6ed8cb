"""Speed against accuracy: the methods of a ladder by what they cost and how far they are from its reference."""

import time
from dataclasses import dataclass

import numpy as np

from ..ladder import LADDERS
from ..measure.cost import FLOOR, SIZE
from ..measure.error import METRICS
from ..measure.tradeoff import effort, seconds, tradeoffs
from ..model import choice, param
from .axes import Axes, Axis
from .diagram import number
from .drawing import Drawing, Drawn, cut, width_of, wrapped
from .pace import REDRAWN

NOTHING = "No question with several methods arises for this material in this light."
UNITS = {"evaluation": ("cost of an evaluation", "ns", 1e9), "sample": ("cost of a sample", "ns", 1e9)}
UNITS |= {"frame": ("cost of a frame", "ms", 1e3)}
SPAN = 12  # most decades of error that are shown
MARK = 10  # diameter of a mark, points
STRIP = 30  # height of the strip of exact methods, points
SMALL = 10.5  # height of small print, points
SHARE = 4  # and at least this times what drawing took
ASKED = 16  # points from one line of a question to the next
TALL = 162  # points of a panel whose chart leaves no room for a second one, and without a chart
LOW = 62
NARROW = 300  # points that each of several charts side by side takes at least
NEAR = 100  # points from a mark to its name, and more only if it would meet lines of the chart there
FARTHEST = 400  # and at most
SHAPE = 1.4  # width over height that suits a chart


@dataclass(frozen=True)
class Chart(Drawn):
    """Cost against error of the methods that answer one question, measured on this machine while it is on screen."""

    title = "Chart"
    instrument = True

    ladder: str = choice("shadowing", (*LADDERS, "all"), "the question whose methods are compared")
    error: str = choice("own", ("own", *METRICS), "measure of error; own: the one that suits the question")
    cost: str = choice(
        "evaluation", ("evaluation", "frame"), "time of an evaluation of f, or of a pass of the sphere in the window"
    )
    tolerance: float = param(0.01, 1e-9, 10.0, "error that is small enough", scale="log")

    def shows(self, state):
        return (self, state.model, state.light, state.views["sphere"], state.look.theme)

    def ladders(self, state):
        """The ladders to show: the one chosen, or all that arise for the state."""
        return [LADDERS[self.ladder]] if self.ladder != "all" else [k for k in LADDERS.values() if k.applies(state)]

    def measured(self, gpu, state):
        """Yield the list of Tradeoffs, better from one to the next; the last one's `doing` is "" when all are finished."""
        sphere = gpu.targets.get("window sphere")
        size = sphere[0].size if sphere else SIZE
        finished = []
        for ladder in self.ladders(state):
            for found in tradeoffs(gpu, ladder, state, self.error, self.cost, size):
                yield [*finished, found], False
            finished.append(found)
        yield finished, True

    def drawings(self, gpu, state, size, scale=1.0):
        drawn, since, took = None, 0.0, 0.0
        for found, done in self.measured(gpu, state):
            begun = time.perf_counter()
            anew = done or drawn is None or begun - since > max(REDRAWN, SHARE * took)
            if anew:
                drawn = self.drawing(gpu, state, found, size, scale)
            yield drawn, "" if done else f"measuring {found[-1].ladder.name}: {found[-1].doing or 'begins'}", done
            if anew:
                since = time.perf_counter()
                took = since - begun

    def drawing(self, gpu, state, found, size, scale):
        """The Drawing of some Tradeoffs."""
        draw = Drawing(size, scale, state.look.theme)
        width, height = size
        pixels = sorted({t.size for t in found if t.repeats})
        print_ = [gpu.device]
        if pixels:
            each = " and ".join(f"{w}x{h}" for w, h in pixels)
            repeats = sorted({t.repeats for t in found if t.repeats})
            repeats = f"{repeats[0]} to {repeats[-1]}" if len(repeats) > 1 else str(repeats[0])
            print_.append(f"draws of {each} pixels, {repeats} repeats in turns, medians and quartiles")
        print_.append(
            "line: Pareto front; green: cheapest within the tolerance; ring: in use; hollow: outside its domain"
        )
        lines = wrapped(print_, width / scale - 24, SMALL) if height > 260 * scale and width > 200 * scale else []
        foot = (24 + 14 * len(lines)) * scale
        for i, words in enumerate(lines):
            draw.text(words, (12 * scale, foot - (6 + 14 * i) * scale), "muted", (0.0, 0.5), SMALL)
        total = len(self.ladders(state))
        if total == 0:
            for i, words in enumerate(wrapped([NOTHING], width / scale - 24, 12.5)):
                draw.text(words, (12 * scale, height - (20 + 18 * i) * scale), "muted", (0.0, 0.5), 12.5)
            return draw
        columns, rows = layout(total, width, height - foot, NARROW * scale)
        for i, tradeoff in enumerate(found):
            row, column = divmod(i, columns)
            left, top = column * width / columns, height - row * (height - foot) / rows
            box = (left, top - (height - foot) / rows, left + width / columns, top)
            self.panel(draw, box, tradeoff, state)
        return draw

    def panel(self, draw, box, found, state):
        """One ladder's chart in a box of the drawing."""
        s = draw.scale
        left, bottom, right, top = box
        room = (right - left) / s - 24
        if room < 40 or top - bottom < 30 * s:
            return
        asked = wrapped([found.ladder.question], room, 13.5)
        height = (top - bottom) / s
        if (len(asked) - 1) * ASKED > height - (TALL if height >= TALL else LOW):
            asked = [cut(found.ladder.question, room, 13.5)]
        for i, words in enumerate(asked):
            draw.text(words, (left + 12 * s, top - (15 + ASKED * i) * s), "ink", (0.0, 0.5), 13.5)
        top -= ASKED * (len(asked) - 1) * s
        if found.reason:
            for i, words in enumerate(wrapped([found.reason], room, 12.5)):
                y = top - (44 + 18 * i) * s
                if y > bottom + 10 * s:
                    draw.text(words, (left + 12 * s, y), "muted", (0.0, 0.5), 12.5)
            return
        about = f"against {found.reference}"
        if found.own:
            about += f", itself known to {number(found.own.error, 2)}"
        if found.kind == "sample":
            about = "green: the least time to any error, cost × error²"
        draw.text(cut(about, room, 11.0), (left + 12 * s, top - 33 * s), "muted", (0.0, 0.5), 11.0)
        frame = (left + 58 * s, bottom + 42 * s, right - 18 * s, top - 70 * s)
        if frame[2] - frame[0] < 60 * s or frame[3] - frame[1] < 50 * s:
            best = found.best(self.tolerance)
            told = f"green would be: {best.name}" if best else "none is within the tolerance"
            if top - bottom > LOW * s and not found.doing:
                words = cut(f"No room for the chart; {told}.", room, 11.0)
                draw.text(words, (left + 12 * s, top - 51 * s), "muted", (0.0, 0.5), 11.0)
            return
        self.plot(draw, frame, found, state, room - 46)

    def plot(self, draw, frame, found, state, room):
        s = draw.scale
        left, bottom, right, top = frame
        words, unit, per = UNITS[found.kind]
        metric = METRICS[found.metric]
        known = [p for p in found.points if p.known]
        current = found.ladder.current(state)
        best = found.best(self.tolerance)
        dashed = found.kind != "sample"
        # ranges
        costs = [per * max(c, FLOOR) for p in known for c in p.cost[:3]] or [1.0]
        middle = np.sqrt(min(costs) * max(costs))
        reach = max(1.3 * max(costs) / middle, 2.0)
        x = Axis(middle / reach, middle * reach, cut(f"{words} [{unit}]", room, 12.0), "log")
        errors = [p.error.value for p in known if not p.exact] + [self.tolerance] * (dashed or not known)
        high = 10.0 ** np.ceil(np.log10(max(errors)) + 0.05)
        low = max(10.0 ** np.floor(np.log10(min(errors)) - 0.05), high / 10.0**SPAN)
        strip = STRIP * s if dashed else 0.0  # no sampler is exact
        share = strip / (top - bottom)
        y = Axis(low * (low / high) ** (share / (1 - share)), high, cut(metric.title, room, 12.0), "log")
        axes = Axes(draw, frame, x, y)
        draw.fill((left, bottom, right, bottom + strip), "backdrop")
        ticks = Axis(low, high, "", "log").ticks(top - bottom - strip, 34 * s)
        axes.frame(ys=ticks)
        if dashed:
            draw.text("exact", (left - 6 * s, bottom + strip / 2), "muted", (1.0, 0.5), 11.0)
            line = axes.place(x.low, self.tolerance)[1]
            for at in np.arange(left, right - 3 * s, 9 * s):
                draw.stroke([(at, line), (min(at + 5 * s, right), line)], "green", 1.2)
        if not known:
            draw.text("measuring ...", ((left + right) / 2, (top + bottom) / 2 + strip / 2), "muted")
            return

        def spot(p):
            at = axes.place(per * seconds(p), max(p.error.value, 1e-300))
            return np.array([at[0], bottom + strip / 2 if p.exact else max(at[1], bottom + strip)])

        spots = {p.name: spot(p) for p in known}
        front = [spots[p.name] for p in found.front()]
        steps = [at for a, b in zip(front, front[1:], strict=False) for at in (a, (b[0], a[1]))] + front[-1:]
        draw.over()
        if len(steps) > 1:
            draw.stroke(steps, "blue", 1.4, 0.55)
        blocked = Blocked((left + 2 * s, bottom + 2 * s, right - 2 * s, top - 2 * s))
        for a, b in zip(steps, steps[1:], strict=False):
            blocked.add_line((*(np.minimum(a, b) - s), *(np.maximum(a, b) + s)))
        draw.over()
        for p in known:
            at, color = spots[p.name], "green" if p is best else "blue"
            lows, highs = (axes.place(per * max(c, FLOOR), y.low)[0] for c in (p.cost.low, p.cost.high))
            draw.stroke([(lows, at[1]), (highs, at[1])], color, 1.0)
            blocked.add_line((lows, at[1] - s, highs, at[1] + s))
            if not p.exact:
                span = np.array([p.error.value - p.error.error, p.error.value + p.error.error])
                ends = np.clip(axes.place(x.low, np.maximum(span, 1e-300))[:, 1], bottom + strip, top)
                draw.stroke([(at[0], ends[0]), (at[0], ends[1])], color, 1.0)
                blocked.add_line((at[0] - s, ends[0], at[0] + s, ends[1]))
        draw.over()
        for p in known:
            at = spots[p.name]
            if p.method is current:
                turn = np.linspace(0, 2 * np.pi, 33)
                ring = (MARK / 2 + 4) * s
                draw.stroke(at + ring * np.stack([np.cos(turn), np.sin(turn)], axis=-1), "accent", 2.0)
            draw.dot(at, "green" if p is best else "blue", MARK)
            half = (MARK / 2 + (5 if p.method is current else 1)) * s
            blocked.add((*(at - half), *(at + half)))
        draw.over()
        for p in known:
            if p.outside:
                draw.dot(spots[p.name], "paper", MARK - 4)
        draw.over()
        if dashed:
            told = f"within {self.tolerance:g}: {best.name if best else 'none'}"
            spots_told = ((right - 4 * s, 1.0), (left + 4 * s, 0.0), ((left + right) / 2, 0.5))
            places = [(at, line + d * s, anchor) for at, anchor in spots_told for d in (9, -9)]
            label(draw, blocked, told, places, "green", 11.5)
        # names: those that matter most first
        for p in sorted(known, key=lambda p: (p is not best, p.method is not current, bool(p.outside))):
            at = spots[p.name]
            color = "ink" if p.method is current or p is best else "muted"
            box = label(draw, blocked, p.name, around(at, s), color, 12.0, at)
            tip, loads = self.tip(found, p), loading(found.ladder, p.method)
            for place in [(*(at - 9 * s), *(at + 9 * s))] + [box] * (box is not None):
                draw.link(place, tip, loads)

    def tip(self, found, p):
        """What is known of a point, line by line."""
        _, unit, per = UNITS[found.kind]
        cost, (value, own) = p.cost, p.error
        lines = [
            f"{p.name}{' (the reference)' if p.name == found.reference else ''}",
            f"{number(per * cost.median)} {unit} a{'n' * (found.kind == 'evaluation')} {found.kind}"
            f"{', lost in noise' * (cost.median <= FLOOR)}, "
            f"quartiles {number(per * cost.low)} to {number(per * cost.high)}, {cost.repeats} repeats",
            f"{METRICS[found.metric].title}: {number(value, 3)} ± {number(own, 2)}",
        ]
        if found.kind == "sample":
            lines.append(f"cost × error²: {number(per * effort(p))} {unit}")
        if p.outside:
            lines.append(f"outside its domain: {p.outside}")
        if p.method.changes is None:
            lines.append("only measured: what is on screen is drawn in float32")
        return "\n".join(lines)


def loading(ladder, method):
    """A function that gives a state the method, where its question arises; None if no state holds it."""
    return None if method.changes is None else lambda now: ladder.at(now, method) if ladder.applies(now) else now


def layout(total, width, height, least):
    """Columns and rows of `total` boxes of a shape near to SHAPE; several columns are at least `least` wide."""

    def away(columns):
        return abs(np.log(width / columns / (max(height, 1) / -(-total // columns)) / SHAPE))

    columns = min(range(1, min(max(int(width / least), 1), max(total, 1)) + 1), key=away)
    return columns, -(-total // columns)


class Blocked:
    """What no further label may meet, within a box that it may not leave: boxes of left, bottom, right, top in pixels.

    Words and marks are met by none, lines by those only that find no other place.
    """

    def __init__(self, inside):
        self.inside, self.boxes, self.lines, self.words = inside, [], [], []

    def add(self, box):
        self.boxes.append(box)

    def add_line(self, box):
        self.lines.append(box)

    def over_words(self, start, end):
        """Whether a straight line meets a label."""
        along = start + np.linspace(0, 1, 17)[:, None] * (end - start)
        return any(np.any(np.all((along > box[:2]) & (along < box[2:]), axis=1)) for box in self.words)

    def free(self, box, of_lines=True):
        left, bottom, right, top = box
        a, b, c, d = self.inside
        within = left >= a and bottom >= b and right <= c and top <= d
        others = self.boxes + self.lines * of_lines
        return within and not any(left < o[2] and o[0] < right and bottom < o[3] and o[1] < top for o in others)


def around(at, scale):
    """Places for a name (x, y, anchor) about a mark, from the nearest on."""
    for distance in (12, 20, 32, 46, *range(62, FARTHEST, 12)):
        d = distance * scale
        for x, y, anchor in ((1, 0, 0), (-1, 0, 1), (0, 1, 0.5), (0, -1, 0.5), (0.8, 0.7, 0), (0.8, -0.7, 0)):
            yield at[0] + x * d, at[1] + y * d, anchor
        for x, y, anchor in ((-0.8, 0.7, 1), (-0.8, -0.7, 1)):
            yield at[0] + x * d, at[1] + y * d, anchor


def label(draw, blocked, words, places, color, size, mark=None):
    """Write words at the first of some places that is free, at least of words and marks; the box taken, or None.

    A line leads to a mark that is far, over other words if there is no other way; words hide the lines that they meet.
    """
    s = draw.scale
    width, height = (width_of(words, size) + 4) * s, 1.15 * size * s
    places = list(places)
    for of_lines, of_words in ((True, True), (False, True), (False, False)):
        for x, y, anchor in places:
            left = x - anchor * width
            box = (left, y - height / 2, left + width, y + height / 2)
            if not blocked.free(box, of_lines):
                continue
            if mark is not None:
                near = np.clip(mark, box[:2], box[2:])
                far = np.linalg.norm(near - mark) / s
                if of_lines and far > NEAR or of_words and blocked.over_words(mark, near):
                    continue
                if far > 20:
                    draw.stroke([mark + (near - mark) * 0.35, near], "muted", 0.8)
            if not blocked.free(box):
                draw.over()
                draw.fill(box, "paper")
            blocked.add(box)
            blocked.words.append(box)
            draw.text(words, (x, y), color, (anchor, 0.5), size)
            return box
    return None

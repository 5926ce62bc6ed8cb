"""The readings: where a formula of the lecture errs or can be read in two ways, both, and what the wrong one costs."""

import time
from dataclasses import dataclass, replace

import numpy as np

from ..measure.readings import COARSE, FINE, READINGS, finding, found
from ..model import choice
from .axes import Axes, Axis
from .diagram import number
from .drawing import Drawing, Drawn, width_of, wrapped
from .picture import Curves

LINE = 1.45  # from line to line, over a line's height
MARGIN = 14  # points
WIDE = 620  # points from which words and curves stand side by side
COLUMN = 0.5  # share of a wide picture that the words have
LOW = {True: 330, False: 520}  # points, by whether it is wide, below which a picture has its words in few lines
LEAST_PLOT = (150, 60)  # points of the frame of the curves, below which they are left out
AROUND = (56, 42, 20, 40)  # points from that frame to the ends of its part: left, below, right, above
NUMBER = 60  # points of a column of numbers
FACTOR = 330  # points of a table from which it has their quotient too
STYLE = {"printed": ("red", "as printed"), "right": ("blue", "right")}


@dataclass(frozen=True)
class Words:
    """What is said of a reading: the slide's title, the formulas as printed and as they are right, a line each, and why.

    sphere: the choices of a material that put the right one on the sphere, or None.
    """

    name: str
    slide: str
    printed: tuple
    right: tuple
    why: str
    sphere: dict | None = None


WORDS = {
    "stretching": Words(
        "stretching",
        "Anisotropic Distributions via Stretching",
        ("sx = αy / αx", "directions (x, y, z) become (sx x, y, z)"),
        ("directions (x, y, z) become (x / sx, y, z)", "normals become v = (sx x, y, z), and D has sx / |v|⁴"),
        "The surface becomes isotropic when it shrinks along x by sx. Rays shrink with it; normals, which stand on it, turn the "
        "other way. So the printed factor is right for D and wrong for Λ and G.",
        {},
    ),
    "correlated": Words(
        "correlated G",
        "Joint Masking-Shadowing",
        ("correlated: G(ωi, ωo) ≈ G(ωi)",),
        ("G(ωi, ωo) ≈ min(G(ωi), G(ωo))", "by heights: G = 1 / (1 + Λ(ωi) + Λ(ωo))"),
        "Where one hides all that the other does, the stronger one counts. G of the light alone forgets what hides facets from "
        "the viewer: light and viewer cannot be exchanged, and more light leaves than comes.",
        {"shadowing": "full"},
    ),
    "fresnel": Words(
        "Fresnel",
        "Torrance-Sparrow BRDF",
        ("f = D(ωh) G(ωi, ωo) Fr(ωo) / (4 cos θi cos θo)",),
        ("f = D(ωh) G(ωi, ωo) Fr(ωo · ωh) / (4 cos θi cos θo)",),
        "The angle of incidence is that at the facet, whose normal is ωh. With θo instead, a grazing viewer sees every facet as "
        "a grazing mirror, and light and viewer cannot be exchanged.",
        {},
    ),
    "slope": Words(
        "mean slope",
        "Beckmann Distribution",
        ("α = √2 σ / τ, mean slope",),
        (
            "α = √2 σ / τ if C(r) = σ² exp(−r² / 2τ²)",
            "α = 2 σ / τ if C(r) = σ² exp(−r² / τ²)",
            "α is the rms of |grad h|",
        ),
        "Slopes depend on the heights' autocorrelation C: α² = −2 C''(0). With the τ of Beckmann and Spizzichino, where C falls "
        "to 1/e, the printed α is √2 too small. The mean of |grad h| is α √π / 2.",
    ),
    "mirrors": Words(
        "mirrors",
        "Specular Microfacets Redux",
        ("fmf = δ(ωi − R(ωh, ωo)) / (ωi · ωh)", "gives the Torrance-Sparrow model"),
        ("fmf = F(ωi · ωh) δ(ωi − R(ωh, ωo)) / (ωi · ωh)",),
        "The δ alone reflects all light, so the integral gives D G / (4 cos θi cos θo), without F. Its ωh and its dωm are one "
        "variable.",
        {},
    ),
    "fourier": Words(
        "Eq. 27",
        "Lambertian Generalizations",
        ("the first-order mode f(1) is Eq. 27", "f = f(0) + f(1) cos φ + f(2) cos 2φ"),
        ("f = f(0) + 2 f(1) cos φ + 2 f(2) cos 2φ",),
        "Eq. 27 of d'Eon 2021 is a Fourier coefficient, the mean of f cos φ over φ. As cos² φ has the mean 1/2, modes from the "
        "first on count twice. The albedo is the same in both readings.",
        {},
    ),
    "slab": Words(
        "thin slab",
        "Thin Dielectric BSDF",
        ("T' = TT + TRRT + TRRRTT + ... = 1 − R'", "R' = R + T²R / (1 − R²)"),
        ("T' = TT + TRRT + TRRRRT + ... = T² / (1 − R²)", "R' = 2R / (1 + R) if T = 1 − R"),
        "Each further term reflects twice more, R², and still enters and leaves once. As printed R' is 0/0 where R = 1, and T' "
        "is 1 − R' only if nothing is absorbed.",
    ),
}


@dataclass(frozen=True)
class Readings(Drawn):
    """Where the lecture errs or is ambiguous: both readings over an angle, and what the wrong one costs."""

    title = "Readings"
    instrument = True

    reading: str = choice("stretching", tuple(WORDS), "the formula that has two readings")

    def shows(self, state):
        return (self, state.material, state.directions, state.look.theme)

    def question(self, state, effort=FINE):
        """The arguments of measure.readings.found and finding."""
        at = state.directions
        return self.reading, state.model, float(np.radians(at.theta_o)), float(np.radians(at.phi_o)), effort

    def table_of(self, gpu, state):
        """Both readings, and others beside them, as Curves over an angle in degrees."""
        f = found(*self.question(state))[0]
        return Curves(f"{f.angle} [deg]", f.x, f.curves)

    def drawings(self, gpu, state, size, scale=1.0):
        draw, start = None, time.perf_counter()
        for effort in (COARSE, FINE):
            one = finding(*self.question(state, effort))
            while one.result is None:
                one.step()
                if gpu.pace is not None and time.perf_counter() - start >= gpu.pace:
                    yield draw, "", False
                    start = time.perf_counter()
            draw = Drawing(size, scale, state.look.theme)
            self.page(draw, state, *one.result)
            yield draw, "", effort is FINE
            start = time.perf_counter()

    def page(self, draw, state, f, example):
        """Names of all readings, then words and curves of this one."""
        s, words = draw.scale, WORDS[self.reading]
        width, height = draw.size[0] / s, draw.size[1] / s
        top = height - self.names(draw)
        wide = width >= WIDE
        head = list(heading(words, height < LOW[wide]))
        rest = [*costs(f), *about(state, f, example), *reason(words)]
        if wide:
            column = Column(draw, MARGIN, COLUMN * width - MARGIN, top)
            fill(column, MARGIN, head + rest)
            self.sphere(draw, f, column)
            plot(draw, (COLUMN * width, 0.0, width, top), f)
            return
        column = Column(draw, MARGIN, width - MARGIN, top)
        foot = max(LEAST_PLOT[1] + AROUND[1] + AROUND[3], 0.37 * height)
        room = [top - sum(block[0](column) for block in blocks) for blocks in (head, head[1:])]
        if room[0] < foot <= room[1]:  # the slide's title gives way to the curves
            head = head[1:]
        elif room[1] < foot:
            foot = MARGIN
        fill(column, foot, head + rest)
        plot(draw, (0.0, 0.0, width, column.y), f)

    def names(self, draw):
        """A line of the readings' names, each a link, as many as have room; its height in points."""
        s, width = draw.scale, draw.size[0] / draw.scale
        y = draw.size[1] / s - 15
        parts = [(name, words.name) for name, words in WORDS.items()]
        if sum(width_of(w, 12.0) + 18 for _, w in parts) > width - 2 * MARGIN:
            parts = [(self.reading, WORDS[self.reading].name)]
        x = MARGIN
        for name, text in parts:
            extent = width_of(text, 12.0)
            here = name == self.reading
            draw.text(text, (x * s, y * s), "ink" if here else "accent", (0.0, 0.5), 12.0)
            if here:
                draw.stroke(np.array([(x, y - 10), (x + extent, y - 10)]) * s, "accent", 1.6)
            else:
                box = np.array([x - 4, y - 10, x + extent + 4, y + 10]) * s
                draw.link(box, WORDS[name].slide, reading_of(name))
            x += extent + 18
        return 36

    def sphere(self, draw, f, column):
        """A link to the sphere with the right reading, as printed, where it can be shown there."""
        words, s = WORDS[self.reading], draw.scale
        if words.sphere is None or column.y - MARGIN < 22:
            return
        text = "the right one on the sphere, formulas as printed"
        column.y -= 8
        y = column.y
        column.line(text, "accent", 12.0)
        box = np.array([MARGIN, column.y, MARGIN + width_of(text, 12.0), y]) * s
        draw.link(box, "click: this material with these formulas, on the sphere", self.printed(f.model))

    def printed(self, example):
        """A function that gives a state the right one of the formulas as printed; another material where it has none."""

        def change(state):
            model = example if READINGS[self.reading].applies(state.model) else state.model
            return state.with_model(replace(model, **WORDS[self.reading].sphere)).with_view(
                "sphere", formulas="textbook"
            )

        return change


def reading_of(name):
    """A function that shows a reading."""
    return lambda state: state.with_view("readings", reading=name)


class Column:
    """Lines of text from the top down between two edges, in points; y is where the next one begins."""

    def __init__(self, draw, left, right, y):
        self.draw, self.left, self.right, self.y = draw, left, right, y

    def wrapped(self, text, size):
        return wrapped([text], self.right - self.left, size)

    def line(self, text, color="ink", size=12.5, at=None, anchor=0.0):
        """A line; at: another place along it, which does not move on to the next."""
        s = self.draw.scale
        y = self.y - LINE * size / 2
        x = self.left if at is None else at
        self.draw.text(text, (x * s, y * s), color, (anchor, 0.5), size)
        if at is None:
            self.y -= LINE * size


# Blocks of words: (height(column), draw(column)), in the order in which they stand and are kept where there is little room.


def text(words, color="ink", size=12.5, before=0.0):
    def height(column):
        return before + LINE * size * len(column.wrapped(words, size))

    def write(column):
        column.y -= before
        for line in column.wrapped(words, size):
            column.line(line, color, size)

    return height, write


def heading(words, few):
    """Title and formulas; in few lines these are in the colours of their curves, else below the colours' names."""
    yield text(f"Slide “{words.slide}”", "muted", 12.5)
    for what, lines in (("printed", words.printed), ("right", words.right)):
        color, name = STYLE[what]
        if not few:
            yield text(name, color, 12.0, 8)
        for line in lines:
            yield text(line, color, 13.0) if few else text(line, "ink", 15.0)


def costs(f):
    """What the wrong reading costs: a table of each quantity by both."""

    def columns(column):
        """How many columns of numbers there are: the printed one, the right one, and their quotient where it has room."""
        return 3 if column.right - column.left >= FACTOR else 2

    def cells(column, words, size):
        count = columns(column)
        for i, (word, color) in enumerate(words[:count]):
            column.line(word, color, size, column.right - NUMBER * (count - 1 - i), 1.0)

    def head(column):
        column.y -= 14
        cells(column, (("as printed", "red"), ("right", "blue"), ("factor", "muted")), 12.0)
        column.line("What it costs", "muted", 12.0)

    def row(cost):
        def rows(column):
            right = column.right - NUMBER * columns(column)
            return Column(column.draw, column.left, right, column.y).wrapped(cost.name, 12.5)

        def write(column):
            factor = "" if np.isnan(cost.printed) or cost.right == 0 else f"× {number(cost.printed / cost.right, 3)}"
            cells(column, [(word, "ink") for word in (value(cost.printed), value(cost.right), factor)], 12.5)
            for line in rows(column):
                column.line(line)

        return lambda column: LINE * 12.5 * len(rows(column)), write

    first, *others = (row(cost) for cost in f.costs)
    # the head is of no use without a row
    yield lambda column: 14 + LINE * 12 + first[0](column), lambda column: (head(column), first[1](column))
    yield from others


def about(state, f, example):
    """What it is measured for."""
    at = state.directions
    viewer = f"θo\u00a0=\u00a0{at.theta_o:.3g}°"
    if len(set(getattr(f.model, "alpha", (0,)))) > 1:
        viewer += f", φo\u00a0=\u00a0{at.phi_o:.3g}°"
    if example:
        yield text(f"Example ({state.material.name}: {example}): {f.about}; {viewer}", "muted", 12.0, 10)
    else:
        yield text(f"{state.material.name}: {f.about}; {viewer}", "muted", 12.0, 10)


def reason(words):
    yield text(words.why, "ink", 12.5, 10)


def fill(column, foot, blocks):
    """Write blocks down to `foot`; where one has no room, those after it have none either."""
    for height, write in blocks:
        if column.y - height(column) < foot:
            return
        write(column)


def value(x):
    return "0/0" if np.isnan(x) else number(x, 3)


def plot(draw, box, f):
    """Both curves over the angle. box: left, bottom, right, top in points."""
    s = draw.scale
    left, bottom, right, top = box
    frame = (left + AROUND[0], bottom + AROUND[1], right - AROUND[2], top - AROUND[3])
    if frame[2] - frame[0] < LEAST_PLOT[0] or frame[3] - frame[1] < LEAST_PLOT[1]:
        return
    values = np.concatenate(list(f.curves.values()))
    scale, low, high = ranged(values)
    x, y = Axis(0.0, float(90 if f.x[-1] > 60 and f.x[-1] <= 90 else f.x[-1]), f.angle), Axis(low, high, "", scale)
    axes = Axes(draw, np.array(frame) * s, x, y)
    ticks = x.ticks((frame[2] - frame[0]) * s, 62 * s)
    if x.high in (90.0, 180.0):
        ticks = np.linspace(0, x.high, 4 if x.high == 90 else 5)
    axes.frame(ticks, [f"{abs(tick):.3g}°" for tick in ticks])
    if f.viewer is not None:
        axes.line([f.viewer] * 2, [low, high], "muted", 1.0)
        side = 1 if f.viewer < 0.9 * x.high else -1
        draw.text("θo", axes.place(f.viewer, high) + np.array([9 * side, -9]) * s, "muted", size=11.5)
        draw.over()
    draw.text(f.quantity, (frame[0] * s, (frame[3] + 28) * s), "ink", (0.0, 0.5), 12.0)
    others = iter(("purple", "green"))
    at = frame[0]
    for name, curve in f.curves.items():
        color, words = STYLE.get(name) or (next(others), name)
        axes.line(f.x, curve, color, 2.2 if name in STYLE else 1.6)
        draw.text(words, (at * s, (frame[3] + 12) * s), color, (0.0, 0.5), 11.5)
        at += width_of(words, 11.5) + 16


def ranged(values):
    """(scale, low, high) of an axis that shows all values: logarithmic where they go over some decades."""
    most, least = float(values.max()), float(np.min(values, where=values > 0, initial=np.inf))
    if most == 0:
        return "linear", 0.0, 1.0
    if most / least > 300:
        return "log", max(least, most / 1e12) / 1.3, most * 1.5
    return "linear", 0.0, most * 1.08

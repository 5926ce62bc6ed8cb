"""The stability map: where float32 fails, by function and regime of its arguments, in our form and in the printed one."""

from dataclasses import dataclass, replace

import numpy as np

from ..lib.common import mirror
from ..measure.grid import angles, direction
from ..measure.regimes import LIMIT, REGIMES
from ..measure.stability import stability
from ..measure.subjects import FORMS
from ..model import Param, choice, declared, param
from .diagram import number
from .drawing import Drawing, Drawn, cut, width_of
from .picture import rgb

COLORS = {  # of verdicts; errors by decades
    "light": {
        "fine": ("#e0f2f1", "#bfe3e2", "#93cdce"),
        "error": ("#fbc77d", "#f08c3a", "#cf3f08"),
        "nan": "#c800c8",
        "infinite": "#6d28d9",
        "negative": "#1e3a8a",
        "gain": "#f5d90a",
        "exchange": "#8a5a2b",
        "over": "#dfe3e9",
        "ill": "#dfe3e9",
        "hatch": "#b6bec9",
    },
    "dark": {
        "fine": ("#12363a", "#17494f", "#1d6068"),
        "error": ("#94610f", "#c46a1c", "#f0541e"),
        "nan": "#e232e2",
        "infinite": "#9061f9",
        "negative": "#4c6ef5",
        "gain": "#d6b70a",
        "exchange": "#a3744a",
        "over": "#343a45",
        "ill": "#343a45",
        "hatch": "#505866",
    },
}
WORDS = {  # what stands in a cell, and what it means
    "nan": ("NaN", "no number"),
    "infinite": ("∞", "infinite"),
    "negative": ("< 0", "negative"),
    "gain": ("E > 1", "gains energy"),
    "exchange": ("o ≠ i", "not reciprocal"),
    "over": ("range", "beyond the format"),
    "ill": ("κ", "ill-conditioned"),
}
FORM_WORDS = {"stable": "as rearranged", "textbook": "as printed"}
HEAD, SIDE = 58, 10  # points above the cells and beside them
LABELS, NARROW, LEAST_LABELS = 104, 82, 72  # points of the column of names, by the width
ROW, MOST = 25, 58  # points of a row, at least and at most
SMALL = 10.5  # height of the legend's letters, points
LEAST = 26  # points of a column whose cells have letters; narrower ones have their colours and tooltips


@dataclass(frozen=True)
class Stability(Drawn):
    """Where float32 fails, by function and regime: in our form and in the printed one, against float64."""

    title = "Stability"
    instrument = True

    rows: str = choice(
        "material", ("material", "all"), "functions of this material alone, or of every choice that it has"
    )
    first: int = param(0, 0, 60, "rows that are passed over, where not all have room")

    def shows(self, state):
        return (self, type(state.model), state.model.choices(), state.look.theme)

    def drawings(self, gpu, state, size, scale=1.0):
        shown = None
        for found in stability(gpu, state.model, everything=self.rows == "all"):
            if found is not shown:
                draw, note = self.drawing(found, state, size, scale)
            shown, done = found, found.progress == 1
            yield draw, note if done else f"{100 * found.progress:.0f} % measured; {note}", done

    def drawing(self, found, state, size, scale):
        """The Drawing of a Map, and a note."""
        draw = Drawing(size, scale, state.look.theme)
        width, height = size[0] / scale, size[1] / scale
        columns = [c for c in REGIMES if any((r, c, FORMS[0]) in found.cells for r in found.rows) or found.progress < 1]
        labels = LABELS if width > 760 else NARROW if width > 560 else LEAST_LABELS
        across = max((width - labels - SIDE) / max(len(columns), 1), 1.0)
        told = across >= LEAST
        entries = legend(state.look.theme)
        lines = flow([words for _, _, words in entries], width - 2 * SIDE)
        foot = 36 + 17 * (lines[-1][0] + 1)
        room = max(height - HEAD - foot, ROW)
        count = max(min(int(room / ROW), len(found.rows)), 1)
        first = min(self.first, len(found.rows) - count)
        down = min(room / count, MOST)
        top = height - HEAD

        def box(left, bottom, right, high):
            return np.array([left, bottom, right, high]) * scale

        def words(text, x, y, color="ink", anchor=(0.5, 0.5), points=11.0):
            draw.text(text, (x * scale, y * scale), color, anchor, points)

        words("upper: " + FORM_WORDS["stable"], SIDE, height - 11, anchor=(0, 0.5), points=10.5)
        words("lower: " + FORM_WORDS["textbook"], SIDE, height - 23, anchor=(0, 0.5), points=10.5)
        small = 10.0 if across > 41 else 8.8 if across > 32 else 7.8
        for i, name in enumerate(columns if told else ()):
            x = labels + (i + 0.5) * across
            for line, text in enumerate(REGIMES[name].head):
                words(text, x, height - 37 - 12 * line, "muted", points=small)
        hatches, texts = [], []
        for j, row in enumerate(found.rows[first : first + count]):
            y = top - j * down
            name, _, chosen = row.partition(" ")
            words(name, SIDE, y - down / 2 + 6 * bool(chosen), anchor=(0, 0.5), points=11.5)
            words(cut(chosen, labels - SIDE, 9.5), SIDE, y - down / 2 - 7, "muted", (0, 0.5), 9.5)
            for i, column in enumerate(columns):
                cells = [found.cells.get((row, column, form)) for form in FORMS]
                cells = [c for c in cells if c]
                for k, cell in enumerate(cells):
                    part = (down - 3) / len(cells)
                    left, high = labels + i * across + 1, y - k * part - k * 0.5
                    area = box(left, high - part + 0.5, left + across - 2, high)
                    color = shade(cell, state.look.theme)
                    draw.fill(area, color)
                    if cell.verdict == "ill":
                        hatches.append(area)
                    middle = ((area[0] + area[2]) / 2, (area[1] + area[3]) / 2)
                    texts.append((summary(cell, across > 41), middle, contrast(color)))
                    draw.link(area, tip(cell, state), leading(cell, type(state.model)))
        for area in hatches:
            for start, end in diagonals(area, 7 * scale):
                draw.stroke([start, end], COLORS[state.look.theme]["hatch"], 0.8)
        for text, middle, color in texts if told else ():
            draw.text(text, middle, color, size=min(small + 0.2, 10.0))
        for (line, x), (text, color, meaning) in zip(lines, entries, strict=True):
            y = foot - 14 - 17 * line
            area = box(SIDE + x, y - 6.5, SIDE + x + 32, y + 6.5)
            draw.fill(area, color)
            if text == WORDS["ill"][0]:
                for start, end in diagonals(area, 7 * scale):
                    draw.stroke([start, end], COLORS[state.look.theme]["hatch"], 0.8)
            words(text, SIDE + x + 16, y, contrast(color), points=9.5)
            words(meaning, SIDE + x + 37, y, "muted", (0, 0.5), SMALL)
        note = f"{len(found.broken)} of ours fail" if found.broken else "all of ours keep their promise"
        if count < len(found.rows):
            note += f"; rows {first + 1} to {first + count} of {len(found.rows)}"
        return draw, note


def legend(theme):
    """[(text, colour, meaning)] of what cells show."""
    colors = COLORS[theme]
    fine = f"error up to {short(LIMIT)}, half {short(REGIMES['half'].limit)}"
    entries = [("2e-7", colors["fine"][0], fine), ("35 %", colors["error"][1], "larger error")]
    return entries + [(text, colors[name], meaning) for name, (text, meaning) in WORDS.items()]


def flow(meanings, width):
    """(line, x) of entries of the legend, one after the other in lines."""
    line, x, places = 0, 0.0, []
    for words in meanings:
        extent = 37 + width_of(words, SMALL) + 12
        if x and x + extent > width:
            line, x = line + 1, 0.0
        places.append((line, x))
        x += extent
    return places


def shade(cell, theme):
    """The colour of a cell, "#rrggbb"."""
    colors = COLORS[theme]
    if cell.verdict == "fine":
        return colors["fine"][sum(cell.error > e for e in (1e-6, 1e-5))]
    if cell.verdict == "error":
        return colors["error"][sum(cell.error > e for e in (1e-2, 1.0))]
    return colors[cell.verdict]


def contrast(color):
    """Black or white, whichever reads better over a colour."""
    red, green, blue = rgb(color)
    return "#111827" if 0.3 * red + 0.59 * green + 0.11 * blue > 0.5 else "#ffffff"


def summary(cell, wide=True):
    """The few letters in a cell."""
    if cell.verdict == "fine":
        return short(cell.error)
    if cell.verdict == "error":
        return f"{100 * cell.error:.0f}{' ' * wide}%" if 0.01 <= cell.error < 9.995 else short(cell.error)
    if cell.verdict == "ill":
        return f"κ {short(cell.hard.condition)}" if wide else f"κ{short(cell.hard.condition)}"
    text = WORDS[cell.verdict][0]
    return text if wide else text.replace(" ", "")


def short(value):
    """One digit and a power of ten."""
    if not np.isfinite(value):
        return "∞"
    mantissa, exponent = f"{value:.0e}".split("e")
    return "0" if value == 0 else f"{mantissa}e{int(exponent)}"


def figure(value):
    """Two digits, or the sign of infinity."""
    return number(value, 2) if np.isfinite(value) else "∞"


def diagonals(box, step):
    """Ends of the lines that hatch a box."""
    left, bottom, right, top = box
    lines = []
    for offset in np.arange(left + bottom + step, right + top, step):
        x0, x1 = max(left, offset - top), min(right, offset - bottom)
        if x1 > x0:
            lines.append(((x0, offset - x0), (x1, offset - x1)))
    return lines


def tip(cell, state):
    """What a cell has to say, line by line."""
    lines = [f"{cell.row}, {FORM_WORDS[cell.form]}: {REGIMES[cell.column].doc}"]
    wrong = {"NaN": cell.nan, "infinite": cell.infinite, "negative": cell.negative}
    counts = ", ".join(f"{n} {what}" for what, n in wrong.items() if n)
    lines.append(f"{counts or 'no NaN, infinite or negative'} among {cell.points} points")
    lines.append(f"largest error {figure(cell.error)} where well conditioned")
    if cell.hard:
        lines.append(f"where not, {figure(cell.hard.error)} at condition {figure(cell.hard.condition)}")
    if cell.gain > 1e-6:
        lines.append(f"gains energy: an albedo is too large by {figure(cell.gain)}, relative")
    if cell.reciprocity > 1e-6:
        lines.append(f"exchanging light and viewer changes it by {figure(cell.reciprocity)}")
    if cell.over or cell.under:
        lines.append(f"{100 * cell.over:.2g} % too large for the format, {100 * cell.under:.2g} % too small")
    lines += described(cell)
    lines += held(state, cell)[2] or ["click: to this point, with these formulas on the sphere"]
    return "\n".join(lines)


def described(cell):
    """The point of a cell in words, in lines."""
    parts = []
    for name, value in cell.at.arguments.items():
        if name in ("wo", "wi", "w", "wm", "m"):
            theta, phi = np.degrees(angles(np.array(value)))
            cosine = f" (cos {number(value[2], 2)})" if value[2] < 0.01 else ""
            parts.append(f"{name} {theta:.6g}°, {phi:.4g}°{cosine}")
        else:
            values = value if isinstance(value, list) else [value]
            parts.append(f"{name} {', '.join(f'{v:.7g}' for v in values)}")
    single, exact = (", ".join(f"{v:.5g}" for v in values) for values in (cell.at.value, cell.at.exact))
    return [f"at {'; '.join(parts)}:", f"float32 {single}", f"float64 {exact}"]


def held(state, cell):
    """Of a cell's point what a state can hold: parameters by name, theta_o, phi_o and the light's theta in degrees, None where
    the point has no directions; and in words what lies beyond.
    """
    at, beyond = cell.at.arguments, []

    def within(name, value, declaration):
        values = value if isinstance(value, list) else [value]
        values = [round(v) for v in values] if isinstance(declaration.default, int) else values
        kept = [min(max(v, declaration.low), declaration.high) for v in values]
        unit = "°" if declaration.unit == "deg" else ""
        for there, here in zip(values, kept, strict=True):
            if there != here:
                beyond.append(f"{name} {there:.3g}{unit} is beyond what a state holds: there it is {here:.4g}{unit}")
        return tuple(kept) if len(kept) > 1 else kept[0]

    params = declared(state.model, Param)
    values = {name: within(name, at[name], p) for name, p in params.items() if name in at}
    values = {n: v if isinstance(v, tuple) or params[n].size == 1 else (v,) * params[n].size for n, v in values.items()}
    wo, wi = directions_of(at)
    if wo is None:
        return values, None, beyond
    theta, phi = (float(np.degrees(a)) for a in angles(wo))
    between = float(np.degrees(2 * np.arctan2(np.linalg.norm(wo - wi), np.linalg.norm(wo + wi))))
    return values, (within("theta_o", theta, declared(state.directions)["theta_o"]), phi, between), beyond


def shown_at(state, cell):
    """The state with a cell's point in it, its formulas on the sphere; and in words what of it lies beyond what can be shown."""
    values, directions, beyond = held(state, cell)
    state = state.with_model(replace(state.model, **cell.choices, **values))
    state = state.with_view("sphere", formulas=cell.form)
    if directions is None:
        return state, beyond
    theta, phi, between = directions
    viewer = replace(state.directions, theta_o=theta, phi_o=phi)
    irradiance = state.light.irradiance or declared(state.light)["irradiance"].default
    return replace(state, directions=viewer, light=replace(state.light, theta=between, irradiance=irradiance)), beyond


def leading(cell, cls):
    """A function that leads a state to a cell's point, if it shows a material of that class."""
    return lambda state: shown_at(state, cell)[0] if type(state.model) is cls else state


def directions_of(arguments):
    """wo and wi that a function's arguments stand for, or None: of a normal alone both are that normal."""
    known = {name: np.array(value) for name, value in arguments.items()}
    if "wm" in known:
        return known["wm"], known["wm"]
    wo = known.get("wo", known.get("w"))
    if wo is None and "c" in known:
        wo = direction(np.arccos(known["c"]), 0.0)
    if wo is None:
        return None, None
    return wo, known.get("wi", mirror(wo, np.array([0.0, 0.0, 1.0])))

"""The slice through the plane of incidence as a polar plot: f or f cos over the direction to the light."""

from dataclasses import dataclass
from itertools import count
from typing import NamedTuple

import numpy as np

from ..lib.srgb import luminance
from ..measure.grid import direction, flat_refraction
from ..measure.laws import Shader
from ..measure.noise import mean_f
from ..model import choice
from .diagram import QUANTITIES, Diagram, apart, arrow, nice_step, number, powers_below, radius
from .drawing import Drawing, Drawn, cut, width_of
from .picture import Curves
from .table import LONGEST, PASSES, progressive

MARGIN = 44  # points around the half disc, for the angles
FOOT = 46  # points below it, for values and a note; half of that below a whole disc
NODES = 385  # of each half of a slice: many more than the lobe has, so that no tip has corners in a large picture
FEW = 145  # the same of estimates, which are the better for being few
LINE = 18  # points from one line of the legend to the next
CHANNELS = ("red", "green", "blue")
WORDS = 12.5  # height of the legend's letters, points
LEAST = 55  # and points that its lines have room for at least


PARTS = ("red", "purple", "green")  # colours of the parts of a material


class Slice(NamedTuple):
    """A curve. color: a role, or the number of a material; double and error: None where there is none."""

    name: str
    color: str | int
    theta: np.ndarray  # (n,) radians
    single: np.ndarray  # float32 values (n,)
    double: np.ndarray | None  # float64 ones
    error: np.ndarray | None  # standard errors


@dataclass(frozen=True)
class Polar(Drawn, Diagram):
    """The slice through the plane of incidence: f or f cos over the direction to the light, as a polar plot.

    A half disc over the surface, or a whole one if one of the materials transmits.
    """

    title = "Polar slice"

    curves: str = choice(
        "materials", ("materials", "rgb"), "a curve for each material, or red, green and blue of the active one"
    )
    reference: str = choice("on", ("on", "off"), "float64 values as a thin line over the shader's float32 ones")

    def shows(self, state):
        return (self, self.materials(state), state.directions, state.look.theme)

    def materials(self, state):
        """The materials that have curves."""
        return state.materials if self.curves == "materials" else (state.material,)

    def whole(self, state):
        """Whether there is light on both sides of the surface."""
        return any(m.model.index() is not None for m in self.materials(state))

    def disc(self, size, scale=1.0, whole=False):
        """Centre (2,) of the half or whole disc in a picture of that size, pixels from the bottom left, and its radius."""
        if whole:
            return np.divide(size, 2), max(min(size) / 2 - MARGIN * scale, 1.0)
        around = (MARGIN + FOOT) * scale
        extent = max(min(size[0] / 2 - MARGIN * scale, size[1] - around), 1.0)
        return np.array([size[0] / 2, FOOT * scale + max(size[1] - extent - around, 0.0) / 2]), extent

    def pivot(self, state, size, scale=1.0):
        """The place (2,) about which a drag turns the viewer, in pixels from the bottom left."""
        return self.disc(size, scale, self.whole(state))[0]

    def slices(self, gpu, state):
        """The Slices of all curves at their best."""
        return next(found for found, _, done in self.progress(gpu, state, PASSES) if done)

    def progress(self, gpu, state, passes=LONGEST):
        """Yield (Slices, walks of each value, done): once, or better and better where a material is stochastic."""
        runs = [self.of_material(gpu, state, i, passes) for i in range(len(self.materials(state)))]
        last = [next(run) for run in runs]
        while True:
            done = all(final for _, _, final in last)
            yield [s for found, _, _ in last for s in found], max(walks for _, walks, _ in last), done
            if done:
                return
            last = [next(run, (found, walks, True)) for run, (found, walks, _) in zip(runs, last, strict=True)]

    def of_material(self, gpu, state, index, passes):
        """Yield (Slices, walks, done) of one material."""
        material = self.materials(state)[index]
        model = material.model
        shown = model.parts() if material is state.material and self.curves == "materials" else {}
        if len(shown) < 2:
            shown = {material.name: model}
        nodes = FEW if model.stochastic else NODES
        runs = [progressive(gpu, m, state.directions, 2, nodes, passes=passes) for m in shown.values()]
        last = [next(run) for run in runs]
        for turn in count():  # one part in each step, as each takes as long as the whole
            sides = zip(*(tables for tables, _ in last), strict=True)
            found = [
                s for tables in sides for s in self.of_tables(material, index, dict(zip(shown, tables, strict=True)))
            ]
            done = all(final for _, final in last)
            yield found, min(tables[0].walks for tables, _ in last), done
            if done:
                return
            at = turn % len(runs)
            last[at] = next(runs[at], (last[at][0], True))

    @np.errstate(under="ignore")  # in the tails of a density
    def of_tables(self, material, index, tables):
        """The Slices of one side of the surface, by Tables of a material or by name of its parts."""
        theta, wi, f = zip(*(t.plane() for t in tables.values()), strict=True)
        theta, wi, wo = theta[0], wi[0], next(iter(tables.values())).wo
        cos = np.reshape(self.factor(wi), (-1, 1))
        values = [v * cos for v in f]
        errors = [None if t.error is None else t.along(t.error) * cos for t in tables.values()]
        found, name = [], material.name
        if len(tables) > 1:
            for role, part, v, e in zip(PARTS, tables, values, errors, strict=False):
                found.append(Slice(part, role, theta, luminance(v), None, luminance(e)))
            values, errors = [sum(values)], [np.sqrt(sum(e**2 for e in errors))]
            name = f"{name}, all"
        double = None if material.model.stochastic else material.model.f(wo, wi) * cos
        columns = (values[0], double, errors[0])
        if self.curves == "rgb":
            for c, channel in enumerate(CHANNELS):
                found.append(Slice(channel, channel, theta, *(None if v is None else v[:, c] for v in columns)))
        else:
            found.append(Slice(name, index, theta, *(None if v is None else luminance(v) for v in columns)))
        return found

    @np.errstate(under="ignore")
    def table_of(self, gpu, state):
        """The slices as Curves over theta in degrees, each evaluated at every angle that the grid of one of them has."""
        x = np.concatenate([s.theta for s in self.slices(gpu, state)])
        x = np.unique(np.where(x < -np.pi, x + 2 * np.pi, x))
        phi = np.radians(state.directions.phi_o)
        wo, wi = direction(np.radians(state.directions.theta_o), phi), direction(x, phi)
        y = {}
        for material in self.materials(state):
            if material.model.stochastic:
                walks = mean_f(Shader(gpu, material.model), wo, wi)
                columns = {"mean": walks.value, "standard error": walks.error}
            else:
                columns = {"float32": gpu.f(material.model, wo, wi), "float64": material.model.f(wo, wi)}
            for kind, f in columns.items():
                f = f * np.reshape(self.factor(wi), (-1, 1))
                if self.curves == "rgb":
                    y |= {f"{channel} {kind}": f[:, c] for c, channel in enumerate(CHANNELS)}
                else:
                    y[f"{material.name} {kind}"] = luminance(f)
        return Curves("theta_i [deg]", np.degrees(x), y)

    def drawings(self, gpu, state, size, scale=1.0):
        for slices, walks, done in self.progress(gpu, state):
            draw, note = self.drawing(state, slices, size, scale)
            if any(s.error is not None for s in slices):
                note += f"; {walks} walks a direction, bands of one standard error"
            yield draw, note, done

    def drawing(self, state, slices, size, scale):
        """The Drawing of Slices, and a note."""
        draw = Drawing(size, scale, state.look.theme)
        colors = draw.colors
        width, height = size
        peak = max(float(np.max(s.single)) for s in slices)
        top = 1.04 * peak if peak > 0 else 1.0
        whole = self.whole(state)
        center, extent = self.disc(size, scale, whole)
        theta_o = np.radians(state.directions.theta_o)

        def place(theta, share):
            theta, share = np.broadcast_arrays(theta, share)
            return center + extent * share[..., None] * np.stack([np.sin(theta), np.cos(theta)], axis=-1)

        def reach(values):
            return radius(values / top, self.radius, self.decades)

        def stroke(theta, share, color, points, opacity=1.0):
            draw.stroke(place(theta, share), color, points, opacity)

        if self.radius == "linear":
            step = nice_step(top / 4)
            rings = np.arange(1, int(top / step) + 1) * step
        else:
            rings = powers_below(top, self.decades)
        rings = rings[reach(rings) > 0.08]
        arc = np.linspace(-np.pi / 2, np.pi / 2, 181) * (2 if whole else 1)
        spokes = np.radians(np.arange(-180, 166, 15) if whole else np.arange(-90, 91, 15))
        for r in reach(rings):
            stroke(arc, r, "grid", 1.0)
        for a in spokes:
            stroke(a, np.array([0.0, 1.0]), "grid", 1.0)
        stroke(arc, 1.0, "muted", 1.0)
        stroke(np.array([-np.pi / 2, np.pi / 2]), 1.0, "ink", 1.2)
        viewer = place(theta_o, 1 + 34 * scale / extent)
        for a in spokes[::2]:
            at = place(a, 1 + 17 * scale / extent)
            if np.any(np.abs(at - viewer) > np.array([20, 12]) * scale):
                draw.text(f"{abs(round(np.degrees(a)))}°", at, "muted")
        words = [number(value) for value in rings]
        for i in apart(extent * reach(rings), [(width_of(w, 11.0) + 4) * scale for w in words]):
            draw.text(words[i], place(np.pi / 2, reach(rings[i])) - [0, 12 * scale], "muted", size=11.0)

        # the viewer, and dashed where a mirror and a flat surface of the active material would send its ray
        straight = flat_refraction(direction(theta_o, 0.0), state.model.index())
        for points in arrow(center, place(theta_o, 1.0), scale):
            draw.stroke(points, "accent", 1.6)
        for i in range(0, 40, 2):
            stroke(-theta_o, np.array([i, i + 1]) / 40, "accent", 1.0)
            if straight is not None:
                stroke(np.arctan2(-np.hypot(*straight[:2]), straight[2]), np.array([i, i + 1]) / 40, "accent", 1.0)
        draw.text("ωo", viewer, "accent", size=13.0)

        legend = [(QUANTITIES[self.quantity], "ink")]
        bands = [s for s in slices if s.error is not None and np.isfinite(s.error).all()]
        for s in bands:  # from one end of each bar to the next
            ends = np.stack([s.single - s.error, s.single + s.error], axis=-1)
            stroke(np.repeat(s.theta, 2), reach(np.maximum(ends, 0.0)).ravel(), self.color(s, colors), 1.5, 0.3)
        if bands:
            draw.over()
        for s in slices:
            color = self.color(s, colors)
            stroke(s.theta, reach(s.single), color, 4.0 if s.error is None else 2.0)
            legend += [(s.name, color)] * ((s.name, color) not in legend)
        draw.over()
        if self.reference == "on" and any(s.double is not None for s in slices):
            for s in slices:
                if s.double is not None:
                    stroke(s.theta, reach(s.double), "reference", 1.0)
            legend.append(("float64", "reference"))
        for words, color, side, y in self.columns(legend, size, scale, whole):
            x = 12 * scale if side == "left" else width - 12 * scale
            draw.text(words, (x, height - y), color, (0.0 if side == "left" else 1.0, 0.5), WORDS)
        return draw, f"peak {number(peak, 4)} / sr at θo = {state.directions.theta_o:g}°"

    def color(self, slice, colors):
        """The colour of a Slice: that of its material, or its role's."""
        return colors["curves"][slice.color % len(colors["curves"])] if isinstance(slice.color, int) else slice.color

    def columns(self, legend, size, scale, whole=False):
        """The legend [(words, colour)] in the upper corners, clear of angles and viewer: [(words, colour, side, y from the top)].

        Words that are too long end in an ellipsis. Where lines do not suffice, the last says how many more there are.
        """
        center, extent = self.disc(size, scale, whole)
        least = min(LEAST, max(width_of(words, WORDS) for words, _ in legend))
        lines = []
        for side, around in (("left", 28), ("right", 50)):
            clear = extent + around * scale
            for y in np.arange(16, size[1] / scale, LINE) * scale:
                above = size[1] - y - 8 * scale - center[1]
                end = size[0] / 2 - (np.sqrt(clear**2 - above**2) if 0 <= above < clear else 8 * scale)
                room = end / scale - 12
                if above < 0 or room < least:
                    break
                lines.append((room, side, y))
        if not lines:  # a tiny picture says what it shows, no more
            return [(*legend[0], "left", 16 * scale)]
        if len(lines) < len(legend):
            legend = [*legend[: len(lines) - 1], (f"+ {len(legend) - len(lines) + 1} more", "muted")]
        return [
            (cut(words, room, WORDS), color, side, y)
            for (words, color), (room, side, y) in zip(legend, lines, strict=False)
        ]

"""Facets that are no mirrors: f along the plane of incidence as their lobes sharpen, and how it becomes Torrance and
Sparrow's.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..lib.srgb import luminance
from ..measure.grid import direction
from ..measure.mirror_limit import SHARPNESS, differences, has_facets, mirrors, sharpened
from ..model import Invalid, choice, param
from .axes import Axes, Axis
from .diagram import number
from .drawing import Drawing, Drawn, width_of, wrapped
from .picture import Curves

STEPS = (10.0, 100.0, 1e3, 1e4)
"""The sharpnesses whose curves are always there."""
ANGLES = 121
"""Directions of a curve, even ones; as many more lie about the mirror direction."""
LIMIT = 1e6
"""The sharpness that stands for the limit in the words."""
LEFT = 54  # points left of the curves, for ticks
AXIS = 50  # points from there that the name of the upward axis takes


@lru_cache(64)
@np.errstate(under="ignore")  # in the tails of a density
def curve(model, kappa, theta_o, phi_o):
    """theta (n,) in radians and the luminance (n,) of a microfacet model's f with lobes for mirrors; theta_o, phi_o: degrees."""
    theta_o, phi = np.radians([theta_o, phi_o])
    near = 0.3 * max(model.alpha) * np.tan(np.linspace(-1.4, 1.4, ANGLES)) - theta_o
    theta = np.unique(np.concatenate([np.radians(np.linspace(-89.8, 89.8, ANGLES)), near]))
    theta = theta[np.abs(theta) < np.radians(89.9)]
    wo, wi = direction(theta_o, phi), direction(theta, phi)
    return theta, luminance(model.f(wo, wi) if kappa == np.inf else sharpened(model, kappa, wo, wi))


@dataclass(frozen=True)
class Facets(Drawn):
    """The lecture's last step: facets with lobes become mirrors, and their f becomes that of Torrance and Sparrow."""

    title = "Non-specular"

    sharpness: float = param(30.0, 1.0, 1e6, "sharpness of the lobe whose curve is drawn thick", scale="log")
    axis: str = choice("log", ("log", "linear"), "scale of the values")
    decades: int = param(4, 1, 12, "decades that a logarithmic axis shows")

    def shows(self, state):
        return (self, state.material, state.directions, state.look.theme)

    def curves(self, state):
        """theta (n,) in radians, positive on the viewer's side, and {kappa: luminance of f (n,)}, mirrors at infinity."""
        model, at = mirrors(state.model), (state.directions.theta_o, state.directions.phi_o)
        found = {k: curve(model, k, *at)[1] for k in sorted({*STEPS, self.sharpness})}
        return curve(model, np.inf, *at)[0], found | {np.inf: curve(model, np.inf, *at)[1]}

    def table_of(self, gpu, state):
        """The curves as Curves over theta in degrees. Raises Invalid for a material without facets to sharpen."""
        if not has_facets(state.model):
            raise Invalid(f"{state.material.name} ({state.model.name()}) has no facets whose lobes could be sharpened")
        theta, found = self.curves(state)
        names = {k: "Torrance-Sparrow" if k == np.inf else f"kappa {k:g}" for k in found}
        return Curves("theta_i [deg]", np.degrees(theta), {names[k]: v for k, v in found.items()})

    def drawings(self, gpu, state, size, scale=1.0):
        draw = Drawing(size, scale, state.look.theme)
        width, height = size
        if not has_facets(state.model):
            for dy, words in ((9, "No facets to sharpen:"), (-9, f"{state.model.name()} has no distribution of them")):
                draw.text(words, (width / 2, height / 2 + dy * scale), "muted")
            yield draw, "", True
            return
        theta, found = self.curves(state)
        theta_o, phi = np.radians([state.directions.theta_o, state.directions.phi_o])
        kappas = np.unique(np.append(SHARPNESS, self.sharpness))
        yield self.drawing(draw, state, theta, found, kappas, None), "", False
        off = differences(state.model, theta_o, phi, kappas)
        here = number(float(off[kappas == self.sharpness][0]), 3)
        draw = self.drawing(Drawing(size, scale, state.look.theme), state, theta, found, kappas, off)
        yield draw, f"largest difference at κ = {self.sharpness:.3g}: {here} of the peak", True

    def drawing(self, draw, state, theta, found, kappas, off):
        """Everything drawn; off: the differences for the kappas, or None while they are not known."""
        (width, height), scale = draw.size, draw.scale
        lines = self.words(state, (width / scale - 24))
        legend = self.legend(found, draw)
        beside = width >= 640 * scale
        middle = 0.62 * width if beside else 0.36 * height
        right = (middle if beside else width) - 18 * scale
        rows, row, x = [], 0, 0.0
        for text, color in legend:
            wide = (width_of(text, 11.5) + 14) * scale
            row, x = (row + 1, 0.0) if x > 0 and LEFT * scale + x + wide > right else (row, x)
            rows.append((text, color, x, row))
            x += wide
        top = height - (22 + 18 * len(lines) + 17 * (row + 1) + 22) * scale
        left, foot, end = LEFT * scale, 46 * scale, width - 18 * scale
        if beside:
            boxes = (left, foot, right, top), (middle + 46 * scale, foot, end, top)
        else:
            boxes = (left, middle + foot, end, top), (left, foot, end, middle - 28 * scale)
        if min(box[3] - box[1] for box in boxes) < 30 * scale or right - left < 100 * scale:
            draw.text("No room for the curves", (width / 2, height / 2), "muted")
            return draw
        for i, line in enumerate(lines):
            draw.text(line, (12 * scale, height - (16 + 18 * i) * scale), "ink", (0.0, 0.5), 12.0)
        for text, color, x, row in rows:
            at = (left + x, height - (16 + 18 * len(lines) + 10 + 17 * row) * scale)
            draw.text(text, at, color, (0.0, 0.5), 11.5)
        self.lobes(draw, boxes[0], theta, found, state.directions.theta_o)
        if off is not None:
            self.fall(draw, boxes[1], kappas, off)
        return draw

    def legend(self, found, draw):
        """[(words, colour role or number)] of the curves."""
        first, _, *others = draw.colors["curves"]  # the second is near the accent
        colors = dict(zip(STEPS, (first, *others), strict=False))
        lobes = [(f"κ = {number(k)}", "accent" if k == self.sharpness else colors[k]) for k in found if k != np.inf]
        return [("mirrors: Torrance-Sparrow", "reference"), *lobes]

    def lobes(self, draw, box, theta, found, theta_o):
        s = draw.scale
        top = 1.3 * max(float(v.max()) for v in found.values())
        y = Axis(top / 10**self.decades if self.axis == "log" else 0.0, top, "f  [1/sr]", self.axis)
        axes = Axes(draw, box, Axis(-90.0, 90.0, "θi in the plane of incidence"), y)
        angles = np.arange(-90, 91, 30)
        axes.frame(angles, [f"{abs(a)}°" for a in angles])
        axes.line([theta_o, theta_o], [y.low, y.high], "accent", 1.2)
        for words, theta_i in (("ωo", theta_o), ("ωr", -theta_o))[: 2 if theta_o > 8 else 1]:
            at = axes.place(theta_i, y.high) + [0, 9 * s]
            if at[0] - box[0] > AXIS * s:
                draw.text(words, at, "accent", size=11.5)
        draw.over()
        degrees = np.degrees(theta)
        axes.line(degrees, found[np.inf], "reference", 5.0, 0.35)
        draw.over()
        _, *lobes = self.legend(found, draw)
        for (_, color), (kappa, v) in zip(lobes, found.items(), strict=False):
            axes.line(degrees, v, color, 2.8 if kappa == self.sharpness else 1.4)

    def fall(self, draw, box, kappas, off):
        """The largest difference over the sharpness, and a line that falls as its reciprocal."""
        s = draw.scale
        x = Axis(min(kappas[0], SHARPNESS[0]), SHARPNESS[-1], "sharpness κ", "log")
        axes = Axes(draw, box, x, Axis(min(off[-1] / 3, 1e-4), 1.0, "largest difference / peak", "log"))
        axes.frame()
        line = np.array([max(off[-1] * x.high, x.low), x.high])
        axes.line(line, off[-1] * x.high / line, "muted", 1.0)
        draw.text("1/κ", (axes.place(line, off[-1] * x.high / line).mean(axis=0) - [14 * s, 8 * s]), "muted", size=11.5)
        draw.over()
        axes.line(kappas, off, "blue", 2.4)
        draw.over()
        draw.dot(axes.place(self.sharpness, float(off[kappas == self.sharpness][0])), "accent", 9.0)

    @np.errstate(under="ignore")
    def words(self, state, room):
        """Lines of `room` points: what the limit is, and what it is as the lecture prints it, in the mirror direction."""
        wo = direction(*np.radians([state.directions.theta_o, state.directions.phi_o]))
        wi = (wo * [-1, -1, 1])[None]
        exact = luminance(mirrors(state.model).f(wo, wi))[0]
        limit, bare = (luminance(sharpened(state.model, LIMIT, wo, wi, F))[0] / exact for F in (True, False))
        return wrapped(
            (
                f"f_mf = F δ(ωi - R) / (ωi·ωm) gives D G F / (4 cos cos): κ = 1e6 gives {limit:.5f} of it along ωr.",
                f"As printed, without F, f_mf = δ(ωi - R) / (ωi·ωm) gives D G / (4 cos cos): {bare:.4f} of it.",
            ),
            room,
            12.0,
        )

"""Facets that are no mirrors: f along the plane of incidence as their lobes sharpen, and how it becomes Torrance and
Sparrow's.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..lib.common import quotient
from ..lib.srgb import luminance
from ..measure.grid import direction
from ..measure.mirror_limit import SHARPNESS, differences, mirrors, sharpened, slope_scale, without_facets
from ..model import Invalid, choice, param
from .axes import Axes, Axis
from .diagram import number
from .drawing import Drawing, Drawn, nothing, width_of, wrapped
from .picture import Curves

STEPS = (10.0, 100.0, 1e3, 1e4)
"""The sharpnesses whose curves are always there."""
ANGLES = 121
"""Directions of a curve, even ones; as many more lie about the mirror direction."""
LIMIT = 1e6
"""The sharpness that stands for the limit in the words."""
LEFT = 54  # points left of the curves, for ticks
AXIS = 50  # points from there that the name of the upward axis takes
FOOT, HEAD, EDGE = 46, 22, 18  # points below curves for ticks and title, above them, and right of them
LEGEND = 11.5  # height of its letters, points
WIDE = 640  # points from which curves and differences stand side by side
SHARE = 0.58  # of the height that both have, that of the curves where they stand above the differences
KEEP, LEAST = 130, 36  # points of the curves' height below which words give way, and below which there is no room


@lru_cache(64)
@np.errstate(under="ignore")  # in the tails of a density
def curve(model, kappa, theta_o, phi_o):
    """theta (n,) in radians and the luminance (n,) of a microfacet model's f with lobes for mirrors; theta_o, phi_o: degrees."""
    theta_o, phi = np.radians([theta_o, phi_o])
    near = 0.3 * slope_scale(model.alpha, phi) * np.tan(np.linspace(-1.4, 1.4, ANGLES)) - theta_o
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
        """Yield theta (n,) in radians, positive on the viewer's side, and {kappa: luminance of f (n,)}, one more each time.

        Mirrors, at infinity, are first; then comes the sharpness that is asked for.
        """
        model, at = mirrors(state.model), (state.directions.theta_o, state.directions.phi_o)
        found = {}
        for k in dict.fromkeys((np.inf, self.sharpness, *self.kappas())):
            theta, found[k] = curve(model, k, *at)
            yield theta, dict(sorted(found.items()))

    def table_of(self, gpu, state):
        """The curves as Curves over theta in degrees. Raises Invalid where there are no facets to sharpen."""
        if without_facets(state.model):
            raise Invalid(" ".join(none(state)))
        *_, (theta, found) = self.curves(state)
        names = {k: "Torrance-Sparrow" if k == np.inf else f"kappa {k:g}" for k in found}
        return Curves("theta_i [deg]", np.degrees(theta), {names[k]: v for k, v in found.items()})

    def drawings(self, gpu, state, size, scale=1.0):
        if without_facets(state.model):
            yield nothing(size, scale, state.look.theme, *none(state)), "", True
            return
        draw = None
        for theta, found in self.curves(state):
            if gpu.pace is not None:
                yield draw, "", False
            if self.sharpness in found and draw is None:
                draw = self.drawing(state, size, scale, theta, found)
                yield draw, "", False
        draw = self.drawing(state, size, scale, theta, found)
        yield draw, "", False
        theta_o, phi = np.radians([state.directions.theta_o, state.directions.phi_o])
        kappas = np.unique(np.append(SHARPNESS, self.sharpness))
        off = []
        for kappa in kappas:
            off.append(float(differences(state.model, theta_o, phi, [kappa])[0]))
            if gpu.pace is not None:
                yield draw, "", False
        off = np.array(off)
        here = number(float(off[kappas == self.sharpness][0]), 3)
        draw = self.drawing(state, size, scale, theta, found, kappas, off)
        yield draw, f"largest difference at κ = {self.sharpness:.3g}: {here} of the peak", True

    def drawing(self, state, size, scale, theta, found, kappas=None, off=None):
        """Everything drawn; off: the differences for the kappas, or None while they are not known."""
        draw = Drawing(size, scale, state.look.theme)
        width, height = np.divide(size, scale)
        for lines in (self.words(state, width - 24), []):  # in points, as all here
            legend = self.rows(draw, width - LEFT - EDGE)
            top = height - (HEAD + 18 * len(lines) + 17 * (1 + legend[-1][3]) + HEAD)
            boxes = arranged(width, top)
            if boxes[0][3] - boxes[0][1] >= KEEP:
                break
        if boxes[0][3] - boxes[0][1] < LEAST:  # the legend gives way too
            legend, boxes = [], arranged(width, height - HEAD)
        if min(boxes[0][3] - boxes[0][1], boxes[0][2] - LEFT - 60) < LEAST:
            return nothing(size, scale, state.look.theme, "No room for the curves")
        for i, line in enumerate(lines):
            draw.text(line, np.multiply((12, height - 16 - 18 * i), scale), "ink", (0.0, 0.5), 12.0)
        for text, color, x, row in legend:
            at = (LEFT + x, height - 14 - 18 * len(lines) - 12 * bool(lines) - 17 * row)
            draw.text(text, np.multiply(at, scale), color, (0.0, 0.5), LEGEND)
        self.lobes(draw, np.multiply(boxes[0], scale), theta, found, state.directions.theta_o)
        if off is not None and off[-1] > 0 and boxes[1][3] - boxes[1][1] >= LEAST:
            self.fall(draw, np.multiply(boxes[1], scale), kappas, off)
        return draw

    def rows(self, draw, room):
        """The legend [(words, colour, x, row)] on rows of `room` points; with few words where many take another row."""
        placed = []
        for first in ("mirrors: Torrance-Sparrow", "Torrance-Sparrow", "mirrors"):
            placed, row, x = [], 0, 0.0
            for text, color in [(first, "reference"), *self.legend(draw).values()]:
                wide = width_of(text, LEGEND) + 14
                row, x = (row + 1, 0.0) if x > 0 and x + wide > room else (row, x)
                placed.append((text, color, x, row))
                x += wide
            if row == 0:
                break
        return placed

    def kappas(self):
        """The sharpnesses of the curves, rising."""
        return sorted({*STEPS, self.sharpness})

    def legend(self, draw):
        """{kappa: (words, colour)} of the curves of lobes, also of those that are not known yet."""
        first, _, *others = draw.colors["curves"]  # the second is near the accent
        colors = dict(zip(STEPS, (first, *others), strict=False))
        return {k: (f"κ = {number(k)}", "accent" if k == self.sharpness else colors[k]) for k in self.kappas()}

    def lobes(self, draw, box, theta, found, theta_o):
        s = draw.scale
        top = 1.3 * max(float(v.max()) for v in found.values()) or 1.0
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
        for kappa, (_, color) in self.legend(draw).items():
            if kappa in found:
                axes.line(degrees, found[kappa], color, 2.8 if kappa == self.sharpness else 1.4)

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
        limit, bare = (
            quotient(luminance(sharpened(state.model, LIMIT, wo, wi, F))[0], exact).item() for F in (True, False)
        )
        return wrapped(
            (
                f"f_mf = F δ(ωi - R) / (ωi·ωm) gives D G F / (4 cos cos): κ = 1e6 gives {limit:.5f} of it along ωr.",
                f"As printed, without F, f_mf = δ(ωi - R) / (ωi·ωm) gives D G / (4 cos cos): {bare:.4f} of it.",
            ),
            room,
            12.0,
        )


def none(state):
    """Lines that say that a material has no facets to sharpen, and why."""
    return "No facets to sharpen until they are mirrors:", f"{state.material.name}: {without_facets(state.model)}"


def arranged(width, top):
    """The frames of curves and of differences below `top`: (left, bottom, right, top) in points, side by side or stacked."""
    right = width - EDGE
    if width >= WIDE:
        middle = 0.62 * width
        return (LEFT, FOOT, middle - EDGE, top), (middle + FOOT, FOOT, right, top)
    room = top - 2 * FOOT - HEAD - 6
    return (LEFT, top - SHARE * room, right, top), (LEFT, FOOT, right, FOOT + (1 - SHARE) * room)

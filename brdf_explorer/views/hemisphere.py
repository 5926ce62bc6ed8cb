"""D, D_visible, pdf and f as maps over the hemisphere of directions, with directions drawn by the model's sampler.

Of a material that transmits f and pdf are maps over both hemispheres, the lower one seen from above through the surface. `up` is
1 for the hemisphere above and -1 for that below, and directions on a disc are as if above.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..glsl import assemble, of_model
from ..lib import slot
from ..lib.common import normalize, vec
from ..lib.random import seeded
from ..lib.srgb import luminance
from ..measure.albedo import albedo_with_error, integral, quadrature
from ..measure.grid import angles, direction, flat_refraction, sides
from ..measure.microsurface import D_visible, facets, projected_area
from ..measure.noise import mean_f
from ..model import choice, param
from .axes import Axis, colorbar
from .diagram import number
from .drawing import Drawing, Drawn
from .picture import rgb

QUANTITIES = {  # name -> title, and what its integral over the hemisphere is called
    "f": ("f(ωo, ωi)  [1/sr]", "∫ f cos θ dω"),
    "f_cos": ("f(ωo, ωi) cos θi  [1/sr]", "∫ f cos θ dω"),
    "pdf": ("pdf(ωi)  [1/sr]", "∫ pdf dω"),
    "D": ("D(ωm)  [1/sr]", "∫ D cos θ dω"),
    "D_visible": ("D_visible(ωo, ωm)  [1/sr]", "∫ D_visible dω"),
}
OVER = {"wi": "over ωi, the directions to the light", "wm": "over ωm, the normals of the facets"}
RAYS = 96  # about the mirror direction, and directions a ray, among which the peak is looked for
FAINT = 0.01  # share of the peak down to which the inset shows the lobe
NARROW = 0.12  # half width of that, in radii of the disc, from which on the disc itself shows it
HEAD, FOOT, RIM = 46, 26, 24  # points above the disc and below it for words, and around it
WALKS = 16  # estimates of a stochastic f for a pixel
EDGE = 1 - 1e-6  # radius of the directions that count as the horizon's: on it f is 0
BAR, INSET, STRIP = 84, 138, 150  # points for the colour bar, for the inset, and of both below the disc


class Peak(NamedTuple):
    """The largest value of a map, its direction, and how far from it on the disc values above FAINT of it lie."""

    value: float
    w: np.ndarray
    reach: float


@dataclass(frozen=True)
class Hemisphere(Drawn):
    """A quantity over the hemisphere of directions, on a disc of equal areas, with directions that the sampler draws."""

    title = "Hemisphere"

    quantity: str = choice("pdf", QUANTITIES, "what the colours show: f and pdf over ωi, D and D_visible over ωm")
    scale: str = choice("log", ("log", "linear"), "scale of the colours")
    decades: int = param(4, 1, 8, "decades that a logarithmic scale shows below the peak")
    samples: int = param(200, 0, 2000, "directions drawn by the model's sampler; over ωm, their half vectors")

    def shows(self, state):
        return (self, state.model, state.directions, state.look.theme)

    @property
    def over(self):
        """The direction that the map is over."""
        return "wm" if self.quantity in ("D", "D_visible") else "wi"

    @np.errstate(under="ignore")  # in the tails of a density
    def values(self, model, wo, w):
        """The quantity in float64, 1/sr (...), for directions w (..., 3)."""
        if self.quantity == "D":
            return slot("ndf", model.ndf).D(w, np.array(model.alpha))
        if self.quantity == "D_visible":
            return D_visible(model, wo, w)
        if self.quantity == "pdf":
            return model.pdf(wo, w)
        if model.stochastic:
            with seeded(0):  # the same numbers for all
                f = mean_f(model, wo, w, WALKS).value
        else:
            f = model.f(wo, w)
        return luminance(f) * (np.abs(w[..., 2]) if self.quantity == "f_cos" else 1.0)

    def hemispheres(self, model):
        """`up` of the hemispheres that are shown."""
        return (1.0,) if self.over == "wm" or model.index() is None else (1.0, -1.0)

    def peak(self, model, wo, up=1.0):
        """The Peak: the best of a grid that follows the lobe, then of steps from there that shrink."""
        turn = np.array([1.0, 1.0, up])
        if self.over == "wm":
            w = facets(np.array([0.0, 0.0, 1.0]), model.alpha, RAYS)[0]
        else:
            (side,) = (s for s in sides(wo, model.slopes(), model.index()) if s.up == up)
            w = quadrature(side.wo, side.alpha, RAYS)[0].wi
        values = self.values(model, wo, w * turn)
        seen = values >= FAINT * values.max()
        best = disc(w[np.unravel_index(values.argmax(), values.shape)])
        reach = float(np.linalg.norm(disc(w[seen]) - best, axis=-1).max())
        if model.stochastic:  # further steps would climb its noise
            return Peak(float(values.max()), of_disc(best), reach)
        steps = np.stack(np.meshgrid(*[np.linspace(-1, 1, 5)] * 2), axis=-1).reshape(-1, 2)
        for step in 0.1 * max(reach, 1e-6) * 0.6 ** np.arange(30):
            tries = best + step * steps
            tries /= np.maximum(np.linalg.norm(tries, axis=-1, keepdims=True) / EDGE, 1.0)
            best = tries[self.values(model, wo, of_disc(tries) * turn).argmax()]
        return Peak(float(self.values(model, wo, of_disc(best) * turn)), of_disc(best), reach)

    def mass(self, model, wo):
        """The integral that QUANTITIES names, by quadrature."""
        if self.quantity == "D":
            return projected_area(model, (0.0, 0.0, 1.0))
        if self.quantity == "D_visible":
            return projected_area(model, wo) / float(slot("ndf", model.ndf).visible_area(wo, np.array(model.alpha)))

        if model.stochastic and self.quantity != "pdf":
            return float(luminance(albedo_with_error(model, wo).value))

        def function(wo, wi):
            return (model.pdf(wo, wi) if self.quantity == "pdf" else luminance(model.f(wo, wi)) * np.abs(wi[..., 2]))[
                ..., None
            ]

        return float(integral(function, wo, model.slopes(), tolerance=1e-6, most=256, index=model.index()).value[0])

    def drawn(self, model, wo, up=1.0):
        """The directions (n, 3) that the sampler draws in that hemisphere, or all half vectors."""
        wi = model.sample_f(wo, np.random.default_rng(1).random((self.samples, 2)))[0]
        return wi[up * wi[:, 2] > 0] * [1.0, 1.0, up] if self.over == "wi" else normalize(wo + wi)

    def drawings(self, gpu, state, size, scale=1.0):
        model = state.model
        if self.over == "wm" and "ndf" not in model.choices():
            draw = Drawing(size, scale, state.look.theme)
            words = f"No {self.quantity} to show:", f"{model.name()} has no distribution of normals"
            for line, text in enumerate(words):
                draw.text(text, (size[0] / 2, size[1] / 2 + (9 - 18 * line) * scale), "muted")
            yield draw, "", True
            return
        wo = direction(np.radians(state.directions.theta_o), np.radians(state.directions.phi_o))
        peaks = {up: self.peak(model, wo, up) for up in self.hemispheres(model)}
        draw = self.drawing(gpu, state, wo, peaks, size, scale)
        up, peak = max(peaks.items(), key=lambda item: item[1].value)
        theta, phi = np.degrees(angles(peak.w * [1.0, 1.0, up])).round(2) + 0.0  # which makes -0 a 0
        note = f"peak {number(peak.value, 4)} / sr at θ {theta:g}°" + f", φ {phi % 360:g}°" * bool(theta)
        if model.stochastic and self.quantity in ("f", "f_cos"):
            note += f", by {WALKS} walks a pixel"
        yield draw, note, False
        yield draw, f"{note}; {QUANTITIES[self.quantity][1]} = {self.mass(model, wo):.6f}", True

    def drawing(self, gpu, state, wo, peaks, size, scale):
        draw = Drawing(size, scale, state.look.theme)
        beside = len(peaks) if size[0] >= size[1] else 1  # and else one below the other
        part = np.array([size[0] / beside, size[1] * beside / len(peaks)])
        most = max(peak.value for peak in peaks.values())
        for i, (up, peak) in enumerate(peaks.items()):
            corner = np.array([i * part[0], 0.0]) if beside > 1 else np.array([0.0, (len(peaks) - 1 - i) * part[1]])
            where = ("above the surface", "below it, seen through it")[i] if len(peaks) > 1 else OVER[self.over]
            self.disc_of(draw, gpu, state, wo, up, peak, most, corner, part, where)
        draw.text(QUANTITIES[self.quantity][0], (12 * scale, size[1] - 15 * scale), "ink", (0.0, 0.5), 12.5)
        return draw

    def disc_of(self, draw, gpu, state, wo, up, peak, most, corner, size, where):
        """One hemisphere in a part of the drawing, from `corner` on; `most` has the last colour."""
        scale = draw.scale
        inset = peak.reach < NARROW
        center, radius, bar, lens = layout(np.divide(size, scale), inset)
        center, radius = corner + center * scale, radius * scale
        x, y = corner / scale
        if bar:
            bar = bar[0] + x, bar[1] + y, bar[2] + x, bar[3] + y
            draw.text(where, corner + [12 * scale, size[1] - 33 * scale], "muted", (0.0, 0.5), 11.5)
        half = int(radius) + 2
        at = np.round(center).astype(int) - half
        center = at + half
        shown = (gpu, state, wo, up, peak, most)
        draw.raster(at, self.map(*shown, "hemisphere", (2 * half, 2 * half), (0.0, 0.0), 1 / radius))
        samples = disc(self.drawn(state.model, wo, up))

        def place(p):
            return center + radius * np.asarray(p)

        turn = np.radians(np.arange(0, 361, 4))
        ring = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        phi = np.radians(state.directions.phi_o)
        draw.over()
        for theta in (30, 60):
            draw.stroke(place(ring * np.sqrt(2) * np.sin(np.radians(theta / 2))), "#ffffff", 1.0, 0.35)
        draw.stroke(place([-direction2(phi), direction2(phi)]), "#ffffff", 1.0, 0.35)
        draw.stroke(place(ring), "muted", 1.2)
        dots(draw, place(samples))
        reach = max(1.3 * peak.reach, 1e-5)
        if lens and inset:
            left, bottom, side = np.round((np.array(lens) + [x, y, 0]) * scale).astype(int)
            middle, pixel = disc(peak.w), 2 * reach / side
            draw.raster((left, bottom), self.map(*shown, "inset", (side, side), middle, pixel))
            draw.over()
            near = samples[np.all(np.abs(samples - middle) < reach * (1 - 4 * scale / side), axis=-1)]
            dots(draw, (left + side / 2, bottom + side / 2) + (near - middle) / pixel)
            draw.over()
            square(draw, (left + side / 2, bottom + side / 2), side / 2, "ink")
            square(draw, place(middle), max(reach * radius, 5 * scale), "#ffffff")
            words = f"the peak, {number(np.degrees(2 * np.sqrt(2) * reach), 2)}° across"
            draw.text(words, (left + side / 2, bottom - 9 * scale), "muted", size=11.0)
        draw.over()
        self.names(draw, center, radius, wo, phi, up, state.model.index())
        if bar:
            logarithmic = self.scale == "log" and most > 0
            low = most / 10**self.decades if logarithmic else 0.0
            axis = Axis(low, most or 1.0, scale="log" if logarithmic else "linear")
            colorbar(gpu, draw, np.array(bar) * scale, axis)

    def map(self, gpu, state, wo, up, peak, most, name, size, middle, pixel):
        """The quantity's picture, with `middle` of the disc in its middle and `pixel` of the disc's radius a pixel."""
        model = state.model
        slots = {f"of_{self.over}": self.quantity, "radius": self.scale}
        uniforms = {
            "material": model,
            "walks": WALKS,
            "wo": tuple(wo),
            "up": up,
            "size": tuple(map(float, size)),
            "middle": tuple(middle),
        }
        uniforms |= {"pixel": float(pixel), "peak": tuple(disc(peak.w)), "decades": float(self.decades)}
        uniforms |= {"share": 1 / most if most > 0 else 0.0}
        uniforms |= {"paper": rgb(Drawing(size, theme=state.look.theme).color("paper"))}
        if self.over == "wm":
            uniforms["alpha"] = model.alpha
            source = assemble("views/hemisphere_wm.frag", {**model.choices(), **slots})
        else:
            source = of_model("views/hemisphere_wi.frag", model, slots=slots)
        target = gpu.target(f"hemisphere {name} {up:+g}", size, 4, "f1")
        gpu.draw(gpu.program(source), target, uniforms)
        return target

    def names(self, draw, center, radius, wo, phi, up, index):
        """Names of rings and directions, each on a chip of paper."""
        s = draw.scale
        taken = []
        if up < 0:
            straight = flat_refraction(wo, index)
            marks = [("ωt", straight * [1, 1, -1], "accent")] if straight is not None else []
        elif self.over == "wi":
            marks = [("ωo", wo, "accent"), ("ωr", wo * [-1, -1, 1], "accent")]
        else:
            marks = [("ωo", wo, "accent"), ("n", np.array([0.0, 0.0, 1.0]), "ink")]
        rings = [(f"{theta}°", direction(np.radians(theta), phi + np.pi / 2), "muted") for theta in (30, 60, 90)]
        axes = [("x", direction(np.pi / 2, 0.0), "muted"), ("y", direction(np.pi / 2, np.pi / 2), "muted")]
        for words, w, color in marks + rings + axes if radius > 40 * s else []:
            at = center + radius * disc(w)
            out = disc(w) / max(np.linalg.norm(disc(w)), 1e-9) if w[2] < 1 - 1e-9 else np.array([0.0, 0.0])
            marked = color != "muted"
            if marked:
                turn = np.linspace(0, 2 * np.pi, 25)
                circle = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
                draw.stroke(at + 5 * s * circle, "#000000", 3.0, 0.5)
                draw.over()
                draw.stroke(at + 5 * s * circle, "accent" if color == "accent" else "#ffffff", 1.6)
                draw.over()
            away = 16 * s if marked or w[2] < 1e-9 else 0.0
            at = at + away * (out if np.any(out) else np.array([0.0, 1.0]))
            if any(np.all(np.abs(at - other) < np.array([28, 17]) * s) for other in taken):
                continue
            taken.append(at)
            if np.linalg.norm(at - center) < radius + 8 * s:
                wide = 0.5 * (6.2 * len(words) + 4) * s
                draw.fill((at[0] - wide, at[1] - 7 * s, at[0] + wide, at[1] + 7 * s), "paper")
            draw.text(words, at, color, size=11.0 if color == "muted" else 12.5)


def disc(w):
    """Places (..., 2) of directions w (..., 3) on the disc of radius 1 that keeps areas: r = sqrt(2) sin(theta / 2)."""
    return w[..., :2] / np.sqrt(1 + np.maximum(w[..., 2:], 0.0))


def of_disc(p):
    """The direction (..., 3) at a place (..., 2) on the disc."""
    r2 = np.sum(p * p, axis=-1)
    return vec(p[..., 0] * np.sqrt(2 - r2), p[..., 1] * np.sqrt(2 - r2), 1 - r2)


def direction2(phi):
    return np.array([np.cos(phi), np.sin(phi)])


def layout(size, inset):
    """Centre and radius of the disc, box of the colour bar or None, corner and side of the inset or None; in points."""
    width, height = size
    beside = INSET + 24 if inset else BAR
    tall = height - HEAD - FOOT
    right, below = min(width - beside, tall), min(width, tall - STRIP)
    if max(right, below) < 2 * RIM + 80:
        extent = max(min(width, tall) / 2 - RIM, 1.0)
        return np.array([width / 2, FOOT + max(tall, 2.0) / 2]), extent, None, None
    if right >= below:
        center = np.array([(width - beside) / 2, FOOT + tall / 2])
        left, top = width - beside + 4, FOOT + tall - 8
        bar = max(top - 180, FOOT + 8 + (INSET + 30) * inset)
        if top - bar < 60:  # no room for both
            return center, right / 2 - RIM, (left, max(top - 180, FOOT + 8), left + 10, top), None
        return center, right / 2 - RIM, (left, bar, left + 10, top), (left, FOOT + 18, INSET) if inset else None
    center = np.array([width / 2, FOOT + STRIP + (tall - STRIP) / 2])
    bar = (16.0, FOOT + 10, 26.0, FOOT + STRIP - 16)
    return center, below / 2 - RIM, bar, (width - INSET - 16, FOOT + 16, min(INSET, STRIP - 18)) if inset else None


def dots(draw, places):
    """Points that show on every colour of the map."""
    draw.over()
    for at in places:
        draw.dot(at, "#000000", 4.2, 0.75)
    draw.over()
    for at in places:
        draw.dot(at, "#ffffff", 2.4)


def square(draw, center, half, color):
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)]) * half
    draw.stroke(np.asarray(center) + corners, color, 1.2)

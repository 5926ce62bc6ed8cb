"""D, D_visible, pdf and f as maps over the hemisphere of directions, with directions drawn by the model's sampler.

Of a material that transmits f and pdf are maps over both hemispheres, the lower one seen from above through the surface. `up` is
1 for the hemisphere above and -1 for that below, and directions on a disc are as if above.
"""

import time
from dataclasses import dataclass
from itertools import islice
from typing import NamedTuple

import numpy as np

from ..glsl import assemble, of_model
from ..lib import slot
from ..lib.common import normalize, vec
from ..lib.srgb import luminance
from ..measure.albedo import integral, quadrature
from ..measure.grid import angles, direction, flat_refraction, sides
from ..measure.laws import Shader
from ..measure.microsurface import D_visible, facets, projected_area
from ..model import choice, param
from .axes import Axis, colorbar
from .diagram import number
from .drawing import Drawing, Drawn, nothing
from .pace import REDRAWN, Pace, chords, in_turn
from .picture import rgb
from .table import progressive

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
WALKS = 64  # estimates of a stochastic f for a pixel
PASSES = 48  # of the table that tells its integral and peak
FEW = 4  # of these, for where the peak is
EDGE = 1 - 1e-6  # radius of the directions that count as the horizon's: on it f is 0
BAR, INSET, STRIP = 84, 138, 150  # points for the colour bar, for the inset, and of both below the disc


class Peak(NamedTuple):
    """The largest value of a map, its direction, and how far from it on the disc values above FAINT of it lie."""

    value: float
    w: np.ndarray
    reach: float


class Place(NamedTuple):
    """Where a hemisphere is drawn: pixels from the bottom left.

    title: left end of the line that says `where` it is; at: lower left corner of the disc's picture, whose side is 2 half;
    bar: box of the colour bar, or None; lens: lower left corner and side of the inset, or None.
    """

    up: float
    title: np.ndarray
    at: np.ndarray
    radius: float
    bar: np.ndarray | None
    lens: np.ndarray | None
    where: str

    @property
    def half(self):
        return int(self.radius) + 2

    @property
    def center(self):
        return self.at + self.half


class Map:
    """The quantity over a part of the disc: values, which get better where they are estimates, and their colours.

    size: pixels; middle: of the picture, on the disc; pixel: the side of a pixel on the disc.
    """

    def __init__(self, view, gpu, state, wo, up, peak, name, size, middle, pixel):
        self.gpu, self.name, self.size, self.pixel = gpu, f"hemisphere {name} {up:+g}", size, float(pixel)
        model, slots = state.model, {f"of_{view.over}": view.quantity}
        if view.over == "wm":
            source = assemble("views/hemisphere_wm.frag", {**model.choices(), **slots})
        else:
            source = of_model("views/hemisphere_wi.frag", model, slots=slots)
        self.program = gpu.program(source)
        self.place = {"size": tuple(map(float, size)), "middle": tuple(map(float, middle)), "pixel": self.pixel}
        self.uniforms = {"material": model, "wo": tuple(wo), "up": up, "peak": tuple(disc(peak.w))} | self.place
        if view.over == "wm":
            self.uniforms["alpha"] = model.alpha
        self.values, self.side = None, 1

    def draw(self, target, n=0, side=1, box=None):
        """Pass n into a target in which a pixel stands for `side` along each side."""
        place = {"size": tuple(c / side for c in self.place["size"]), "pixel": self.pixel * side}
        uniforms = self.uniforms | place | {"share": 1 / (n + 1), "pass": n}
        self.gpu.draw(self.program, target, uniforms, blend="mean" if n else None, box=box)

    def small(self, side):
        target = self.gpu.target(f"{self.name} {side}", tuple(-(-n // side) for n in self.size))
        self.draw(target, side=side)
        return target

    def passes(self, most):
        """Draw the mean of `most` passes, in steps; yield the number of whole ones after each."""
        width, height = self.size
        pace = Pace(self.gpu, self.program, np.minimum(chords(height, 1 / self.pixel + 1), width))
        side = pace.preview(self.small)
        if side > 1:
            self.values, self.side = self.small(side), side
            yield 0
        target = self.gpu.target(f"{self.name} values", self.size)
        for n in range(most):
            for last in pace.strips(lambda box, n=n: self.draw(target, n, box=box), width):
                if last:
                    self.values, self.side = target, 1
                yield n + last

    def painted(self, view, most, paper):
        """The framebuffer of the values' colours, of which the last is that of `most`."""
        target = self.gpu.target(self.name, self.size, 4, "f1")
        uniforms = {"side": float(self.side), "decades": float(view.decades), "paper": rgb(paper)} | self.place
        uniforms["share"] = 1 / most if most > 0 else 0.0
        program = self.gpu.program(assemble("views/hemisphere_paint.frag", {"radius": view.colors}))
        self.gpu.draw(program, target, uniforms, {"values": self.values.color_attachments[0]})
        return target


@dataclass(frozen=True)
class Hemisphere(Drawn):
    """A quantity over the hemisphere of directions, on a disc of equal areas, with directions that the sampler draws."""

    title = "Hemisphere"

    quantity: str = choice("pdf", QUANTITIES, "what the colours show: f and pdf over ωi, D and D_visible over ωm")
    colors: str = choice("log", ("log", "linear"), "scale of the colours")
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
        """The quantity, 1/sr (...), of a model or its Shader for directions w (..., 3)."""
        if self.quantity == "D":
            return slot("ndf", model.ndf).D(w, np.array(model.alpha))
        if self.quantity == "D_visible":
            return D_visible(model, wo, w)
        if self.quantity == "pdf":
            return model.pdf(wo, w)
        return luminance(model.f(wo, w)) * (np.abs(w[..., 2]) if self.quantity == "f_cos" else 1.0)

    def hemispheres(self, model):
        """`up` of the hemispheres that are shown."""
        return (1.0,) if self.over == "wm" or model.index() is None else (1.0, -1.0)

    def estimated(self, model):
        """Whether the quantity is a mean of estimates."""
        return model.stochastic and self.quantity in ("f", "f_cos")

    def peak(self, model, wo, up=1.0):
        """The Peak: the best of a grid that follows the lobe, then of steps from there that shrink."""
        *_, found = self.climb(model, wo, up, model)
        return found

    def climb(self, model, wo, up, quick):
        """Yield ever better Peaks; the last is that of `peak`. quick: what evaluates the grid, the model or its Shader."""
        turn = np.array([1.0, 1.0, up])
        if self.over == "wm":
            w = facets(np.array([0.0, 0.0, 1.0]), model.alpha, RAYS)[0]
        else:
            (side,) = (s for s in sides(wo, model.slopes(), model.index()) if s.up == up)
            w = quadrature(side.wo, side.alpha, RAYS)[0].wi
        values = self.values(model if self.over == "wm" else quick, wo, w * turn)
        best, reach = around(values, w)
        yield Peak(float(values.max()), of_disc(best), reach)
        steps = np.stack(np.meshgrid(*[np.linspace(-1, 1, 5)] * 2), axis=-1).reshape(-1, 2)
        for n, step in enumerate(0.1 * max(reach, 1e-6) * 0.3 ** np.arange(12), 1):
            tries = best + step * steps
            tries /= np.maximum(np.linalg.norm(tries, axis=-1, keepdims=True) / EDGE, 1.0)
            values = self.values(model, wo, of_disc(tries) * turn)
            best = tries[values.argmax()]
            if n % 4 == 0:
                yield Peak(float(values.max()), of_disc(best), reach)

    def peak_of(self, table):
        """The Peak of estimates in a Table."""
        w = table.grid.wi * [1.0, 1.0, table.side.up]
        values = luminance(table.f) * (w[..., 2] if self.quantity == "f_cos" else 1.0)
        best, reach = around(values, w)
        return Peak(float(values.max()), of_disc(best), reach)

    def mass(self, model, wo, evaluator=None):
        """The integral that QUANTITIES names, by quadrature of a model, or over directions to the light of its Shader."""
        if self.quantity == "D":
            return projected_area(model, (0.0, 0.0, 1.0))
        if self.quantity == "D_visible":
            return projected_area(model, wo) / float(slot("ndf", model.ndf).visible_area(wo, np.array(model.alpha)))

        evaluator = evaluator or model

        def function(wo, wi):
            if self.quantity == "pdf":
                return evaluator.pdf(wo, wi)[..., None]
            return luminance(evaluator.f(wo, wi))[..., None] * np.abs(wi[..., 2:])

        return float(integral(function, wo, model.slopes(), tolerance=1e-6, most=256, index=model.index()).value[0])

    def drawn(self, model, wo, up=1.0):
        """The directions (n, 3) that the sampler draws in that hemisphere, or all half vectors."""
        wi = model.sample_f(wo, np.random.default_rng(1).random((self.samples, 2)))[0]
        return wi[up * wi[:, 2] > 0] * [1.0, 1.0, up] if self.over == "wi" else normalize(wo + wi)

    def drawings(self, gpu, state, size, scale=1.0):
        model = state.model
        if self.over == "wm" and "ndf" not in model.choices():
            words = f"No {self.quantity} to show:", f"{model.name()} has no distribution of normals"
            yield nothing(size, scale, state.look.theme, *words), "", True
            return
        wo = direction(np.radians(state.directions.theta_o), np.radians(state.directions.phi_o))
        tables = progressive(gpu, model, state.directions, passes=PASSES) if self.estimated(model) else None
        for found in self.peaks(gpu, model, wo, tables):
            peaks = dict(found)
            if gpu.pace:
                yield None, "", False
        samples = {up: disc(self.drawn(model, wo, up)) for up in peaks}
        if gpu.pace:
            yield None, "", False
        places = self.places(peaks, size, scale)
        maps = {name: one for place in places for name, one in self.maps(gpu, state, wo, place, peaks, scale).items()}
        runs = {name: one.passes(WALKS if tables else 1) for name, one in maps.items()}
        runs["integral"] = self.integrals(gpu, model, wo, tables)
        drawn, since = None, 0.0
        for found, done in in_turn(gpu, runs):
            if not maps.keys() <= found.keys():
                yield None, "", False
                continue
            words, values = found.get("integral", ("", {}))
            peaks |= {up: peaks[up]._replace(value=value) for up, value in values.items()}
            if drawn is None or done or tables and time.perf_counter() - since > REDRAWN:
                drawn, since = self.drawing(state, wo, peaks, places, maps, samples, size, scale), time.perf_counter()
            up, peak = max(peaks.items(), key=lambda item: item[1].value)
            theta, phi = np.degrees(angles(peak.w * [1.0, 1.0, up])).round(2) + 0.0  # which makes -0 a 0
            note = f"peak {number(peak.value, 4)} / sr at θ {theta:g}°" + f", φ {phi % 360:g}°" * bool(theta)
            if tables:
                walks = max(min(found[name] for name in maps), 1)
                note += f", {walks} walk{'s' * (walks > 1)} a pixel"
            yield drawn, note + f"; {QUANTITIES[self.quantity][1]} = {words}" * bool(words), done

    def peaks(self, gpu, model, wo, tables):
        """Yield {up: Peak}, better and better and of one hemisphere more, or from the first estimates in Tables."""
        if tables:
            for found, _ in islice(tables, FEW):
                yield {t.side.up: self.peak_of(t) for t in found}
            return
        found = {}
        for up in self.hemispheres(model):
            for peak in self.climb(model, wo, up, Shader(gpu, model)):
                found[up] = peak
                yield found

    def integrals(self, gpu, model, wo, tables):
        """Yield the integral that QUANTITIES names, as words, and largest values by hemisphere where they get better."""
        for found, _ in tables or ():
            parts = [luminance(t.albedo) / t.side.dense for t in found]
            cosine = [t.weight * np.abs(t.grid.wi[..., 2]) for t in found]
            error = np.sqrt(sum(np.sum((c * luminance(t.error)) ** 2) for c, t in zip(cosine, found, strict=True)))
            words = f"{sum(parts):.4f} ± {number(error, 1)}"
            yield words, {t.side.up: self.peak_of(t).value for t in found}
        if not tables:
            yield f"{self.mass(model, wo, Shader(gpu, model)):.5f}", {}

    def places(self, peaks, size, scale):
        """The Places of the hemispheres in a picture of that size."""
        beside = len(peaks) if size[0] >= size[1] else 1  # and else one below the other
        part = np.array([size[0] / beside, size[1] * beside / len(peaks)])
        found = []
        for i, (up, peak) in enumerate(peaks.items()):
            corner = np.array([i * part[0], 0.0]) if beside > 1 else np.array([0.0, (len(peaks) - 1 - i) * part[1]])
            center, radius, bar, lens = layout(part / scale, peak.reach < NARROW)
            center, radius = corner + center * scale, radius * scale
            at = np.round(center).astype(int) - int(radius) - 2
            if bar:
                bar = np.array(bar) * scale + [*corner, *corner]
            if lens:
                lens = np.round(np.array(lens) * scale + [*corner, 0.0]).astype(int)
            where = ("above the surface", "below it, seen through it")[i] if len(peaks) > 1 else OVER[self.over]
            found.append(Place(up, corner + [12 * scale, part[1] - 33 * scale], at, radius, bar, lens, where))
        return found

    def maps(self, gpu, state, wo, place, peaks, scale):
        """The Maps of a Place, {(up, "disc" or "inset"): Map}."""
        peak = peaks[place.up]
        shown = (self, gpu, state, wo, place.up, peak)
        found = {
            (place.up, "disc"): Map(*shown, "disc", (2 * place.half, 2 * place.half), (0.0, 0.0), 1 / place.radius)
        }
        if place.lens is not None:
            side = int(place.lens[2])
            found[place.up, "inset"] = Map(*shown, "inset", (side, side), disc(peak.w), 2 * across(peak) / side)
        return found

    def drawing(self, state, wo, peaks, places, maps, samples, size, scale):
        draw = Drawing(size, scale, state.look.theme)
        most = max(peak.value for peak in peaks.values())
        for place in places:
            self.disc_of(draw, state, wo, place, peaks[place.up], most, maps, samples[place.up])
        draw.text(QUANTITIES[self.quantity][0], (12 * scale, size[1] - 15 * scale), "ink", (0.0, 0.5), 12.5)
        return draw

    def disc_of(self, draw, state, wo, place, peak, most, maps, samples):
        """One hemisphere with samples (n, 2) on its disc; `most` has the last colour."""
        scale, up, center, radius = draw.scale, place.up, place.center, place.radius
        if place.bar is not None:
            draw.text(place.where, place.title, "muted", (0.0, 0.5), 11.5)
        draw.raster(place.at, maps[up, "disc"].painted(self, most, draw.color("paper")))
        turn = np.radians(np.arange(0, 361, 4))
        ring = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        phi = np.radians(state.directions.phi_o)
        draw.over()
        for theta in (30, 60):
            draw.stroke(center + radius * ring * np.sqrt(2) * np.sin(np.radians(theta / 2)), "#ffffff", 1.0, 0.35)
        draw.stroke(center + radius * np.array([-direction2(phi), direction2(phi)]), "#ffffff", 1.0, 0.35)
        draw.stroke(center + radius * ring, "muted", 1.2)
        dots(draw, center + radius * samples)
        if place.lens is not None:
            left, bottom, side = place.lens
            inset, reach, middle = maps[up, "inset"], across(peak), disc(peak.w)
            draw.raster((left, bottom), inset.painted(self, most, draw.color("paper")))
            draw.over()
            near = samples[np.all(np.abs(samples - middle) < reach * (1 - 4 * scale / side), axis=-1)]
            dots(draw, (left + side / 2, bottom + side / 2) + (near - middle) / inset.pixel)
            draw.over()
            square(draw, (left + side / 2, bottom + side / 2), side / 2, "ink")
            square(draw, center + radius * middle, max(reach * radius, 5 * scale), "#ffffff")
            words = f"the peak, {number(np.degrees(2 * np.sqrt(2) * reach), 2)}° across"
            draw.text(words, (left + side / 2, bottom - 9 * scale), "muted", size=11.0)
        draw.over()
        self.names(draw, center, radius, wo, phi, up, state.model.index())
        if place.bar is not None:
            logarithmic = self.colors == "log" and most > 0
            low = most / 10**self.decades if logarithmic else 0.0
            axis = Axis(low, most or 1.0, scale="log" if logarithmic else "linear")
            colorbar(maps[up, "disc"].gpu, draw, place.bar, axis)

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


def around(values, w):
    """Of values over directions w (..., 3): the place (2,) of the largest on the disc, and how far those over FAINT of it are."""
    best = disc(w[np.unravel_index(values.argmax(), values.shape)])
    return best, float(np.linalg.norm(disc(w[values >= FAINT * values.max()]) - best, axis=-1).max())


def across(peak):
    """Half of the side of a Peak's inset, on the disc."""
    return max(1.3 * peak.reach, 1e-5)


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

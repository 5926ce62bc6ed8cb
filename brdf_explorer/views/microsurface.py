"""The microsurface: rough ground with the material's slopes, which of it light and viewer reach, and what Smith says of it."""

import time
from dataclasses import dataclass

import numpy as np

from ..glsl import assemble
from ..measure.surface import (
    BINS,
    G1,
    HORIZON,
    LAWS,
    P2,
    A,
    along,
    first_hit,
    lit,
    measured,
    measuring,
    patch,
    seeds,
    surface,
)
from ..model import Invalid, choice, declared, param
from .axes import Axes, Axis
from .diagram import arrow, nice_step, number
from .drawing import Drawing, Drawn, width_of, wrapped
from .picture import PALETTES, R2, Curves, rgb

KINDS = {"beckmann": "gaussian", "ggx": "ellipsoids"}
NAMES = {"beckmann": "Beckmann", "ggx": "Trowbridge-Reitz"}
COARSE, FINE = 65, 161  # heights along a side of the surface: of the first picture and of the others
PASSES = 4  # jittered drawings whose mean has smooth edges
TARGETS = {"surface": ("f1",), "once": ("f1", True), "mean": ("f2",)}  # of the passes: what shows, one, their mean
SURFACES = 16  # that are measured: the lit area's standard error is then below 0.002
ROOM = (560, 400)  # points from which a picture has room for two columns, and for two rows
TALL = (400, 600)  # points from which a single column has room for all
CLASSES = (("visible", "ink"), ("shadowed", "red"), ("masked", "blue"), ("both", "purple"))
RAYS = 9  # places of the profile that rays are drawn from


@dataclass(frozen=True)
class Microsurface(Drawn):
    """A surface that has the slopes of the active material's alpha, what hides what on it, and Smith's functions beside it.

    The material owns alpha; tau is this view's, and the heights' sigma follows. Where alpha_x and alpha_y differ the surface is
    stretched, and tau is the correlation length across the grain. The light is in the plane of incidence, on the viewer's
    other side, at the light's angle to the eye.
    """

    title = "Microsurface"
    instrument = True

    surface: str = choice(
        "material", ("material", *LAWS), "the surface: that of the material's ndf, or one of these with its alpha"
    )
    tau: float = param(
        10.0, 0.1, 1000.0, "correlation length; of ellipsoids the largest radius", scale="log", unit="μm"
    )
    extent: float = param(10.0, 3.0, 24.0, "width of the surface shown, in correlation lengths", scale="log")
    seed: int = param(1, 0, 9999, "number of the random surface")
    show: str = choice("all", ("all", "surface", "profile", "statistics"), "which of the drawings")
    azimuth: float = param(-65.0, -180.0, 180.0, "azimuth of the camera about the viewer's plane", unit="deg")
    elevation: float = param(30.0, 5.0, 90.0, "height of the camera over the surface", unit="deg")

    def shows(self, state):
        return (self, state.model, state.directions, state.light.theta, state.look.theme)

    def ground(self, state):
        """The Ground under the state. Raises Invalid for a material without a distribution of facets."""
        model = state.model
        if not {"alpha", "ndf"} <= set(declared(model)):
            raise Invalid(f"{state.material.name} ({model.name()}) has no distribution of facets, so no microsurface")
        kind = KINDS[model.ndf] if self.surface == "material" else self.surface
        alpha = (model.alpha[0], 0.0) if kind == "brushed" else model.alpha
        theta = np.radians(state.directions.theta_o)
        return Ground(
            kind, self.seed, alpha, theta, theta - np.radians(state.light.theta), np.radians(state.directions.phi_o)
        )

    def layout(self, size, scale=1.0):
        """The box of each drawing that there is room for, by name: left, bottom, right, top in pixels from the bottom left."""
        width, height = size
        wide, high = (n >= room * scale for n, room in zip(size, ROOM, strict=True))
        foot, top = (24 * scale if height > 200 * scale else 0.0), height - 26 * scale

        def box(left, low, right, high):
            """Of shares of the picture's width, and of the height between foot and top."""
            y = (foot + share * (top - foot) for share in (low, high))
            return (left * width, next(y), right * width, next(y))

        whole = box(0, 0, 1, 1)
        if self.show == "statistics":
            if wide:
                return {"slopes": box(0, 0, 0.5, 1), "visibility": box(0.5, 0, 1, 1)}
            if high:
                return {"visibility": box(0, 0, 1, 0.6), "slopes": box(0, 0.6, 1, 1)}
            return {"visibility": whole}
        if self.show != "all":
            return {self.show: whole}
        if wide and high:  # below the visibility stands why it is not Smith's
            left = {"surface": box(0, 0.5, 0.55, 1), "profile": box(0, 0, 0.55, 0.5)}
            return left | {"slopes": box(0.55, 0.6, 1, 1), "visibility": box(0.55, 0, 1, 0.6)}
        if wide:
            return {"surface": box(0, 0, 0.5, 1), "profile": box(0.5, 0, 1, 1)}
        if height >= TALL[1] * scale and width >= TALL[0] * scale:
            upper = {"surface": box(0, 0.68, 1, 1), "profile": box(0, 0.38, 1, 0.68)}
            return upper | {"slopes": box(0, 0, 0.46, 0.38), "visibility": box(0.46, 0, 1, 0.38)}
        if high:
            return {"surface": box(0, 0.5, 1, 1), "profile": box(0, 0, 1, 0.5)}
        return {"profile": whole}

    def pivot(self, state, size, scale=1.0):
        """The place (2,) about which a drag turns the viewer, in pixels from the bottom left."""
        left, bottom, right, _ = self.layout(size, scale).get("profile", (0, 0, size[0], size[1]))
        return np.array([(left + right) / 2, bottom + 40 * scale])

    def drawings(self, gpu, state, size, scale=1.0):
        try:
            ground = self.ground(state)
        except Invalid as error:
            draw = Drawing(size, scale, state.look.theme)
            paragraph(draw, str(error), (12 * scale, size[1] - 18 * scale), size[0] - 24 * scale, "muted")
            yield draw, "", True
            return
        boxes = self.layout(size, scale)
        draw, note = None, ""
        for stage in self.stages(gpu, ground, boxes, state.look.theme):
            if stage is None:
                if gpu.pace is not None:
                    yield draw, note, False
                continue
            cut, target, found, done = stage
            draw = Drawing(size, scale, state.look.theme)
            say(draw, self.heading(ground, size[0] / scale), (12 * scale, size[1] - 15 * scale), "ink", (0.0, 0.5))
            if "surface" in boxes:
                self.draw_surface(draw, boxes["surface"], cut, target)
            if "profile" in boxes:
                self.draw_profile(draw, boxes["profile"], cut)
            if "slopes" in boxes:
                draw_slopes(draw, boxes["slopes"], ground, found)
            if "visibility" in boxes:
                draw_visibility(draw, boxes["visibility"], ground, found)
            note = ""
            if found:
                alpha, error = (ground.along * value for value in found.alpha)
                note = f"{found.count} surface{'s' * (found.count > 1)} measured, α = {number(alpha, 4)}"
                note += f" ± {error:.1g}" if found.count > 1 else ""
            yield draw, note, done

    def stages(self, gpu, ground, boxes, theme):
        """(Cut, its picture, Measured, done): few heights, then all of them, smooth edges, and one surface more each time.

        None is a step between two of these.
        """
        left, bottom, right, top = boxes.get("surface", (0, 0, 1, 1))
        size = (max(round(right - left), 1), max(round(top - bottom), 1))
        targets = [gpu.target(f"microsurface.{n}", size, 4, *of) for n, of in TARGETS.items()]

        def relief(cut, i=0, count=1):
            return self.relief(gpu, targets, boxes["surface"], cut, theme, i, count) if "surface" in boxes else None

        surface(ground.kind, ground.seed)
        yield None
        cut = ground.cut(self.extent, COARSE)
        yield cut, relief(cut), None, False
        cut = ground.cut(self.extent, FINE)
        yield None
        target = relief(cut)
        yield None
        passes = PASSES if target else 0
        most = SURFACES if {"slopes", "visibility"} & set(boxes) else 0
        yield cut, target, None, passes + most == 0
        for i in range(passes):
            relief(cut, i, PASSES)
            yield None
        if passes:
            yield cut, target, None, most == 0
        for count, seed in enumerate(seeds(ground.seed, most), 1):
            one, start = measuring(ground.kind, seed), time.perf_counter()
            while one.result is None:
                one.step()
                if gpu.pace is not None and time.perf_counter() - start >= gpu.pace:
                    yield None
                    start = time.perf_counter()
            yield cut, target, measured(ground.kind, ground.seed, count), count == most

    def table_of(self, gpu, state):
        """Smith's functions and the measured ones over theta in degrees."""
        ground = self.ground(state)
        found = measured(ground.kind, ground.seed, SURFACES)
        law = LAWS[ground.kind]
        columns = {"a": A, "G1": G1(law, A), "visible": found.visible[0], "visible error": found.visible[1]}
        columns |= {"lit by Smith": lit(law, A), "lit": found.lit[0], "lit error": found.lit[1]}
        theta = np.degrees(ground.theta_of(A))
        return Curves("theta [deg]", theta[::-1], {name: values[::-1] for name, values in columns.items()})

    def heading(self, ground, room):
        """What the surface is, with its lengths, in as many words as there is room for in points."""
        ax, ay = ground.alpha
        steep = max(ground.alpha)
        same = ax == ay

        def um(value):
            return f"{number(self.tau * value)} μm"

        if ground.kind == "ellipsoids":
            radius = f"radius {um(1)}" if same else f"half axes {um(steep / ax)}, {um(steep / ay)}"
            words = [f"α = height / radius = {number(ax)}" if same else f"αx, αy = {number(ax)}, {number(ay)}"]
            words += [f"{radius}, height {um(steep)} at most", "half ellipsoids (Trowbridge-Reitz)"]
        else:
            words = ["α = √2 σ / τ = " if same else "αx, αy = √2 σ / τx, τy = "]
            words[0] += number(ax) if same else f"{number(ax)}, {number(ay)}"
            lengths = f"τ {um(1)}" if same or ay == 0 else f"τx {um(steep / ax)}, τy {um(steep / ay)}"
            words += [f"σ {um(steep / np.sqrt(2))}, {lengths}", f"{ground.kind} (Beckmann)"]
        while len(words) > 1 and 6.2 * len("     ".join(words)) > room - 24:
            words.pop()
        return "     ".join(words)

    # --- the surface ---------------------------------------------------------------------------------------------------

    def camera(self, box, cut):
        """(right, up, eye, centre in pixels from the box's corner, pixels a tau) of the block in a box."""
        azimuth, elevation = np.radians(self.azimuth), np.radians(self.elevation)
        ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
        right, up, eye = np.array([-sa, ca, 0.0]), np.array([-se * ca, -se * sa, ce]), np.array([ce * ca, ce * sa, se])
        reach = self.extent / 2 * (abs(ca) + abs(sa))
        low, high = cut.foot * ce - reach * se, cut.top * ce + reach * se
        width, height = box[2] - box[0], box[3] - box[1]
        unit = max(min(0.92 * width / (2 * reach), 0.8 * height / (high - low)), 1e-3)
        return right, up, eye, np.array([width / 2, 0.44 * height - unit * (low + high) / 2]), unit

    def relief(self, gpu, targets, box, cut, theme, i, count):
        """Draw jittered pass i of `count` of the surface; the first of the targets, which has their mean from the last on."""
        colors = dict(zip(("body", "shadowed", "masked", "both"), SKIN[theme], strict=True))
        target, once, mean = targets
        program = gpu.program(assemble("views/microsurface.frag"), assemble("views/microsurface.vert"))
        over = gpu.program(assemble("views/over.frag"))
        field = gpu.texture(np.stack([cut.heights, corners(cut.lit), corners(cut.seen)], axis=-1))
        right, up, eye, center, unit = self.camera(box, cut)
        half = np.array(target.size) / 2
        uniforms = {"right": tuple(right), "up": tuple(up), "eye": tuple(eye), "unit": tuple(unit / half)}
        uniforms |= {"pitch": cut.pitch, "foot": cut.foot, "depth": 0.5 / self.extent}
        uniforms |= {name: rgb(color) for name, color in colors.items()} | {"side": rgb(WALL[theme])}
        uniforms |= {"light": (np.sin(cut.ground.theta_i), 0.0, np.cos(cut.ground.theta_i))}
        paper = rgb(PALETTES[theme]["paper"])
        if i == 0:
            mean.clear()
        jitter = (R2 * i + 0.5) % 1.0 - 0.5 if count > 1 else np.zeros(2)
        once.clear(*paper, 1.0)
        uniforms |= {"center": tuple((center + jitter) / half - 1)}
        gpu.draw(program, once, uniforms, {"field": field}, index=block(gpu, len(cut.heights)), depth=True)
        gpu.draw(over, mean, {"share": 1 / count}, {"picture": once.color_attachments[0]}, blend="add")
        if i == count - 1:
            gpu.draw(over, target, {"share": 1.0}, {"picture": mean.color_attachments[0]})
        return target

    def draw_surface(self, draw, box, cut, target):
        """The surface, the profile along its front, and arrows to viewer and light."""
        scale = draw.scale
        draw.raster(box[:2], target)
        right, up, eye, center, unit = self.camera(box, cut)

        def pixels(points):
            points = np.asarray(points)
            return np.array(np.round(box[:2])) + center + unit * np.stack([points @ right, points @ up], axis=-1)

        n = len(cut.heights)
        u = (np.arange(n) - (n - 1) / 2) * cut.pitch
        front = np.full(n, -self.extent / 2)
        if eye[1] < 0:
            draw.stroke(pixels(np.stack([u, front, cut.heights[0]], axis=-1)), "ink", 1.4)
        start = np.array([0.0, 0.0, float(cut.heights.max())])
        length = 0.4 * self.extent
        for name, color, theta in cut.ground.pointers():
            w = np.array([np.sin(theta), 0.0, np.cos(theta)])
            foot, tip = pixels([start, start + length * w])
            for points in arrow(foot, tip, scale):
                draw.stroke(points, color, 1.6)
            say(draw, name, tip + 11 * scale * unit_vector(tip - foot), color, size=13.0)
        draw.over()

    # --- the profile ---------------------------------------------------------------------------------------------------

    def draw_profile(self, draw, box, cut):
        """The front edge in the plane of incidence: its facets by what reaches them, and rays."""
        scale = draw.scale
        left, bottom, right, top = box
        z = cut.heights[0]
        n = len(z)
        room = np.array([right - left - 24 * scale, 0.42 * (top - bottom)])
        unit = max(min(room[0] / self.extent, room[1] / max(np.ptp(z), 1e-9)), 1e-3)
        x = (left + right) / 2 + unit * (np.arange(n) - (n - 1) / 2) * cut.pitch
        y = bottom + 30 * scale + unit * (z - z.min())
        line = np.stack([x, y], axis=-1)
        ground = cut.ground

        # the legend, with shares of the whole surface
        shares = cut.shares()
        plain = shares[0] > 0.995
        sky = (left + 4 * scale, bottom, right - 4 * scale, top - (36 if plain else 22) * scale)
        at = left + 12 * scale
        for (name, color), share in zip(CLASSES, shares, strict=True):
            words = f"{name} {percent(share)}"
            extent = width_of(words, 12.0) * scale
            if at + extent < right:
                say(draw, words, (at, top - 10 * scale), color, (0.0, 0.5))
            at += extent + 14 * scale

        # rays from some places: to the light and to the viewer, or to what is in the way
        row = cut.rows[0]
        inset = len(z) // (2 * RAYS)
        for i in np.linspace(inset, n - 2 - inset, RAYS).round().astype(int):
            middle = line[i : i + 2].mean(axis=0)
            for theta, free, color in ((ground.theta_i, "green", "red"), (ground.theta_o, "accent", "blue")):
                w = np.array([np.sin(theta), np.cos(theta)])
                slope = (z[i + 1] - z[i]) / cut.pitch
                if w[1] < HORIZON or w[1] - slope * w[0] <= 0:
                    continue
                hit = first_hit(row, cut.pitch, n - 1 + i, w)
                if hit is None:
                    draw.stroke(clipped(middle, w, sky), free, 1.0, 0.45)
                    continue
                end = middle + w / w[0] * unit * cut.pitch * (hit - (n - 1 + i + 0.5))
                draw.stroke(clipped(middle, w, sky, float(np.linalg.norm(end - middle))), color, 1.0, 0.8)
        draw.over()

        # the facets
        lit, seen = cut.lit[0], cut.seen[0]
        classes = 1 * (lit < 0.5) + 2 * (seen < 0.5)
        ends = np.flatnonzero(np.diff(classes)) + 1
        for run in np.split(np.arange(n - 1), ends):
            draw.stroke(line[run[0] : run[-1] + 2], CLASSES[classes[run[0]]][1], 2.6)
        draw.over()
        if len(ground.pointers()) == 1:
            middle = np.array([(left + right) / 2, top - 30 * scale])
            say(draw, "the light is below the horizon", middle, "muted")
        elif plain:
            words = "nearly nothing is hidden: rougher ground or lower directions hide more"
            say(draw, words, (left + 12 * scale, top - 26 * scale), "muted", (0.0, 0.5), 11.0)
        self.draw_reflection(draw, line, cut, sky)
        self.draw_bar(draw, (left + 12 * scale, bottom + 12 * scale), unit, right - left - 24 * scale)

    def draw_reflection(self, draw, line, cut, sky):
        """Viewer, light and half vector at the facet that is nearest to reflect one to the other."""
        scale, ground = draw.scale, cut.ground
        pointers = ground.pointers()
        z, n = cut.heights[0], len(cut.heights)
        place = np.arange(n - 1) / (n - 2) - 0.5
        if len(pointers) == 2:
            half = 0.5 * (ground.theta_o + ground.theta_i)
            pointers.append(("ωm", "ink", half))
            off = np.abs(np.arctan(np.diff(z) / cut.pitch) + half)
        else:
            off = np.zeros(n - 1)
        reached = (cut.lit[0] > 0.99) & (cut.seen[0] > 0.99) & (np.abs(place) < 0.4)
        # the best turned one near the middle: the whole width counts as a tilt of 0.3; one out of reach only if all are
        i = int(np.argmin(off + 0.3 * np.abs(place) + 10.0 * ~reached))
        foot = line[i : i + 2].mean(axis=0)
        for name, color, theta in pointers:
            w = np.array([np.sin(theta), np.cos(theta)])
            length = (0.5 if name == "ωm" else 0.75) * max(sky[3] - foot[1], 1.0)
            end = clipped(foot, w, sky, length)[1]
            for points in arrow(*((end, foot) if name == "ωi" else (foot, end)), scale):
                draw.stroke(points, color, 2.0)
            say(draw, name, end + 11 * scale * w, color, size=13.0)

    def draw_bar(self, draw, at, unit, room):
        """A bar of a round length, for both axes."""
        length = nice_step(0.16 * self.extent * self.tau)
        end = at + np.array([unit * length / self.tau, 0.0])
        tick = np.array([0.0, 3 * draw.scale])
        for points in ([at, end], [at - tick, at + tick], [end - tick, end + tick]):
            draw.stroke(points, "muted", 1.2)
        words = f"{number(length)} μm, heights too"
        if end[0] - at[0] + 6.2 * draw.scale * len(words) < room:
            say(draw, words, end + [6 * draw.scale, 0], "muted", (0.0, 0.5), 11.0)


# colours of the surface in 3D: visible, shadowed, masked, both; and of its walls
SKIN = {
    "light": ("#f3efe6", "#f0958a", "#93b4f5", "#b48bdc"),
    "dark": ("#a39e94", "#dc6a5e", "#5f8df0", "#9a62d0"),
}
WALL = {"light": "#c9c5bc", "dark": "#4a4a4d"}


@dataclass(frozen=True)
class Ground:
    """A surface and the directions that it is looked at and lit from, radians; theta_i is negative beyond the normal."""

    kind: str
    seed: int
    alpha: tuple
    theta_o: float
    theta_i: float
    phi: float

    @property
    def along(self):
        """Scale of the slopes in the plane of incidence."""
        return along(self.kind, self.alpha, self.phi)

    def theta_of(self, a):
        """The angle at which 1 / (alpha tan theta) is a."""
        return np.arctan2(1.0, self.along * a)

    def a_of(self, theta):
        """1 / (alpha tan theta), at most 1e6."""
        return np.cos(theta) / np.maximum(self.along * np.sin(theta), 1e-6 * np.cos(theta))

    def pointers(self):
        """(name, colour, angle) of the viewer, and of the light if it is above the horizon."""
        light = [("ωi", "green", self.theta_i)] * int(np.cos(self.theta_i) >= HORIZON)
        return [("ωo", "accent", self.theta_o), *light]

    def cut(self, extent, n):
        return Cut(self, patch(self.kind, self.seed, self.alpha, self.phi, extent, n))


class Cut:
    """The part of a Ground that is shown, with the share of each segment of its rows that is lit and that is seen."""

    def __init__(self, ground, part):
        self.ground = ground
        self.rows, self.heights, self.pitch = part.rows, part.heights, part.pitch
        self.lit, self.seen = part.seen(ground.theta_i), part.seen(ground.theta_o)
        self.top = float(self.heights.max())
        self.foot = float(self.heights.min()) - 0.04 * self.pitch * len(self.heights)

    def shares(self):
        """Shares of the area, projected along the normal, that are visible, shadowed, masked and both."""
        dark, hidden = 1 - self.lit, 1 - self.seen
        return [float(np.mean(s)) for s in (self.lit * self.seen, dark * self.seen, self.lit * hidden, dark * hidden)]


def percent(share):
    """A share in percent, also of what is rare."""
    return f"{100 * share:.0f} %" if share >= 0.01 else f"{number(100 * share, 1)} %"


def corners(share):
    """Shares (n, n - 1) of segments as those (n, n) of their corners."""
    padded = np.pad(share, ((0, 0), (1, 1)), mode="edge")
    return 0.5 * (padded[:, 1:] + padded[:, :-1])


def block(gpu, n):
    """Index buffer of the triangles of a field of n x n heights and its walls, kept with the Gpu."""
    name = f"microsurface {n}"
    if name not in gpu.buffers:
        row, column = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
        a = row * (n + 2) + column
        b = a + n + 2
        triangles = np.stack([a, a + 1, b, b, a + 1, b + 1], axis=-1)
        gpu.buffers[name] = gpu.ctx.buffer(triangles.astype("u4").tobytes())
    return gpu.buffers[name]


def clipped(start, w, box, most=np.inf):
    """The line (2, 2) from a point along a unit vector until it leaves a box, or for `most`."""
    left, bottom, right, top = box
    ends = [most, (top - start[1]) / max(w[1], 1e-9)]
    if abs(w[0]) > 1e-9:
        ends.append(((right if w[0] > 0 else left) - start[0]) / w[0])
    return np.array([start, start + max(min(ends), 0.0) * w])


def unit_vector(v):
    return v / max(np.linalg.norm(v), 1e-9)


# --- statistics ------------------------------------------------------------------------------------------------------


def inside(box, scale, below):
    """The frame of a plot in a box, with room for numbers, titles and a legend."""
    left, bottom, right, top = box
    left, bottom = left + 44 * scale, bottom + below * scale
    return (left, bottom, max(right - 18 * scale, left + 1), max(top - 48 * scale, bottom + 1))


def draw_slopes(draw, box, ground, found):
    """The histogram of slopes in the plane of incidence, and its law."""
    scale, law = draw.scale, LAWS[ground.kind]
    alpha = max(ground.along, 1e-9)
    x = Axis(-3 * alpha, 3 * alpha, "slope in the plane of incidence")
    y = Axis(0.0, 1.35 * float(P2(law, 0.0)) / alpha, "share per slope")
    axes = Axes(draw, inside(box, scale, 40), x, y)
    step = nice_step(1.2 * alpha)
    axes.frame([step * i for i in range(-2, 3) if abs(step * i) <= 3 * alpha])
    say(draw, f"P22, {NAMES[law]}", (axes.box[0], box[3] - 14 * scale), "accent", (0.0, 0.5))
    say(draw, "measured", (axes.box[2], box[3] - 14 * scale), "blue", (1.0, 0.5))
    if found:
        for low, high, value in zip(BINS[:-1], BINS[1:], found.slopes[0], strict=True):
            (left, foot), (right, top) = axes.place(alpha * np.array([low, high]), [0.0, value / alpha])
            draw.fill((left, foot, right, min(top, axes.box[3])), BARS[draw.theme])
    s = np.linspace(-3, 3, 121)
    axes.line(alpha * s, P2(law, s) / alpha, "accent", 2.0)


BARS = {"light": "#93b4f5", "dark": "#355ba8"}


def draw_visibility(draw, box, ground, found):
    """What a direction sees of the surface, by Smith and measured, over its angle; and why they differ."""
    scale, law = draw.scale, LAWS[ground.kind]
    left, bottom, right, top = box
    found_room = (wrapped([why], (right - left) / scale - 28, 11.5) for why in reasons(ground, found))
    words = next((lines for lines in found_room if top - bottom >= (190 + 15 * len(lines)) * scale), [])
    x, y = Axis(0.0, 90.0, "θ"), Axis(0.0, 1.0, "share that is seen from θ")
    axes = Axes(draw, inside(box, scale, 40 + (10 + 15 * len(words)) * bool(words)), x, y)
    angles = (0, 30, 60, 90)
    axes.frame(angles, [f"{angle}°" for angle in angles])
    say(draw, "facing facets: G1", (axes.box[0], top - 14 * scale), "accent", (0.0, 0.5))
    say(draw, "area", (axes.box[2], top - 14 * scale), "blue", (1.0, 0.5))
    theta_o = np.degrees(ground.theta_o)
    corner = axes.place(0.0, 0.0) + np.array([8, 12]) * scale
    legend = ("dots: rays over heights", "lines: Smith")
    crossed = axes.place(theta_o, 0.0)[0] < corner[0] + (width_of(legend[0], 11.0) + 4) * scale
    low = 38 * scale / (axes.box[3] - axes.box[1]) if crossed else 0.0  # from over the words on
    axes.line([theta_o, theta_o], [min(low, 1.0), 1.0], "muted", 1.0)
    say(draw, "θo", axes.place(theta_o, 1.0) + [0, 9 * scale], "muted", size=11.0)
    draw.over()
    theta = np.radians(np.linspace(0.0, 90.0, 181))
    a = np.clip(ground.a_of(theta), 1e-6, 20.0)  # from there on all is seen
    for function, color, values in ((G1, "accent", "visible"), (lit, "blue", "lit")):
        axes.line(np.degrees(theta), function(law, a), color)
        if found:
            mean, error = getattr(found, values)
            for at, m, e in zip(np.degrees(ground.theta_of(A)), mean, error, strict=True):
                draw.dot(axes.place(at, m), color, 5.0)
                if found.count > 1:
                    axes.line([at, at], [m - e, m + e], color, 1.0)
    for i, line in enumerate(legend):
        say(draw, line, corner + [0, 15 * i * scale], "muted", (0.0, 0.5), 11.0)
    for i, line in enumerate(words):
        at = (left + 14 * scale, bottom + (15 * (len(words) - i) - 6) * scale)
        draw.text(line, at, "ink", (0.0, 0.5), 11.5)


def reasons(ground, found):
    """Where the theory holds for a surface and where it does not, in many words and in few."""
    law = LAWS[ground.kind]
    if ground.along < 1e-6:
        return ["Along the grooves nothing hides anything."]
    widest = ""
    if found:
        gap = 100 * (found.lit[0] / lit(law, A) - 1)
        largest = gap[np.argmax(np.abs(gap))]
        widest = f" ({largest:+.{1 if abs(largest) < 10 else 0}f}\u00a0% at the most)"
    if ground.kind == "ellipsoids":
        covered = surface(ground.kind, ground.seed).covered
        return [
            f"The flat floor between ellipsoids, {100 * (1 - covered):.0f} % of the area, makes G1 = 1 / (1 + {covered:.2f} Λ). "
            "Smith takes heights and slopes as independent; here steep facets are all at the foot, and those are hidden. "
            f"From above they have little area, so more of it is seen than he says{widest}.",
            f"Smith's heights and slopes are independent; here steep facets lie low: more area is seen{widest}.",
        ]
    return [
        "Projected area is conserved, so facing facets follow G1 however heights are arranged. Smith also takes heights and "
        "slopes as independent; within τ they are not: facets tilted from the viewer are hidden more often, so less area is "
        f"seen than he says{widest}.",
        f"Smith's heights and slopes are independent; within τ they are not: less area is seen{widest}.",
    ]


# --- words -----------------------------------------------------------------------------------------------------------


def say(draw, words, at, color="ink", anchor=(0.5, 0.5), size=12.0):
    """A text where it has room: inside the picture and clear of those before, else none."""
    width, height = draw.size
    extent = np.array([width_of(words, size), 1.2 * size]) * draw.scale
    x, y = at[0] - anchor[0] * extent[0], at[1] - (1 - anchor[1]) * extent[1]
    if x < 0 or y < 0 or x + extent[0] > width or y + extent[1] > height:
        return
    for b in draw.labels:
        across, down = width_of(b.text, b.size) * draw.scale, 1.2 * b.size * draw.scale
        left, low = b.x - b.anchor[0] * across, height - b.y - (1 - b.anchor[1]) * down
        if x < left + across and left < x + extent[0] and y < low + down and low < y + extent[1]:
            return
    draw.text(words, at, color, anchor, size)


def paragraph(draw, words, at, width, color="ink", size=12.5):
    """Lines of text from the top left on."""
    for i, line in enumerate(wrapped([words], width / draw.scale, size)):
        say(draw, line, (at[0], at[1] - 1.4 * size * draw.scale * i), color, (0.0, 0.5), size)

"""The lobe of f over directions to the light, in 3D."""

import time
from dataclasses import dataclass, replace

import numpy as np

from ..glsl import assemble
from ..lib.colormap import viridis
from ..lib.srgb import luminance
from ..measure.grid import flat_refraction
from ..model import param
from .diagram import QUANTITIES, Diagram, apart, arrow, nice_step, number, powers_below, radius
from .drawing import cut
from .lines import Stroke, draw_lines
from .pace import REDRAWN
from .picture import PALETTES, R2, Label, Picture, rgb
from .table import NODES, RAYS, noise, progressive

PASSES = 8  # jittered drawings whose mean has smooth edges
FOOT = 36  # points from the lower edge to a line of words, under which the window has its note
BAR = 76  # points at the right for the legend
THIN = 3  # points across, below which a lobe is drawn as a line
AXIS = 24  # pieces of that line, each of one colour
ARROW = 1.12  # length of the arrows, in radii of the disc


@dataclass(frozen=True)
class Lobe(Diagram):
    """The lobe of f or f cos over all directions to the light, for one viewer."""

    title = "Lobe"

    azimuth: float = param(-60.0, -180.0, 180.0, "azimuth of the camera", unit="deg")
    elevation: float = param(20.0, 0.0, 90.0, "height of the camera over the surface", unit="deg")
    zoom: float = param(1.0, 0.2, 50.0, "size of the lobe", scale="log")

    def shows(self, state):
        return (self, state.model, state.directions, state.look.theme)

    def pictures(self, gpu, state, size, scale=1.0):
        picture, since = None, 0.0
        for values, final in progressive(gpu, state.model, state.directions):
            if picture and not final and time.perf_counter() - since < REDRAWN:
                yield picture
                continue
            note = described(values)
            if values[0].error is not None:
                note += f"; {values[0].walks} walks a direction"
                note += f", noise {number(100 * noise(values), 2)} %" if np.isfinite(values[0].error).all() else ""
            for drawn in self.drawn(gpu, state, values, size, scale):
                picture, since = replace(drawn, note=note, done=drawn.done and final), time.perf_counter()
                yield picture
                if not final:
                    break

    def drawn(self, gpu, state, values, size, scale):
        """Pictures of Tables, from the first to the smooth one."""
        colors = PALETTES[state.look.theme]
        peak = max(map(self.peak, values))
        share = 1 / peak if peak > 0 else 0.0
        target = gpu.target("lobe", size, 4, "f1")
        camera = Camera(self, size, scale, both=len(values) > 1)
        below, above, labels = stage(camera, values[0].wo, colors, state.model.index())
        outlines, widths = zip(*(self.outline(camera, t, share, colors) for t in values), strict=True)
        above += outlines[0]
        labels += thin(size, scale, colors, widths)
        over = gpu.program(assemble("views/over.frag"))
        surfaces = [self.surfaces(gpu.beside(f"lobe {i}"), t, camera, share) for i, t in enumerate(values)]
        picture = None
        for layers in zip(*surfaces, strict=True):
            (near, done), *far = layers
            if picture and not done:
                yield picture
                continue
            target.clear(*rgb(colors["paper"]), 1.0)
            for (layer, _), lines in zip(far, outlines[1:], strict=True):  # seen through the surface
                picture = {"picture": layer.color_attachments[0]}
                gpu.draw(over, target, {"share": 1.0}, picture, blend="premultiplied")
                draw_lines(gpu, target, lines)
            draw_lines(gpu, target, below)
            gpu.draw(over, target, {"share": 1.0}, {"picture": near.color_attachments[0]}, blend="premultiplied")
            draw_lines(gpu, target, above)
            legend = self.draw_bar(gpu, target, size, scale, peak, colors)
            picture = Picture(target, labels=labels + legend, done=done)
            yield picture

    def peak(self, values):
        """The largest of what the radius shows of a Table."""
        return float((luminance(values.f) * self.factor(values.grid.wi)).max())

    def outline(self, camera, values, share, colors):
        """Strokes along the slice of a Table through the plane of incidence, and None.

        Of a lobe too thin to be seen a line along its axis, too, in the map's colours, and its width at half the peak, radians.
        """
        theta, wi, f = values.plane()
        value = luminance(f) * self.factor(wi)
        profile = radius(value * share, self.radius, self.decades)
        strokes = [camera.stroke(wi * profile[:, None], colors["ink"], 1.0, 0.45)]
        at = int(np.argmax(profile))
        if profile[at] <= 0 or width(theta, profile) * profile[at] * camera.unit >= THIN * camera.scale:
            return strokes, None
        heights = np.linspace(0.0, profile[at], AXIS + 1)
        for low, high in zip(heights, heights[1:], strict=False):
            color = "#" + "".join(f"{c:02x}" for c in np.round(255 * viridis(np.array(high))).astype(int))
            strokes.append(camera.stroke([low * wi[at], high * wi[at]], color, 3.5))
        return strokes, width(theta, value)

    def surfaces(self, gpu, values, camera, share, paint="value", uniforms=None):
        """The lobe's triangles as (framebuffer of colour and coverage, done): one drawing at first, at last the mean of several.

        share: radius 1 over the largest value. paint: "value", the map's colours, or "plain", of the uniform `ink`.
        """
        size = camera.size
        vertex = assemble("views/lobe.vert", {"quantity": self.quantity, "radius": self.radius})
        program = gpu.program(assemble("views/lobe.frag", {"paint": paint}), vertex)
        add = gpu.program(assemble("views/over.frag"))
        textures = {"directions": values.directions, "values": values.target.color_attachments[0]}
        uniforms = {"share": share, "decades": float(self.decades)} | (uniforms or {})
        once = gpu.target("lobe.surface", size, 4, "f1", depth=True)
        mean = gpu.target("lobe.mean", size, 4, "f2")
        for n in range(PASSES):
            jitter = (R2 * n + 0.5) % 1.0 - 0.5
            once.clear()
            gpu.draw(program, once, uniforms | camera.uniforms(jitter), textures, index=surface(gpu), depth=True)
            if n == 0:
                mean.clear()
            gpu.draw(add, mean, {"share": 1 / PASSES}, {"picture": once.color_attachments[0]}, blend="add")
            done = n + 1 == PASSES
            yield mean if done else once, done

    def draw_bar(self, gpu, target, size, scale, peak, colors):
        """Draw the legend, the map's colours, if there is room; its Labels, the values they stand for."""
        top = size[1] - 44 * scale
        bottom = max(top - 180 * scale, 24 * scale)
        if top - bottom < 60 * scale:
            return []
        left = size[0] - (BAR - 4) * scale
        box = (left, bottom, left + 10 * scale, top)
        gpu.draw(gpu.program(assemble("views/colorbar.frag")), target, {"box": box}, blend="over", box=box)
        title = Label(QUANTITIES[self.quantity], size[0] - 10 * scale, 24 * scale, colors["ink"], (1.0, 0.5), 12.5)
        if self.radius == "linear":
            ticks = np.arange(0, peak * 0.9, nice_step(peak / 5)) if peak > 0 else []
        else:
            ticks = powers_below(peak * 0.6, self.decades)
        labels = [title]
        values = np.array([*ticks, peak])
        shares = values / peak if peak > 0 else 0 * values
        heights = bottom + radius(shares, self.radius, self.decades) * (top - bottom)
        for i in apart(heights, np.full(len(values), 12 * scale)):
            y = size[1] - heights[i]
            labels.append(Label(number(values[i]), left + 16 * scale, y, colors["muted"], (0.0, 0.5), 11.5))
        return labels


def width(theta, v):
    """How far the first and last angles theta (n,) are apart at which v (n,) is half of its largest, on lines through it."""
    half = 0.5 * v.max()
    first, last = np.flatnonzero(v >= half)[[0, -1]]
    before, after = max(first - 1, 0), min(last + 1, len(v) - 1)
    ends = (np.interp(half, v[[out, at]], theta[[out, at]]) for out, at in ((before, first), (after, last)))
    return float(abs(np.subtract(*ends)))


def thin(size, scale, colors, widths):
    """Labels that say how wide the lobes are, of a width in radians each, that are drawn as lines; None is one that is not."""
    known = [f"{number(np.degrees(angle), 2)}°" for angle in widths if angle is not None]
    if not known:
        return []
    lines = "lines" if len(known) > 1 else "a line"
    words = f"too thin to be seen, drawn as {lines}: {' and '.join(known)} wide at half the peak"
    at = 12 * scale, size[1] - FOOT * scale
    return [Label(cut(words, size[0] / scale - 24, 11.5), *at, colors["muted"], (0.0, 0.5), 11.5)]


def described(values):
    """The albedo, or what is reflected and transmitted, by Tables of one material: a line of text."""
    names = ("albedo",) if len(values) == 1 else ("reflected", "transmitted")
    return ", ".join(f"{n} " + "  ".join(f"{a:.3f}" for a in t.albedo) for n, t in zip(names, values, strict=True))


def stage(camera, wo, colors, index=None):
    """What stands around a lobe: strokes below it, strokes over it, and Labels of the normal, the viewer, its mirror image, and
    where a flat surface of an index refracts it to.
    """
    turn = np.radians(np.arange(0, 361, 3))
    ring = np.stack([np.cos(turn), np.sin(turn), np.zeros(turn.size)], axis=-1)
    below = [camera.stroke(ring * r, colors["grid"]) for r in (0.25, 0.5, 0.75)]
    below += [camera.stroke([-ring[i], ring[i]], colors["grid"]) for i in range(0, 60, 10)]
    below.append(camera.stroke(ring, colors["muted"]))
    normal, mirror = np.array([0.0, 0.0, 1.0]), wo * [-1, -1, 1]
    straight = flat_refraction(wo, index)
    dashed = [("ωr", mirror)] + ([("ωt", straight)] if straight is not None else [])
    for _, w in dashed:
        below += [camera.stroke([w * i / 28, w * (i + 1) / 28], colors["accent"]) for i in range(0, 32, 2)]
    above = []
    for w, color in ((normal, "ink"), (wo, "accent")):
        for points in arrow(*camera.pixels([0 * w, ARROW * w]), camera.scale):
            below.append(Stroke(points, colors[color], 1.6 * camera.scale))
            above.append(Stroke(points, colors[color], 1.6 * camera.scale, 0.25))  # seen through the lobe
    labels = []
    for name, w, color in [("ωo", wo, "accent"), ("n", normal, "ink"), *((name, w, "accent") for name, w in dashed)]:
        start, tip = camera.pixels([0 * w, ARROW * w])
        x, y = tip + 12 * camera.scale * (tip - start) / max(np.linalg.norm(tip - start), 1e-9)
        y = camera.size[1] - y
        if all(np.hypot(x - b.x, y - b.y) > 20 * camera.scale for b in labels):  # at theta_o = 0 one is enough
            labels.append(Label(name, float(x), float(y), colors[color], size=13.0))
    return below, above, labels


class Camera:
    """An orthographic camera that looks at the hemisphere, or both; directions in the surface's frame, z up."""

    def __init__(self, view, size, scale, bar=BAR, both=False):
        """view: the Lobe's options; bar: points at the right that are kept free; both: with the lower hemisphere."""
        azimuth, elevation = np.radians(view.azimuth), np.radians(view.elevation)
        ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
        self.eye = np.array([ce * ca, ce * sa, se])
        self.right = np.array([-sa, ca, 0.0])
        self.up = np.array([-se * ca, -se * sa, ce])
        self.size, self.scale = size, scale
        # the box of the disc and of an upright arrow fits beside the legend, with room for labels
        high = max(ARROW * ce, se)
        low = -high if both else -se
        room = np.array([size[0] - (bar + 64) * scale, size[1] - 72 * scale])
        self.unit = max(min(room[0] / (2 * ARROW), room[1] / (high - low)), 1.0) * view.zoom
        self.center = np.array([(size[0] - bar * scale) / 2, size[1] / 2 - self.unit * (low + high) / 2])

    def pixels(self, points):
        """Pixels (n, 2) from the bottom left of points (n, 3)."""
        points = np.asarray(points, dtype=float)
        return self.center + self.unit * np.stack([points @ self.right, points @ self.up], axis=-1)

    def stroke(self, points, color, width=1.0, opacity=1.0):
        """The Stroke through points (n, 3), `width` points wide."""
        return Stroke(self.pixels(points), color, width * self.scale, opacity)

    def uniforms(self, jitter):
        """The camera's uniforms for a picture moved by `jitter` pixels."""
        lamp = self.eye + 0.6 * self.up - 0.5 * self.right
        half = np.array(self.size) / 2
        return {
            "right": tuple(self.right),
            "up": tuple(self.up),
            "eye": tuple(self.eye),
            "lamp": tuple(lamp / np.linalg.norm(lamp)),
            "center": tuple((self.center + jitter) / half - 1),
            "unit": tuple(self.unit / half),
        }


def surface(gpu):
    """Index buffer of the triangles between a table's texels; rays are joined around, kept with the Gpu."""
    if "lobe" not in gpu.buffers:
        ray, node = np.meshgrid(np.arange(RAYS), np.arange(NODES - 1), indexing="ij")
        a, b = ray * NODES + node, (ray + 1) % RAYS * NODES + node
        triangles = np.stack([a, a + 1, b, b, a + 1, b + 1], axis=-1)
        gpu.buffers["lobe"] = gpu.ctx.buffer(triangles.astype("u4").tobytes())
    return gpu.buffers["lobe"]

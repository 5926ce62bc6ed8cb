"""Two materials A and B: their spheres with a line between them, their lobes and slices over each other, and the difference."""

import time
from dataclasses import dataclass, fields, replace

import numpy as np

from ..glsl import assemble
from ..lib.colormap import diverging
from ..lib.srgb import luminance
from ..measure import error
from ..measure.laws import Shader, viewers
from ..model import Invalid, choice, param
from .axes import Axes, Axis
from .develop import develop
from .diagram import QUANTITIES, number
from .drawing import Drawing, Drawn, cut, nothing
from .lines import draw_lines
from .lobe import Camera, stage
from .pace import in_turn
from .picture import PALETTES, rgb
from .polar import NODES
from .table import progressive

PARTS = ("sphere", "difference", "lobes", "curves")
THROUGH = 0.55  # opacity of the lobe of B, through which A is seen
LEAST = 1e-12  # of the reference's mean: a difference below it has no colours
NOTHING = 1e-6  # of the reference's mean: a difference below it is none
ESTIMATES = 64  # of a stochastic f, whose noise its numbers hold
REDRAWN = 0.1  # seconds between drawings while the parts get better
GAP, HEAD, BESIDE = 14, 24, 40  # points between the parts, above each for its title, and beside one for its axis
NUMBERS, WORDS, FOOT = (
    5,
    190,
    0.2,
)  # lines of numbers below all, points that one is wide, and share of the height for them
SMALL = 70  # points of a part's side below which spheres and curves alone are shown
APART = 20  # times one lobe's peak the other's, from which on each is drawn over its own
DEPTH = 1000  # times lower than the lower curve's peak a logarithmic axis goes at least


@dataclass(frozen=True)
class Compare(Drawn):
    """The active material A against another one B, in the same light and from the same direction."""

    title = "Compare"
    instrument = True

    show: str = choice("all", ("all", *PARTS), "what is shown")
    other: int = param(2, 1, 99, "number of B in the list of materials; the next after A if that is A, or not there")
    swipe: float = param(0.5, 0.0, 1.0, "place of the line: left of it the sphere is A, right of it B")
    axis: str = choice("log", ("log", "linear"), "scale of f in the slices; a logarithmic one shows the tails")
    decades: int = param(5, 1, 12, "decades that a logarithmic axis shows, or more if one curve is lower")

    def against(self, state):
        """The number of B in the list of materials, from 0, or None where there is only one."""
        count = len(state.materials)
        if count < 2:
            return None
        return self.other - 1 if self.other <= count and self.other - 1 != state.active else (state.active + 1) % count

    def boxes(self, size, scale=1.0):
        """Box of each part by name, and columns and rows of the numbers below them."""
        width, height = np.divide(size, scale)
        columns = max(int((width - 12) // WORDS), 1)
        rows = min(-(-NUMBERS // columns), int(FOOT * height / 16))
        parts = PARTS if self.show == "all" else (self.show,)
        found = layout(size, scale, len(parts), 16 + 16 * rows)
        if len(parts) > 2 and min(found[0][2] - found[0][0], found[0][3] - found[0][1]) < SMALL * scale:
            parts = ("sphere", "curves")
            found = layout(size, scale, len(parts), 16 + 16 * rows)
        return dict(zip(parts, found, strict=True)), columns, rows

    def shows(self, state):
        return (self, state.materials, state.active, state.directions, state.light, state.look, state.views["sphere"])

    def drawings(self, gpu, state, size, scale=1.0):
        b = self.against(state)
        if b is None:
            words = "Nothing to compare with:", "add a material to the list, or a copy of this one"
            yield nothing(size, scale, state.look.theme, *words), "", True
            return
        states = state, replace(state, active=b)
        shown, drawn, since = {}, None, 0.0
        for found, done in in_turn(gpu, self.runs(gpu, states, size, scale)):
            fresh = any(found[name] is not shown.get(name) for name in found)
            complete = any(not name.endswith(" A") for name in found.keys() - shown.keys())
            if drawn is None or done or complete or fresh and time.perf_counter() - since > REDRAWN:
                drawn, shown, since = self.drawing(gpu, states, size, scale, found), found, time.perf_counter()
            yield drawn, "", done

    def runs(self, gpu, states, size, scale):
        """Generators of what is shown, of A and of B: pictures of spheres, Tables of slices and of lobes; and the numbers."""
        boxes, *_ = self.boxes(size, scale)
        side = side_of(boxes)
        runs = {}
        for name, g, s in zip("AB", sides_of(gpu), states, strict=True):
            if "sphere" in boxes or "difference" in boxes:
                runs["sphere " + name] = s.views["sphere"].pictures(g, s, (side, side), scale)
            if "curves" in boxes:
                runs["curves " + name] = progressive(gpu, s.model, s.directions, rays=2, nodes=NODES)
        if "lobes" in boxes:
            runs["lobes"] = both_lobes(gpu, states, boxes["lobes"], scale)
        return runs | {"numbers": differences_of_values(gpu, *(s.model for s in states))}

    def drawing(self, gpu, states, size, scale, found):
        """The Drawing of what is `found`, the latest of each of the `runs`."""
        draw = Drawing(size, scale, states[0].look.theme)
        boxes, columns, rows = self.boxes(size, scale)
        known = {part: [found[f"{part} {n}"] for n in "AB"] for part in PARTS if f"{part} B" in found}
        words = found.get("numbers", [])
        if "sphere" in known:
            if "sphere" in boxes:
                self.spheres(draw, boxes["sphere"], states, sides_of(gpu), known["sphere"])
            if "difference" in boxes:
                side = side_of(boxes)
                targets = [g.target("sphere", (side, side)) for g in sides_of(gpu)]  # without what lies behind
                pixels = [gpu.pixels(target) for target in targets]
                self.difference(draw, gpu, boxes["difference"], targets, pixels)
                words = words + difference_of_pictures(*pixels)
        if "lobes" in found:
            self.lobes(draw, boxes["lobes"], states, found["lobes"])
        if "curves" in known:
            self.curves(draw, boxes["curves"], states, [[t.plane() for t in tables] for tables, _ in known["curves"]])
        for i, text in enumerate(words[: columns * rows]):
            at = (12 + i % columns * WORDS, 6 + 16 * (rows - i // columns))
            draw.text(text, np.multiply(at, scale) - [0, 8 * scale], "muted", (0.0, 0.5), 11.5)
        return draw

    def spheres(self, draw, box, states, sides, pictures):
        """A left of the line, B right of it."""
        s = draw.scale
        left, bottom, right, top = box
        developed = [develop(g, p, state.look) for g, p, state in zip(sides, pictures, states, strict=True)]
        width, height = developed[0].size
        corner = np.round([(left + right - width) / 2, (bottom + top - height) / 2])
        line = int(round(self.swipe * width))
        draw.raster(corner, developed[0], (0, 0, line, height))
        draw.raster(corner, developed[1], (line, 0, width, height))
        at = corner[0] + line
        draw.stroke([(at, corner[1]), (at, corner[1] + height)], draw.colors["paper"], 1.5)
        for state, name, edge, anchor in zip(states, "AB", (left, right), (0.0, 1.0), strict=True):
            words = cut(f"{name}  {state.material.name}", (right - left) / (2 * s), 12.5)
            draw.text(words, (edge, top + 12 * s), color_of(state, draw.colors), (anchor, 0.5), 12.5)

    def lobes(self, draw, box, states, lobes):
        """Both lobes, over each other."""
        left, bottom, right, top = box
        target, labels, apart = lobes
        height = target.size[1]
        draw.raster((left, bottom), target)
        quantity = QUANTITIES[states[0].views["lobe"].quantity] + ", each over its own peak" * apart
        draw.text(
            cut(quantity, (right - left) / draw.scale, 12.5), (left, top + 12 * draw.scale), "ink", (0.0, 0.5), 12.5
        )
        for label in labels:
            at = (round(left) + label.x, round(bottom) + height - label.y)
            draw.text(label.text, at, label.color, label.anchor, label.size)

    def curves(self, draw, box, states, slices):
        """f along the plane of incidence; below the surface too, if one of them transmits."""
        s = draw.scale
        left, bottom, right, top = box
        lines = [
            (state, theta, luminance(f)) for state, parts in zip(states, slices, strict=True) for theta, _, f in parts
        ]
        high = 1.3 * max(float(v.max()) for _, _, v in lines) or 1.0
        lower = min(v.max() for v in (np.concatenate([v for s, _, v in lines if s is state]) for state in states))
        low = min(high / 10**self.decades, lower / DEPTH if lower > 0 else np.inf) if self.axis == "log" else 0.0
        frame = (left + 44 * s, bottom + 36 * s, max(right - 8 * s, left + 52 * s), max(top - 4 * s, bottom + 40 * s))
        lowest = -270.0 if max(map(len, slices)) > 1 else -90.0
        title = "θi in the plane of incidence" if frame[2] - frame[0] > 170 * s else "θi"
        axes = Axes(draw, frame, Axis(lowest, 90.0, title), Axis(low, high, "", self.axis))
        angles = np.arange(lowest, 91, 30 if lowest == -90 else 45)
        axes.frame(angles, [f"{min(abs(a), 360 - abs(a)):g}°" for a in angles])
        draw.text("f  [1/sr]", (left, top + 12 * s), "ink", (0.0, 0.5), 12.5)
        draw.over()
        for state, theta, v in lines:
            axes.line(np.degrees(theta), v, color_of(state, draw.colors), 2.0)

    def difference(self, draw, gpu, box, targets, pixels):
        """B less A, its luminance over A's mean."""
        s = draw.scale
        left, bottom, right, top = box
        largest = difference_map(gpu, draw, "compare difference", box, targets, pixels)
        if largest is None or largest <= NOTHING:
            words = "B less A: " + ("no difference" if largest is not None else "A is black")
        else:
            words = f"B less A, ±{number(100 * largest, 2)} % of A's mean"
            edge = (left + right + targets[0].size[0]) / 2 + 8 * s
            if right - edge > 52 * s:
                bar = edge, (bottom + top) / 2 - 60 * s, edge + 10 * s, (bottom + top) / 2 + 60 * s
                self.bar(draw, bar, 100 * largest)
        draw.text(cut(words, (right - left) / s, 12.5), (left, top + 12 * s), "ink", (0.0, 0.5), 12.5)

    def bar(self, draw, box, percent):
        """The colours of the differences, and what the first and the last stand for."""
        left, bottom, right, top = box
        edges = np.round(np.linspace(bottom, top, 42))
        for low, high, x in zip(edges[:-1], edges[1:], np.linspace(-1, 1, 41), strict=True):
            red, green, blue = np.round(255 * diverging(x)).astype(int)
            draw.fill((left, low, right, high), f"#{red:02x}{green:02x}{blue:02x}")
        for y, words in (
            (top, f"+{number(percent, 2)} %"),
            ((bottom + top) / 2, "0"),
            (bottom, f"-{number(percent, 2)} %"),
        ):
            draw.text(words, (right + 5 * draw.scale, y), "muted", (0.0, 0.5), 11.0)


def difference_map(gpu, draw, name, box, targets, pixels):
    """Draw how much brighter the second of two pictures is than the first; the largest difference over the first's mean, or
    None if that is black. name: of the map's target."""
    left, bottom, right, top = box
    a, b = (luminance(p[..., :3].astype(float)) for p in pixels)
    mean = a[pixels[0][..., 3] > 0].mean()
    largest = max(float(np.quantile(np.abs(b - a), 0.999)), LEAST * max(mean, LEAST))
    width, height = targets[0].size
    target = gpu.target(name, (width, height), 4, "f1")
    uniforms = {"share": 1 / largest, "backdrop": rgb(draw.colors["paper"])}
    textures = {"picture": targets[1].color_attachments[0], "reference": targets[0].color_attachments[0]}
    gpu.draw(gpu.program(assemble("views/difference.frag")), target, uniforms, textures)
    draw.raster(np.round([(left + right - width) / 2, (bottom + top - height) / 2]), target)
    return largest / mean if mean > 0 else None


def sides_of(gpu):
    """A Gpu for A and one for B, each with targets of its own."""
    return gpu.beside("compare A").paced(gpu.pace), gpu.beside("compare B").paced(gpu.pace)


def side_of(boxes):
    """The side of a square picture in each of the boxes, pixels."""
    return int(max(min(min(right - left, top - bottom) for left, bottom, right, top in boxes.values()), 8))


def both_lobes(gpu, states, box, scale):
    """Yield a framebuffer as large as the box with both lobes, A seen through B, its Labels, and whether each is drawn over its
    own peak: better and better ones.
    """
    colors = PALETTES[states[0].look.theme]
    left, bottom, right, top = box
    size = (max(int(right - left), 8), max(int(top - bottom), 8))
    lobe = states[0].views["lobe"]
    target = gpu.target("compare lobes", size, 4, "f1")
    runs = [progressive(gpu, state.model, state.directions) for state in states]
    last = [next(run) for run in runs]
    while True:
        found, finals = zip(*last, strict=True)
        peaks = [max(map(lobe.peak, parts)) for parts in found]
        apart = 0 < min(peaks) * APART < max(peaks)
        if not apart:
            peaks = [max(peaks)] * 2
        camera = Camera(lobe, size, scale, bar=0, both=max(map(len, found)) > 1)
        below, above, labels = stage(camera, found[0][0].wo, colors)
        surfaces = [
            lobe.surfaces(
                g.beside(f"lobe {i}"), t, camera, 1 / (peak or 1.0), "plain", {"ink": rgb(color_of(state, colors))}
            )
            for g, state, parts, peak in zip(sides_of(gpu), states, found, peaks, strict=True)
            for i, t in enumerate(parts)
        ]
        shares = [share for share, parts in zip((1.0, THROUGH), found, strict=True) for _ in parts]
        far = [i > 0 for parts in found for i in range(len(parts))]
        for n, layers in enumerate(zip(*surfaces, strict=True)):
            if n == 0 or layers[0][1]:
                seen = list(zip(far, shares, (layer for layer, _ in layers), strict=True))
                target.clear(*rgb(colors["paper"]), 1.0)
                for side, lines in ((True, below), (False, above)):  # what lies beyond the surface is seen through it
                    for beyond, share, layer in seen:
                        if beyond == side:
                            picture = {"picture": layer.color_attachments[0]}
                            over = gpu.program(assemble("views/over.frag"))
                            gpu.draw(over, target, {"share": share}, picture, blend="premultiplied")
                    draw_lines(gpu, target, lines)
            yield target, labels, apart
            if not all(finals):
                break
        if all(finals):
            return
        last = [next(run, one) for run, one in zip(runs, last, strict=True)]


def color_of(state, colors):
    """The colour of a state's active material, which it has in the slices, too."""
    return colors["curves"][state.active % len(colors["curves"])]


def layout(size, scale, count, foot):
    """Boxes of the parts, (left, bottom, right, top) in pixels, over `foot` points: in the columns that make them largest."""

    def side(columns):
        down = (size[1] - foot * scale) / -(-count // columns) - HEAD * scale
        return min(size[0] / columns - BESIDE * scale, down)

    columns = max(range(1, count + 1), key=side)
    rows = -(-count // columns)
    gap, head, foot = GAP * scale, HEAD * scale, foot * scale
    width = (size[0] - (columns + 1) * gap) / columns
    height = (size[1] - foot - rows * head) / rows
    boxes = []
    for i in range(count):
        left, top = gap + i % columns * (width + gap), size[1] - head - i // columns * (height + head)
        boxes.append((left, max(top - height, 0.0), left + max(width, 1.0), top))
    return boxes


def differences_of_values(gpu, a, b):
    """Yield lines that say how far the shader's f of the model b is from that of a, better and better where they are estimates.

    Of estimates there are two independent halves, in each of which both draw the same numbers.
    """
    alpha, index = np.minimum(a.slopes(), b.slopes()), a.index() or b.index()
    noisy = a.stochastic or b.stochastic
    halves, lines, rays = [[0, 0], [0, 0]], [], error.RAYS // 2 if noisy else error.RAYS
    for n in range(ESTIMATES if noisy else 1):
        half = halves[n % 2]
        for i, model in enumerate((a, b)):
            parts = []
            for wo in viewers()[:, None]:  # one in each step
                parts.append(error.values(Shader(gpu, model), alpha, rays, wo, index, seed=2 * n, estimates=1))
                yield lines
            once = error.Values(
                *(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(error.Values))
            )
            half[i] = half[i] + once.f
        if noisy and n % 2 == 0:
            continue
        share = 2 / (n + 1) if noisy else 1.0
        pairs = [[replace(once, f=total * share) for total in half] for half in halves[: 1 + noisy]]
        lines = of_estimates(pairs, n + 1) if noisy else of_values(*pairs[0])
    yield lines


def of_values(reference, found):
    return [
        f"{m.title}: {number(m.function(found, reference), 2)}"
        for m in (error.METRICS[name] for name in ("rmse", "maximum", "energy"))
    ]


def of_estimates(pairs, walks):
    """As of_values, of halves of estimates; of the largest relative error they tell nothing."""
    means = [replace(one, f=(one.f + other.f) / 2) for one, other in zip(*pairs, strict=True)]
    rmse, energy = error.METRICS["rmse"], error.METRICS["energy"]
    return [
        f"{rmse.title}: {number(error.rmse_of_halves(*pairs), 2)}",
        f"{energy.title}: {number(energy.function(*means), 2)}",
        f"f by {walks} walks a direction",
    ]


def difference_of_pictures(a, b):
    """Lines that say how far the picture b is from a."""
    try:
        rms, mean = error.METRICS["picture"].function(b, a), error.brightening(b, a)
    except Invalid as reason:
        return [str(reason)]
    return [f"{error.METRICS['picture'].title}: {number(rms, 2)}", f"sphere's mean: {100 * mean:+.2g} %"]

"""The estimator of the reflection equation at work: all samplers of the material at once, for its scene and viewer."""

import time
from dataclasses import dataclass, field, replace

import numpy as np

from ..lib import slot
from ..measure.albedo import quadrature
from ..measure.cost import costs, fill, sample, summary
from ..measure.estimator import FIRST, RUNS, Runs, Surroundings, moments, rms_error, samplers, slope, surroundings
from ..measure.grid import angles, direction
from ..measure.microsurface import D_visible
from ..measure.sampling import chi_square
from ..model import choice, param
from .axes import TICK, Axes, Axis
from .diagram import arrow, number
from .drawing import Drawing, Drawn, width_of
from .picture import Curves, rgb

PANELS = {  # in the order of their importance where there is little room, with their titles
    "error": "relative error of the estimate",
    "variance": "one sample",
    "histogram": "directions drawn, and pdf",
    "weights": "share of samples by weight",
    "facets": "facets that ωo sees",
    "time": "relative error by time",
}
MEANINGS = {  # of the columns of the table
    "variance": "variance of f L cos / pdf, by quadrature",
    "ns": "ns: time to draw a direction, by the shader",
    "product": "var. × ns: time for a given error; the least is best",
    "slope": "slope of log error to log N; by theory −½",
    "lost": "lost: directions below the horizon, of weight 0",
    "largest": "largest: weight f cos / pdf",
}
CELL = (260, 155)  # points that a panel takes at least
STEP = 0.02  # seconds of work between two pictures
TESTED = 20_000  # directions of the chi-square test
FACETS = 24  # of the profile
BINS = 24  # of the histogram
ROUNDING = 1e-12  # variance over the squared mean, and relative error, below which they are float64's rounding
PER_DECADE = 12  # bins of the weights


@dataclass
class Found:
    """What is known so far.

    wo        the viewer
    light     the Surroundings, or None for L = 1
    models    the samplers by name; `own` is the material's
    moments   of the weights, by quadrature
    runs      Runs of each sampler
    tests     ChiSquare of each sampler
    costs     seconds a sample (n,), of each sampler
    expected  polar angles of directions, and the probability by the own pdf that each stands for
    """

    wo: np.ndarray
    light: Surroundings | None
    models: dict
    own: str
    moments: object = None
    runs: dict = field(default_factory=dict)
    tests: dict = field(default_factory=dict)
    costs: dict = field(default_factory=dict)
    expected: tuple | None = None

    def errors(self, name):
        """Numbers of samples (n,), and their relative errors as a Measured of arrays."""
        runs = self.runs[name]
        return np.array(runs.counts, dtype=float), rms_error(runs.estimates, self.moments.mean)

    def variance(self, name):
        """Of one sample, by quadrature."""
        return float(self.moments.variance[list(self.models).index(name)])


@dataclass(frozen=True)
class Sampling(Drawn):
    """The estimator 1/N sum f L cos / pdf by all samplers of the material: error, variance, cost, directions and weights."""

    title = "Sampling"
    instrument = True

    show: str = choice("all", ("all", *PANELS), "one panel, or as many as there is room for")
    samples: int = param(4096, 64, 65536, "most samples in each of a sampler's 32 runs", scale="log")

    def shows(self, state):
        return (self, state.model, state.light, state.directions, state.look.theme)

    # --- measuring -----------------------------------------------------------------------------------------------------

    def measure(self, gpu, state, timed=True):
        """Yield after each short step: the Found, which grows, when there is news, else None."""
        wo = direction(np.radians(state.directions.theta_o), np.radians(state.directions.phi_o))
        found = Found(wo, surroundings(state.light, wo), *samplers(state.model))
        rays = int(np.clip(self.samples / 16, 64, 256))  # few samples need no better reference
        better = moments(list(found.models.values()), wo, found.light, rays)
        while found.moments is None:
            found.moments = next(better)
            yield None
        if found.moments.mean <= 0:  # a black material
            yield found
            return
        for seed, (name, model) in enumerate(found.models.items()):
            found.runs[name] = Runs(model, wo, found.light, seed)
            yield from (None for _ in found.runs[name].double())
        yield found
        theta, share = [], []
        for part in expected(state.model, wo):
            theta, share = [*theta, part[0]], [*share, part[1]]
            yield None
        found.expected = np.concatenate(theta), np.concatenate(share)
        for news in better:
            found.moments = news or found.moments
            yield news and found
        while found.runs[found.own].counts[-1] * 2 <= self.samples:
            for runs in found.runs.values():
                yield from (None for _ in runs.double())
            yield found
        for name, runs in found.runs.items():
            drawn = runs.wi[:TESTED]
            found.tests[name] = chi_square(runs.model, wo, len(drawn), sample=lambda wo, u, wi=drawn: (wi, None))
            yield None
        yield found
        if timed:
            bare = fill(gpu)
            works = {name: sample(gpu, model, bare) for name, model in found.models.items()}
            for i, found.costs in enumerate(costs(gpu, works)):
                yield None if i % 64 else found

    def table_of(self, gpu, state):
        """Relative errors of all samplers, and what their variance says they are, as Curves over the number of samples."""
        found = [news for news in self.measure(gpu, state, timed=False) if news][-1]
        y = {}
        for name in found.runs:
            n, error = found.errors(name)
            y[f"{name} relative error"] = error.value
            y[f"{name} standard error of it"] = error.error
            y[f"{name} sigma / sqrt(N)"] = np.sqrt(found.variance(name) / n) / found.moments.mean
        return Curves("samples", n if y else np.zeros(0), y)

    # --- drawing -------------------------------------------------------------------------------------------------------

    def drawings(self, gpu, state, size, scale=1.0):
        found, drawn, start = None, None, time.perf_counter()
        for news in self.measure(gpu, state, timed=self.show in ("all", "variance", "time")):
            if news:
                found, drawn = news, self.drawing(state, news, size, scale)
            if (found or gpu.pace) and time.perf_counter() - start >= STEP:
                yield drawn, note(found) if found else "", False
                start = time.perf_counter()
        yield self.drawing(state, found, size, scale), note(found), True

    def drawing(self, state, found, size, scale):
        draw = Drawing(size, scale, state.look.theme)
        width, height = np.divide(size, scale)
        if found.moments.mean <= 0:
            draw.text("Nothing to estimate: the material is black", np.divide(size, 2), "muted")
            return draw
        colors = dict(zip(found.models, draw.colors["curves"], strict=False))
        head = header(draw, state, found, colors)
        room = height - head - 24
        if self.show == "all":
            columns = int(np.clip(width // CELL[0], 1, 3))
            rows = int(np.clip(room // CELL[1], 1, -(-len(PANELS) // columns)))
            names = list(PANELS)[: columns * rows]
        else:
            columns, rows, names = 1, 1, [self.show]
        for i, name in enumerate(names):
            left, top = i % columns * width / columns, height - head - i // columns * room / rows
            box = np.array([left, top - room / rows, left + width / columns, top]) * scale
            if box[2] - box[0] > 110 * scale and box[3] - box[1] > 90 * scale:
                DRAW[name](draw, box, state, found, colors)
        return draw


def note(found):
    n = found.runs[found.own].counts[-1] if found.runs else 0
    return f"{n} samples in each of {RUNS} runs"


def expected(model, wo, rays=320):
    """Yield, in parts, polar angles (n,) of directions that follow the lobe, and the probability by pdf that each stands for."""
    g, weight = quadrature(wo, model.slopes(), rays, model.index())
    for wi, w in zip(np.array_split(g.wi, 16), np.array_split(weight, 16), strict=True):
        with np.errstate(under="ignore"):
            yield angles(wi)[0].ravel(), (model.pdf(wo, wi) * w).ravel()


def header(draw, state, found, colors):
    """What is estimated, and the samplers' colours; the height of it in points."""
    s = draw.scale
    width, height = np.divide(draw.size, s)
    m = found.moments
    words = f"∫ f L cos θi dωi = {m.mean:.6g} ± {number(max(m.mean_error, 1e-16), 1)}"
    words += ", estimated by 1/N Σ f L cos θi / pdf" * int(width >= 520)
    lines = [(words, "ink", 12.5)]
    if found.light:
        words = f"L: {state.light.environment}" + ", without the directional light" * (state.light.irradiance > 0)
    else:
        words = "L = 1: the albedo, as a directional light is a delta"
    lines.append((words, "muted", 11.5))
    if width < 300 or height < 200:
        lines = lines[: int(width >= 250)]
    y = 4
    for words, color, points in lines:
        y += 17
        draw.text(words, (12 * s, draw.size[1] - (y - 6) * s), color, (0.0, 0.5), points)
    x, y = 12.0, y + 18
    for name, color in colors.items():
        words = called(name)
        if len(colors) == 1:
            words += ", the only one"
        same = [other for other in list(colors)[: list(colors).index(name)] if alike(found, other, name)]
        if same and width >= 520:
            words += f" (varies as {same[0]})"
        if x > 12 and x + width_of(words, 12.5) > width - 8:
            x, y = 12.0, y + 17
        draw.text(words, (x * s, draw.size[1] - (y - 6) * s), color, (0.0, 0.5), 12.5)
        x += width_of(words, 12.5) + 14
    return y + 8


def called(name):
    """A sampler's name in words."""
    return "its sampler" if name == "its own" else name


def alike(found, a, b):
    """Whether two samplers have the same variance, so that the line of one covers that of the other."""
    a, b = found.variance(a), found.variance(b)
    return abs(a - b) <= 1e-6 * max(a, b)


def axes_in(draw, box, name, x, y, **frame):
    """Axes in a panel's box, with room for ticks and titles."""
    s = draw.scale
    left, bottom, right, top = box
    axes = Axes(draw, (left + 52 * s, bottom + 38 * s, right - 16 * s, top - 26 * s), x, replace(y, title=PANELS[name]))
    axes.frame(**frame)
    return axes


def draw_error(draw, box, state, found, colors):
    known = {name: found.errors(name) for name in found.runs}
    n = next(iter(known.values()))[0]
    draw_errors(draw, box, "error", found, colors, {name: n for name in known}, "samples N")


def draw_time(draw, box, state, found, colors):
    if not found.costs:
        words_in(draw, box, "time", "measuring the time of a sample …")
        return
    seconds = {name: summary(found.costs[name]).median for name in found.runs}
    if min(seconds.values()) <= 0:
        words_in(draw, box, "time", "a sample is too fast to be timed here")
        return
    n = found.errors(found.own)[0]
    draw_errors(draw, box, "time", found, colors, {name: n * t for name, t in seconds.items()}, "seconds")


def draw_errors(draw, box, name, found, colors, x, title):
    """Relative errors of all samplers over x {name: (n,)}: as measured, with error bars, and by their variance."""
    s = draw.scale
    theory = {k: np.sqrt(found.variance(k) / found.errors(k)[0]) / found.moments.mean for k in x}
    measured = {k: found.errors(k)[1] for k in x}
    least = [min(v.min() for v in theory.values()), *(m.value[m.value > 0].min(initial=1.0) for m in measured.values())]
    most = max(v.value.max() for v in measured.values())
    if most < ROUNDING:
        words_in(draw, box, name, "all samples have the same weight: no error")
        return
    y = Axis(max(0.6 * min(least), 1e-12), 2.5 * max(most, min(least)), scale="log")
    every = np.concatenate(list(x.values()))
    title += "; lines: σ / √N by quadrature" * int(box[2] - box[0] >= 250 * s)
    axes = axes_in(draw, box, name, Axis(0.8 * every.min(), 1.25 * every.max(), title, "log"), y)
    reference = found.moments.mean_error / found.moments.mean
    draw.over()
    if reference > y.low:
        axes.line([every.min(), every.max()], [reference, reference], "muted", 1.0, 0.8)
        draw.text("error of the reference", axes.place(every.max(), reference) + [0, 7 * s], "muted", (1.0, 0.5), TICK)
    for k, color in colors.items():
        axes.line(x[k], np.where(theory[k] < y.high, theory[k], np.nan), color, 1.0, 0.55)
    draw.over()
    for k, color in colors.items():
        value, error = measured[k]
        for at, v, e in zip(x[k], value, error, strict=True):
            if v > 0:
                axes.line([at, at], [max(v - e, y.low), v + e], color, 1.0)
                draw.dot(axes.place(at, max(v, y.low)), color, 4.0)


def words_in(draw, box, name, words):
    s = draw.scale
    draw.text(PANELS[name], (box[0] + 52 * s, box[3] - 14 * s), "ink", (0.0, 0.5), 12.0)
    draw.text(words, ((box[0] + box[2]) / 2, (box[1] + box[3]) / 2), "muted", size=12.0)


def draw_variance(draw, box, state, found, colors):
    """A table of the samplers: variance, cost, their product, the share that is lost, the slope of the error."""
    s = draw.scale
    left, _, right, top = box
    rows = []
    for name in found.models:
        variance, runs = found.variance(name), found.runs[name]
        if variance < ROUNDING * found.moments.mean**2:
            variance = 0.0
        row = {"variance": number(variance), "ns": "…", "product": "…"}
        if found.costs:
            cost = summary(found.costs[name])
            row |= {"ns": number(1e9 * cost.median, 2), "product": number(1e9 * cost.median * variance, 2)}
        row["lost"] = f"{100 * np.mean(runs.weight == 0):.3g} %"
        row["largest"] = number(runs.weight.max(), 2)
        if variance == 0:
            row["slope"] = "no error"
        elif runs.counts[-1] >= 16 * FIRST:
            fit = slope(runs.counts, runs.estimates, found.moments.mean)
            row["slope"] = f"{fit.value:.2f} ± {fit.error:.2f}".replace("-", "−")
        else:
            row["slope"] = "…"
        rows.append(row)
    columns = [("variance", 60), ("ns", 38), ("product", 58), ("slope", 84), ("lost", 52), ("largest", 56)]
    columns = [c for i, c in enumerate(columns) if 76 + sum(w for _, w in columns[: i + 1]) <= (right - left) / s - 16]
    draw.text(PANELS["variance"], (left + 12 * s, top - 14 * s), "ink", (0.0, 0.5), 12.0)
    step = min(19 * s, (top - box[1] - 26 * s) / (len(rows) + 1))
    if step < 12 * s:
        return
    x = left + 76 * s
    heads = {"product": "var. × ns"}
    for column, wide in columns:
        x += wide * s
        draw.text(heads.get(column, column), (x, top - 32 * s), "muted", (1.0, 0.5), TICK)
        for i, row in enumerate(rows):
            draw.text(row[column], (x, top - 32 * s - (i + 1) * step), "ink", (1.0, 0.5), 12.0)
    for i, (name, color) in enumerate(colors.items()):
        draw.text(called(name), (left + 12 * s, top - 32 * s - (i + 1) * step), color, (0.0, 0.5), 12.0)
    foot = top - 40 * s - (len(rows) + 1) * step
    for words in (MEANINGS[column] for column, _ in columns):
        if foot - 8 * s > box[1] and right - left > 330 * s:
            draw.text(words, (left + 12 * s, foot), "muted", (0.0, 0.5), TICK)
            foot -= 16 * s


def draw_histogram(draw, box, state, found, colors):
    """The own sampler's directions by polar angle as bars, and what pdf says."""
    s = draw.scale
    runs = found.runs[found.own]
    theta = np.degrees(angles(runs.wi[runs.weight > 0])[0])
    last = 180.0 if state.model.transmits else 90.0
    low, high = np.quantile(theta, [0.002, 0.998]) if len(theta) else (0.0, last)
    margin = 0.1 * (high - low)
    low, high = (0.0, last) if high - low > 45 else (max(low - margin, 0), min(high + margin, last))
    edges = np.linspace(low, max(high, low + 1e-9), BINS + 1)
    drawn = np.histogram(theta, edges)[0] / max(len(runs.wi), 1)
    theta_i, mass = found.expected or (np.zeros(0), np.zeros(0))
    by_pdf = np.histogram(np.degrees(theta_i), edges, weights=mass)[0]
    y = Axis(0.0, 1.25 * max(drawn.max(), by_pdf.max(), 1e-9))
    axes = axes_in(draw, box, "histogram", Axis(edges[0], edges[-1], f"θi by {called(found.own)}, degrees"), y)
    for a, b, v in zip(edges, edges[1:], drawn, strict=False):
        (x0, y0), (x1, y1) = axes.place([a, b], [0.0, v])
        draw.fill((x0 + 0.5, y0 + 1, x1 - 0.5, max(y1, y0 + 1)), faint(draw, colors[found.own]))
    draw.over()
    if found.expected:
        axes.line(np.repeat(edges, 2)[1:-1], np.repeat(by_pdf, 2), "ink", 1.4)
    if found.tests:
        p = found.tests[found.own].p
        least = min(test.p for test in found.tests.values())
        sidak = -np.expm1(len(found.tests) * np.log1p(-min(least, 1 - 1e-16)))
        words = f"χ² p = {number(p, 2)}; of all {number(sidak, 2)} (Šidák)"
        right, top, _ = (*axes.box[2:], draw.over())
        clear = (right - (8 + width_of(words, TICK)) * s, top - 17 * s, right, top - 1)
        draw.fill(clear, "paper")  # no grid through the words
        draw.text(words, (axes.box[2] - 4 * s, axes.box[3] - 9 * s), "muted", (1.0, 0.5), TICK)


def faint(draw, color):
    """A colour halfway to the paper's."""
    mixed = (0.5 * np.add(rgb(draw.color(color)), rgb(draw.color("paper"))) * 255).round().astype(int)
    return "#" + "".join(f"{c:02x}" for c in mixed)


def draw_weights(draw, box, state, found, colors):
    """How many samples have which weight f cos / pdf, of all samplers; their mean and largest."""
    s = draw.scale
    top = max(runs.weight.max() for runs in found.runs.values())
    mean = found.runs[found.own].weight.mean()
    last = int(np.ceil(PER_DECADE * np.log10(2 * top)))
    first = min(int(np.floor(PER_DECADE * np.log10(max(mean, 1e-12)))) - 2 * PER_DECADE, last - 2 * PER_DECADE)
    edges = 10.0 ** (np.arange(first, last + 1) / PER_DECADE)
    shares = {}
    for name, runs in found.runs.items():
        known = runs.weight > edges[0]
        place = np.minimum((PER_DECADE * np.log10(runs.weight[known]) - first).astype(int), last - first - 1)
        shares[name] = np.bincount(place, minlength=last - first) / len(runs.weight)
    y = Axis(0.0, 1.15 * max(v.max() for v in shares.values()))
    title = "weight f cos θi / pdf" + "; dots: the largest" * int(box[2] - box[0] >= 250 * s)
    axes = axes_in(draw, box, "weights", Axis(edges[0], edges[-1], title, "log"), y)
    axes.line([mean, mean], [0.0, y.high], "ink", 1.0)
    draw.over()
    for name, color in colors.items():
        axes.line(np.repeat(edges, 2)[1:-1], np.repeat(shares[name], 2), color, 1.4)
        draw.dot(axes.place(found.runs[name].weight.max(), 0.0), color, 5.0)
    draw.text("mean", axes.place(mean, y.high) + [-4 * s, -8 * s], "ink", (1.0, 0.5), TICK)


def draw_facets(draw, box, state, found, colors):
    """A profile with slopes by D in the plane of incidence, the parts that wo sees, and D and D_visible over the facets' tilt."""
    model, s = state.model, draw.scale
    if "ndf" not in model.choices():
        words_in(draw, box, "facets", f"{model.name()} has no distribution of normals")
        return
    left, bottom, right, top = box
    theta_o, phi = angles(found.wo)
    middle = bottom + 0.58 * (top - bottom)
    x, h, seen = profile(model, theta_o, phi)
    wide = right - left - 68 * s
    unit = min(wide, (top - middle - 44 * s) / max(np.ptp(h), 1e-9))
    at = np.stack(
        [left + 52 * s + wide * x, (middle + top - 20 * s) / 2 + unit * (h - (h.max() + h.min()) / 2)], axis=-1
    )
    draw.stroke(at, "muted", 1.2)
    draw.over()
    for piece in np.split(np.arange(len(x)), np.flatnonzero(np.diff(seen)) + 1):
        if seen[piece[0]] and len(piece) > 1:
            draw.stroke(at[piece], "accent", 2.6)
    draw.over()
    toward = np.array([np.sin(theta_o), np.cos(theta_o)])
    for place in (0.2, 0.5, 0.8):
        pieces = np.flatnonzero(seen & (x >= place))
        if len(pieces):
            start = at[pieces[0]]
            reach = min(
                (top - 24 * s - start[1]) / toward[1], (right - 6 * s - start[0]) / max(toward[0], 1e-9), 46 * s
            )
            for points in arrow(start, start + max(reach, 0.0) * toward, 0.6 * s):
                draw.stroke(points, "accent", 1.0, 0.8)
    tilt = np.linspace(-89.5, 89.5, 359)
    wm = direction(np.radians(tilt), phi)
    with np.errstate(under="ignore"):
        every = slot("ndf", model.ndf).D(wm, np.array(model.alpha)) * wm[:, 2]
        visible = D_visible(model, found.wo, wm)
    y = Axis(0.0, 1.15 * max(every.max(), visible.max()))
    axes = Axes(
        draw,
        (left + 52 * s, bottom + 38 * s, right - 16 * s, middle - 6 * s),
        Axis(-90, 90, "tilt of the facet towards ωo"),
        y,
    )
    ticks = (-90, -45, 0, 45, 90)
    axes.frame(ticks, [f"{t}°".replace("-", "−") for t in ticks])
    draw.over()
    axes.line(tilt, every, "muted", 1.6)
    axes.line(tilt, visible, "accent", 1.8)
    draw.text(PANELS["facets"], (left + 52 * s, top - 14 * s), "ink", (0.0, 0.5), 12.0)
    draw.text("D_visible", (axes.box[0] + 6 * s, axes.box[3] - 8 * s), "accent", (0.0, 0.5), TICK)
    draw.text("D cos θm", (axes.box[0] + 6 * s, axes.box[3] - 21 * s), "muted", (0.0, 0.5), TICK)


def profile(model, theta_o, phi, points=40):
    """A line of FACETS facets as x in [0, 1], height, and whether the viewer, on the side of +x, sees it, (n,) each.

    The slopes are even quantiles of those that D cos has along the plane of incidence, in an order without meaning: a picture,
    not a sample of a surface, whose neighbouring facets would be alike.
    """
    n = 8192
    u = np.random.default_rng(1).random((n, 2))
    up = np.array([0.0, 0.0, 1.0])
    wm = slot("sampling", model.ndf, "caps").sample_wm(up, u, np.array(model.alpha))  # as seen from above: by D cos
    slopes = np.sort(-(wm[:, 0] * np.cos(phi) + wm[:, 1] * np.sin(phi)) / wm[:, 2])
    slopes = slopes[((np.arange(FACETS) + 0.5) / FACETS * n).astype(int)]
    random = np.random.default_rng(1)
    orders = (random.permutation(slopes - slopes.mean()) for _ in range(100))
    slopes = min(orders, key=lambda order: np.ptp(np.cumsum(order)))  # a level one
    x = np.arange(FACETS * points + 1) / (FACETS * points)
    h = np.interp(x, np.arange(FACETS + 1) / FACETS, np.concatenate([[0.0], np.cumsum(slopes) / FACETS]))
    # a ray towards the viewer passes over what lies lower in the direction across it; the profile repeats
    across = np.concatenate([h * np.sin(theta_o) - x * np.cos(theta_o)] * 2)
    across[len(x) :] -= np.cos(theta_o)
    beyond = np.maximum.accumulate(across[::-1])[::-1]
    return x, h, across[: len(x)] >= beyond[: len(x)] - 1e-12


DRAW = {
    "error": draw_error,
    "variance": draw_variance,
    "histogram": draw_histogram,
    "weights": draw_weights,
    "facets": draw_facets,
    "time": draw_time,
}

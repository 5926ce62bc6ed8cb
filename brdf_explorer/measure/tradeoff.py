"""Cost against error of the methods of a ladder, measured better and better."""

import os
import platform
import time
from dataclasses import dataclass, replace

import numpy as np

from ..ladder import HALF, Ladder, Method
from ..model import Invalid, Model
from . import cost
from .cost import Cost
from .error import METRICS, RAYS, ROUNDING, Measured, Values, values
from .laws import Shader as OnGpu
from .laws import viewers

NATURAL = {"f": "rmse", "numbers": "rmse", "samples": "spread", "picture": "picture"}
"""The metric by which a ladder is judged if no other is asked for, by what it measures."""
JUDGED = {"f": ("values", "pictures"), "numbers": ("values",), "samples": ("samples",), "picture": ("pictures",)}
"""What its metrics can compare."""
SAMPLED = (256, 256)
"""Pixels of a timed draw of samples, which may cost ten times an evaluation."""
SIDE = 96
"""Pixels along each side of the spheres that errors of pictures are measured on."""
PASSES = 64
"""Passes of each, under an environment, if the methods do not differ in them."""
FIRST = 0.7
"""Seconds after which costs come before the rest of the errors."""
PARTS, WALKS, TOGETHER = 16, 8, 4
"""Of a model whose f is an estimate: independent tables of values by half the rays, estimates that are averaged in each, and how
many of these are made between two yields."""
ROUGH = 4
"""Tables of which first errors are found."""
KEPT = 200
"""Measurements of errors that are kept."""


class Senseless(Invalid):
    """Why nothing can be measured, a sentence."""


@dataclass(frozen=True)
class Point:
    """Where a method stands, as far as it is measured."""

    method: Method
    outside: str
    cost: Cost | None = None
    error: Measured | None = None

    @property
    def name(self):
        return self.method.name

    @property
    def known(self):
        return self.cost is not None and self.error is not None

    @property
    def exact(self):
        """Whether it cannot be told from the reference: its error is no larger than the error of that."""
        return self.error.value <= self.error.error


@dataclass(frozen=True)
class Tradeoff:
    """The methods of a ladder for a state.

    metric     the name of one of METRICS
    kind       what the cost is of: an "evaluation", a "sample" or a "frame", in seconds
    size       pixels of the draws that are timed
    reference  the name of the method that the others are compared with, and `own` its own error
    reason     why nothing is measured, or ""
    doing      what is being measured, or "" at the end
    """

    ladder: Ladder
    metric: str
    kind: str
    size: tuple[int, int]
    points: tuple[Point, ...] = ()
    reference: str = ""
    own: Measured | None = None
    reason: str = ""
    doing: str = ""

    @property
    def repeats(self):
        return max((p.cost.repeats for p in self.points if p.cost), default=0)

    def front(self):
        """The Pareto front, from the cheapest on: points within their domain such that no cheaper one is as accurate."""
        inside = sorted((p for p in self.points if p.known and not p.outside), key=lambda p: (seconds(p), height(p)))
        found = []
        for point in inside:
            if not found or height(point) < height(found[-1]):
                found.append(point)
        return found

    def best(self, tolerance):
        """The cheapest point within its domain whose error, its own added, is within the tolerance, or None.

        Of samplers, the one that takes least time to any error.
        """
        if self.kind == "sample":
            return min((p for p in self.points if p.known and not p.outside), key=effort, default=None)
        return next((p for p in self.front() if p.exact or p.error.value + p.error.error <= tolerance), None)


def effort(point):
    """Seconds that samples of this method take to a relative standard error of 1: cost times error squared."""
    return seconds(point) * point.error.value**2


def seconds(point):
    """The median cost, and no less than what can be timed: costs below that are equal."""
    return max(point.cost.median, cost.FLOOR)


def height(point):
    """The error of a point, 0 where it cannot be told from the reference."""
    return 0.0 if point.exact else point.error.value


def tradeoffs(gpu, ladder, state, metric="own", kind="evaluation", size=cost.SIZE):
    """Yield the Tradeoff of a ladder for a state, from the first points to the best; each step takes some milliseconds.

    metric: a name of METRICS, or "own" for the ladder's; kind: "evaluation", or "frame" for the sphere in a picture of `size`;
    ladders of samples have the cost of a sample, of pictures that of a frame, of numbers that of an evaluation. What was
    measured before is not again.
    """
    metric = NATURAL[ladder.measures] if metric == "own" else metric
    kind = {"samples": "sample", "picture": "frame", "numbers": "evaluation"}.get(ladder.measures, kind)
    timed = {"evaluation": cost.SIZE, "sample": SAMPLED, "frame": size}[kind]
    found = Tradeoff(ladder, metric, kind, timed)
    reason = senseless(ladder, state, metric)
    if reason:
        yield replace(found, reason=reason)
        return
    points = {m.name: Point(m, m.outside(state)) for m in ladder.methods}
    found = replace(found, points=tuple(points.values()), reference=ladder.reference(state).name)

    def with_points(doing, **changes):
        return replace(found, points=tuple(points.values()), doing=doing, **changes)

    try:
        start = time.perf_counter()
        errors, measuring = {}, kept_errors(gpu, ladder, state, metric)
        for errors in measuring:
            points |= {name: replace(points[name], error=e) for name, e in errors.items()}
            if len(errors) == len(points) or errors and time.perf_counter() - start > FIRST:
                break  # rough or not: times come next, and then the rest
            yield with_points(f"error of {len(errors)} of {len(points)} methods")
        for samples in cost.costs(gpu, works(gpu, ladder, state, kind, timed)):
            points |= {name: replace(points[name], cost=cost.summary(s)) for name, s in samples.items()}
            repeats = f", {len(next(iter(samples.values())))} repeats" if samples else ""
            yield with_points(f"cost{repeats}", own=errors.get(found.reference))
        for errors in measuring:
            points |= {name: replace(points[name], error=e) for name, e in errors.items()}
            yield with_points("errors", own=errors.get(found.reference))
        yield with_points("", own=errors[found.reference])
    except Senseless as error:
        yield replace(found, points=(), reason=str(error))


def senseless(ladder, state, metric):
    """Why a metric says nothing about a ladder for a state, in a sentence, or ""."""
    if not ladder.applies(state):
        return "The question does not arise for this material in this light."
    if METRICS[metric].extreme and ladder.stochastic(state):
        return f"f of one of its methods is an estimate: {metric} would be the largest of its noise. Choose rmse or energy."
    if METRICS[metric].compares in JUDGED[ladder.measures]:
        return ""
    about = {
        "f": "the values of f",
        "numbers": "how numbers are held",
        "samples": "how samples are drawn",
        "picture": "how the picture is made",
    }
    others = [name for name, m in METRICS.items() if m.compares in JUDGED[ladder.measures]]
    return f"Its methods differ in {about[ladder.measures]}: {metric} is no error of theirs. Choose from: {', '.join(others)}."


def report(gpu, found, tolerance):
    """Tradeoffs as plain values, for JSON: machine, driver, and all numbers; costs in seconds."""
    about = {
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors",
        "driver": gpu.device,
        "tolerance": tolerance,
    }
    return about | {"ladders": [ladder_report(t, tolerance) for t in found]}


def ladder_report(found, tolerance):
    about = {
        "ladder": found.ladder.name,
        "question": found.ladder.question,
        "metric": {"name": found.metric, "title": METRICS[found.metric].title},
        "cost": {"of": found.kind, "unit": "s", "size": list(found.size)},
    }
    if found.reason:
        return about | {"reason": found.reason}
    front, best = found.front(), found.best(tolerance)
    about |= {
        "reference": {"name": found.reference, "error": found.own.error},
        "best": best and best.name,
        "methods": [],
    }
    for p in found.points:
        row = {"name": p.name, "changes": p.method.changes, "cost": p.cost._asdict(), "error": p.error._asdict()}
        row |= {"exact": p.exact, "outside": p.outside, "front": p in front}
        if found.kind == "sample":
            row["effort"] = effort(p)
        about["methods"].append(row)
    return about


def works(gpu, ladder, state, kind, size):
    """{name of a method: its Work}."""
    bare = {}
    if kind != "frame":
        bare = {dtype: cost.fill(gpu, size, dtype) for dtype in {m.dtype or "f4" for m in ladder.methods} - {"f8"}}
    found = {}
    for method in ladder.methods:
        at, dtype = ladder.at(state, method), method.dtype or "f4"
        if kind == "frame":
            work = cost.one_pass(gpu, at, size)
            found[method.name] = replace(work, count=1 / (method.changes or {}).get("samples", 1))
        elif kind == "sample":
            found[method.name] = cost.sample(gpu, at.model, bare[dtype], size)
        elif dtype == "f8":
            found[method.name] = cost.in_numpy(at.model)
        else:
            found[method.name] = cost.evaluation(gpu, at.model, bare[dtype], size, dtype)
    return found


# --- errors ----------------------------------------------------------------------------------------------------------


def kept_errors(gpu, ladder, state, metric):
    """Yield {name: Measured}, more of them or better ones from one to the next; at once all, if they were measured before.

    They depend on the state as the reference leaves it, so not on which of the methods is in use.
    """
    at = ladder.at(state, ladder.reference(state))
    key = (
        ladder.name,
        metric,
        at.model,
        *((at.light, at.views["sphere"]) if METRICS[metric].compares == "pictures" else ()),
    )
    if key not in gpu.errors:
        kind = METRICS[metric].compares
        kind = "estimates" if kind == "values" and ladder.measures == "f" and ladder.stochastic(state) else kind
        errors = {
            "values": value_errors,
            "estimates": estimate_errors,
            "samples": sample_errors,
            "pictures": picture_errors,
        }
        for found in errors[kind](gpu, ladder, state, METRICS[metric]):
            yield found
        gpu.errors[key] = found
        if len(gpu.errors) > KEPT:
            del gpu.errors[next(iter(gpu.errors))]
    yield gpu.errors[key]


def value_errors(gpu, ladder, state, metric):
    """By quadrature in float64; the own error is the change from half the rays and what the reference is known to."""
    reference = ladder.reference(state)
    alpha, index = ladder.at(state, reference).model.slopes(), ladder.at(state, reference).model.index()
    own = reference.own(state)
    tables, found = {}, {}
    for method in (reference, *ladder.methods):
        if method.name not in tables:
            parts = {n: [] for n in (RAYS // 2, RAYS)}
            for n, of_rays in parts.items():
                for wo in viewers():
                    one = evaluator(gpu, ladder.at(state, method).model, method)
                    of_rays.append(values(one, alpha, n, wo[None], index))
                    yield found
            tables[method.name] = [joined(of_rays) for of_rays in parts.values()]
        coarse, fine = map(metric.function, tables[method.name], tables[reference.name])
        found = found | {method.name: Measured(fine, abs(fine - coarse) + own + ROUNDING)}
        yield found


@dataclass(frozen=True)
class Shader:
    """f of a material by the shader, in float32 or stored as half-floats, of which the largest stands for what is beyond."""

    gpu: object
    model: Model
    dtype: str

    def f(self, wo, wi):
        found = self.gpu.f(self.model, wo, wi)
        with np.errstate(under="ignore"):
            return np.minimum(found, HALF).astype(np.float16) if self.dtype == "f2" else found


def evaluator(gpu, model, method):
    """What evaluates f of a model by a method."""
    return Shader(gpu, model, method.dtype) if method.dtype in ("f2", "f4") else model


def estimate_errors(gpu, ladder, state, metric):
    """As `value_errors` where f of some methods is an estimate: of these, means of PARTS x WALKS by the shader, in float32.

    A square of a difference holds that of the noise, which falls as 1 / PARTS: the jackknife takes it away, and says how
    uncertain the rest is. The reference's own error is half of that of one half of its tables from the other.
    """
    reference = ladder.reference(state)
    models = {m.name: ladder.at(state, m).model for m in ladder.methods}
    alpha, index = models[reference.name].slopes(), models[reference.name].index()
    tables, found = {name: [] for name in models}, {}
    for n in range(1, PARTS + 1):
        for name, model in models.items():
            on, count = (OnGpu(gpu, model), WALKS // TOGETHER) if model.stochastic else (model, int(n == 1))
            means = Values(0.0, 0.0, 0.0, 0.0)
            for k in range(count):
                seed = 2 * (WALKS * n + TOGETHER * k)  # of f there and back
                means = sum_of(means, values(on, alpha, RAYS // 2, None, index, seed, TOGETHER), 1 / count)
                yield found
            tables[name] += [means] * (count > 0)
        if n in (ROUGH, PARTS):
            own = tables[reference.name]
            for name in models:
                if name == reference.name:
                    halves = jackknife(metric, own[::2], own[1::2])
                    found = found | {name: Measured(0.0, 0.5 * (halves.value + halves.error))}
                else:
                    found = found | {name: jackknife(metric, tables[name], own)}
                yield found


@np.errstate(under="ignore")  # in the tails of a density
def sum_of(a, b, share):
    """Values a + share b."""
    return Values(*(getattr(a, n) + share * getattr(b, n) for n in Values.__dataclass_fields__))


@np.errstate(under="ignore")
def mean_without(tables, k):
    """The mean of Values without the k-th; of one alone that one."""
    kept = [table for i, table in enumerate(tables) if i != k] if len(tables) > 1 else tables
    return Values(*(np.mean([getattr(t, n) for t in kept], axis=0) for n in Values.__dataclass_fields__))


def jackknife(metric, found, reference):
    """The error Measured between means of Values: its square less what noise adds, and the standard error of that.

    Quenouille 1956 and Tukey 1958: of n tables, n times the square from all less n - 1 times the mean of those without one.
    """
    n = max(len(found), len(reference))

    def square(k):
        return metric.function(mean_without(found, k), mean_without(reference, k)) ** 2

    whole, less = square(None), np.array([square(k) for k in range(n)])
    value = max(n * whole - (n - 1) * less.mean(), 0.0)
    return root_of(value, np.sqrt((n - 1) / n * np.sum((less - less.mean()) ** 2)))


def root_of(square, error):
    """The root of a square with a standard error, Measured: where 0 is within that, the error is as large as the root."""
    value = np.sqrt(square)
    above, below = np.sqrt(square + error) - value, value - np.sqrt(max(square - error, 0.0))
    return Measured(float(value), float(max(above, below)) + ROUNDING)


def joined(parts):
    """Values of several viewers as one."""
    return Values(*(np.concatenate([getattr(p, name) for p in parts]) for name in Values.__dataclass_fields__))


def sample_errors(gpu, ladder, state, metric):
    """By quadrature in float64; the own error is the change from half the rays."""
    alpha = state.model.slopes()
    found = {}
    for method in ladder.methods:
        model = ladder.at(state, method).model
        coarse = metric.function(model, alpha, RAYS)
        yield found
        fine = metric.function(model, alpha, 2 * RAYS)
        found = found | {method.name: Measured(fine, abs(fine - coarse) + ROUNDING)}
        yield found


def picture_errors(gpu, ladder, state, metric):
    """On spheres of SIDE pixels with the same random numbers.

    Where methods have as many passes the own error is the change from half of them. Where they differ in that, it is the error
    of the reference after half of its own, which is its standard error: the two halves are independent. Where f is an estimate,
    squares after half and after all tell what noise adds: this is taken away, and what is left of it is the own error.
    """
    state = state.with_view("sphere", background="plain", samples=PASSES, noise=1e-6)
    reference = ladder.reference(state)
    differ = "samples" in (reference.changes or {})
    noisy = metric is METRICS["picture"] and ladder.stochastic(state)
    kept = {}  # name -> pictures after half of the passes and after all

    def draw(method):
        at = ladder.at(state, method)
        most = at.views["sphere"].samples
        for n, picture in enumerate(at.views["sphere"].pictures(gpu.apart(), at, (SIDE, SIDE)), 1):
            if n & (n - 1) == 0 or picture.done:  # half of the last is among the powers of two
                before = kept.get(method.name, (None, None))[1]
                pixels = gpu.pixels(picture.target).astype(float)
                kept[method.name] = (pixels if before is None else before, pixels)
            yield n / most

    def measured(name):
        (half, whole), (true_half, true) = kept[name], kept[reference.name]
        if not (true_half[..., :3].any() and true[..., :3].any()):
            raise Senseless("The sphere of the reference is black: no error is relative to it.")
        value = metric.function(whole, true)
        if noisy and name != reference.name:
            noise = max(metric.function(half, true_half) ** 2 - value**2, 0.0)
            return root_of(max(value**2 - noise, 0.0), noise * np.sqrt(72 / np.count_nonzero(true[..., 3])))
        own = metric.function(true_half, true) if differ else abs(value - metric.function(half, true_half))
        return Measured(value, own + ROUNDING)

    found, rough = {}, draw(reference)
    for share in rough:
        yield found
        if differ and share >= 1 / 64:  # enough for first errors; the rest of it comes last
            break
    for method in ladder.methods:
        if method is not reference:
            for _ in draw(method):
                yield found
            found = found | {method.name: measured(method.name)}
            yield found
    for _ in rough:
        yield found
    yield {m.name: measured(m.name) for m in ladder.methods}

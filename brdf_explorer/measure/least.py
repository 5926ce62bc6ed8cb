"""The least sufficient model: the cheapest methods, jointly, whose sphere stays within a tolerance of the reference's.

Combinations of one method of each ladder are looked at in order of cost. Bounds of the error from a rough evaluation reject
most of them; a finer one has to confirm, its own uncertainty included, or the search goes on.

The metric "picture" is the RMSE over the disc, relative to the mean. Its square is a bias, which ladders of f have, and a
variance, which samplers and sample counts have. The bias is found in float64 at places of the disc instead of pixels: a
pixel averages, so the error of a picture of any size is at most that one. Variance and bias together are found again in
pictures by the shaders, twice with independent random numbers: each combination against the reference with the same numbers.
Other metrics are of pictures; they see no ladder of noise, which then stays at its reference.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product
from math import inf
from typing import NamedTuple

import numpy as np

from ..environment import environment, toward, turn
from ..ladder import LADDERS, Ladder, Method
from ..lib.common import HORIZON, dot, mirror, normalize, quotient, split, vec
from ..lib.environment import environment_lookup, sample_environment
from ..lib.ndf_ggx import D
from ..model import Invalid
from . import cost
from .error import METRICS, brightening

ROUGH = (256, 4)
"""Places on the disc, and directions from each of two samplers in an environment, of the evaluation that rejects."""
FINE = (2048, 8)
"""Those of the evaluation that confirms."""
SURE = 3.0
"""Standard errors between an estimate and its bounds."""
SIDE = 64
"""Pixels of a side of the pictures that confirm."""
SPARE = 0.7
"""What is surely noise of the reference's f counts by this share for a combination's whose own was not measured."""
TIMED = (192, 192)
"""Pixels of the pictures that are timed."""
REPEATS = (9, 41)
"""Repeats of a timing, no fewer and no more."""
PASSES = 64
"""Passes of pictures that metrics other than "picture" compare."""
LONGEST = 65536
"""More passes than any picture has."""


EYE = np.array([0.0, 0.0, 1.0])


class Estimate(NamedTuple):
    """An error and the bounds that it is surely between."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Question:
    """A ladder as a state meets it.

    methods   that are tried, from the cheapest to the reference, the last
    left_out  (name, why) of the others
    noise     whether they differ in noise, not in what the picture converges to
    """

    ladder: Ladder
    methods: tuple[Method, ...]
    left_out: tuple[tuple[str, str], ...]
    noise: bool

    @property
    def top(self):
        """The index of the reference."""
        return len(self.methods) - 1


@dataclass(frozen=True)
class Prices:
    """What passes cost, seconds: one of the reference, and by (ladder, method) what a change to one method adds, alone.

    Differences add up: that is an assumption. `passes` of a state is what a frame takes of them.
    """

    reference: float
    change: dict
    passes: Callable

    def frame(self, questions, combination, state):
        """Seconds of a frame. Where differences add up to less than nothing, a tenth of the reference's pass."""
        added = sum(self.change[q.ladder.name, q.methods[i].name] for q, i in zip(questions, combination, strict=True))
        return max(self.reference + added, 0.1 * self.reference) * self.passes(state)


@dataclass(frozen=True)
class Step:
    """A ladder in the answer.

    change    error of changing this ladder alone to `chosen`; brighter: the mean difference over the mean
    saving    time of the reference's frame over that with this change alone, or None
    rejected  (name, error, standing) of the next cheaper method with all else as chosen, or None
    """

    question: Question
    chosen: Method
    change: float = 0.0
    brighter: float = 0.0
    saving: cost.Cost | None = None
    rejected: tuple | None = None


@dataclass(frozen=True)
class Sufficient:
    """The answer.

    states       reference and reduced
    steps        of the ladders that were tried; untried: (name, why) of the others
    error        of the reduced picture, with its bounds; bias and noise: its parts, for the metric "picture"
    ratio        time of the reference's frame over the reduced one's, measured against each other, or None
    combinations how many there are; evaluated: how many were evaluated roughly and finely
    """

    reference: object
    reduced: object
    steps: tuple[Step, ...]
    untried: tuple[tuple[str, str], ...]
    metric: str
    tolerance: float
    error: Estimate
    noise: float
    ratio: cost.Cost | None
    combinations: int
    evaluated: tuple[int, int]
    device: str


# --- questions -------------------------------------------------------------------------------------------------------


def questions(state, metric="picture", ladders=LADDERS):
    """The Questions of a state, and (name, why) of the ladders that are not tried."""
    lit = surrounded(state.light)
    found, untried = [], []
    for ladder in ladders.values():
        noise = ladder.measures == "samples" or any("samples" in (m.changes or {}) for m in ladder.methods)
        if noise and not lit:
            untried.append((ladder.name, "no environment to sample"))
            continue
        if not ladder.applies(state):
            untried.append((ladder.name, "does not apply"))
            continue
        left_out = [(m.name, "no shader" if m.changes is None else m.outside(state)) for m in ladder.methods]
        methods = tuple(m for m, (_, why) in zip(ladder.methods, left_out, strict=True) if not why)
        if noise and metric != "picture":
            untried.append((ladder.name, f"{METRICS[metric].title} is not split into bias and noise"))
            methods = methods[-1:]
        elif len(methods) < 2:
            untried.append((ladder.name, "one method only"))
        if methods:
            found.append(Question(ladder, methods, tuple(p for p in left_out if p[1]), noise))
    return tuple(found), tuple(untried)


def surrounded(light):
    """Whether an environment shines."""
    return light.environment != "none" and light.gain > 0


def at(state, asked, combination):
    """The state with a method of each question in use. combination: their indices."""
    for question, i in zip(asked, combination, strict=True):
        state = question.ladder.at(state, question.methods[i])
    return state


def settled(state):
    """The state with as many samples a pixel as it says, however little noise is left."""
    return state.with_view("sphere", noise=1e-6) if surrounded(state.light) else state


# --- the search ------------------------------------------------------------------------------------------------------


def search(combinations, rough, fine, tolerance):
    """The first combination that is sufficient, and its Estimate, as a generator's result; None if there is none.

    rough, fine: generators whose results are Estimates. Rejected is what is surely beyond the tolerance, accepted what is
    surely within.
    """
    for combination in combinations:
        if (yield from rough(combination)).low <= tolerance:
            found = yield from fine(combination)
            if found.high <= tolerance:
                return combination, found
    return None


def in_order(asked, prices, state):
    """All combinations by cost; of equal ones the more accurate first."""

    def rank(combination):
        away = sum(q.top - i for q, i in zip(asked, combination, strict=True))
        return prices.frame(asked, combination, at(state, asked, combination)), away

    return sorted(product(*(range(len(q.methods)) for q in asked)), key=rank)


# --- bias in float64 -------------------------------------------------------------------------------------------------


class Places:
    """Places on the sphere, with directions to the light, at which all combinations are compared.

    Places are drawn evenly over the disc, about the highlight of the directional light, and where a mirror would show the
    bright parts of the environment; directions from the reference's f and from the environment, in two independent halves.
    """

    def __init__(self, state, count, rays, seed):
        rng = np.random.default_rng(seed)
        light, model = state.light, state.model
        self.irradiance, self.surrounded = light.irradiance, surrounded(light)
        self.toward = np.array(toward(light))
        parts = [(even(count, rng), lambda normal: np.ones(len(normal)))]
        if self.irradiance > 0 and self.toward[2] > -1 + 1e-6:
            parts.append(about_highlight(self.toward, model.slopes(), count, rng))
        if self.surrounded:
            found = environment(light.environment, light.file)
            to_map = np.reshape(turn(light), (3, 3))  # right of a row of vectors
            parts.append(about_bright(found, to_map, count, rng))
        shares = [0.5, *[0.5 / (len(parts) - 1)] * (len(parts) - 1)] if len(parts) > 1 else [1.0]
        chosen = [p[rng.permutation(len(p))[: round(s * count)]] for (p, _), s in zip(parts, shares, strict=True)]
        self.count = sum(map(len, chosen))
        shares = [len(c) / self.count for c in chosen]
        normal = np.concatenate(chosen)
        normal = normal[normal[:, 2] > 1e-6]  # those behind count as 0
        self.weight = 1 / sum(s * density(normal) for s, (_, density) in zip(shares, parts, strict=True))
        frame = np.swapaxes(frames(normal), 0, 1)  # tangents, bitangents, normals: (3, places, 3)
        self.wo = normalize(vec(*(f[:, 2] for f in frame)))
        self.straight = vec(*(dot(f, self.toward) for f in frame))
        if self.surrounded:
            self._look_around(found, to_map, frame, model, light.gain, rays, rng)

    def _look_around(self, found, to_map, frame, model, gain, rays, rng):
        """Directions (places, 2, rays, 3), half of them from each sampler, and the light that each stands for."""
        shape = (len(self.wo), 2, rays // 2)
        own, _ = model.sample_f(np.broadcast_to(self.wo[:, None, None], (*shape, 3)), rng.random((*shape, 2)))
        lit = sample_environment(found.map, found.cdf, steps(rng, shape))[0] @ to_map.T
        lit = vec(*(np.einsum("phkc,pc->phk", lit, f) for f in frame))
        self.around = np.concatenate([own, lit], axis=2)
        seen = environment_lookup(found.map, np.einsum("phki,ipc->phkc", self.around, frame) @ to_map)
        with np.errstate(under="ignore"):
            both = model.pdf(self.wo[:, None, None], self.around) + seen[..., 3]
            share = np.where(self.around[..., 2] > HORIZON, quotient(self.around[..., 2], both), 0.0)
            self.light = seen[..., :3] * (share * gain * 2 / rays)[..., None]

    def radiance(self, model):
        """Radiance to the eye (places, 2, 3): two estimates that differ in the directions to the environment."""
        total = np.zeros((len(self.wo), 2, 3))
        with np.errstate(under="ignore"):
            if self.irradiance > 0:
                f = model.f(self.wo, self.straight)
                total += (f * (np.maximum(self.straight[:, 2:], 0.0) * self.irradiance))[:, None]
            if self.surrounded:
                total += np.sum(model.f(self.wo[:, None, None], self.around) * self.light, axis=2)
        return total

    @np.errstate(under="ignore")
    def mean(self, values):
        """Mean of values (places,) over the disc, an Estimate."""
        return mean_of(np.append(values * self.weight, np.zeros(self.count - len(values))))


def steps(rng, shape):
    """Random numbers (*shape, 2) in [0, 1) in steps of 2^-24."""
    return rng.integers(0, 2**24, (*shape, 2)) / 2**24


def even(count, rng):
    """Normals (count, 3) of places that are even over the disc."""
    r, phi = np.sqrt((np.arange(count) + rng.random(count)) / count), 2 * np.pi * rng.random(count)
    r = np.minimum(r, 1 - 1e-9)
    return vec(r * np.cos(phi), r * np.sin(phi), np.sqrt((1 - r) * (1 + r)))


def about_highlight(toward, alpha, count, rng):
    """Normals (count, 3) about the one that mirrors the light to the eye, as GGX has them, and their density over even ones'."""
    alpha = np.maximum(alpha, 1e-4)
    frame = frames(normalize(toward + EYE))
    u, phi = (np.arange(count) + rng.random(count)) / count, 2 * np.pi * rng.random(count)
    slope = np.sqrt(u / (1 - u + 1e-12))
    normals = normalize(vec(alpha[0] * slope * np.cos(phi), alpha[1] * slope * np.sin(phi), 1.0)) @ frame

    def density(normal):
        own = normal @ frame.T
        up = own[:, 2] > 1e-9
        with np.errstate(under="ignore"):
            own = np.where(up[:, None], own, EYE)
            return np.where(up, np.pi * D(own, alpha) * own[:, 2] / normal[:, 2], 0.0)

    return normals, density


def about_bright(found, to_map, count, rng):
    """Normals (count, 3) at which a mirror shows the environment by its density, and theirs over even ones'.

    A normal at cos theta mirrors 4 cos theta of its solid angle, and covers cos theta of it on the disc.
    """
    ahead = sample_environment(found.map, found.cdf, steps(rng, (count,)))[0] @ to_map.T + EYE
    normals = normalize(ahead[dot(ahead, ahead) > 1e-12])
    return normals, lambda normal: 4 * np.pi * environment_lookup(found.map, mirror(EYE, normal) @ to_map)[:, 3]


def frames(normal):
    """Rows tangent, bitangent, normal (..., 3, 3) of the sphere at normals (..., 3), as views/sphere.frag has them."""
    x, y, z = split(normal)
    tangent = normalize(vec(z, np.zeros_like(x), -x))
    return np.stack([tangent, np.cross(normal, tangent), normal], axis=-2)


class Bias:
    """Bias of models against a reference at Places: squares without the variance of the directions, by their two halves."""

    @np.errstate(under="ignore")
    def __init__(self, state, size, seed):
        self.places = Places(state, *size, seed)
        self.reference = self.places.radiance(state.model)
        self.level = self.places.mean(self.reference.mean(axis=(1, 2)))
        self.known = {}

    @np.errstate(under="ignore")
    def of(self, model):
        """For a model the mean square of the difference over the mean's square, an Estimate, and the mean difference over it."""
        if model not in self.known:
            difference = self.places.radiance(model) - self.reference
            square = self.places.mean(np.mean(difference[:, 0] * difference[:, 1], axis=-1))
            shift = self.places.mean(difference.mean(axis=(1, 2)))
            self.known[model] = (relative(square, self.level), shift.value / self.level.value)
        return self.known[model]


def mean_of(values):
    """The mean of independent values (n,), an Estimate.

    A few large values may hide how many more there are, so the lower bound is the best of those of values cut at some size.
    """
    lows = []
    for share in (1.0, 0.99, 0.9):
        cut = np.minimum(values, np.quantile(values, share))
        lows.append(cut.mean() - SURE * cut.std() / np.sqrt(len(cut)))
    mean = values.mean()
    return Estimate(float(mean), float(max(lows)), float(mean + SURE * values.std() / np.sqrt(len(values))))


def relative(square, level):
    """A mean square over the square of a mean, Estimates, the bounds of one over those of the other."""
    low = max(square.low, 0.0) / level.high**2
    high = max(square.high, 0.0) / level.low**2 if level.low > 0 else inf
    return Estimate(square.value / level.value**2, low, high)


def root(*squares):
    """The root of a sum of squares, Estimates."""
    return Estimate(*(float(np.sqrt(max(sum(s), 0.0))) for s in zip(*squares, strict=True)))


NONE = Estimate(0.0, 0.0, 0.0)


# --- pictures by the shaders -----------------------------------------------------------------------------------------


class Shots:
    """Pictures of states after some passes, kept.

    Random numbers go by the pixel's place, so in a wider picture the same sphere has other ones: those of a `replica`.
    """

    def __init__(self, gpu, state):
        self.gpu = gpu.apart()
        next(state.views["sphere"].pictures(self.gpu, state, (8, 8)))  # all share its environment from here on
        self.runs, self.taken = {}, {}

    def of(self, state, side, replica=0, passes=None):
        """The picture (side, side, 4) after `passes`, or after all that the state takes, as a generator's result."""
        passes = passes or state.views["sphere"].samples
        most = settled(state).with_view("sphere", background="plain", samples=LONGEST)
        key = (most.model, most.views["sphere"], side, replica)
        if (key, passes) not in self.taken:
            if key not in self.runs or self.runs[key][0] > passes:
                size = (side * (1 + 2 * replica), side)
                self.runs[key] = (0, most.views["sphere"].pictures(self.gpu.apart(), most, size), None)
            count, pictures, picture = self.runs[key]
            while count < passes and (better := next(pictures, None)):
                count, picture = count + 1, better
                self.runs[key] = (count, pictures, picture)
                yield
            pixels = self.gpu.pixels(picture.target)[:, side * replica : side * (replica + 1)]
            self.taken[key, passes] = pixels.astype(float)
        return self.taken[key, passes]


@np.errstate(under="ignore")
def over_disc(squares, reference):
    """Mean square (H, W, 3) over the disc, over the reference's mean's square, an Estimate; NONE for a black one.

    Pixels are even over the disc, so that the mean's own error is far below that of as many random places.
    """
    covered = reference[..., 3] > 0
    level = float(reference[covered][:, :3].mean())
    if level <= 0:  # a highlight that no pixel meets
        return NONE
    return relative(mean_of(squares[covered].mean(axis=-1)), Estimate(level, level, level))


class Judge:
    """What is known of a state's combinations, roughly and finely."""

    def __init__(self, gpu, state, asked, metric, tolerance, seed=1):
        self.state, self.asked, self.metric, self.tolerance = state, asked, metric, tolerance
        self.top = tuple(q.top for q in asked)
        self.reference = at(state, asked, self.top)
        if not surrounded(state.light) and state.light.irradiance == 0:
            raise Invalid("no light in this scene: the picture is black, so every model is enough")
        self.shots = Shots(gpu, self.reference)
        self.split = metric == "picture"
        self.bias = (
            [Bias(self.reference, size, seed + i) for i, size in enumerate((ROUGH, FINE))] if self.split else None
        )
        if self.split and self.bias[1].level.value <= 0:
            raise Invalid("the sphere is black in this light: no error is relative to it")
        self.seen = {}  # combination -> Estimate, the finer one if there is one
        self.noise = {}  # combination -> relative standard error, where it was measured
        self.confirmed = set()

    def only(self, combination, noise):
        """The state with the combination's methods of noise ladders, or of all others, and references elsewhere."""
        mixed = (i if q.noise == noise else q.top for q, i in zip(self.asked, combination, strict=True))
        return at(self.state, self.asked, tuple(mixed))

    def rough(self, combination):
        """Bounds from few places in float64, and from pictures of the reference's f with the combination's noise."""
        if not self.split:
            self.seen[combination] = Estimate(0.0, 0.0, inf)
            return self.seen[combination]
        bias, _ = self.bias[0].of(self.only(combination, noise=False).model)
        found = root(bias)
        yield
        if surrounded(self.state.light) and found.low <= self.tolerance:
            noise = yield from self.variance(self.only(combination, noise=True))
            found = root(bias, noise._replace(low=noise.low * SPARE**2))
        self.seen[combination] = found
        return found

    def variance(self, state):
        """The variance of a state's picture over the mean's square, an Estimate: half the square of what two differ by."""
        first = yield from self.shots.of(state, SIDE, 0)
        second = yield from self.shots.of(state, SIDE, 1)
        return over_disc((first - second)[..., :3] ** 2 / 2, first)

    def fine(self, combination):
        """The larger of two: bias from many places in float64 with the noise of pictures, and both from pictures."""
        if not self.split:
            found = yield from self.compared(combination)
        else:
            bias, _ = self.bias[1].of(self.only(combination, noise=False).model)
            found = root(bias)
            yield
            if found.low <= self.tolerance:
                noise, whole = yield from self.pictured(combination)
                self.noise[combination] = float(np.sqrt(noise.value))
                found = Estimate(*map(max, zip(root(bias, noise), root(whole), strict=True)))
        self.seen[combination] = found
        self.confirmed.add(combination)
        return found

    def pictured(self, combination):
        """(variance, mean square error) of the combination's picture over the reference's mean's square, Estimates.

        The reference has the same samplers and numbers, so that their noise does not pass for bias.
        """
        state, reference = at(self.state, self.asked, combination), self.only(combination, noise=True)
        found = []
        for replica in range(2 if surrounded(state.light) else 1):
            own = yield from self.shots.of(state, SIDE, replica)
            true = yield from self.shots.of(reference, SIDE, replica)
            found.append((own, (own - true)[..., :3]))
        squares = found[0][1] * found[-1][1]
        noise = (found[0][0] - found[-1][0])[..., :3] ** 2 / 2
        return over_disc(noise, true), over_disc(squares + noise, true)

    def compared(self, combination):
        """The error of pictures by a metric of pictures, with the same numbers; its own error is the change from half of them."""
        state, metric = self.only(combination, noise=False), METRICS[self.metric].function
        passes = PASSES if surrounded(state.light) else None
        worst = Estimate(0.0, 0.0, 0.0)
        for side in (SIDE, 2 * SIDE):
            values = []
            for count in (PASSES // 8, passes):
                own = yield from self.shots.of(state, side, passes=count)
                true = yield from self.shots.of(self.reference, side, passes=count)
                values.append(metric(own, true))
            half, value = values
            spread = abs(value - half)
            worst = Estimate(*map(max, zip(worst, (value, max(value - spread, 0.0), value + spread), strict=True)))
            if worst.low > self.tolerance:
                break
        return worst

    def alone(self, question, i):
        """(error, mean difference over the mean) of changing one ladder of the reference, not one of noise, to its method i."""
        changed = at(self.state, self.asked, tuple(i if q is question else q.top for q in self.asked))
        if self.split and question.ladder.measures == "f":
            square, shift = self.bias[1].of(changed.model)
            yield
            return float(np.sqrt(max(square.value, 0.0))), shift
        passes = PASSES if surrounded(self.state.light) else None
        own = yield from self.shots.of(changed, SIDE, passes=passes)
        true = yield from self.shots.of(self.reference, SIDE, passes=passes)
        return METRICS[self.metric].function(own, true), brightening(own, true)


# --- costs -----------------------------------------------------------------------------------------------------------


def timed(gpu, state, asked):
    """The Prices of a state, and {(ladder, method): seconds (n,)} of passes, as a generator's result.

    Each method is timed in the reference's place, all in turns. A difference of less than two of its standard errors is none.
    """
    top = at(state, asked, tuple(q.top for q in asked))
    works = {"reference": cost.one_pass(gpu, top, TIMED)}
    for question in asked:
        for method in question.methods:
            works[question.ladder.name, method.name] = cost.one_pass(gpu, question.ladder.at(top, method), TIMED)
    for samples in cost.costs(gpu, works, *REPEATS):
        count = len(next(iter(samples.values()))) if samples else 0
        yield f"timing {len(works) - 1} methods, {count} repeats"
    base = samples.pop("reference")
    change = {}
    for key, own in samples.items():
        low, median, high = np.quantile(own - base, [0.25, 0.5, 0.75])
        change[key] = float(median) if abs(median) > 2 * 0.93 * (high - low) / np.sqrt(len(base)) else 0.0
    return Prices(float(np.median(base)), change, passes), samples | {"reference": base}


def passes(state):
    """Passes that a frame takes: its samples in an environment, else the first, which is all that a moving picture shows."""
    return state.views["sphere"].samples if surrounded(state.light) else 1


def ratio(gpu, reference, reduced):
    """The time of the reference's frame over that of the reduced one, a Cost, timed in turns; as a generator's result."""
    works = {"reference": cost.one_pass(gpu, reference, TIMED), "reduced": cost.one_pass(gpu, reduced, TIMED)}
    for found in cost.costs(gpu, works, *REPEATS):
        samples = found
        yield "timing the answer against the reference"
    return cost.summary(samples["reference"] * passes(reference) / (samples["reduced"] * passes(reduced)))


# --- the answer ------------------------------------------------------------------------------------------------------


def least(gpu, state, tolerance=0.01, metric="picture", ladders=LADDERS, prices=None):
    """The Sufficient model of a state, as the result of a generator that yields what it does in a few words.

    prices: Prices instead of measured ones. Raises Invalid where nothing can be reduced or compared, or nothing is within
    the tolerance.
    """
    if state.model.index() is not None:
        raise Invalid(
            f"{state.material.name}: light inside a ball is not compared here; `chart` compares f of its methods"
        )
    asked, untried = questions(state, metric, ladders)
    if all(len(q.methods) < 2 for q in asked):
        raise Invalid(f"{state.material.name}: nothing to reduce: each question that it raises has one method only")
    yield "reference"
    judge = Judge(gpu, state, asked, metric, tolerance)
    measured = None
    if prices is None:
        prices, measured = yield from timed(judge.shots.gpu, state, asked)
    ordered = in_order(asked, prices, state)
    looking = search(ordered, judge.rough, judge.fine, tolerance)
    try:
        while True:
            next(looking)
            yield f"{len(judge.seen)} of {len(ordered)} combinations"
    except StopIteration as end:
        answer = end.value
    if answer is None:
        own = judge.seen.get(judge.top)
        raise Invalid(
            f"no combination is surely within {tolerance:g}: the reference itself is known to {own.high:.2g} only; "
            "ask for more"
        )
    chosen, error = answer
    reduced = settled(at(state, asked, chosen))
    found = None
    if measured is not None:
        found = yield from ratio(judge.shots.gpu, judge.reference, reduced)
    described = []
    for question, i in zip(asked, chosen, strict=True):
        step = Step(question, question.methods[i], rejected=rejected(judge, ordered, chosen, question))
        if i != question.top:
            yield f"{question.ladder.name} alone"
            change = (judge.noise[chosen], 0.0) if question.noise else (yield from judge.alone(question, i))
            step = replace(step, change=change[0], brighter=change[1], saving=saving(measured, state, question, i))
        described.append(step)
    return Sufficient(
        settled(judge.reference),
        reduced,
        tuple(described),
        untried,
        metric,
        tolerance,
        error,
        judge.noise.get(chosen, 0.0),
        found,
        len(ordered),
        (len(judge.seen), len(judge.confirmed)),
        gpu.device,
    )


def saving(measured, state, question, i):
    """The time of a frame of the reference over that with one method changed, a Cost, or None if nothing was timed."""
    if measured is None:
        return None
    ladder, methods = question.ladder, question.methods
    count = [passes(ladder.at(state, m)) for m in (methods[question.top], methods[i])]
    return cost.summary(measured["reference"] * count[0] / (measured[ladder.name, methods[i].name] * count[1]))


def rejected(judge, ordered, chosen, question):
    """(name, Estimate, whether confirmed) of the dearest method of a question that is cheaper with all else as chosen."""
    spot = judge.asked.index(question)
    for other in reversed(ordered[: ordered.index(chosen)]):
        if other[:spot] + other[spot + 1 :] == chosen[:spot] + chosen[spot + 1 :]:
            return question.methods[other[spot]].name, judge.seen[other], other in judge.confirmed
    return None


def result(generator, show=lambda words: None):
    """The result of a generator that yields words on what it does."""
    while True:
        try:
            show(next(generator))
        except StopIteration as end:
            return end.value


# --- in words --------------------------------------------------------------------------------------------------------

HEADS = ("ladder", "in use", "reference", "error alone", "frame, cheaper by", "next cheaper method")


def amount(value, metric):
    """An error in the metric's words: a share in percent, or a plain number."""
    return f"{100 * value:.2g} %" if metric in ("picture", "brightness") else f"{value:.2g}"


def times(found):
    """A ratio of times with its quartiles."""
    return f"{found.median:.3g} x ({found.low:.3g} to {found.high:.3g})"


def rows(answer):
    """The ladders as rows of text, one cell for each of HEADS."""
    found = []
    for step in answer.steps:
        question = step.question
        reference = question.methods[question.top]
        kept = step.chosen is reference
        error = "" if kept else amount(step.change, answer.metric)
        if question.noise and not kept:
            error = f"noise {error}"
        elif not kept and abs(step.brighter) >= 1e-5:
            error += f", {tone(step.brighter)}"
        saving = times(step.saving) if step.saving else ""
        found.append((question.ladder.name, step.chosen.name, reference.name, error, saving, refused(step, answer)))
    return found


def tone(brighter):
    return f"{100 * abs(brighter):.2g} % {'brighter' if brighter > 0 else 'darker'}"


def refused(step, answer):
    """Why the next cheaper method is not in use, in a few words."""
    if step.rejected is None:
        return "none is cheaper" if len(step.question.methods) > 1 else "one method"
    name, error, confirmed = step.rejected
    sure = "" if confirmed else "about "
    return f"{name}: {sure}{amount(error.value, answer.metric)}"


def sentences(answer):
    """The answer in words, a list of sentences."""
    metric = METRICS[answer.metric]
    reduced = [s for s in answer.steps if s.chosen is not s.question.methods[s.question.top]]
    found = []
    if reduced:
        found.append(f"{len(reduced)} of {len(answer.steps)} ladders come down from their reference.")
    else:
        found.append("Nothing can be dropped: no cheaper combination stays within the tolerance.")
    found.append(
        f"{metric.title[0].upper() + metric.title[1:]}: {amount(answer.error.value, answer.metric)}, surely below "
        f"{amount(answer.error.high, answer.metric)}; tolerance {amount(answer.tolerance, answer.metric)}."
    )
    for step in reduced:
        name = step.question.methods[step.question.top].name
        effect = f"noise {amount(step.change, answer.metric)}" if step.question.noise else tone(step.brighter)
        if not step.question.noise:
            effect += f", error {amount(step.change, answer.metric)}"
        cheaper = f", {times(step.saving)} cheaper" if step.saving else ""
        found.append(f"{step.chosen.name} instead of {name}: {effect}{cheaper}.")
    for step in answer.steps:
        if step.rejected:
            name, error, _ = step.rejected
            why = "beyond the tolerance" if error.low > answer.tolerance else "not surely within the tolerance"
            found.append(f"{name} instead of {step.chosen.name} is {why}: error {amount(error.value, answer.metric)}.")
    if answer.ratio:
        found.append(f"A frame of the reference takes {times(answer.ratio)} the time of a reduced one.")
    out = [f"{name} ({why})" for name, why in untried(answer)]
    if out:
        found.append(f"Not tried: {', '.join(out)}.")
    return found


def untried(answer):
    """(name, why) of all ladders and methods that were not tried."""
    left = [(f"{s.question.ladder.name} {name}", why) for s in answer.steps for name, why in s.question.left_out]
    return [*answer.untried, *left]

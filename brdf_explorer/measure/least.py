"""The least sufficient model: the cheapest methods, jointly, whose sphere stays within a tolerance of the reference's.

Combinations of one method of each ladder are looked at in order of cost. Bounds of the error from a rough evaluation reject
most of them; a finer one has to confirm, its own uncertainty included, or the search goes on.

The metric "picture" is the RMSE over the disc, relative to the mean. Its square is a bias, which ladders of f have, and a
variance, which samplers and sample counts have. The bias is found in float64 at places of the disc instead of pixels: a
pixel averages, so the error of a picture of any size up to LARGEST is at most that one. (Beyond that, towards the silhouette,
an f without masking has no bound, nor has its error.) Variance and bias together are found again in pictures by the shaders,
twice with independent random numbers: each combination against the reference with the same numbers. Squares of biases are
products of two independent halves, so that no noise passes for bias. Where f is itself an estimate, by the combination or by
the reference, pictures alone judge, and the answer is for their size. Other metrics are of pictures; they see no ladder of
noise, which then stays at its reference.

Work is done in generators that yield every few milliseconds, and whose result is what `return` gives.
"""

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
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
EARLY = 64
"""Passes of pictures that reject where f is an estimate."""
PASSES = 64
"""Passes of pictures that metrics other than "picture" compare."""
LONGEST = 65536
"""More passes than any picture has."""
EXACT = 1e-9
"""Errors below it are of rounding in float64."""
CHUNK = 512
"""Directions at which f is found between two yields."""


LARGEST = 4096
"""Pixels of a side of the largest pictures that the answer is for."""
EDGE = 1.0 - 0.5 / (0.46 * LARGEST)
"""Largest distance from the disc's centre, in radii, at which views/sphere.frag shades those."""


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
    remodels  whether they change the model, and with it which other questions arise
    """

    ladder: Ladder
    methods: tuple[Method, ...]
    left_out: tuple[tuple[str, str], ...]
    noise: bool
    remodels: bool = False

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

    def frame(self, asked, combination, state):
        """Seconds of a frame. Where differences add up to less than nothing, a tenth of a pass by that model."""
        used = [(q, self.change[q.ladder.name, q.methods[i].name]) for q, i in zip(asked, combination, strict=True)]
        model = self.reference + sum(change for q, change in used if q.remodels)
        added = sum(change for q, change in used if not q.remodels)
        return max(model + added, 0.1 * model) * self.passes(state)


@dataclass(frozen=True)
class Step:
    """A ladder in the answer.

    change    error of changing this ladder alone to `chosen`; of a ladder of noise, the noise then, and `before` at first
    brighter  the mean difference over the mean
    saving    time of a frame over that with this change alone, or None
    rejected  (name, error, standing) of the next cheaper method with all else as chosen, or None
    """

    question: Question
    chosen: Method
    change: float = 0.0
    before: float = 0.0
    brighter: float = 0.0
    saving: cost.Cost | None = None
    rejected: tuple | None = None

    @property
    def dropped(self):
        """Whether a cheaper method than the reference's is in use."""
        return self.chosen is not self.question.methods[self.question.top]


@dataclass(frozen=True)
class Sufficient:
    """The answer.

    reference, reduced  states
    steps        of the ladders that were tried; untried: (name, why) of the others
    error        of the reduced picture, with its bounds; noise: its part of that, for the metric "picture"
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
    """The Questions of a state, those that change the model first, and (name, why) of the ladders that are not tried."""
    lit, states = surrounded(state.light), models_within_reach(state, ladders)
    arising = {k.name: next((s for s in states if k.applies(s)), None) for k in ladders.values()}
    found, untried = [], []
    for ladder in ladders.values():
        noise = ladder.measures == "samples" or any("samples" in (m.changes or {}) for m in ladder.methods)
        if noise and not lit:
            untried.append((ladder.name, "no environment to sample"))
            continue
        where = arising[ladder.name]
        if where is None:
            untried.append((ladder.name, "does not apply"))
            continue
        rivals = [k for k in ladders.values() if arising[k.name] and changes(k) & changes(ladder)] or [ladder]
        asked = next((k for k in rivals if k.current(where)), rivals[0])
        if asked is not ladder:
            untried.append((ladder.name, f"{asked.name} is the question about this material"))
            continue
        left_out = [(m.name, "no shader" if m.changes is None else m.outside(where)) for m in ladder.methods]
        methods = tuple(m for m, (_, why) in zip(ladder.methods, left_out, strict=True) if not why)
        if noise and metric != "picture":
            untried.append((ladder.name, f"{METRICS[metric].title} is not split into bias and noise"))
            methods = methods[-1:]
        elif len(methods) < 2:
            untried.append((ladder.name, "one method only"))
        if methods:
            remodels = len({type(ladder.at(where, m).model) for m in methods}) > 1
            found.append(Question(ladder, methods, tuple(p for p in left_out if p[1]), noise, remodels))
    return tuple(sorted(found, key=lambda q: not q.remodels)), tuple(untried)


def models_within_reach(state, ladders):
    """States with each class of model that methods lead to, the given one first."""
    found = [state]
    for reached in found:  # which grows
        for ladder in ladders.values():
            if ladder.applies(reached):
                others = [ladder.at(reached, m) for m in ladder.methods if m.changes is not None]
                found += {
                    type(s.model): s for s in others if type(s.model) not in {type(f.model) for f in found}
                }.values()
    return found


def changes(ladder):
    """What a ladder's methods change: (section, parameter)."""
    return {(ladder.section, name) for method in ladder.methods for name in method.changes or {}}


def surrounded(light):
    """Whether an environment shines."""
    return light.environment != "none" and light.gain > 0


def noisy(state):
    """Whether its picture is an estimate, which gets better with the passes."""
    return surrounded(state.light) or state.model.stochastic


def at(state, asked, combination):
    """The state with a method in use of each question that arises. combination: their indices."""
    for question, i in zip(asked, combination, strict=True):
        if question.ladder.applies(state):
            state = question.ladder.at(state, question.methods[i])
    return state


def settled(state):
    """The state with as many samples a pixel as it says, however little noise is left."""
    return state.with_view("sphere", noise=1e-6) if noisy(state) else state


def arising(state, asked, combination):
    """The combination with the reference's method of each question that does not arise for the model that it chooses."""
    first = sum(q.remodels for q in asked)
    reached = at(state, asked[:first], combination[:first])
    kept = (q.remodels or q.ladder.applies(reached) for q in asked)
    return tuple(i if keep else q.top for q, i, keep in zip(asked, combination, kept, strict=True))


def place(state, asked, question):
    """The combination nearest to the reference in which a question arises: there its methods are compared alone."""
    top = tuple(q.top for q in asked)
    less = [(*top[:j], i, *top[j + 1 :]) for j, q in enumerate(asked) if q.remodels for i in reversed(range(q.top))]
    return next(c for c in (top, *less) if question.ladder.applies(at(state, asked, c)))


def moved(combination, asked, question, i):
    """The combination with a question's method i."""
    return tuple(i if q is question else j for q, j in zip(asked, combination, strict=True))


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
    """All combinations by cost, each once, as a generator's result; of equal ones the more accurate first."""
    ranks = {}
    for number, combination in enumerate(product(*(range(len(q.methods)) for q in asked))):
        if arising(state, asked, combination) == combination:
            away = sum(q.top - i for q, i in zip(asked, combination, strict=True))
            ranks[combination] = prices.frame(asked, combination, at(state, asked, combination)), away
        if number % 32 == 0:
            yield
    return sorted(ranks, key=ranks.get)


# --- bias in float64 -------------------------------------------------------------------------------------------------


class Places:
    """Places on the sphere, with directions to the light, at which all combinations are compared.

    Places are drawn evenly over the disc, towards its edge, about the highlight of the directional light, and where a mirror
    would show the bright parts of the environment; directions from the reference's f and from the environment, in two
    independent halves.
    """

    def __init__(self, state, count, rays, seed):
        rng = np.random.default_rng(seed)
        light, model = state.light, state.model
        self.irradiance, self.surrounded = light.irradiance, surrounded(light)
        self.toward = np.array(toward(light))
        parts = [(even(count, rng), lambda normal: np.ones(len(normal))), towards_edge(count, rng)]
        if self.irradiance > 0 and self.toward[2] > -1 + 1e-6:
            parts.append(about_highlight(self.toward, model.slopes(), count, rng))
        if self.surrounded:
            found = environment(light.environment, light.file)
            to_map = np.reshape(turn(light), (3, 3))  # right of a row of vectors
            parts.append(about_bright(found, to_map, count, rng))
        shares = [0.5, *[0.5 / (len(parts) - 1)] * (len(parts) - 1)]
        chosen = [p[rng.permutation(len(p))[: round(s * count)]] for (p, _), s in zip(parts, shares, strict=True)]
        self.count = sum(map(len, chosen))
        shares = [len(c) / self.count for c in chosen]
        normal = np.concatenate(chosen)
        normal = normal[normal[:, 2] > np.sqrt(1 - EDGE**2)]  # those behind count as 0
        self.weight = 1 / sum(s * density(normal) for s, (_, density) in zip(shares, parts, strict=True))
        frame = np.swapaxes(frames(normal), 0, 1)  # tangents, bitangents, normals: (3, places, 3)
        self.wo = normalize(vec(*(f[:, 2] for f in frame)))
        self.straight = vec(*(dot(f, self.toward) for f in frame))
        size = max(CHUNK // (2 * rays if self.surrounded else 1), 1)
        self.parts = [slice(i, i + size) for i in range(0, len(self.wo), size)]
        if self.surrounded:
            around = (self.look_around(p, found, to_map, frame[:, p], model, light.gain, rays, rng) for p in self.parts)
            self.around = Kept(around)

    def look_around(self, part, found, to_map, frame, model, gain, rays, rng):
        """Directions (places, 2, rays, 3), half of them from each sampler, and the light that each stands for."""
        wo = self.wo[part]
        shape = (len(wo), 2, rays // 2)
        own, _ = model.sample_f(np.broadcast_to(wo[:, None, None], (*shape, 3)), rng.random((*shape, 2)))
        lit = sample_environment(found.map, found.cdf, steps(rng, shape))[0] @ to_map.T
        lit = vec(*(np.einsum("phkc,pc->phk", lit, f) for f in frame))
        wi = np.concatenate([own, lit], axis=2)
        seen = environment_lookup(found.map, np.einsum("phki,ipc->phkc", wi, frame) @ to_map)
        both = model.pdf(wo[:, None, None], wi) + seen[..., 3]
        share = np.where(wi[..., 2] > HORIZON, quotient(wi[..., 2], both), 0.0)
        return wi, seen[..., :3] * (share * gain * 2 / rays)[..., None]

    def radiance(self, model):
        """Radiance to the eye (places, 2, 3), as a generator's result: two estimates by other directions to the environment."""
        total = np.zeros((len(self.wo), 2, 3))
        for i, part in enumerate(self.parts):
            with np.errstate(under="ignore"):
                wo = self.wo[part]
                if self.irradiance > 0:
                    wi = self.straight[part]
                    total[part] += (model.f(wo, wi) * (self.irradiance * np.maximum(wi[:, 2:], 0.0)))[:, None]
                if self.surrounded:
                    wi, light = self.around[i]
                    total[part] += np.sum(model.f(wo[:, None, None], wi) * light, axis=2)
            yield
        return total

    @np.errstate(under="ignore")
    def mean(self, values):
        """Mean of values (places,) over the disc, an Estimate."""
        return mean_of(np.append(values * self.weight, np.zeros(self.count - len(values))))


class Kept:
    """The values of an iterator by number, found when they are asked for in order, and kept."""

    def __init__(self, values):
        self.coming, self.values = values, []

    def __getitem__(self, i):
        while len(self.values) <= i:
            self.values.append(next(self.coming))
        return self.values[i]


def steps(rng, shape):
    """Random numbers (*shape, 2) in [0, 1) in steps of 2^-24."""
    return rng.integers(0, 2**24, (*shape, 2)) / 2**24


def even(count, rng):
    """Normals (count, 3) of places that are even over the disc."""
    return on_disc(np.sqrt((np.arange(count) + rng.random(count)) / count), rng)


def on_disc(r, rng):
    """Normals (count, 3) at distances (count,) from the disc's centre."""
    phi = 2 * np.pi * rng.random(len(r))
    return vec(r * np.cos(phi), r * np.sin(phi), np.sqrt((1 - r) * (1 + r)))


def towards_edge(count, rng):
    """Normals (count, 3) whose cosine to the eye is even in its logarithm down to the edge, and their density over even ones'."""
    decay = -0.5 * np.log(1 - EDGE**2)
    cosine = np.exp(-decay * (np.arange(count) + rng.random(count)) / count)
    return on_disc(np.sqrt((1 - cosine) * (1 + cosine)), rng), lambda normal: 1 / (2 * decay * normal[:, 2] ** 2)


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

    def __init__(self, state, size, seed):
        self.places, self.reference = Places(state, *size, seed), state.model
        self.found = {}  # model -> its radiance

    def radiance(self, model):
        """That at the places, as a generator's result."""
        if model not in self.found:
            self.found[model] = yield from self.places.radiance(model)
        return self.found[model]

    def level(self):
        """The reference's mean over the disc, an Estimate, as a generator's result."""
        reference = yield from self.radiance(self.reference)
        return self.places.mean(reference.mean(axis=(1, 2)))

    def of(self, model, other=None):
        """For a model less another, or the reference, the mean square of the difference over that of the reference's mean,
        an Estimate, and the mean difference over the mean; as a generator's result."""
        other = other or self.reference
        if model == other:
            return NONE, 0.0
        level = yield from self.level()
        own = yield from self.radiance(model)
        less = yield from self.radiance(other)
        difference = own - less
        with np.errstate(under="ignore"):
            square = self.places.mean(np.mean(difference[:, 0] * difference[:, 1], axis=-1))
            shift = self.places.mean(difference.mean(axis=(1, 2)))
        return relative(square, level), shift.value / level.value


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


def evidence(gpu, reference):
    """The Shots and the Biases, rough and fine, of a reference in its light, and answers by what was asked: kept until those
    of another reference are asked for.

    They serve any tolerance, and any state that has this reference.
    """
    key = (reference.model, reference.light)
    if gpu.errors.get("least", (None,))[0] != key:
        biases = [Bias(reference, size, seed) for seed, size in enumerate((ROUGH, FINE), 1)]
        gpu.errors["least"] = key, (Shots(gpu, reference), biases, {})
    return gpu.errors["least"][1]


class Judge:
    """What is known of a state's combinations, roughly and finely."""

    def __init__(self, gpu, state, asked, metric, tolerance):
        self.state, self.asked, self.metric, self.tolerance = state, asked, metric, tolerance
        self.top = tuple(q.top for q in asked)
        self.reference = at(state, asked, self.top)
        if not surrounded(state.light) and state.light.irradiance == 0:
            raise Invalid("no light in this scene: the picture is black, so every model is enough")
        self.shots, self.biases, self.answers = evidence(gpu, self.reference)
        self.split = metric == "picture"
        self.seen = {}  # combination -> Estimate, the finer one if there is one
        self.noise = {}  # combination -> relative standard error, where it was measured
        self.confirmed = set()

    def check(self):
        """Raise Invalid where errors are not relative to anything; a generator."""
        if self.split and (yield from self.biases[1].level()).value <= 0:
            raise Invalid("the sphere is black in this light: no error is relative to it")

    def only(self, combination, noise):
        """The state with the combination's methods of noise ladders, or of all others, and references elsewhere."""
        mixed = (i if q.noise == noise else q.top for q, i in zip(self.asked, combination, strict=True))
        return at(self.state, self.asked, tuple(mixed))

    def rough(self, combination):
        """Bounds from few places in float64, and from pictures of the reference's f with the combination's noise."""
        found = Estimate(0.0, 0.0, inf)
        state = self.only(combination, noise=False)
        if self.split and self.estimated(state):
            bias, *_ = yield from self.pictured(combination, EARLY)
            found = root(bias)
        elif self.split:
            bias, _ = yield from self.biases[0].of(state.model)
            found = root(bias)
            if surrounded(self.state.light) and found.low <= self.tolerance:
                noise = yield from self.variance(self.only(combination, noise=True))
                found = root(bias, noise._replace(low=noise.low * SPARE**2))
        self.seen[combination] = found
        return found

    def estimated(self, state):
        """Whether f of a state or of the reference is an estimate: its noise is then unlike that of others."""
        return state.model.stochastic or self.reference.model.stochastic

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
            state, bias = self.only(combination, noise=False), NONE
            if not self.estimated(state):
                bias, _ = yield from self.biases[1].of(state.model)
            found = root(bias)
            if found.low <= self.tolerance:
                _, noise, whole = yield from self.pictured(combination)
                self.noise[combination] = float(np.sqrt(noise.value))
                found = Estimate(*map(max, zip(root(bias, noise), root(whole), strict=True)))
        self.seen[combination] = found
        self.confirmed.add(combination)
        return found

    def pictured(self, combination, passes=None):
        """(bias squared, variance, both) of the combination's picture over the reference's mean's square, Estimates.

        The reference has the same samplers and numbers, so that their noise does not pass for bias.
        """
        state, reference = at(self.state, self.asked, combination), self.only(combination, noise=True)
        return (yield from self.apart(state, reference, passes))

    def apart(self, state, reference, passes=None):
        """What `pictured` says, of two states."""
        found = []
        for replica in range(1 + (noisy(state) or noisy(reference))):
            own = yield from self.shots.of(state, SIDE, replica, passes)
            true = yield from self.shots.of(reference, SIDE, replica, passes)
            found.append((own, (own - true)[..., :3]))
        squares = found[0][1] * found[-1][1]
        noise = (found[0][0] - found[-1][0])[..., :3] ** 2 / 2
        return tuple(over_disc(s, true) for s in (squares, noise, squares + noise))

    def compared(self, combination):
        """The error of pictures by a metric of pictures, with the same numbers; its own error is the change from half of them."""
        state, worst = self.only(combination, noise=False), NONE
        if state == self.reference:
            return worst
        for side in (SIDE, 2 * SIDE):
            half = yield from self.difference(state, self.reference, side, PASSES // 8)
            value = yield from self.difference(state, self.reference, side, PASSES)
            spread = abs(value - half)
            worst = Estimate(*map(max, zip(worst, (value, max(value - spread, 0.0), value + spread), strict=True)))
            if worst.low > self.tolerance:
                break
        return worst

    def difference(self, state, reference, side, passes, metric=None):
        """A metric of pictures of two states after some passes, or after the last ones if they are no estimates."""
        count = passes if noisy(state) or noisy(reference) or passes < PASSES else LONGEST
        own = yield from self.shots.of(state, side, passes=count)
        true = yield from self.shots.of(reference, side, passes=count)
        return (yield from aside(metric or METRICS[self.metric].function, own, true))

    def alone(self, question, i):
        """Error, of a noise ladder (noise, that before), and mean difference over the mean of changing to one method alone."""
        before = place(self.state, self.asked, question)
        reference, state = (at(self.state, self.asked, c) for c in (before, moved(before, self.asked, question, i)))
        if question.noise:
            own = yield from self.variance(state)
            first = yield from self.variance(reference)
            return float(np.sqrt(own.value)), float(np.sqrt(first.value)), 0.0
        if self.split and (state.model.stochastic or reference.model.stochastic):
            square, *_ = yield from self.apart(state, reference)
            own, true = self.shots.of(state, SIDE), self.shots.of(reference, SIDE)
            return root(square).value, 0.0, brightening((yield from own), (yield from true))
        if self.split and question.ladder.measures == "f":
            square, shift = yield from self.biases[1].of(state.model, reference.model)
            return root(square).value, 0.0, shift
        error = yield from self.difference(state, reference, SIDE, PASSES)
        return error, 0.0, (yield from self.difference(state, reference, SIDE, PASSES, brightening))


def aside(function, *arguments):
    """The function's value as a generator's result, from a thread: some take long, and leave Python to others."""
    pool = ThreadPoolExecutor(1)
    coming = pool.submit(function, *arguments)
    pool.shutdown(wait=False)
    while not coming.done():
        time.sleep(0.0005)
        yield
    return coming.result()


# --- costs -----------------------------------------------------------------------------------------------------------


def timed(gpu, state, asked):
    """The Prices of a state, and {(ladder, method): seconds (n,)} of passes, as a generator's result.

    Each method is timed in its question's `place`, all in turns. A difference that is not surely of one sign is none: two
    standard deviations of the number of positive ones on either side of their median, whatever their distribution.
    """
    works = {}
    for question in asked:
        base = place(state, asked, question)
        for i, method in enumerate(question.methods):
            changed = at(state, asked, moved(base, asked, question, i))
            works[question.ladder.name, method.name] = cost.one_pass(gpu, changed, TIMED)
            yield "timing begins"
    works[None] = cost.one_pass(gpu, at(state, asked, tuple(q.top for q in asked)), TIMED)
    for samples in cost.costs(gpu, works):
        count = len(next(iter(samples.values()))) if samples else 0
        yield f"timing {len(works) - 1} methods, {count} repeats"
    change = {}
    for question in asked:
        base = samples[question.ladder.name, question.methods[question.top].name]
        for method in question.methods:
            more = samples[question.ladder.name, method.name] - base
            low, median, high = np.quantile(more, np.clip(0.5 + np.array([-1, 0, 1]) / np.sqrt(len(more)), 0, 1))
            change[question.ladder.name, method.name] = float(median) if low * high > 0 else 0.0
    return Prices(float(np.median(samples[None])), change, passes), samples


def passes(state):
    """Passes that a frame takes: its samples if it is noisy, else the first, which is all that a moving picture shows."""
    return state.views["sphere"].samples if noisy(state) else 1


def ratio(gpu, reference, reduced):
    """The time of the reference's frame over that of the reduced one, a Cost, timed in turns; as a generator's result."""
    works = {"reference": cost.one_pass(gpu, reference, TIMED), "reduced": cost.one_pass(gpu, reduced, TIMED)}
    for found in cost.costs(gpu, works):
        samples = found
        yield
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
    judge = Judge(gpu, state, asked, metric, tolerance)
    names = tuple((q.ladder.name, *(m.name for m in q.methods)) for q in asked)
    key = tolerance, metric, settled(judge.reference).views["sphere"], names
    measured = None
    if prices is None and key in judge.answers:
        chosen, answer = judge.answers[key]
        return replace(answer, reference=settled(judge.reference), reduced=settled(at(state, asked, chosen)))
    yield from saying(judge.check(), lambda: "the reference")
    if prices is None:
        prices, measured = yield from timed(judge.shots.gpu, state, asked)
    ordered = yield from saying(in_order(asked, prices, state), lambda: "combinations by cost")
    looking = search(ordered, judge.rough, judge.fine, tolerance)
    found = yield from saying(looking, lambda: f"{len(judge.seen)} of {len(ordered)} combinations")
    if found is None:
        own = judge.seen[judge.top]
        raise Invalid(
            f"no combination is surely within {tolerance:g}: the reference itself is known to {own.high:.2g} only; "
            "ask for more, or give it more samples"
        )
    chosen, error = found
    reduced = settled(at(state, asked, chosen))
    described = []
    for question, i in zip(asked, chosen, strict=True):
        step = Step(question, question.methods[i], rejected=rejected(judge, ordered, chosen, question))
        if i != question.top:
            name = question.ladder.name
            change = yield from saying(judge.alone(question, i), lambda name=name: f"{name} alone")
            step = Step(question, step.chosen, *change, saving(measured, state, asked, question, i), step.rejected)
        described.append(step)
    against = None
    if measured is not None:
        timing = ratio(judge.shots.gpu, judge.reference, reduced)
        against = yield from saying(timing, lambda: "timing the answer against the reference")
    answer = Sufficient(
        settled(judge.reference),
        reduced,
        tuple(described),
        untried,
        metric,
        tolerance,
        error,
        judge.noise.get(chosen, 0.0),
        against,
        len(ordered),
        (len(judge.seen), len(judge.confirmed)),
        gpu.device,
    )
    if measured is not None:
        judge.answers[key] = chosen, answer
    return answer


def saying(steps, words):
    """Yield words() at each step of a generator, whose result it is."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value
        yield words()


def saving(measured, state, asked, question, i):
    """The time of a frame in a question's `place` over that with its method i, a Cost, or None if nothing was timed."""
    if measured is None:
        return None
    base = place(state, asked, question)
    seconds = []
    for j in (question.top, i):
        count = passes(at(state, asked, moved(base, asked, question, j)))
        seconds.append(measured[question.ladder.name, question.methods[j].name] * count)
    return cost.summary(seconds[0] / seconds[1])


def rejected(judge, ordered, chosen, question):
    """(name, Estimate, whether confirmed) of the dearest method of a question that is cheaper with all else as chosen."""
    cheaper = ordered[: ordered.index(chosen)]
    others = {}
    for i, method in enumerate(question.methods):
        other = arising(judge.state, judge.asked, moved(chosen, judge.asked, question, i))
        if other in cheaper:
            others[cheaper.index(other)] = method.name, judge.seen[other], other in judge.confirmed
    return others[max(others)] if others else None


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
    return percent(value) if metric in ("picture", "brightness") else figure(value)


def percent(share):
    return f"{figure(100 * share)} %"


def figure(value):
    """A number with two digits, without an exponent where it is large."""
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.2g}"


def times(found):
    """A ratio of times with its quartiles."""
    return f"{found.median:.3g} x ({found.low:.3g} to {found.high:.3g})"


def tone(brighter):
    """How much brighter or darker, in words; "" for less than 0.001 %."""
    return f"{percent(abs(brighter))} {'brighter' if brighter > 0 else 'darker'}" if abs(brighter) >= 1e-5 else ""


def effect(step, metric):
    """What a step alone does to the picture, in a few words."""
    if step.question.noise:
        return f"noise {amount(step.change, metric)} instead of {amount(step.before, metric)}"
    if step.change < EXACT:
        return "no difference"
    return ", ".join(filter(None, [f"error {amount(step.change, metric)}", tone(step.brighter)]))


def refused(step, answer):
    """Why the next cheaper method is not in use, in a few words."""
    if step.rejected is None:
        return "none is cheaper" if len(step.question.methods) > 1 else "no other"
    name, error, confirmed = step.rejected
    return f"{name}: {'' if confirmed else 'about '}{amount(error.value, answer.metric)}"


def rows(answer):
    """The ladders as rows of text, one cell for each of HEADS."""
    found = []
    for step in answer.steps:
        reference = step.question.methods[step.question.top]
        told = effect(step, answer.metric).removeprefix("error ") if step.dropped else ""
        saving = times(step.saving) if step.saving else ""
        names = step.question.ladder.name, step.chosen.name, reference.name
        found.append((*names, told, saving, refused(step, answer)))
    return found


def sentences(answer):
    """The answer in words, a list of sentences."""
    metric, error = METRICS[answer.metric], answer.error
    dropped = [s for s in answer.steps if s.dropped]
    if dropped:
        found = [f"{len(dropped)} of {len(answer.steps)} ladders come down from their reference."]
    else:
        found = ["Nothing can be dropped: no combination that is measurably cheaper stays within the tolerance."]
    tolerance = f"the tolerance is {amount(answer.tolerance, answer.metric)}"
    if error.high < EXACT:
        found.append(f"The picture is that of the reference; {tolerance}.")
    else:
        value, most = (amount(v, answer.metric) for v in (error.value, error.high))
        found.append(f"{metric.title[0].upper()}{metric.title[1:]}: {value}, surely below {most}; {tolerance}.")
    for step in dropped:
        name = step.question.methods[step.question.top].name
        cheaper = f", {times(step.saving)} cheaper" if step.saving else ""
        found.append(f"{step.chosen.name} instead of {name}: {effect(step, answer.metric)}{cheaper}.")
    for step in answer.steps:
        if step.rejected:
            name, error, _ = step.rejected
            why = "beyond the tolerance" if error.low > answer.tolerance else "not surely within the tolerance"
            found.append(f"{name} instead of {step.chosen.name} is {why}: error {amount(error.value, answer.metric)}.")
    if answer.ratio and dropped:
        found.append(f"A frame of the reference takes {times(answer.ratio)} the time of a reduced one.")
    out = [f"{name} ({why})" for name, why in untried(answer)]
    if out:
        found.append(f"Not tried: {', '.join(out)}.")
    return found


def untried(answer):
    """(name, why) of all ladders and methods that were not tried."""
    left = [(f"{s.question.ladder.name} {name}", why) for s in answer.steps for name, why in s.question.left_out]
    return [*answer.untried, *left]


def report(answer):
    """The answer as plain values, for JSON; errors as METRICS have them, times as ratios."""
    steps = []
    for step in answer.steps:
        row = {"ladder": step.question.ladder.name, "question": step.question.ladder.question}
        row |= {"in use": step.chosen.name, "reference": step.question.methods[step.question.top].name}
        row |= {"methods": [m.name for m in step.question.methods]}
        if step.dropped:
            row |= {"noise": step.change, "before": step.before} if step.question.noise else {"error": step.change}
            row |= {} if step.question.noise else {"brighter": step.brighter}
            row |= {"saving": step.saving._asdict()} if step.saving else {}
        if step.rejected:
            name, error, confirmed = step.rejected
            row |= {"next cheaper": {"name": name, "error": plain(error), "confirmed": confirmed}}
        steps.append(row)
    return {
        "driver": answer.device,
        "metric": {"name": answer.metric, "title": METRICS[answer.metric].title},
        "tolerance": answer.tolerance,
        "error": plain(answer.error),
        "noise": answer.noise,
        "ratio": answer.ratio and answer.ratio._asdict(),
        "ladders": steps,
        "not tried": dict(untried(answer)),
        "combinations": {"all": answer.combinations, "roughly": answer.evaluated[0], "finely": answer.evaluated[1]},
    }


def plain(estimate):
    """An Estimate for JSON, which has no infinity."""
    return {name: value if np.isfinite(value) else None for name, value in estimate._asdict().items()}

"""The least sufficient model: the cheapest methods, jointly, whose sphere stays within a tolerance of the reference's.

Combinations of one method of each ladder are looked at in order of cost. Bounds of the error from a rough evaluation reject
most of them; a finer one has to confirm, its own uncertainty included, or the search goes on.

The metric "picture" is the RMSE over the disc, relative to the mean. Its square is a bias, which ladders of f have, and a
variance, which samplers and sample counts have. The bias is found in float64, by measure/bias.py. Variance and bias together
are found again in pictures by the shaders, twice with independent random numbers: each combination against the reference with
the same numbers. Where f is itself an estimate, by the combination or by the reference, pictures alone judge, and the answer
is for their size. Other metrics are of pictures; they see no ladder of noise, which then stays at its reference.

Work is done in generators that yield every few milliseconds, and whose result is what `return` gives.
"""

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import product
from math import inf

import numpy as np

from ..ladder import LADDERS, Ladder, Method
from ..model import Invalid
from . import cost
from .bias import NONE, Bias, Estimate, mean_of, relative, root, surrounded
from .error import METRICS, brightening

ROUGH = (256, 4)
"""Places on the disc, and directions from each of two samplers in an environment, of the evaluation that rejects."""
FINE = (2048, 8)
"""Those of the evaluation that confirms."""
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
        return self.chosen is not self.reference

    @property
    def reference(self):
        return self.question.methods[self.question.top]


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
    """The Questions of a state, those that change the model first, and (name, why) of the ladders that are not tried.

    Against an estimate little can be told in a short time, so a ladder up to one is tried only if the state does not hold its
    cheapest method.
    """
    untried = [(k.name, f"{k.methods[0].name} is in use") for k in ladders.values() if against_estimate(k, state)]
    ladders = {name: k for name, k in ladders.items() if name not in dict(untried)}
    lit, states = surrounded(state.light), models_within_reach(state, ladders)
    arising = {k.name: next((s for s in states if k.applies(s)), None) for k in ladders.values()}
    found = []
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
        left_out = [(m.name, "no state holds it" if m.changes is None else m.outside(where)) for m in ladder.methods]
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


def against_estimate(ladder, state):
    """Whether a state holds the cheapest method of a ladder whose reference's f is an estimate."""
    return ladder.applies(state) and ladder.current(state) is ladder.methods[0] and ladder.stochastic(state)


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
        """Bounds from few places in float64, and from pictures of the reference's f with the combination's noise and model."""
        found = Estimate(0.0, 0.0, inf)
        if self.split:
            state = self.only(combination, noise=False)
            if self.estimated(state):
                bias, *_ = yield from self.apart(state, self.reference, EARLY)
            else:
                bias, _ = yield from self.biases[0].of(state.model)
            found = root(bias)
            kept = (i if q.noise or q.remodels else q.top for q, i in zip(self.asked, combination, strict=True))
            alike = at(self.state, self.asked, tuple(kept))
            if noisy(alike) and found.low <= self.tolerance:
                noise = yield from self.variance(alike)
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

    def pictured(self, combination):
        """(bias squared, variance, both) of the combination's picture over the reference's mean's square, Estimates.

        The reference has the same samplers and numbers, so that their noise does not pass for bias.
        """
        state, reference = at(self.state, self.asked, combination), self.only(combination, noise=True)
        return (yield from self.apart(state, reference))

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
            f"no combination is surely within {tolerance:g}: the reference itself is known to {own.high:.2g} only; allow more"
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

"""The least sufficient model: the cheapest methods, jointly, whose sphere stays within a tolerance of the reference's.

Combinations of one method of each ladder are looked at in order of cost. Bounds of the error from a rough evaluation reject
most of them; a finer one has to confirm, its own uncertainty included, or the search goes on.

The metric "picture" is the RMSE over the disc, relative to the mean. Its square is a bias, which ladders of f have, and a
variance, which samplers and sample counts have. The bias is found in float64, by measure/bias.py. Variance and bias together
are found again in pictures by the shaders, twice with independent random numbers: each combination against the reference with
the same numbers. Where f is itself an estimate, by the combination or by the reference, and where the sphere is a ball with
light inside, pictures alone judge, and the answer is for their size. Other metrics are of pictures; they see no ladder of
noise, which then stays at its reference.

Work is done in generators that yield every few milliseconds, and whose result is what `return` gives.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from ..ladder import LADDERS, Method
from ..model import Invalid
from . import cost
from .bias import Estimate
from .judge import Judge
from .questions import Question, arising, at, moved, noisy, place, questions, settled

TIMED = (192, 192)
"""Pixels of the pictures that are timed."""


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
    own = yield from saying(judge.own(), lambda: f"how well the reference is known{judge.shots.doing}")
    if own.high > tolerance:
        raise Invalid(unanswerable(tolerance, own))
    if prices is None:
        prices, measured = yield from timed(judge.shots.gpu, state, asked)
    ordered = yield from saying(in_order(asked, prices, state), lambda: "combinations by cost")
    looking = search(ordered, judge.rough, judge.fine, tolerance)
    found = yield from saying(looking, lambda: f"{len(judge.seen)} of {len(ordered)} combinations{judge.shots.doing}")
    if found is None:
        raise Invalid(unanswerable(tolerance, judge.seen[judge.top]))
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


def unanswerable(tolerance, own):
    """Why there is no answer, and the smallest tolerance that has one, from the reference's own error, an Estimate."""
    digit = 10.0 ** (np.floor(np.log10(own.high)) - 1)
    least = np.ceil(own.high / digit) * digit
    known = f"the reference itself is known to {own.high:.2g} only"
    return f"no combination is surely within {tolerance:g}: {known}; allow {least:.2g}"


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

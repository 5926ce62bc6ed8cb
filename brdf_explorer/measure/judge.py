"""What is known of combinations of methods: bounds of the error of their spheres, rough ones first, then fine ones."""

import time
from concurrent.futures import ThreadPoolExecutor
from math import inf

import numpy as np

from ..model import Invalid
from .bias import NONE, Bias, Estimate, mean_of, relative, root, surrounded
from .error import METRICS, brightening
from .questions import at, by_pictures, moved, noisy, place, settled

ROUGH = (256, 4)
"""Places on the disc, and directions from each of two samplers in an environment, of the evaluation that rejects."""
FINE = (2048, 8)
"""Those of the evaluation that confirms."""
SIDE = 64
"""Pixels of a side of the pictures that confirm."""
SPARE = 0.7
"""What is surely noise of the reference's f counts by this share for a combination's whose own was not measured."""
EARLY = 64
"""Passes of pictures that reject where f is an estimate, and that a look at the reference's noise begins with."""
PASSES = 64
"""Passes of pictures that metrics other than "picture" compare."""
LONGEST = 65536
"""More passes than any picture has."""


class Shots:
    """Pictures of states after some passes, kept.

    Random numbers go by the pixel's place, so in a wider picture the same sphere has other ones: those of a `replica`.
    """

    def __init__(self, gpu, state):
        self.gpu = gpu.apart()
        next(state.views["sphere"].pictures(self.gpu, state, (8, 8)))  # all share its environment from here on
        self.runs, self.taken = {}, {}
        self.doing = ""  # which pass of how many, in words

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
                self.doing = f", pass {count} of {passes}"
                self.gpu.ctx.finish()  # else passes pile up, and reading them takes as long as all
                yield
            self.doing = ""
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
    if key not in gpu.evidence:
        gpu.evidence.clear()
        biases = [Bias(reference, size, seed) for seed, size in enumerate((ROUGH, FINE), 1)]
        gpu.evidence[key] = Shots(gpu, reference), biases, {}
    return gpu.evidence[key]


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
        if not self.split:
            return
        if by_pictures(self.reference):
            lit = (yield from self.shots.of(self.reference, SIDE, passes=EARLY))[..., :3].any()
        else:
            lit = (yield from self.biases[1].level()).value > 0
        if not lit:
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
        """Whether pictures alone can compare a state with the reference, whose noise may then be unlike."""
        return by_pictures(state) or by_pictures(self.reference)

    def variance(self, state, passes=None):
        """The variance of a state's picture over the mean's square, an Estimate: half the square of what two differ by."""
        first = yield from self.shots.of(state, SIDE, 0, passes)
        second = yield from self.shots.of(state, SIDE, 1, passes)
        return over_disc((first - second)[..., :3] ** 2 / 2, first)

    def own(self):
        """The error of the reference itself, which is its noise, an Estimate: what few passes let expect if that is within the
        tolerance, as more may take long and the search will tell, else from all passes."""
        if not (self.split and noisy(self.reference)):
            return NONE
        most = self.reference.views["sphere"].samples
        few = min(EARLY, most)
        early = yield from self.variance(self.reference, few)
        expected = root(Estimate(*(v * few / most for v in early)))
        return expected if expected.high <= self.tolerance else root((yield from self.variance(self.reference)))

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
        if self.split and (by_pictures(state) or by_pictures(reference)):
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

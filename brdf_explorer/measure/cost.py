"""What methods cost: seconds of one draw and finish, or of one call of numpy, taken in turns.

A draw's time holds the driver's own, so evaluations are timed as a picture of them less an empty one of the same format. All
of a question's methods are timed A B A B ..., with the empty picture among them, so that the machine's drift meets all alike.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..glsl import assemble, of_model

SIZE = (512, 512)
"""Pixels, and so evaluations, of a timed draw."""
LEAST, MOST = 15, 101
"""Repeats: no fewer and no more."""
STEADY = 0.02
"""Standard error of the median, over the median, at which repeating ends."""
PATIENCE = 4.0
"""Seconds after which it ends as well."""
FLOOR = 1e-11
"""Seconds that can still be told from none; noise may leave less, or less than nothing, when empty draws are subtracted."""
PAIRS = 2048
"""Evaluations of a timed call of numpy."""


@dataclass(frozen=True)
class Work:
    """Work to be timed.

    run     does it once, until it is finished
    count   what its seconds are divided by: evaluations, or 1
    bare    other Work whose seconds are subtracted, or None
    key     what it is, if it does not draw; a draw is known by its shaders' text, its size and format
    about   what else a draw is known by: a material whose parameters say how long its f takes
    """

    run: Callable
    count: float = 1.0
    bare: "Work | None" = None
    key: tuple = ()
    about: object = None


class Cost(NamedTuple):
    """Median and quartiles of samples, and how many there are."""

    median: float
    low: float
    high: float
    repeats: int


def rounds(runs):
    """Time named functions in turns, without end: yield {name: [seconds]} after each run, the same dictionary that grows."""
    times = {name: [] for name in runs}
    while True:
        for name, run in runs.items():
            start = time.perf_counter()
            run()
            times[name].append(time.perf_counter() - start)
            yield times


def interleaved(runs, repeats):
    """Seconds (repeats,) of each named function, warmed up and taken in turns."""
    for run in runs.values():
        run()
        run()
    times = next(t for t in rounds(runs) if min(map(len, t.values())) == repeats)
    return {name: np.array(t) for name, t in times.items()}


def costs(gpu, works, least=None, most=None):
    """Yield {name: seconds a unit (n,)} of named Works after each run, n repeats so far; {} until there is one of all.

    It ends when all medians are steady, after `most` repeats (MOST) or after PATIENCE, but not before `least` (LEAST). What was
    measured is kept with the Gpu, and given at once when the same works are asked for: methods are compared within one
    measurement, never across two.
    """
    least, most = least or LEAST, most or MOST
    keys = {}
    for name, work in works.items():
        keys[name] = work.key or (drawn_by(gpu, work.run), work.about)
        yield {}
    same = {key: works[name] for name, key in keys.items()}  # methods whose shaders are one are timed once
    group = frozenset(same)
    if group not in gpu.costs:
        bare = {id(work.bare): work.bare for work in same.values() if work.bare}
        runs = {key: work.run for key, work in (same | bare).items()}
        for run in runs.values():
            run()
            yield {}
        found, done, start = {}, 0, time.perf_counter()
        for times in rounds(runs):
            n = min(map(len, times.values()))
            if n > done:
                bared = {key: times[id(w.bare)][:n] if w.bare else 0.0 for key, w in same.items()}
                found = {key: np.array(times[key][:n]) - bared[key] for key in same}
                done = n
                late = time.perf_counter() - start > PATIENCE
                if n >= most or (n >= least and (late or all(map(steady, found.values())))):
                    break
            yield {name: found[key] / works[name].count for name, key in keys.items()} if found else {}
        gpu.costs[group] = found
    yield {name: gpu.costs[group][key] / works[name].count for name, key in keys.items()}


def drawn_by(gpu, run):
    """What a run draws: its programs, which the Gpu keeps by their text, with sizes and formats."""
    gpu.drawn.clear()
    run()
    return frozenset(gpu.drawn)


def steady(samples):
    """Whether the standard error of a median, of normal samples by their quartiles, is at most STEADY of it."""
    low, median, high = np.quantile(samples, [0.25, 0.5, 0.75])
    return bool(0.93 * (high - low) / np.sqrt(len(samples)) <= STEADY * median)


def summary(samples):
    """The Cost of samples."""
    low, median, high = np.quantile(samples, [0.25, 0.5, 0.75])
    return Cost(float(median), float(low), float(high), len(samples))


# --- kinds of work ---------------------------------------------------------------------------------------------------


def drawing(gpu, fragment, uniforms, size, dtype):
    """Draws a picture of a fragment shader, and waits for it."""

    def run():
        gpu.draw(gpu.program(fragment), gpu.target(f"cost {dtype}", size, 4, dtype), uniforms)
        gpu.ctx.finish()

    return run


def fill(gpu, size=SIZE, dtype="f4"):
    """The Work of an empty picture; given to several works of one measurement, it is timed once for all."""
    return Work(drawing(gpu, assemble("views/fill.frag"), None, size, dtype))


def evaluation(gpu, model, bare, size=SIZE, dtype="f4"):
    """The Work of one evaluation of f by the shader, less the `fill` of the same size and format."""
    uniforms = {"material": model, "size": tuple(map(float, size))}
    run = drawing(gpu, of_model("views/evaluate.frag", model), uniforms, size, dtype)
    return Work(run, size[0] * size[1], bare, about=model if model.stochastic else None)


def sample(gpu, model, bare, size=SIZE):
    """The Work of drawing one direction by the shader, with its weight, less the `fill` of the same size."""
    uniforms = {"material": model, "size": tuple(map(float, size))}
    run = drawing(gpu, of_model("views/sample.frag", model), uniforms, size, "f4")
    return Work(run, size[0] * size[1], bare, about=model if model.stochastic else None)


def one_pass(gpu, state, size):
    """The Work of the sphere's first pass in a picture of that size."""
    own = gpu.apart()

    def run():
        next(state.views["sphere"].pictures(own, state, size))
        gpu.ctx.finish()

    return Work(run, about=state.model if state.model.stochastic else None)


def in_numpy(model, pairs=PAIRS):
    """The Work of one evaluation of f in float64."""
    rng = np.random.default_rng(1)
    wo, wi = (w / np.linalg.norm(w, axis=-1, keepdims=True) for w in rng.random((2, pairs, 3)) + 0.01)
    return Work(lambda: model.f(wo, wi), pairs, key=("numpy", type(model), *model.choices().items()))

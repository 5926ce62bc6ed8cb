"""Where formulas fail: for each function of a material, the corners of its arguments in which float32 goes wrong.

A row is a function, a column a regime of arguments, a cell what became of float32 there: of our form and of the one that is
printed in the lecture and the papers (shaders/textbook), both against the float64 twin at the same float32 arguments. A cell is
searched, not only sampled: points around the worst are tried again, closer and closer.

Where the question itself is ill-conditioned no form can answer it in float32. So errors are told apart by the condition number
of the float64 function: the relative change of its value, over the relative change of its arguments, all components together.
An argument is known to half a unit in the last place, 2^-24, so it alone makes an error of condition x 2^-24.
"""

import time
from dataclasses import dataclass

import numpy as np

from ..lib.common import HORIZON, length
from ..model import Param, declared
from .albedo import quadrature
from .regimes import LIMIT, REGIMES, TINY, UNIT
from .subjects import all_subjects, rows_of, subjects

WELL = 1e-5
"""What the arguments' rounding alone may make of the value, condition x UNIT, where a function is called well conditioned: a
tenth of LIMIT, so that ours may round ten times as its arguments were."""
GAIN = 1e-3
"""What float32 may add to an albedo, relative, before it is called a gain of energy."""
NODES = 24
"""Rays, and directions a ray, of an albedo."""


# --- cells -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Point:
    """Arguments by name, the float32 and float64 values there, the relative error and the condition number."""

    arguments: dict
    value: tuple
    exact: tuple
    error: float
    condition: float


@dataclass(frozen=True)
class Cell:
    """What became of a form of a function in a regime.

    points, nan, infinite, negative   how many, of arguments tried, and of those with such a value
    error         largest relative error where the function is well conditioned, at `worst`
    choices       those that selected the function
    hard          the Point of the largest error where it is ill-conditioned, or None
    reciprocity   largest relative change when light and viewer are exchanged, where it is well conditioned
    gain          largest relative gain of an albedo of more than 1 over the float64 one
    over, under   shares of the float64 values outside of the format's range
    at            the Point that shows the verdict
    """

    row: str
    column: str
    form: str
    choices: dict
    points: int
    nan: int
    infinite: int
    negative: int
    error: float
    limit: float
    worst: Point
    hard: Point | None
    reciprocity: float
    gain: float
    over: float
    under: float
    at: Point

    @property
    def verdict(self):
        """The gravest of what is wrong: nan, infinite, negative, gain, exchange or error; else over, ill or fine."""
        if self.nan or self.infinite or self.negative:
            return "nan" if self.nan else "infinite" if self.infinite else "negative"
        if self.gain > GAIN:
            return "gain"
        if self.error > self.limit:
            return "error"
        if self.reciprocity > 2 * self.limit:
            return "exchange"
        if self.over:
            return "over"
        return "ill" if self.hard and self.hard.error > self.limit else "fine"

    @property
    def kept(self):
        """Whether the promise is kept: no NaN, infinity or negative value, no error where the function is well conditioned."""
        return self.verdict in ("over", "ill", "fine")


@dataclass(frozen=True)
class Batch:
    """Arguments tried, and what a form made of them. k is the number of values that are compared: components, or 1."""

    u: np.ndarray  # (n, arguments, 4), of the cube
    arguments: dict
    value: np.ndarray  # (n, components) float32
    exact: np.ndarray  # (n, components) float64
    error: np.ndarray  # (n, k) relative
    condition: np.ndarray  # (n, k), NaN where the error is too small to ask
    bad: np.ndarray  # (n, 3): NaN, infinite, negative


KNOWN = 1e-6
"""The relative error from which on the condition number is asked for."""


def evaluated(gpu, subject, regime, u, form, arguments):
    """The Batch of a form at arguments drawn at u."""
    value, sampled = subject.single(gpu, arguments, form)
    known, counts = dict(arguments), np.ones(len(value), dtype=bool)
    lost = np.zeros(len(value), dtype=bool)
    if sampled is not None:  # the weight is compared in the direction that was drawn
        lost = ~np.all(np.isfinite(sampled), axis=1)
        counts = ~lost & ((np.abs(sampled[:, 2]) if subject.model.transmits else sampled[:, 2]) > HORIZON)
        known.pop("u")
        known["wi"] = np.where(counts[:, None], sampled, np.float32([0, 0, 1])).astype(float)
    exact = subject.exact(known)
    exact = np.where(counts[:, None], exact, 0.0)
    with np.errstate(all="ignore"):
        value = value.astype(np.float16).astype(float) if regime.half else value.astype(float)
    value = np.where(counts[:, None] | ~np.isfinite(value), value, 0.0)
    within = np.abs(exact) < regime.largest * (1 - 1e-3)
    bad = np.stack(
        [
            np.any(np.isnan(value), axis=1) | lost,
            np.any(np.isinf(value) & within, axis=1),
            np.any(value < 0, axis=1) & (not subject.direction),
        ],
        axis=1,
    )
    floor = regime.tiny
    for name in ("wo", "wi", "w"):  # a factor leaves the range before its quotient by a cosine does
        if name in known and not regime.half:
            floor = floor / np.abs(known[name][:, 2])
    floor = np.reshape(floor, (-1, 1))
    with np.errstate(all="ignore"):
        off, size = np.abs(value - exact), np.abs(exact)
        if subject.direction:
            off, size = length(off)[:, None], length(size)[:, None]
        error = np.maximum(off - floor, 0) / np.maximum(size, floor)
        error = np.where(within | subject.direction, error, 0.0)
    condition = np.full(error.shape, np.nan)
    asked = np.any(error > KNOWN, axis=1)
    if np.any(asked):
        condition[asked] = subject.condition({name: v[asked] for name, v in known.items()})
    return Batch(u, arguments, value, exact, error, condition, bad)


def joined(batches):
    """The Batches of one form as one."""
    arguments = {name: np.concatenate([b.arguments[name] for b in batches]) for name in batches[0].arguments}
    names = ("value", "exact", "error", "condition", "bad")
    parts = {name: np.concatenate([getattr(b, name) for b in batches]) for name in names}
    return Batch(np.concatenate([b.u for b in batches]), arguments, **parts)


def closer(rng, batch, parents=12, children=24):
    """Points of the cube around those of the largest errors that the condition does not explain."""
    with np.errstate(all="ignore"):
        allowed = np.fmax(np.nan_to_num(batch.condition * UNIT, nan=0.0) / WELL, 1.0)
        score = np.max(np.where(np.isfinite(batch.error), batch.error, 0.0) / allowed, axis=1)
    best = batch.u[np.argsort(score)[-parents:]].repeat(children, axis=0)
    step = 10.0 ** rng.uniform(-5, -0.5, (len(best), 1, 1))
    moved = rng.random(best.shape) < 0.5
    return np.clip(best + moved * step * rng.normal(size=best.shape), 0.0, 1.0)


def examine(gpu, subject, regime, count=512, rounds=3, seed=1):
    """{form: Cell} of a function in a regime: `count` points, then `rounds` of points closer to the worst of each form."""
    (*_, found) = examination(gpu, subject, regime, count, rounds, seed)
    return found


def examination(gpu, subject, regime, count, rounds, seed=1):
    """Yield None after each short step, and at last what `examine` gives."""
    rng = np.random.default_rng([seed, *map(ord, subject.label + regime.name)])
    u = rng.random((count, len(subject.arguments), 4))
    batches = {form: [] for form in subject.forms}
    for step in range(rounds + 1):
        arguments = subject.draw(regime, u)
        for form in subject.forms:
            batches[form].append(evaluated(gpu, subject, regime, u, form, arguments))
            yield None
        if step < rounds:
            u = np.concatenate([closer(rng, joined(batches[form])) for form in subject.forms])
    found = {}
    for form in subject.forms:
        found[form] = cell(gpu, subject, regime, form, joined(batches[form]))
        yield None
    yield found


def cell(gpu, subject, regime, form, batch):
    """The Cell of a form's Batch."""

    def point(i):
        j = int(np.argmax(np.nan_to_num(batch.error[i], nan=-1.0)))
        condition = float(batch.condition[i, j])
        return Point(
            {name: v[i].tolist() for name, v in batch.arguments.items()},
            tuple(batch.value[i].tolist()),
            tuple(batch.exact[i].tolist()),
            float(batch.error[i, j]),
            condition,
        )

    error = np.where(np.isfinite(batch.error), batch.error, 0.0)
    well = ~(batch.condition * UNIT > WELL)
    easy, tough = np.max(np.where(well, error, 0.0), axis=1), np.max(np.where(well, 0.0, error), axis=1)
    nan, infinite, negative = (int(n) for n in batch.bad.sum(axis=0))
    worst, hard = int(np.argmax(easy)), int(np.argmax(tough))
    at = (
        int(np.argmax(batch.bad[:, np.argmax([nan, infinite, negative] if not nan else [1, 0, 0])]))
        if batch.bad.any()
        else worst
    )
    exchange, exchanged = reciprocity(gpu, subject, form, batch) if not regime.half else (0.0, worst)
    gain, gaining = energy(gpu, subject, form, batch) if not regime.half else (0.0, worst)
    if not batch.bad.any() and easy[worst] <= regime.limit:
        if gain > GAIN:
            at = gaining
        elif exchange > 2 * regime.limit:
            at = exchanged
        elif tough[hard] > regime.limit:
            at = hard
    size = np.abs(batch.exact)
    return Cell(
        subject.label,
        regime.name,
        form,
        subject.choices,
        len(batch.u),
        nan,
        infinite,
        negative,
        float(easy[worst]),
        regime.limit,
        point(worst),
        point(hard) if tough[hard] > 0 else None,
        exchange,
        gain,
        float(np.mean(np.any(size > regime.largest, axis=1))),
        float(np.mean(np.any((size > 0) & (size < regime.tiny), axis=1))),
        point(at),
    )


SWAPPED = {"wo": "wi", "wi": "wo", "Lambda_o": "Lambda_i", "Lambda_i": "Lambda_o"}


def reciprocity(gpu, subject, form, batch):
    """Largest relative change under an exchange of light and viewer, beyond that of the float64 value, where f or G2 is well
    conditioned, and at which point."""
    if subject.name not in ("f", "G2"):
        return 0.0, 0
    arguments = {name: batch.arguments[SWAPPED.get(name, name)] for name in batch.arguments}
    there = batch.value
    back = subject.single(gpu, arguments, form)[0].astype(float)
    if subject.name == "f" and subject.model.transmits:  # radiance dims by n^2 as it leaves a medium
        back = back * np.where(batch.arguments["wi"][:, 2] < 0, batch.arguments["eta"] ** -2.0, 1.0)[:, None]
    with np.errstate(all="ignore"):
        size = np.maximum(np.abs(there), np.abs(back))
        floor = TINY / np.abs(batch.arguments["wo"][:, 2] * batch.arguments["wi"][:, 2])[:, None]
        change = np.maximum(np.abs(there - back) - floor, 0) / np.maximum(size, floor)
        change = np.where(np.isfinite(change), change, 0.0)
    asked = np.flatnonzero(np.max(change, axis=1) > LIMIT)
    if len(asked):  # of these the condition may not be known yet
        condition = subject.condition({name: v[asked] for name, v in batch.arguments.items()})
        exact = subject.exact({name: v[asked] for name, v in arguments.items()})
        own = np.abs(batch.exact[asked] - exact) / np.maximum(size, floor)[asked]
        change[asked] = np.where(condition * UNIT > WELL, 0.0, np.maximum(change[asked] - own, 0.0))
    change = np.max(change, axis=1)
    k = int(np.argmax(change))
    return float(change[k]), k


def energy(gpu, subject, form, batch):
    """Largest relative gain of an albedo of more than 1 over the float64 one on the same grid, and at which point."""
    if subject.name != "f":
        return 0.0, 0
    error = np.max(np.where(np.isfinite(batch.error), batch.error, 0.0), axis=1)
    chosen = np.unique(np.concatenate([np.arange(3), np.argsort(error)[-3:]]))
    arguments, cosine, weight = [], [], []
    for i in chosen:
        one = {name: v[i] for name, v in batch.arguments.items()}
        alpha = rows_of(subject.model, {}, {**_defaults(subject.model), **one}).slopes()
        grid, solid = quadrature(one["wo"], tuple(alpha), NODES)
        wi = grid.wi.reshape(-1, 3).astype(np.float32).astype(float)
        wi[:, 2] = np.maximum(wi[:, 2], 1e-9)
        arguments.append(
            {name: wi if name == "wi" else np.broadcast_to(v, (len(wi), *np.shape(v))) for name, v in one.items()}
        )
        cosine.append(wi[:, 2])
        weight.append(solid.ravel())
    arguments = {name: np.concatenate([a[name] for a in arguments]) for name in batch.arguments}
    single = subject.single(gpu, arguments, form)[0].astype(float)
    exact = subject.exact(arguments)
    shape = (len(chosen), NODES * NODES, -1)
    with np.errstate(all="ignore"):
        share = (np.concatenate(cosine) * np.concatenate(weight)).reshape(shape)
        single, exact = (np.nansum(v.reshape(shape) * share, axis=1) for v in (single, exact))
        gain = np.max(np.where(single > 1, single / np.maximum(exact, 1.0) - 1, 0.0), axis=1)
    gain = np.nan_to_num(gain, nan=0.0, posinf=0.0)
    k = int(np.argmax(gain))
    return float(gain[k]), int(chosen[k])


def _defaults(cls):
    return {name: p.default for name, p in declared(cls, Param).items()}


# --- the map ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Map:
    """The cells so far: {(row, column, form): Cell}, for rows and columns in order; `progress` is in [0, 1]."""

    rows: tuple[str, ...]
    cells: dict
    progress: float

    @property
    def broken(self):
        """Our cells that break their promise."""
        return [c for c in self.cells.values() if c.form == "stable" and not c.kept]


EFFORTS = ((192, 0), (512, 3))
"""Points and rounds of search of each pass: coarse cells first."""
PAUSE = 0.2
"""Seconds between two Maps."""
_kept = {}


def stability(gpu, model, efforts=EFFORTS, everything=False):
    """Yield the Map of a material's functions as it grows, in passes of growing effort; of its choices, not its parameters.

    After each short step; the same Map again where there was no time for another one.

    everything: the functions of all options of its choices too, with the other choices as they are. Cells are kept by the text
    of their shaders.
    """
    rows = all_subjects(model) if everything else subjects(model)
    todo = [
        (subject, regime, *effort)
        for effort in efforts
        for subject in rows
        for regime in REGIMES.values()
        if regime.concerns(subject)
    ]
    labels, cells = tuple(s.label for s in rows), {}
    last, latest = time.perf_counter(), Map(labels, {}, 0.0)
    for n, (subject, regime, count, rounds) in enumerate(todo, 1):
        key = (gpu.device, subject.texts, subject.label, regime.name, count, rounds)
        if key not in _kept:
            for made in examination(gpu, subject, regime, count, rounds):
                if made:
                    _kept[key] = made
                yield latest
        for form, found in _kept[key].items():
            cells[subject.label, regime.name, form] = found
        if n == len(todo) or time.perf_counter() - last > PAUSE:
            latest = Map(labels, dict(cells), n / len(todo))
            yield latest
            last = time.perf_counter()

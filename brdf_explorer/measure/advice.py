"""The least sufficient model in words and numbers: its ladders as a table, the answer in sentences, and a tree for JSON."""

import numpy as np

from .error import METRICS

EXACT = 1e-9
"""Errors below it are of rounding in float64."""
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
    return f"{factor(found.median)} x ({factor(found.low)} to {factor(found.high)})"


def gain(saving):
    """What a change does to the time of a frame, in words."""
    return f"{times(saving)} {'cheaper' if saving.low > 1 else 'as fast'}"


def factor(value):
    """A number with three digits, or all those of a large one."""
    return f"{value:.0f}" if value >= 1000 else f"{value:.3g}"


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
        told = effect(step, answer.metric).removeprefix("error ") if step.dropped else ""
        saving = times(step.saving) if step.saving else ""
        names = step.question.ladder.name, step.chosen.name, step.reference.name
        found.append((*names, told, saving, refused(step, answer)))
    return found


def sentences(answer):
    """The answer in words, a list of sentences."""
    error = answer.error
    dropped = [s for s in answer.steps if s.dropped]
    if dropped:
        come = "comes down from its" if len(dropped) == 1 else "come down from their"
        found = [f"{len(dropped)} of {len(answer.steps)} ladders {come} reference."]
    else:
        found = ["Nothing can be dropped: no combination that is measurably cheaper stays within the tolerance."]
    tolerance = f"the tolerance is {amount(answer.tolerance, answer.metric)}"
    if error.high < EXACT:
        found.append(f"The picture is that of the reference; {tolerance}.")
    else:
        value, most = (amount(v, answer.metric) for v in (error.value, error.high))
        found.append(f"{capital(of_what(answer))}: {value}, surely below {most}; {tolerance}.")
    for step in dropped:
        cheaper = f", {gain(step.saving)}" if step.saving else ""
        found.append(f"{step.chosen.name} instead of {step.reference.name}: {effect(step, answer.metric)}{cheaper}.")
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


def of_what(answer):
    """What the answer's error is, in words: noise alone where nothing was dropped."""
    return METRICS[answer.metric].title if any(s.dropped for s in answer.steps) else "noise of the reference itself"


def capital(words):
    return f"{words[0].upper()}{words[1:]}"


def untried(answer):
    """(name, why) of all ladders and methods that were not tried."""
    left = [(f"{s.question.ladder.name} {name}", why) for s in answer.steps for name, why in s.question.left_out]
    return [*answer.untried, *left]


def report(answer):
    """The answer as plain values, for JSON; errors as METRICS have them, times as ratios."""
    steps = []
    for step in answer.steps:
        row = {"ladder": step.question.ladder.name, "question": step.question.ladder.question}
        row |= {"in use": step.chosen.name, "reference": step.reference.name}
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

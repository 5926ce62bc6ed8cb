"""The questions that a state raises: which ladders arise, with which methods, and the states of their combinations."""

from dataclasses import dataclass

from ..ladder import LADDERS, Ladder, Method
from .bias import surrounded
from .error import METRICS


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
    return surrounded(state.light) or by_pictures(state)


def by_pictures(state):
    """Whether pictures alone tell what its sphere shows: f is an estimate, or the sphere a ball with light inside."""
    return state.model.stochastic or state.model.index() is not None


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

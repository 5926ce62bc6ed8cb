"""Pictures drawn in steps: they are in the end what they are in one go, and what takes long is seen small at first."""

from collections import deque
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from brdf_explorer.state import load
from brdf_explorer.views import VIEWS
from brdf_explorer.views.pace import MOST, Pace, chords, in_turn

SIZE = (96, 64)
SHORT = 1e-7  # seconds, less than any drawing takes: strips are single rows


def states():
    """Of a mirror, a ball of glass and walks, in the studio."""
    for name in ("gold", "frosted_glass", "sandblasted_copper"):
        state = load(name, load("studio")).with_view("sphere", samples=3, background="plain")
        yield name, state.with_view("hemisphere", quantity="f")


@pytest.mark.parametrize("name, state", list(states()))
def test_a_sphere_in_strips_is_the_sphere(gpu, name, state):
    whole = gpu.pixels(deque(state.views["sphere"].pictures(gpu.apart(), state, SIZE), 1)[0].target)
    pictures = list(state.views["sphere"].pictures(gpu.apart().paced(SHORT), state, SIZE))
    assert len(pictures) > 3 * 50
    assert pictures[0].note == f"1 sample in {MOST} x {MOST} pixels" and pictures[-1].note == "3 samples a pixel"
    assert np.array_equal(gpu.pixels(pictures[-1].target), whole)


@pytest.mark.parametrize("name, state", list(states()))
def test_a_preview_shows_the_sphere_as_large(gpu, name, state):
    """Its coverage is that of the sphere to the pixel, and its brightness near to it."""
    whole = gpu.pixels(deque(state.views["sphere"].pictures(gpu.apart(), state, SIZE), 1)[0].target)
    small = gpu.pixels(next(state.views["sphere"].pictures(gpu.apart().paced(SHORT), state, SIZE)).target)
    np.testing.assert_allclose(small[..., 3], whole[..., 3], atol=1e-6)
    covered = whole[..., 3] == 1
    assert 0.4 < covered.mean() < 0.7
    assert 1 / 3 < small[covered][:, :3].mean() / whole[covered][:, :3].mean() < 3


@pytest.mark.parametrize("view", VIEWS)
def test_the_last_picture_is_the_one_without_steps(gpu, view):
    """What is random draws the same numbers; what is measured, times and their like, is left out."""
    state = load("gold").with_view("sampling", show="error", samples=64)
    if view in ("chart", "least", "stability"):
        pytest.skip("shows costs, or takes long")
    state = replace(state, materials=(*state.materials, *load("copper").materials))
    (*_, whole) = state.views[view].pictures(gpu.apart(), state, (480, 360))
    (*_, last) = state.views[view].pictures(gpu.apart().paced(1e-3), state, (480, 360))
    assert last.done and last.note == whole.note and last.labels == whole.labels
    assert np.array_equal(gpu.pixels(last.target), gpu.pixels(whole.target))


def test_strips_cover_every_row_once(gpu):
    for rows in (1, 7, 64):
        boxes = []
        pace = Pace(gpu.paced(SHORT), "a program", chords(rows, rows / 2))
        gpu.speeds["a program"] = 1.0
        lasts = list(pace.strips(boxes.append, 10))
        del gpu.speeds["a program"]
        assert [box[1] for box in boxes] == [0, *[box[3] for box in boxes[:-1]]] and boxes[-1][3] == rows
        assert lasts == [False] * (len(boxes) - 1) + [True]


def test_turns_pass_from_one_to_the_next(gpu):
    runs = {"a": iter(range(3)), "b": iter("x")}
    found = list(in_turn(gpu, runs))
    assert found[0] == ({"a": 0, "b": "x"}, False) and found[-1] == ({"a": 2, "b": "x"}, True)
    assert not list(islice(runs["a"], 1))

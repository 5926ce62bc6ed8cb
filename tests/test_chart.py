"""The chart of speed against accuracy: what it measures, what it draws, and what the command prints."""

import json
from collections import deque
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from brdf_explorer.cli import main
from brdf_explorer.environment import environment, turn
from brdf_explorer.export import embedded, font
from brdf_explorer.ladder import ESTIMATORS, LADDERS, Ladder, Method
from brdf_explorer.lib.common import normalize, quotient, split
from brdf_explorer.lib.environment import environment_lookup, sample_environment
from brdf_explorer.lib.random import STREAM_BSDF, STREAM_LIGHT, random2
from brdf_explorer.measure import tradeoff
from brdf_explorer.measure.cost import Cost
from brdf_explorer.measure.error import METRICS, Measured, picture_rmse
from brdf_explorer.measure.grid import direction
from brdf_explorer.measure.laws import viewers
from brdf_explorer.measure.tradeoff import Point, Tradeoff, kept_errors, tradeoffs
from brdf_explorer.model import Declared
from brdf_explorer.models import MODELS
from brdf_explorer.state import Light, Look, State, dumps, load
from brdf_explorer.views import chart
from brdf_explorer.views.chart import Chart
from brdf_explorer.views.picture import R2
from brdf_explorer.views.sphere import SMOOTH, toward

MICROFACET, DIFFUSE = MODELS["microfacet"], MODELS["diffuse"]
MATERIALS = [
    MICROFACET(alpha=(0.3, 0.6), spectrum="gold"),
    MICROFACET(alpha=0.6, ndf="beckmann"),
    MICROFACET(alpha=0.2, eta=1.5, k=0.0, fresnel="dielectric"),
    DIFFUSE(diffuse="eon"),
]
STATES = [State(light=Light(environment="studio")).with_model(m) for m in MATERIALS]
GOLD = STATES[0]


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Few repeats and passes of small draws."""
    monkeypatch.setattr(tradeoff.cost, "SIZE", (32, 32))
    monkeypatch.setattr(tradeoff.cost, "LEAST", 3)
    monkeypatch.setattr(tradeoff.cost, "MOST", 3)
    monkeypatch.setattr(tradeoff, "SAMPLED", (32, 32))
    monkeypatch.setattr(chart, "SIZE", (32, 32))
    monkeypatch.setattr(tradeoff, "SIDE", 32)


def last(steps):
    return deque(steps, maxlen=1)[0]


def cases():
    """Questions with the states in which they arise: of the one of thousands of samples, one."""
    states = {name: [s for s in STATES if ladder.applies(s)] for name, ladder in LADDERS.items()}
    return [(name, s) for name, found in states.items() for s in found[: 1 if name == "environment" else None]]


@pytest.mark.parametrize("name, state", cases())
def test_the_reference_is_the_most_accurate(gpu, name, state):
    found = last(tradeoffs(gpu, LADDERS[name], state))
    reference = next(p for p in found.points if p.name == found.reference)
    assert all(p.known for p in found.points) and not found.doing
    slack = reference.error.error
    assert all(p.error.value >= reference.error.value - slack for p in found.points if not p.outside)
    if METRICS[found.metric].compares != "samples":
        assert reference.exact and any(p.error.value > 10 * p.error.error for p in found.points)


@pytest.mark.parametrize("sampling", ["uniform", "cosine", "ndf", "visible", "caps", "bounded"])
def test_spread_of_samples_is_that_of_drawn_weights(gpu, sampling):
    errors = last(kept_errors(gpu, LADDERS["sampling"], GOLD, "spread"))
    model = replace(GOLD.model, sampling=sampling)
    rng = np.random.default_rng(5)
    n, squares, sigmas = 40_000, [], []
    for wo in viewers():
        weight = model.sample_f(wo, rng.random((n, 2)))[1]
        square = (weight**2).sum(axis=-1)
        whole = np.sum(weight.mean(axis=0) ** 2)
        squares.append(square.mean() / whole - 1)
        sigmas.append(square.std() / whole / np.sqrt(n))
    # the mean of the weights errs as well, and as much
    expected, sigma = np.mean(squares), 2 * np.hypot.reduce(sigmas) / len(sigmas)
    assert errors[sampling].value ** 2 == pytest.approx(expected, abs=5 * sigma)


def pixels_of_sphere(state, n, jitter=0.0):
    """Coverage (pixels, 1) of a sphere in a picture of n x n pixels, where there is some; wo and the frame there, as shaded."""
    radius = state.views["sphere"].radius((n, n))
    y, x = np.mgrid[:n, :n] + 0.5 - n / 2
    coverage = np.clip(radius + 0.5 - np.hypot(x, y), 0, 1)
    edge, seen = 1 - 0.5 / radius, coverage > 0
    p = np.stack([x[seen], y[seen]], axis=-1)
    p = (p + jitter) / radius
    p = p * np.minimum(edge / np.maximum(np.hypot(*split(p)), edge), 1.0)[:, None]
    normal = np.concatenate([p, np.sqrt(1 - (p**2).sum(-1, keepdims=True))], axis=-1)
    tangent = normalize(np.stack([normal[:, 2], 0 * normal[:, 0], -normal[:, 0]], axis=-1))
    frame = np.stack([tangent, np.cross(normal, tangent), normal], axis=-2)
    return coverage[seen][:, None], frame @ [0.0, 0.0, 1.0], frame


def test_errors_of_pictures_are_those_of_f_under_one_light(gpu):
    """The sphere of 32 pixels shaded by float64 f, pass by pass at the places where the shader's rays go."""
    state = State(light=Light(theta=60.0, phi=20.0)).with_model(MICROFACET(alpha=0.5))
    errors = last(kept_errors(gpu, LADDERS["shadowing"], state, "picture"))

    def shaded(method):
        model, color = LADDERS["shadowing"].at(state, method).model, 0.0
        for i in range(SMOOTH):
            coverage, wo, frame = pixels_of_sphere(state, 32, (R2 * i + 0.5) % 1.0 - 0.5)
            wi = frame @ toward(state.light)
            color += model.f(wo, wi) * np.maximum(wi[:, 2:], 0)
        return np.concatenate([coverage * color, coverage], axis=-1)[None]

    reference = shaded(LADDERS["shadowing"].reference(state))
    for method in LADDERS["shadowing"].methods:
        expected = picture_rmse(shaded(method), reference)
        assert errors[method.name].value == pytest.approx(expected, rel=1e-3, abs=1e-7)


@np.errstate(under="ignore")
def estimates(state, estimator, wo, frame, of_bsdf, of_light):
    """Radiance (places, n, 3) by one pass each, in float64, from random numbers (places, n, 2)."""
    found, rotation = environment(state.light.environment), np.reshape(turn(state.light), (3, 3))
    wo = np.broadcast_to(wo[:, None], (*of_bsdf.shape[:2], 3))
    total = 0.0
    if estimator != "light":
        wi, weight = state.model.sample_f(wo, of_bsdf)
        seen = environment_lookup(found.map, np.einsum("pni,pic->pnc", wi, frame) @ rotation)
        own = state.model.pdf(wo, wi)
        share = quotient(own, own + seen[..., 3]) if estimator == "mis" else np.ones_like(own)
        total = total + weight * seen[..., :3] * np.where(wi[..., 2] > 0, share, 0.0)[..., None]
    if estimator != "bsdf":
        world, density = sample_environment(found.map, found.cdf, of_light)
        wi = np.einsum("pnc,pic->pni", world @ rotation.T, frame)
        density = density + (state.model.pdf(wo, wi) if estimator == "mis" else 0.0)
        light = environment_lookup(found.map, world)[..., :3]
        total = total + state.model.f(wo, wi) * light * (np.maximum(wi[..., 2], 0.0) / density)[..., None]
    return total


def test_errors_of_estimators_are_those_in_float64(gpu):
    """With the shaders' numbers of other pixels, against many passes with numpy's own numbers."""
    errors = last(kept_errors(gpu, LADDERS["environment"], GOLD, "picture"))
    coverage, wo, frame = pixels_of_sphere(GOLD, 32)
    n = len(wo)
    many = np.random.default_rng(7).integers(0, 2**24, (2, n, 512, 2)) / 2**24
    true = estimates(GOLD, "mis", wo, frame, *many).mean(axis=1) * coverage
    wi = frame @ toward(GOLD.light)
    direct = GOLD.model.f(wo, wi) * np.maximum(wi[:, 2:], 0) * GOLD.light.irradiance * coverage
    level = (true + direct).mean()
    for passes in (1, 16):
        pixel = np.stack([np.arange(n) + 9000, np.full(n, 77)], axis=-1)[:, None].repeat(passes, axis=1)
        few = [random2(pixel, np.arange(passes), stream) for stream in (STREAM_BSDF, STREAM_LIGHT)]
        for estimator in ESTIMATORS:
            own = estimates(GOLD, estimator, wo, frame, *few).mean(axis=1) * coverage
            squares = np.mean((own - true) ** 2, axis=-1) / level**2
            sigma = np.sqrt(2 / n) * squares.std()  # the picture errs as much
            assert errors[f"{ESTIMATORS[estimator]} {passes}"].value ** 2 == pytest.approx(
                squares.mean(), abs=5 * sigma
            )
    for name in ESTIMATORS.values():  # without bias it falls at least as of random numbers
        assert errors[f"{name} 256"].value < errors[f"{name} 16"].value / 4
    own = errors["MIS 4096"]
    assert own.value == pytest.approx(0, abs=1e-12) and own.error < errors["MIS 256"].value / 3


def test_errors_of_half_floats_are_those_of_rounding(gpu):
    """A number whose logarithm is anywhere, rounded to 11 bits, is off by 2^-10 / sqrt(12) times the mean of 1 / m^2's root."""
    errors = last(kept_errors(gpu, LADDERS["precision"], GOLD, "rmse"))
    mean = (1 - 1 / 4) / (2 * np.log(2))  # of 1 / m^2, m between 1 and 2
    assert errors["half output"].value == pytest.approx(2.0**-10 * np.sqrt(mean / 12), rel=0.1)


def test_errors_of_float32_are_those_of_random_directions(gpu):
    errors = last(kept_errors(gpu, LADDERS["precision"], GOLD, "rmse"))
    rng, n, squares, sigmas = np.random.default_rng(3), 50_000, [], []
    wi = direction(np.arccos(rng.random(n)), rng.uniform(0, 2 * np.pi, n))
    for wo in viewers():
        a, b = (f.f(GOLD.model, wo, wi) if f is gpu else f.f(wo, wi) for f in (gpu, GOLD.model))
        square, whole = (((v * wi[:, 2:]) ** 2).sum(axis=-1) for v in (a - b, b))
        squares.append(square.mean() / whole.mean())
        sigmas.append((square - squares[-1] * whole).std() / whole.mean() / np.sqrt(n))
    sigma = np.hypot.reduce(sigmas) / len(sigmas)
    assert errors["float32"].value ** 2 == pytest.approx(np.mean(squares), abs=5 * sigma)


def test_what_half_floats_cannot_hold_is_told():
    ladder = LADDERS["precision"]
    for alpha, words in ((0.3, ""), (1e-4, "beyond 65504")):
        assert words in ladder.methods[0].outside(GOLD.with_model(replace(GOLD.model, alpha=alpha)))


def test_metrics_that_make_no_sense_are_told(gpu):
    for name, state, metric in (
        ("sampling", GOLD, "rmse"),
        ("shadowing", GOLD, "spread"),
        ("smith", GOLD, "rmse"),
        ("precision", GOLD, "picture"),
        ("diffuse", GOLD, "own"),
    ):
        found = last(tradeoffs(gpu, LADDERS[name], state, metric))
        assert found.reason.endswith(".") and not found.points
        view = GOLD.with_view("chart", ladder=name, error=metric)
        words = " ".join(label.text for label in last(view.views["chart"].pictures(gpu, view, (800, 500))).labels)
        assert found.reason in words


# --- front and choice ------------------------------------------------------------------------------------------------


def made(costs, errors, outside=None, kind="evaluation"):
    """A Tradeoff of given costs and errors."""
    outside = [""] * len(costs) if outside is None else outside
    points = tuple(
        Point(Method(str(i), {}), o, Cost(c, c, c, 9), Measured(e, 1e-6))
        for i, (c, e, o) in enumerate(zip(costs, errors, outside, strict=True))
    )
    ladder = Ladder("made", "Which?", "material", "f", tuple(p.method for p in points), bool)
    return Tradeoff(ladder, "rmse", kind, (8, 8), points)


def test_front_is_what_no_other_point_beats():
    rng = np.random.default_rng(1)
    for _ in range(200):
        n = rng.integers(1, 9)
        found = made(rng.integers(1, 6, n) * 1e-9, rng.choice([0, 1e-7, 0.1, 0.2, 0.3], n), rng.choice(["", "far"], n))
        inside = [p for p in found.points if not p.outside]

        def key(p):
            return p.cost.median, 0.0 if p.error.value <= 1e-6 else p.error.value

        beaten = {
            a.name
            for a in inside
            for b in inside
            if key(b) != key(a) and all(x <= y for x, y in zip(key(b), key(a), strict=True))
        }
        assert {key(p) for p in found.front()} == {key(p) for p in inside if p.name not in beaten}
        for tolerance in (1e-3, 0.15, 1.0):
            good = [p.cost.median for p in inside if p.exact or p.error.value + 1e-6 <= tolerance]
            best = found.best(tolerance)
            assert (best.cost.median if best else None) == min(good, default=None)


def test_of_samplers_the_best_is_the_fastest_to_an_error():
    assert made([1.0, 2.0, 5.0], [4.0, 2.0, 1.0], kind="sample").best(1e-9).name == "2"
    assert made([1.0, 2.0, 9.0], [4.0, 2.0, 1.0], kind="sample").best(1e-9).name == "1"


def test_costs_that_noise_makes_negative_win_nothing():
    assert [p.name for p in made([-3e-9, -1e-9, 1e-9], [0.3, 0.2, 0.1]).front()] == ["1", "2"]
    found = made([-3e-9, -1e-9, 1e-9], [4.0, 2.0, 1.0], kind="sample")
    assert found.best(1e-9).name == "1" and "lost in noise" in GOLD.views["chart"].tip(found, found.points[0])


# --- cache and steps -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("options", [{}, {"error": "picture"}, {"cost": "frame"}, {"ladder": "sampling"}])
def test_loading_a_method_measures_nothing_anew(gpu, options):
    state = GOLD.with_view("chart", **options)
    found = last(state.views["chart"].measured(gpu, state))[0][0]
    kept = dict(gpu.costs), dict(gpu.errors)
    for point in found.points:
        other = found.ladder.at(state, point.method)
        again = last(other.views["chart"].measured(gpu, other))[0][0]
        assert [(p.cost, p.error) for p in again.points] == [(p.cost, p.error) for p in found.points]
    assert (gpu.costs.keys(), gpu.errors.keys()) == (kept[0].keys(), kept[1].keys())


def test_first_points_come_before_the_last(gpu):
    gpu.costs.clear()
    gpu.errors.clear()
    steps = [found for (found,), _ in GOLD.views["chart"].measured(gpu, GOLD)]
    known = [sum(p.known for p in found.points) for found in steps]
    assert known[0] == 0 and known[-1] == 5 and known.count(5) > 3
    assert all(found.doing for found in steps[:-2])


# --- drawing ---------------------------------------------------------------------------------------------------------


def boxes_of(picture, scale):
    for label in picture.labels:
        left, top, right, bottom = font(label.size * scale).getbbox(label.text)
        x, y = label.x - label.anchor[0] * (right - left), label.y - label.anchor[1] * (bottom - top)
        yield x, y, x + right - left, y + bottom - top, label.text


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("size, scale", [((1200, 900), 1.0), ((560, 440), 1.0), ((676, 210), 1.0), ((1000, 900), 2.0)])
@pytest.mark.parametrize("options", [{}, {"error": "reciprocity"}, {"ladder": "sampling"}, {"ladder": "all"}])
def test_labels_are_inside_and_apart(gpu, options, size, scale, theme):
    state = replace(GOLD.with_view("chart", **options), look=Look(theme=theme))
    picture = last(state.views["chart"].pictures(gpu, state, size, scale))
    boxes = list(boxes_of(picture, scale))
    asked = " ".join(words for *_, words in boxes)
    if size == (1200, 900):
        assert all(k.question in asked for k in state.views["chart"].ladders(state))
    for box in boxes:
        assert box[0] >= 0 and box[1] >= 0 and box[2] <= size[0] and box[3] <= size[1], box
    for a, b in combinations(boxes, 2):
        assert a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1], (a, b)
    if size == (1200, 900):
        words = {label.text for label in picture.labels}
        for ladder in state.views["chart"].ladders(state):
            assert {m.name for m in ladder.methods} <= words


@pytest.mark.parametrize("name", ["fresnel", "sampling", "environment", "precision"])
def test_names_of_equal_methods_find_room(gpu, name):
    """With marks in one place, or in rows, and with quartiles across the whole chart."""
    state = GOLD.with_view("chart", ladder="all")
    rng = np.random.default_rng(3)
    for costs, errors in ((0.0, 0.0), (0.0, 2.0), (0.1, 0.1), (0.5, 1.0)):
        ladder = LADDERS[name]
        kind = {"samples": "sample", "picture": "frame"}.get(ladder.measures, "evaluation")
        points = []
        for method in ladder.methods:
            cost, error = 1e-8 * 10 ** rng.uniform(0, costs), 1e-2 * 10 ** rng.uniform(0, errors)
            cost, error = Cost(cost, cost / 9, cost * 9, 15), Measured(error, error / 9)
            points.append(Point(method, method.outside(state), cost, error))
        metric = tradeoff.NATURAL[ladder.measures]
        found = Tradeoff(ladder, metric, kind, (8, 8), tuple(points), ladder.reference(state).name, points[-1].error)
        draw = state.views["chart"].drawing(gpu, state, [found], (1200, 900), 1.0)
        boxes = list(boxes_of(draw, 1.0))
        assert {m.name for m in ladder.methods} <= {words for *_, words in boxes}
        for a, b in combinations(boxes, 2):
            assert a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1], (a, b)


def test_every_mark_is_a_link_to_its_method(gpu):
    state = GOLD.with_view("chart", ladder="fresnel")
    links = last(state.views["chart"].pictures(gpu, state, (800, 600))).links
    later, elsewhere = state.with_view("lobe", radius="log"), state.with_model(DIFFUSE())
    for method in LADDERS["fresnel"].methods:
        mine = [k for k in links if k.tip.startswith(method.name)]
        assert mine and all(k.change(later) == LADDERS["fresnel"].at(later, method) for k in mine)
        assert all(k.change(elsewhere) == elsewhere for k in mine)
        assert all(("outside its domain: k is not 0" in k.tip) == (method.name == "dielectric") for k in mine)
        assert all("ns an evaluation, " in k.tip and "quartiles" in k.tip and "±" in k.tip for k in mine)


def test_marks_that_no_state_holds_say_so(gpu):
    state = GOLD.with_view("chart", ladder="precision")
    links = last(state.views["chart"].pictures(gpu, state, (800, 600))).links
    for method in LADDERS["precision"].methods:
        for k in (k for k in links if k.tip.startswith(method.name)):
            assert (k.change is None) == (method.name != "float32") == ("only measured" in k.tip)


def test_marks_outside_their_domain_are_hollow(gpu):
    state = GOLD.with_view("chart", ladder="fresnel")
    picture = last(state.views["chart"].pictures(gpu, state, (800, 600)))
    pixels = gpu.pixels(picture.target)[..., :3]
    for k in picture.links:
        left, top, right, bottom = k.box
        if right - left == bottom - top:  # a mark, not a name
            middle = pixels[round((top + bottom) / 2), round((left + right) / 2)]
            assert (middle.min() > 240) == k.tip.startswith("dielectric")


@pytest.mark.parametrize("size", [(8, 8), (40, 30), (100, 60), (200, 150)])
def test_a_tiny_chart_is_drawn(gpu, size):
    assert last(GOLD.views["chart"].pictures(gpu, GOLD, size)).done


def test_the_chart_is_an_instrument():
    assert issubclass(Chart, Declared) and Chart.instrument
    assert set(Chart.__dataclass_fields__["ladder"].metadata["declared"].options) == {*LADDERS, "all"}


# --- the command -----------------------------------------------------------------------------------------------------


@pytest.fixture
def run(gpu, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return lambda *args: CliRunner().invoke(main, ["chart", *map(str, args)])


def test_the_command_prints_and_writes_what_was_measured(run):
    done = run("shadowing", "--tolerance", 0.05, "--size", "400x300", "-o", "x.svg")
    assert done.exit_code == 0, done.output
    rows = {line.split()[0]: line for line in done.stdout.splitlines() if line.split()}
    assert all(m.name in rows for m in LADDERS["shadowing"].methods)
    assert "exact" in rows["correlated"] and "cheapest" in done.stdout and "llvmpipe" in done.stdout
    assert Path("x.svg").read_text(encoding="utf-8").startswith("<?xml")
    assert embedded(Path("x.svg")) == dumps(load("gold", load("studio")).with_view("chart", tolerance=0.05))


def test_the_json_holds_all_numbers(run):
    done = run("--preset", "ceramic", "--json", "-o", "x.json")
    assert done.exit_code == 0, done.output
    tree = json.loads(done.stdout)
    assert tree == json.loads(Path("x.json").read_text(encoding="utf-8"))
    assert {"machine", "driver", "tolerance", "ladders", "preset"} == set(tree)
    state = load("ceramic", load("studio"))
    assert [one["ladder"] for one in tree["ladders"]] == [n for n, k in LADDERS.items() if k.applies(state)]
    for one in tree["ladders"]:
        ladder = LADDERS[one["ladder"]]
        assert set(one) == {"ladder", "question", "metric", "cost", "reference", "best", "methods"}
        assert one["reference"]["name"] == ladder.reference(state).name and one["cost"]["size"] == [32, 32]
        for row, method in zip(one["methods"], ladder.methods, strict=True):
            assert row["name"] == method.name and row["changes"] == method.changes
            assert row["outside"] == method.outside(state)
            assert row["cost"]["low"] <= row["cost"]["median"] <= row["cost"]["high"] and row["cost"]["repeats"] == 3
            assert row["error"]["value"] >= 0 and row["error"]["error"] > 0


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["shadow"], "did you mean shadowing?"),
        (["--error", "rms"], "did you mean rmse?"),
        (["--cost", "nothing"], "evaluation, frame"),
        (["--tolerance", "0"], "not a number from 1e-09 to 10"),
        (["--preset", "goldd"], "did you mean gold?"),
        (["shadowing", "-o", "x.exr"], "no format for a chart"),
        (["shadowing", "-o", "nowhere/x.svg"], "no folder nowhere"),
        (["shadowing", "-o", "x.svg", "--size", "0x9"], "size = 0x9 cannot be drawn"),
    ],
)
def test_bad_input_is_one_line(run, arguments, words):
    done = run(*arguments)
    assert done.exit_code != 0 and words in done.stderr + str(done.exception)

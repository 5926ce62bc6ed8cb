"""The stability map: ours keeps its promise, printed forms fail where they are known to, planted faults are found.

And a cell leads to its worst point.
"""

import json
import os
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st
from oracles.cases import CASES, case_label
from test_oracles import Textbook
from test_views import check_links

from brdf_explorer.cli import main
from brdf_explorer.export import font, labelled, render
from brdf_explorer.glsl import assemble
from brdf_explorer.measure import regimes
from brdf_explorer.measure import stability as measured
from brdf_explorer.measure.regimes import LIMIT, REGIMES, UNIT
from brdf_explorer.measure.stability import WELL, evaluated, examine, stability
from brdf_explorer.measure.subjects import FORMS, all_subjects, subjects
from brdf_explorer.model import Param, declared
from brdf_explorer.models import MODELS
from brdf_explorer.state import Material, State, dumps, load, loads
from brdf_explorer.views.drawing import Drawing
from brdf_explorer.views.stability import Stability, directions_of, shown_at, tip

QUICK = (192, 1)
"""Points and rounds of search of a cell, in the tests over all cells."""
MICROFACET = MODELS["microfacet"]
KEPT = Path(__file__).parent / "worst_points.json"


def chunks():
    """Every function of a chunk that some material uses, once."""
    found = {}
    for cls in MODELS.values():
        first = cls()
        found |= {s.label: s for s in all_subjects(first) if not s.is_model}
        if "ndf" in first.choices():
            found |= {s.label: s for s in all_subjects(replace(first, ndf="beckmann")) if not s.is_model}
    once = {}
    for label, subject in found.items():  # a file may stand for another
        once.setdefault((code(subject.texts[0]), subject.arguments), label)
    return {label: found[label] for label in once.values()}


def code(text):
    return "\n".join(line for line in text.splitlines() if line and not line.startswith("//"))


CHUNKS = chunks()


def worst(gpu, row, column, form, effort=(512, 2), model=None):
    subject = CHUNKS.get(row) or next(s for s in subjects(model or MICROFACET()) if s.label == row)
    return examine(gpu, subject, REGIMES[column], *effort)[form]


@pytest.mark.parametrize("row", CHUNKS)
def test_ours_keeps_its_promise(gpu, row):
    for regime in REGIMES.values():
        if regime.concerns(CHUNKS[row]):
            cell = examine(gpu, CHUNKS[row], regime, *QUICK)["stable"]
            assert cell.kept and cell.error <= cell.limit, cell


@pytest.mark.parametrize(("cls", "choices"), CASES, ids=case_label)
def test_models_keep_their_promise(gpu, cls, choices):
    """f, pdf and sample_f of every pair of choices, in a few regimes each that differ from case to case."""
    own = [s for s in subjects(cls(**choices)) if s.is_model]
    order = np.random.default_rng(sum(map(ord, case_label(choices)))).permutation(list(REGIMES))
    for subject in own:
        for regime in [REGIMES[name] for name in order if REGIMES[name].concerns(subject)][:2]:
            cell = examine(gpu, subject, regime, 96, 1)["stable"]
            assert cell.kept, cell


# MODELS.md, section 1 and its table: what each printed form does at least, on any driver
FAILURES = {
    "D of GGX at small alpha": ("D ggx", "alpha_0", lambda c: c.error > 0.1),
    "D of Beckmann at small alpha": ("D beckmann", "alpha_0", lambda c: c.error > 0.05),
    "Lambda of GGX at small slopes": ("Lambda ggx exact", "mirror", lambda c: c.error > 0.9),
    "Lambda of Beckmann below 0": ("Lambda beckmann exact", "ordinary", lambda c: c.negative > 0),
    "rational fit near its end": ("Lambda beckmann rational", "ordinary", lambda c: c.negative > 0),
    "half vector of opposite directions": ("cos_facet", "opposite", lambda c: c.error > 1e-3 or c.negative > 0),
    "dielectric next to 1": ("F dielectric", "eta_1", lambda c: c.hard.error > 1e-3),
    "conductor without absorption": ("F conductor", "k_0", lambda c: c.error > 1e-3 or c.negative > 0),
    "azimuths of equal directions": ("G2 directional", "equal", lambda c: c.nan > 0),
    "rim of a cap": ("sample_wi ggx caps", "tails", lambda c: c.error > 1e-3),
    "angles": ("diffuse_f oren_nayar", "ordinary", lambda c: c.error > 1e-4),
}


@pytest.mark.parametrize("failure", FAILURES)
def test_printed_forms_fail_where_they_are_known_to(gpu, failure):
    row, column, known = FAILURES[failure]
    cells = examine(gpu, CHUNKS[row], REGIMES[column], 512, 2)
    assert known(cells["textbook"]), cells["textbook"]
    assert cells["stable"].kept


@pytest.mark.parametrize(("alpha", "expected"), [(1e-2, 5e-3), (1e-3, 0.35)])
def test_error_of_the_printed_ggx_is_the_known_one(gpu, alpha, expected):
    """MODELS.md's figures, as orders of magnitude: a driver rounds as it will, and they were taken elsewhere."""
    slope = np.linspace(0.0, 3.0, 4001)
    wm = np.stack([alpha * slope, 0 * slope, np.ones(4001)], axis=1)
    wm = np.float32(wm / np.linalg.norm(wm, axis=1)[:, None]).astype(float)
    subject = CHUNKS["D ggx"]
    arguments = {"wm": wm, "alpha": np.full((4001, 2), np.float32(alpha), dtype=float)}
    exact = subject.exact(arguments)
    error = {form: np.max(np.abs(subject.single(gpu, arguments, form)[0] / exact - 1)) for form in FORMS}
    assert expected / 4 < error["textbook"] < expected * 4
    assert error["stable"] < 1e-6


# --- the map finds what is planted -----------------------------------------------------------------------------------

PLANTED = {  # what stands in for D of GGX, and the verdict on it in a regime
    "no number": ("if (alpha.x < 2e-6) return sqrt(-alpha.x);", "alpha_0", "nan"),
    "infinite": ("if (alpha.x < 2e-6) return 1.0 / (alpha.x * 1e-38 * 1e-5);", "alpha_0", "infinite"),
    "negative": ("if (wm.x * wm.x + wm.y * wm.y < 1e-10 * wm.z * wm.z) return -1.0;", "mirror", "negative"),
    "a jump": ("if (alpha.x > 0.999) return 0.3 / (alpha.x * alpha.y);", "alpha_1", "error"),
}
RIGHT = """
  vec3 v = vec3(wm.xy / alpha, wm.z);
  float s = dot(v, v) / dot(wm, wm);
  return 0.318309886 / (alpha.x * alpha.y * s * s);
"""


@pytest.mark.parametrize("fault", PLANTED)
def test_planted_faults_are_found(gpu, fault):
    body, column, verdict = PLANTED[fault]
    right = CHUNKS["D ggx"]

    def source(call, form):
        text = f"float D(vec3 wm, vec2 alpha) {{ {body} {RIGHT} }}\n"
        return assemble("views/probe.frag", generated={"chunk.glsl": text, "call.glsl": call})

    faulty = replace(right, source=source)
    assert examine(gpu, faulty, REGIMES[column], 512, 3)["stable"].verdict == verdict
    assert examine(gpu, faulty, REGIMES["ordinary"], 512, 3)["stable"].verdict == "fine"


def test_planted_losses_of_reciprocity_and_energy_are_found(gpu):
    def f_times(factor):
        subject = next(s for s in subjects(MICROFACET(fresnel="one")) if s.name == "f")

        def source(call, form):
            text = subject.source(call, form)
            return replace(text, text=text.text.replace("facet * (D(", f"facet * {factor} * (D("))

        return replace(subject, source=source)

    lit = examine(gpu, f_times("(1.0 + 0.5e-4 * wi.z)"), REGIMES["ordinary"], 256, 1)["stable"]
    assert lit.verdict == "fine" and 1e-5 < lit.reciprocity < 1e-4
    assert examine(gpu, f_times("1.5"), REGIMES["mirror"], 256, 0)["stable"].verdict == "gain"
    measures = examine(gpu, f_times("(1.0 + 1e-3 * wi.z)"), REGIMES["ordinary"], 256, 1)["stable"]
    assert measures.reciprocity > 5e-4 and not measures.kept


def test_condition_numbers_are_those_of_known_functions():
    """((eta - 1) / (eta + 1))^2 has 4 eta / (eta^2 - 1), a factor c has 1, and a product has the sum."""
    subject = replace(
        CHUNKS["F schlick"],
        double=lambda c, eta, k: ((eta - 1) / (eta + 1)) ** 2 * c[:, None],
    )
    eta = np.array([[1.001, 1.5, 3.0]])
    found = subject.condition({"c": np.array([0.5]), "eta": eta, "k": np.zeros((1, 3))})
    np.testing.assert_allclose(found, 1 + 4 * eta / (eta**2 - 1), rtol=2e-3)


# --- worst points ----------------------------------------------------------------------------------------------------


def point(subject, regime, arguments, gpu, form="stable"):
    rows = {name: np.array([v], dtype=float) for name, v in arguments.items()}
    u = np.zeros((1, len(rows), 4))
    return evaluated(gpu, subject, regime, u, form, rows)


CASES_KEPT = json.loads(KEPT.read_text(encoding="utf-8"))


def subject_of(case):
    cls = MODELS[case["model"]]
    return next(s for s in subjects(cls(**case["choices"])) if s.label == case["row"])


@pytest.mark.parametrize("case", CASES_KEPT, ids=lambda c: f"{c['row']} {c['column']}".replace(" ", "-"))
def test_worst_points_of_the_longest_search(gpu, case):
    found = point(subject_of(case), REGIMES[case["column"]], case["arguments"], gpu)
    assert not found.bad.any()
    well = ~(found.condition * UNIT > WELL)
    assert np.all(np.where(well, found.error, 0.0) <= REGIMES[case["column"]].limit)


def test_worst_points_at_50_digits(gpu):
    """The float64 values that the errors of D, Lambda and F are told by."""
    mp = pytest.importorskip("mpmath").mp
    checked = 0
    with mp.workdps(50):
        for case in CASES_KEPT:
            name, _, chosen = case["row"].partition(" ")
            a = case["arguments"]
            book = Textbook(mp, a.get("alpha", (1, 1)))
            if name == "D":
                values = [book.D(chosen, book.vector(a["wm"]))]
            elif name == "Lambda":
                values = [book.Lambda(*chosen.split(), book.vector(a["w"]))]
            elif name == "F" and chosen in ("dielectric", "conductor", "schlick"):
                values = [
                    book.F(chosen, mp.mpf(a["c"]), mp.mpf(e), mp.mpf(k)) for e, k in zip(a["eta"], a["k"], strict=True)
                ]
            else:
                continue
            exact = subject_of(case).exact({n: np.array([v], dtype=float) for n, v in a.items()})[0]
            for found, value in zip(exact, values, strict=True):
                # the directions are unit vectors to 6e-8 only, and D and Lambda are of a direction
                assert abs(found - float(value)) <= 1e-6 * abs(float(value)) + 1e-37, case
                checked += 1
    assert checked >= 10


LONGER = int(os.environ.get("BRDF_EXPLORER_SEARCH", 1))
BUDGET = settings(max_examples=20 * LONGER, deadline=None, phases=tuple(Phase) if LONGER > 1 else (Phase.explicit,))
CORNERS = np.array(
    [0, 1e-38, 1e-9, UNIT, 1e-5, 1e-3, 0.01, 0.1, 0.25, 1 / 3, 0.5, 0.75, 0.9, 0.99, 1 - 1e-5, 1 - UNIT, 1]
)


SEARCHED = [row for row in CHUNKS if "sample_wi" not in row or row.endswith(("caps", "bounded"))]


def among_corners(rng, shape):
    """Points of the cube, from inner ones to those that have all coordinates among CORNERS."""
    at = rng.random(shape) < rng.random((shape[0], 1))
    return np.where(at, rng.choice(CORNERS, shape), rng.random(shape))


@pytest.mark.parametrize("row", SEARCHED)
def test_search_for_new_worst_points(gpu, row):
    """In the cube that a regime draws from, at points that are the same each time.

    With BRDF_EXPLORER_SEARCH, above 1, hypothesis moves there too, that many times 20 examples. What it draws depends on the
    constants in the modules that happen to be imported.
    """
    subject = CHUNKS[row]
    concerned = [r for r in REGIMES.values() if r.concerns(subject)]
    size = 4 * len(subject.arguments)
    points = st.lists(st.lists(st.floats(0, 1), min_size=size, max_size=size), min_size=1, max_size=32)

    def law(regime, rows):
        u = np.array(rows).reshape(len(rows), -1, 4)
        found = evaluated(gpu, subject, regime, u, "stable", subject.draw(regime, u))
        well = ~(found.condition * UNIT > WELL)
        assert not found.bad.any()
        assert np.all(np.where(well, found.error, 0.0) <= LIMIT)

    rng = np.random.default_rng([*map(ord, row)])
    for regime in concerned:
        law = example(regime, among_corners(rng, (1024, size)))(law)
    BUDGET(given(st.sampled_from(concerned), points)(law))()


# --- from a cell to a state ------------------------------------------------------------------------------------------


def test_a_cell_leads_to_its_worst_point(gpu):
    base = State((Material("", MICROFACET(eta=1.5, k=0.0)),))
    cell = worst(gpu, "f microfacet", "opposite", "textbook")
    state, beyond = shown_at(base, cell)
    wo, wi = directions_of(cell.at.arguments)
    assert state.views["sphere"].formulas == "textbook"
    assert np.cos(np.radians(state.light.theta)) == pytest.approx(wo @ wi, abs=1e-6)
    low, high = declared(base.directions)["theta_o"].low, declared(base.directions)["theta_o"].high
    assert state.directions.theta_o == pytest.approx(np.clip(np.degrees(np.arccos(wo[2])), low, high), abs=1e-6)
    for name, p in declared(base.model, Param).items():
        np.testing.assert_allclose(getattr(state.model, name), np.clip(cell.at.arguments[name], p.low, p.high))
    assert loads(dumps(state), base=State()) == state
    assert shown_at(base, replace(cell, form="stable"))[0].views["sphere"].formulas == "stable"


def test_what_cannot_be_shown_is_said(gpu):
    cell = worst(gpu, "D ggx", "alpha_0", "textbook")
    assert min(cell.at.arguments["alpha"]) < 1e-4
    state, beyond = shown_at(State(), cell)
    assert any(line.startswith("alpha") for line in beyond)
    assert min(state.model.alpha) == 1e-4


def test_options_of_another_row_are_chosen(gpu):
    cell = worst(gpu, "Lambda beckmann rational", "ordinary", "textbook")
    state, _ = shown_at(State(), cell)
    assert (state.model.ndf, state.model.smith) == ("beckmann", "rational")


def test_every_cell_of_the_picture_is_a_link(gpu):
    *_, found = stability(gpu, MICROFACET(), efforts=((64, 0),))
    state = State()
    draw, note = Stability().drawing(found, state, (900, 700), 1.0)
    assert isinstance(draw, Drawing) and len(draw.links) == len(found.cells)
    assert all(link.change(state) != state and "float64" in link.tip for link in draw.links)
    check_links(draw.links, state)
    shown = [(row, column) for row, column, _ in found.cells]
    assert len(set(shown)) < len(shown)  # two forms
    cell = next(iter(found.cells.values()))
    assert f"among {cell.points} points" in tip(cell, state)


def test_cells_come_coarse_first_and_are_kept(gpu):
    maps = list(stability(gpu, MODELS["diffuse"](), efforts=((32, 0), (64, 1))))
    assert maps[-1].progress == 1
    assert all(a is b or a.progress < b.progress for a, b in zip(maps, maps[1:], strict=False))
    again = list(stability(gpu, MODELS["diffuse"](albedo=0.1), efforts=((32, 0), (64, 1))))
    assert again[-1].cells == maps[-1].cells  # parameters do not matter: it is about all of them


def test_broken_promise_is_told(gpu, monkeypatch):
    monkeypatch.setattr(regimes, "LIMIT", 1e-9)
    cell = worst(gpu, "D ggx", "ordinary", "stable", (64, 0))
    assert cell.verdict == "error" and not cell.kept


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("rows", ["material", "all"])
@pytest.mark.parametrize(
    ("size", "scale"), [((900, 700), 1.0), ((600, 500), 1.0), ((1200, 1000), 2.0), ((502, 730), 1.0)]
)
def test_labels_lie_inside_and_apart(gpu, size, scale, theme, rows):
    state = State(look=replace(State().look, theme=theme))
    *_, found = stability(gpu, state.model, efforts=((64, 0),), everything=rows == "all")
    boxes = []
    for label in Stability(rows=rows).drawing(found, state, size, scale)[0].labels:
        width = font(label.size * scale).getlength(label.text)
        x, y, half = label.x - label.anchor[0] * width, label.y, 0.36 * label.size * scale
        boxes.append((x, y - half, x + width, y + half, label.text))
    for box in boxes:
        assert box[0] >= 0 and box[1] >= 0 and box[2] <= size[0] and box[3] <= size[1], box
    for a, b in combinations(boxes, 2):
        assert a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1], (a, b)


# --- the command -----------------------------------------------------------------------------------------------------


@pytest.fixture
def run(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(measured, "EFFORTS", ((64, 0),))
    monkeypatch.setattr(measured.stability, "__defaults__", (((64, 0),), False))

    def run(*args, status=0):
        done = CliRunner().invoke(main, ["stability", *args], standalone_mode=False)
        assert done.exception is None or status == 2, done.exception
        assert status == 2 or (done.return_value or 0) == status, done.output
        return done.output if status != 2 else str(done.exception)

    return run


def test_command_prints_and_writes(run):
    assert "as printed" in run("gold") and "sample_f microfacet" in run("gold")
    tree = json.loads(run("chalk", "--json"))
    assert tree["broken"] == [] and {c["form"] for c in tree["cells"]} <= set(FORMS)
    assert all(c["at"]["arguments"] for c in tree["cells"]) and len(tree["columns"]) == len(REGIMES)
    run("chalk", "-o", "map.json")
    assert json.loads(Path("map.json").read_text()) == tree
    run("chalk", "-o", "map.svg", "--size", "300x300")
    assert load("map.svg").model == load("chalk").model


def test_command_writes_a_worst_point_as_a_preset(run):
    out = run("gold", "--worst", "D", "alpha_0", "-o", "worst.toml")
    assert "D ggx alpha_0, error" in out
    state = load("worst.toml")
    assert min(state.model.alpha) < 2e-3 and state.views["sphere"].formulas == "textbook"
    run("gold", "--worst", "D", "alpha_0", "--ours", "-o", "worst.toml")
    assert load("worst.toml").views["sphere"].formulas == "stable"


def test_command_says_what_is_wrong_and_measures_nothing(run, monkeypatch):
    monkeypatch.setattr(measured, "stability", None)  # is not called
    assert "no such row" in run("gold", "--worst", "E", "alpha_0", "-o", "x.toml", status=2)
    assert "no such column" in run("gold", "--worst", "D", "alpha", "-o", "x.toml", status=2)
    assert "no argument" in run("gold", "--worst", "D", "eta_1", "-o", "x.toml", status=2)
    assert "-o FILE.toml" in run("gold", "--worst", "D", "alpha_0", status=2)
    assert "--worst ROW COLUMN" in run("gold", "-o", "x.toml", status=2)
    assert "no format for a map" in run("gold", "-o", "x.exr", status=2)
    assert "no folder nowhere" in run("gold", "-o", "nowhere/x.png", status=2)


def test_command_fails_where_ours_breaks_its_promise(run, monkeypatch):
    monkeypatch.setattr(regimes, "LIMIT", 1e-9)
    monkeypatch.setattr(measured, "_kept", {})
    run("chalk", status=1)


def test_picture_in_the_readme(gpu, picture_regression):
    found = render(gpu, load("gold"), "stability", (760, 520))
    picture_regression.check(labelled(found), "stability", exact="llvmpipe" in gpu.device)

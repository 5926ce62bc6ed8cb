"""The readings of the lecture's formulas: their costs by literal formulas, drawn directions, walks and surfaces; the view."""

from collections import deque

import numpy as np
import pytest
from oracles.cases import CASES, corners, material
from scipy.integrate import dblquad
from scipy.special import erfc
from test_half_space import walked
from test_views import check_labels, check_links

from brdf_explorer.export import save_view
from brdf_explorer.lib.spheres import sphere_s
from brdf_explorer.measure import half_space
from brdf_explorer.measure.grid import direction
from brdf_explorer.measure.microsurface import projected_area
from brdf_explorer.measure.readings import COARSE, EXAMPLES, READINGS, finding, found
from brdf_explorer.measure.steps import Steps
from brdf_explorer.measure.surface import gaussian
from brdf_explorer.models import MODELS
from brdf_explorer.state import Directions, State, load
from brdf_explorer.views.readings import WORDS

MICROFACET, DIFFUSE = MODELS["microfacet"], MODELS["diffuse"]
NORMAL = np.array([0.0, 0.0, 1.0])


def costs(name, theta_o, phi_o=0.0, model=None):
    """The values (n, 2), printed and right, for a viewer's angles in degrees."""
    f, why = found(name, model or EXAMPLES[name], np.radians(theta_o), np.radians(phi_o))
    assert not why
    return np.array([(c.printed, c.right) for c in f.costs])


class Printed:
    """GGX, with Fresnel's reflectance of a dielectric, as slides print them: numpy, no care for rounding."""

    def __init__(self, ax, ay, eta=None):
        self.ax, self.ay, self.eta = ax, ay, eta

    def D(self, m):
        e = (m[..., 0] / self.ax) ** 2 + (m[..., 1] / self.ay) ** 2
        return 1 / (np.pi * self.ax * self.ay * m[..., 2] ** 4 * (1 + e / m[..., 2] ** 2) ** 2)

    def Lambda(self, w):
        tan2 = ((self.ax * w[..., 0]) ** 2 + (self.ay * w[..., 1]) ** 2) / w[..., 2] ** 2
        return (-1 + np.sqrt(1 + tan2)) / 2

    def misread(self, w):
        """Lambda of the isotropic surface of alpha_y with the printed stretch of directions."""
        v = w * [self.ay / self.ax, 1, 1]
        return Printed(self.ay, self.ay).Lambda(v / np.linalg.norm(v, axis=-1, keepdims=True))

    def F(self, c):
        sin_t = np.sqrt(1 - c * c) / self.eta
        ct = np.sqrt(1 - sin_t**2)
        rs, rp = (c - self.eta * ct) / (c + self.eta * ct), (self.eta * c - ct) / (self.eta * c + ct)
        return (rs**2 + rp**2) / 2

    def f(self, wo, wi, G, F=1.0):
        h = (wo + wi) / np.linalg.norm(wo + wi, axis=-1, keepdims=True)
        return self.D(h) * G * F / (4 * wo[..., 2] * wi[..., 2])

    def G1(self, w):
        return 1 / (1 + self.Lambda(w))

    def correlated(self, wo, wi):
        return 1 / (1 + self.Lambda(wo) + self.Lambda(wi))


def drawn(model, wo, functions, n=100_000):
    """Albedos of functions(wo, wi), each (mean, standard error), by directions that the model's sampler draws."""
    wi = model.sample_f(wo, np.random.default_rng(5).random((n, 2)))[0]
    wi = wi[wi[:, 2] > 1e-9]
    pdf = model.pdf(wo, wi)
    values = [function(wo, wi) * wi[:, 2] / pdf for function in functions]
    return [(v.sum() / n, np.sqrt(v.var() / n + v.mean() ** 2 * (1 - len(wi) / n) / n)) for v in values]


def agree(values, estimates):
    for value, (mean, error) in zip(values, estimates, strict=True):
        assert abs(value - mean) < 4 * error + 1e-9 and error < 0.01 * mean


def test_stretching():
    model, book, wo = EXAMPLES["stretching"], Printed(0.2, 0.7), direction(np.radians(60), np.radians(35))
    Lambda, E, area = costs("stretching", 60, 35)
    assert Lambda == pytest.approx([1.34, 0.125], abs=0.005)
    # by the area that a direction sees, the integral of D (w . m)+ = w.z (1 + Lambda)
    misread = wo * [0.7 / 0.2, 1, 1]
    misread /= np.linalg.norm(misread)
    round_one = MICROFACET(alpha=(0.7, 0.7))
    seen = projected_area(round_one, misread) / misread[2] - 1, projected_area(model, wo) / wo[2] - 1
    assert Lambda == pytest.approx(seen, rel=1e-6)

    def wrong(o, i):
        return book.f(o, i, 1 / (1 + book.misread(o) + book.misread(i)))

    def right(o, i):
        return book.f(o, i, book.correlated(o, i))

    agree(E, drawn(model, wo, (wrong, right)))

    def without(theta, phi):
        v = direction(theta, phi) * [0.7 / 0.2, 1, 1]
        return Printed(0.7, 0.7).D(v / np.linalg.norm(v)) * np.cos(theta) * np.sin(theta)

    assert area == pytest.approx([4 * dblquad(without, 0, np.pi / 2, 0, np.pi / 2 - 1e-9)[0], 1], abs=1e-6)


def test_correlated_g():
    model, book = EXAMPLES["correlated"], Printed(1.0, 1.0)
    wo = direction(np.radians(89), 0.0)
    at_viewer, grazing, exchange = costs("correlated", 89)

    def literal(o, i):
        return book.f(o, i, book.G1(i))

    def least(o, i):
        return book.f(o, i, np.minimum(book.G1(o), book.G1(i)))

    assert at_viewer[0] == grazing[0] == pytest.approx(17.6, abs=0.05)
    agree(grazing, drawn(model, wo, (literal, least)))
    assert exchange == pytest.approx([literal(wo, NORMAL) / literal(NORMAL, wo), 1], rel=1e-9)


@pytest.mark.parametrize("name", ["fresnel", "mirrors"])
def test_reflectance_of_a_facet(name):
    model, book = EXAMPLES[name], Printed(0.5, 0.5, 1.5)

    def wrong(o, i):
        F = book.F(o[..., 2]) if name == "fresnel" else 1.0
        return book.f(o, i, book.correlated(o, i), F)

    def right(o, i):
        return book.f(o, i, book.correlated(o, i), book.F(0.5 * np.linalg.norm(o + i, axis=-1)))

    f = (wrong, right)
    values = costs(name, 75)
    for theta, E in ((75, values[0]), (89, values[1])):
        agree(E, drawn(model, direction(np.radians(theta), 0.0), f))
    wo = direction(np.radians(75), 0.0)
    if name == "fresnel":
        assert values[0, 0] / values[0, 1] == pytest.approx(2.8, abs=0.03)
        assert values[2] == pytest.approx([g(wo, NORMAL) / g(NORMAL, wo) for g in f], rel=1e-6)
    else:
        assert values[2] == pytest.approx([g(NORMAL, NORMAL) for g in f], rel=1e-6)


def test_mean_slope():
    """On a surface of Gaussian heights: sigma, the length over which C falls to 1/e, and the slopes."""
    ground = gaussian(np.random.default_rng(3), 1600, 200.0)
    h = ground.heights
    C = np.fft.irfft2(np.abs(np.fft.rfft2(h)) ** 2)
    C = (C[0, :30] + C[:30, 0]) / (2 * C[0, 0])
    T = ground.pitch * np.interp(-1 / np.e, -C, np.arange(30))
    gradient = np.hypot(*((np.roll(h, -1, axis) - np.roll(h, 1, axis)) / (2 * ground.pitch) for axis in (0, 1)))
    alpha, D, G1, mean = costs("slope", 60, model=MICROFACET(alpha=1.0, ndf="beckmann"))
    assert alpha == pytest.approx([np.sqrt(2) * h.std() / T, np.sqrt(np.mean(gradient**2))], rel=0.02)
    assert mean == pytest.approx([gradient.mean(), np.sqrt(np.mean(gradient**2))], rel=0.02)
    assert alpha == pytest.approx([np.sqrt(0.5), 1], rel=1e-5) and mean == pytest.approx([np.sqrt(np.pi) / 2, 1])
    assert D == pytest.approx([2 / np.pi, 1 / np.pi], rel=1e-5)
    a = np.array([np.sqrt(2), 1]) / np.tan(np.radians(60))  # Smith's Lambda as the lecture prints it
    assert G1 == pytest.approx(1 / (1 + (np.exp(-a * a) / (a * np.sqrt(np.pi)) - erfc(a)) / 2), rel=1e-5)


def test_fourier_coefficient():
    """The first mode of what is lost is the printed Eq. 27 less its first scattering; and walks tell which reading is right."""
    theta, model = np.radians(70), EXAMPLES["fourier"]
    f, _ = found("fourier", model, theta, 0.0)
    s = float(sphere_s(model.albedo[0]))
    c, mu = 1 - s * s, np.cos(theta)
    lost = f.curves["right"] - f.curves["printed"]
    weight = np.full(len(lost), np.radians(f.x[1]))
    weight[[0, -1]] /= 2
    mode = np.sum(weight * lost * np.cos(np.radians(f.x))) * 2 / np.pi

    def eq27(H, linear, m):
        inner = 1 + (linear**2 + 45 * m / 64) * mu * mu + 2 * linear * mu
        return c * H * H / (6 * np.pi * 2 * mu) * (1 - mu * mu) * inner

    H = float(half_space.H(1, s, np.array([mu]))[0])
    expected = eq27(H, -0.0589 * c - 0.0047 * c * c, 1 + 0.44 * c) - eq27(1.0, 0.0, 1.0)
    assert mode == pytest.approx(expected, rel=0.01)
    wo, wi = direction(theta, 0.0), direction(np.radians([85.0, 70.0]), np.pi)
    value, error = walked(wo, wi, c, 60_000, np.random.default_rng(7))
    by_name = {cost.name: cost for cost in f.costs}
    for i, name in enumerate(("f at θi = 85°, φ = 180° [1/sr]", "f at θi = θo, φ = 180° [1/sr]")):
        assert abs(by_name[name].right - value[i]) < 3 * error[i] + 1e-3 * value[i]
        assert abs(by_name[name].printed - value[i]) > 5 * error[i]


def test_thin_slab():
    R = Printed(1, 1, 1.5).F(np.cos(np.radians(40)))
    T = 1 - R
    third, closed, absorbed = costs("slab", 40)
    assert third == pytest.approx([T**3 * R**3, T**2 * R**4], rel=1e-9)
    assert np.isnan(closed[0]) and closed[1] == 1
    inner = 1 - (0.9 * R) ** 2
    assert absorbed == pytest.approx([1 - R - T * T * R * 0.81 / inner, T * T * 0.9 / inner], rel=1e-12)


@pytest.mark.parametrize("preset", ["gold", "chalk", "brushed_aluminium", "ceramic", "white_microfacets", "moon_dust"])
@pytest.mark.parametrize("name", READINGS)
def test_every_reading_has_both_curves(name, preset):
    model = load(preset).model
    f, why = found(name, model, np.radians(60.0), 0.3, COARSE)
    assert f.model == (EXAMPLES[name] if why else model)
    assert {"printed", "right"} <= set(f.curves) and all(np.all(np.isfinite(v)) for v in f.curves.values())
    assert np.all(np.diff(f.x) > 0) and all(len(v) == len(f.x) for v in f.curves.values())
    assert not np.allclose(f.curves["printed"], f.curves["right"], rtol=1e-3)


def test_any_material_has_finite_curves():
    rng = np.random.default_rng(2)
    for cls, choices in CASES[::8]:
        for model in (*corners(cls, choices), material(cls, choices, rng)):
            for name, theta in zip(
                READINGS, rng.permutation(np.radians([0.0, 1.0, 30, 60, 80, 89, 89.9])), strict=True
            ):
                f, _ = found(name, model, float(theta), 0.3, COARSE)
                assert all(np.all(np.isfinite(v)) for v in f.curves.values()), (name, model)
                assert all(np.isfinite(c.right) for c in f.costs), (name, model)


# --- the view --------------------------------------------------------------------------------------------------------


def page(gpu, state, size=(900, 520)):
    return deque(state.views["readings"].pictures(gpu, state, size), maxlen=1)[0]


@pytest.mark.parametrize("name", WORDS)
def test_page_says_what_is_printed_what_is_right_and_the_cost(gpu, name):
    state = State(directions=Directions(theta_o=60.0)).with_view("readings", reading=name)
    words = [label.text for label in page(gpu, state).labels]
    assert {*WORDS[name].printed, *WORDS[name].right, "as printed", "right"} <= set(words)
    for cost in found(*state.views["readings"].question(state))[0].costs:
        assert cost.name in words
    assert any(word.startswith("× ") for word in words)


@pytest.mark.parametrize("size", [(900, 520), (676, 210), (282, 215), (400, 300), (500, 450), (460, 760)])
@pytest.mark.parametrize("name", WORDS)
def test_words_have_room(gpu, name, size):
    state = load("brushed_aluminium").with_view("readings", reading=name)
    check_labels(page(gpu, state, size), size, 1.0)


def test_names_lead_to_the_other_readings_and_the_last_link_to_the_sphere(gpu):
    state = load("gold").with_view("readings", reading="correlated")
    *names, sphere = page(gpu, state).links
    assert {link.change(state).views["readings"].reading for link in names} == set(WORDS) - {"correlated"}
    check_links([*names, sphere], state)
    shown = sphere.change(state)
    assert shown.model.shadowing == "full" and shown.views["sphere"].formulas == "textbook"
    assert not [
        link
        for link in page(gpu, state.with_view("readings", reading="slope")).links
        if link.change(state).model != state.model
    ]


def test_curves_are_written(gpu, tmp_path):
    state = load("gold").with_view("readings", reading="stretching")
    for suffix in ("svg", "csv"):
        save_view(gpu, state, "readings", tmp_path / f"x.{suffix}", (600, 400))
    rows = [line for line in (tmp_path / "x.csv").read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    assert rows[0] == "θ [deg],printed,right" and len(rows) > 20


def test_an_example_says_why_it_is_one():
    reasons = {
        ("frosted_glass", "fresnel"): "its facets let light through",
        ("rough_gold", "stretching"): "its light meets several facets",
        ("chalk", "mirrors"): "it has no distribution of facets",
        ("copper", "slope"): "slopes of GGX have no rms",
    }
    for (preset, name), why in reasons.items():
        assert found(name, load(preset).model, 0.7, 0.0, COARSE)[1] == why


def test_the_window_gets_short_steps_and_the_same_page(gpu):
    """None before the first page; none of the last one differs from that of a run without a time to keep."""
    state = State(directions=Directions(theta_o=61.0)).with_view("readings", reading="fresnel")
    finding.cache_clear()
    steps = list(state.views["readings"].drawings(gpu.paced(1e-4), state, (430, 350)))
    alone = list(state.views["readings"].drawings(gpu, state, (430, 350)))
    assert steps[0][0] is None and len(steps) > 40 and len(alone) == 2
    assert steps[-1][0].labels == alone[-1][0].labels and steps[-1][2]


def test_an_error_in_a_step_is_not_waited_for():
    def steps():
        yield
        raise ValueError

    one = Steps(steps())
    with pytest.raises(ValueError):
        one.all()
    with pytest.raises(RuntimeError, match="ended with an error"):
        one.all()

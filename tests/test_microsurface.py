"""Rough surfaces that are made: their slopes, what rays over them see beside Smith's functions, and the view of all this."""

from collections import deque
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from brdf_explorer.export import save_view
from brdf_explorer.lib import slot
from brdf_explorer.lib.common import vec
from brdf_explorer.measure.surface import (
    BINS,
    G1,
    LAWS,
    P2,
    A,
    along,
    cast,
    ellipsoids,
    first_hit,
    gaussian,
    lit,
    measured,
    patch,
    seen,
    surface,
)
from brdf_explorer.model import Invalid
from brdf_explorer.models import MODELS
from brdf_explorer.state import Directions, Light, Material, State
from brdf_explorer.ui import gestures

MICROFACET = MODELS["microfacet"]
VIEW = "microsurface"


@pytest.fixture(scope="module")
def grounds():
    """Three Gaussian surfaces of 100 x 100 correlation lengths with 30 samples each."""
    rng = np.random.default_rng(11)
    return [gaussian(rng, 3000, 100.0) for _ in range(3)]


# --- slopes ----------------------------------------------------------------------------------------------------------


def test_alpha_of_gaussian_heights(grounds):
    """alpha = sqrt(2) sigma / tau is the root mean square of the gradient's length; one surface's is 0.5 % off or so."""
    sigma = np.sqrt(np.mean([np.mean(g.heights**2) for g in grounds]))
    slopes = [np.diff(g.heights, axis=axis) / g.pitch for g in grounds for axis in (0, 1)]
    assert np.sqrt(2) * sigma == pytest.approx(1.0, rel=0.02)
    assert np.sqrt(2 * np.mean([np.mean(s**2) for s in slopes])) == pytest.approx(1.0, rel=0.02)


def test_autocorrelation_of_gaussian_heights(grounds):
    """sigma^2 exp(-r^2 / (2 tau^2)): at one tau 0.607 of the variance, where exp(-r^2 / tau^2) has 0.368."""
    h = grounds[0].heights
    for r in (0.5, 1.0, 2.0):
        lag = round(r / grounds[0].pitch)
        pairs = [np.mean(h * np.roll(h, lag, axis)) for axis in (0, 1)]
        assert np.mean(pairs) / np.mean(h**2) == pytest.approx(np.exp(-((lag * grounds[0].pitch) ** 2) / 2), abs=0.02)


@pytest.mark.parametrize("kind", LAWS)
def test_histogram_of_slopes_is_the_law(kind):
    found = measured(kind, 5, 12)
    law = LAWS[kind]
    share = np.array([quad(lambda s: P2(law, s), *edges)[0] for edges in zip(BINS[:-1], BINS[1:], strict=True)])
    expected = share / np.diff(BINS)
    if kind == "ellipsoids":
        covered = np.mean([surface(kind, seed).covered for seed in (5, *((5, i) for i in range(1, 12)))])
        expected *= covered
        expected[len(expected) // 2] += (1 - covered) / np.diff(BINS)[0]  # the floor
    assert np.all(found.slopes[1] < 0.02)
    np.testing.assert_array_less(np.abs(found.slopes[0] - expected), 5 * found.slopes[1] + 2e-3)
    assert found.alpha[0] == pytest.approx(1.0, abs=max(4 * found.alpha[1], 1e-3)) and found.alpha[1] < 0.01


@np.errstate(under="ignore")  # in the tails
def integral(f, high=np.inf):
    """Integral of f from -infinity to `high`."""
    if high == np.inf:
        return integral(f, 0.0) + integral(lambda s: f(-s), 0.0)
    return quad(lambda t: f(high - t / (1 - t)) / (1 - t) ** 2, 0, 1, epsabs=1e-13, epsrel=1e-11, limit=200)[0]


@pytest.mark.parametrize("law", ["beckmann", "ggx"])
@pytest.mark.parametrize("s", [0.0, 0.4, 2.0])
def test_P2_is_the_marginal_of_P22(law, s):
    D = slot("ndf", law).D

    def P22(y):
        return float(D(vec(-s, -y, 1.0), np.array([1.0, 1.0]))) / (1 + s * s + y * y) ** 2

    assert P2(law, s) == pytest.approx(integral(P22), rel=1e-9)


@pytest.mark.parametrize("law", ["beckmann", "ggx"])
@pytest.mark.parametrize("a", [0.1, 0.7, 2.5])
def test_smith_of_slopes_along_a_line(law, a):
    """1 / G1 is the integral of (1 - s / a)+ P2, the area that faces the direction; lit is G1 times the share that does."""
    assert 1 / G1(law, a) == pytest.approx(integral(lambda s: (1 - s / a) * P2(law, s), a), rel=1e-7)
    assert lit(law, a) / G1(law, a) == pytest.approx(integral(lambda s: P2(law, s), a), rel=1e-9)


def test_normals_of_ellipsoids_are_trowbridge_and_reitz():
    """Over the projected area the CDF of tan^2 is 1 - 1 / (1 + tan^2), which makes it (r / R)^2."""
    made = surface("ellipsoids", 2)
    rng = np.random.default_rng(3)
    x, y = 12.0 * rng.random((2, 40000))
    z, e = made.height(x, y), 1e-7
    rough = z > 1e-2
    assert np.mean(z > 0) == pytest.approx(made.covered, abs=4 * np.sqrt(0.25 / x.size))
    dx, dy = (
        (made.height(x + e * i, y + e * j) - made.height(x - e * i, y - e * j))[rough] / (2 * e)
        for i, j in ((1, 0), (0, 1))
    )
    tan2 = np.sort(dx**2 + dy**2)
    cdf = 1 - 1 / (1 + tan2)
    steep = np.mean(z[z > 0] <= 1e-2)  # left out, as their differences have no digits; they are the last
    expected = np.linspace(0, 1 - steep, cdf.size)
    assert np.max(np.abs(cdf - expected)) < 1.95 / np.sqrt(cdf.size)  # Kolmogorov and Smirnov at 1e-3


def test_ellipsoids_do_not_overlap():
    made = ellipsoids(np.random.default_rng(4), 96, 6.0)
    x, y, radius = made.caps
    dx, dy = ((c[:, None] - c + 3.0) % 6.0 - 3.0 for c in (x, y))
    gap = np.hypot(dx, dy) - radius[:, None] - radius
    np.fill_diagonal(gap, 1.0)
    assert gap.min() > -1e-12 and radius.max() == 1.0 and made.covered > 0.8


def test_brushed_surfaces_have_no_slope_along_the_grooves():
    made = surface("brushed", 1)
    x = np.linspace(0.0, 9.0, 50)
    assert np.ptp([made.height(x, x * 0 + y) for y in (0.0, 0.3, 7.7)], axis=0).max() < 1e-12
    assert np.ptp(patch("brushed", 1, (0.4, 0.0), np.pi / 2, 8.0, 20).heights, axis=1).max() < 1e-12
    assert along("brushed", (0.4, 0.9), 0.0) == 0.4 and along("brushed", (0.4, 0.9), np.pi / 2) < 1e-15


@pytest.mark.parametrize("phi", [0.0, 0.5, np.pi / 2])
def test_a_stretched_surface_has_its_alpha_along_each_azimuth(phi):
    alpha = (0.2, 0.7)
    part = patch("gaussian", 3, alpha, phi, 60.0, 361)
    slopes = np.diff(part.heights, axis=1) / part.pitch
    # its 100 to 1000 patches of one slope make this 3 % uncertain
    assert np.sqrt(2 * np.mean(slopes**2)) == pytest.approx(along("gaussian", alpha, phi), rel=0.1)


# --- rays ------------------------------------------------------------------------------------------------------------

HEIGHTS = st.lists(st.integers(-6, 6), min_size=2, max_size=7)
POINTS = 64  # of a segment that brute force looks at


def by_force(heights, ray, periodic):
    """Share of each segment that rays leave, by looking from many points of it at all corners ahead."""
    n = len(heights) - 1
    repeats = 1 + (int(np.ceil(12 / ray[1] / n)) + 1 if periodic else 0)
    corners_x = np.arange(repeats * n + 1)
    corners_z = np.append(np.tile(heights[:-1], repeats), heights[-1])
    shares = []
    for i in range(n):
        t = (np.arange(POINTS) + 0.5) / POINTS
        x, z = i + t, heights[i] + t * (heights[i + 1] - heights[i])
        above = corners_z - z[:, None] - ray[1] / ray[0] * (corners_x - x[:, None])
        faces = heights[i + 1] - heights[i] < ray[1] / ray[0]
        shares.append(faces * np.mean(np.all((above <= 0) | (corners_x < x[:, None]), axis=1)))
    return np.array(shares)


@given(HEIGHTS, st.floats(0.1, 5.0), st.booleans())
@settings(max_examples=150, deadline=None)
def test_rays_see_what_brute_force_sees(heights, up, periodic):
    heights = np.array([*heights, heights[0]], dtype=float)
    expected = by_force(heights, (1.0, up), periodic)
    np.testing.assert_allclose(seen(heights, 1.0, (1.0, up), periodic), expected, atol=1.01 / POINTS)
    mirrored = seen(heights[::-1], 1.0, (-1.0, up), periodic)[::-1]
    np.testing.assert_allclose(mirrored, expected, atol=1.01 / POINTS)


@given(HEIGHTS, st.floats(0.1, 5.0), st.sampled_from([-1.0, 1.0]))
@settings(max_examples=150, deadline=None)
def test_a_ray_ends_at_the_first_hit(heights, up, run):
    heights = np.array([*heights, heights[0]], dtype=float)
    n = len(heights) - 1
    for i in range(n):
        slope = heights[i + 1] - heights[i]
        if up - run * slope < 1e-3:  # it faces away
            continue
        hit = first_hit(heights, 1.0, i, (run, up))
        end = (n if run > 0 else 0) if hit is None else hit
        x = np.linspace(i + 0.5, end, 50)[1:]
        above = 0.5 * (heights[i] + heights[i + 1]) + up * np.abs(x - i - 0.5) - np.interp(x, np.arange(n + 1), heights)
        assert np.all(above > -1e-9)
        assert hit is None or abs(above[-1]) < 1e-9


def test_straight_down_everything_is_seen():
    part = patch("gaussian", 1, (0.8, 0.8), 0.0, 6.0, 30)
    assert part.seen(0.0).min() == 1.0
    assert part.seen(np.radians(95.0)).max() == 0.0


# --- beside Smith ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", [0.3, 0.6, 1.0])
def test_visible_projected_area_is_smiths(grounds, alpha):
    """Up to 80 degrees within 1 %: the mean of three surfaces of 100 correlation lengths."""
    rows = [np.concatenate([h, h[:, :1]], axis=1) for h in (g.heights[::15] for g in grounds)]
    for theta in np.radians([20.0, 40.0, 60.0, 70.0, 80.0]):
        a = 1 / (alpha * np.tan(theta))
        share = np.mean([cast(h, grounds[0].pitch, a)[0] for h in rows])
        assert share == pytest.approx(G1("beckmann", a), rel=0.01)


def test_lit_area_is_below_smiths():
    """Correlated heights: up to 6.5 % of it, 0.680 for 0.714 at alpha = 0.6 and 70 degrees; none where nothing is hidden."""
    found = measured("gaussian", 1, 12)
    gap = found.lit[0] / lit("beckmann", A) - 1
    assert -0.075 < gap.min() < -0.055 and np.all(gap < 4 * found.lit[1] + 1e-4) and abs(gap[-1]) < 1e-3
    a = 1 / (0.6 * np.tan(np.radians(70.0)))
    assert np.interp(a, A, found.lit[0]) == pytest.approx(0.680, abs=0.01)
    assert lit("beckmann", a) == pytest.approx(0.714, abs=5e-4)


def test_floor_between_ellipsoids_takes_part_in_G1():
    found = measured("ellipsoids", 1, 4)
    covered = np.mean([surface("ellipsoids", seed).covered for seed in (1, (1, 1), (1, 2), (1, 3))])
    Lambda = 1 / G1("ggx", A) - 1
    np.testing.assert_allclose(found.visible[0], 1 / (1 + covered * Lambda), rtol=0.012)
    assert np.all(found.lit[0] > lit("ggx", A))


# --- the view --------------------------------------------------------------------------------------------------------


def at(theta_o=40.0, light=50.0, model=None, **options):
    model = model or MICROFACET(alpha=0.3, ndf="beckmann")
    state = State((Material("m", model),), directions=Directions(theta_o=theta_o), light=Light(theta=light))
    return state.with_view(VIEW, **options)


def pictured(gpu, state, size=(320, 240)):
    return deque(state.views[VIEW].pictures(gpu, state, size), maxlen=1)[0]


def words(gpu, state, size=(320, 240)):
    return " ".join(label.text for label in pictured(gpu, state, size).labels)


def test_heights_follow_the_materials_alpha(gpu):
    assert "σ 2.12 μm, τ 10 μm" in words(gpu, at())
    assert "σ 4.24 μm, τ 20 μm" in words(gpu, at(tau=20.0))
    wider = at(model=MICROFACET(alpha=(0.1, 0.4), ndf="beckmann"))
    assert "σ 2.83 μm, τx 40 μm, τy 10 μm" in words(gpu, wider, (500, 240))
    assert "height / radius = 0.3" in words(gpu, at(model=MICROFACET(alpha=0.3)))
    assert "= 0.3, 0" in words(gpu, at(surface="brushed"))


def test_the_light_keeps_its_angle_to_the_eye(gpu):
    ground = at(theta_o=40.0, light=100.0).views[VIEW].ground(at(theta_o=40.0, light=100.0))
    assert np.degrees(ground.theta_i) == pytest.approx(-60.0)
    assert "ωi" in words(gpu, at(light=100.0)) and "ωi" not in words(gpu, at(light=150.0))
    assert "shadowed 0 % masked 0 %" in words(gpu, at(theta_o=0.0, light=0.0))
    assert "below the horizon" in words(gpu, at(light=150.0)) and "below the horizon" not in words(gpu, at(light=100.0))
    assert "visible 0 % shadowed 100 %" in words(gpu, at(theta_o=0.0, light=150.0))


def test_shares_of_the_surface_are_the_whole_of_it():
    state = at(theta_o=75.0, light=150.0, model=MICROFACET(alpha=0.8, ndf="beckmann"))
    shares = state.views[VIEW].ground(state).cut(10.0, 65).shares()
    assert sum(shares) == pytest.approx(1.0) and min(shares) > 0.02


def test_a_material_without_facets_is_told(gpu):
    state = at(model=MODELS["diffuse"]())
    assert "no microsurface" in words(gpu, state)
    with pytest.raises(Invalid, match="no distribution of facets"):
        state.views[VIEW].table_of(gpu, state)


def test_table_holds_smith_and_measured(gpu):
    state = at()
    curves = state.views[VIEW].table_of(gpu, state)
    assert np.all(np.diff(curves.x) > 0)
    np.testing.assert_allclose(0.3 * np.tan(np.radians(curves.x)) * curves.y["a"], 1.0)
    np.testing.assert_allclose(curves.y["visible"], curves.y["G1"], atol=0.01)
    assert {len(v) for v in curves.y.values()} == {curves.x.size}


def test_vector_file_holds_the_surface_as_a_picture(gpu, tmp_path):
    save_view(gpu, at(show="surface"), VIEW, tmp_path / "x.svg", (200, 150))
    text = (tmp_path / "x.svg").read_text()
    assert "<image" in text and "ωo" in text


def test_pictures_get_better_and_then_stop(gpu):
    """What is hidden by the panel's size is not measured."""
    large, small = (list(at().views[VIEW].pictures(gpu, at(), size)) for size in ((600, 420), (320, 240)))
    assert [p.done for p in large] == [False] * (len(large) - 1) + [True]
    assert len(small) == 2 and small[-1].done and "16 surfaces" in large[-1].note


def test_a_drag_turns_the_viewer():
    state, size = at(), (320, 240)
    x, y = state.views[VIEW].pivot(state, size)
    turned = gestures.viewer(state, state.views[VIEW], (x + 50, size[1] - y - 50), size, 1.0)
    assert turned.directions.theta_o == 45.0
    assert state.views[VIEW].shows(turned) != state.views[VIEW].shows(state)


def test_other_light_changes_nothing():
    state = at()
    assert state.views[VIEW].shows(state) == state.views[VIEW].shows(
        replace(state, light=replace(state.light, gain=2.0))
    )


def test_the_window_gets_short_steps_and_the_same_picture(gpu):
    state = at()
    steps = list(state.views[VIEW].drawings(gpu.paced(1e-4), state, (600, 420)))
    alone = list(state.views[VIEW].drawings(gpu, state, (600, 420)))
    assert steps[0][0] is None and all(draw for draw, *_ in alone)
    assert steps[-1][0].labels == alone[-1][0].labels and steps[-1][1:] == alone[-1][1:]

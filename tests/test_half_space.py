"""The half space of Lambertian spheres: the exact solution against its definitions and walks among spheres; tables against it."""

import re

import numpy as np
import pytest

from brdf_explorer.glsl import SHADERS
from brdf_explorer.lib import spheres
from brdf_explorer.lib.diffuse_lambert_sphere_fast import grazing_albedo
from brdf_explorer.lib.lambert_sphere import TABLE
from brdf_explorer.lib.spheres import sphere_c, sphere_s
from brdf_explorer.measure import albedo, half_space
from brdf_explorer.measure.grid import direction
from brdf_explorer.models import MODELS

Diffuse = MODELS["diffuse"]
S = (0.0, 1e-4, 0.01, 0.1, 0.3, 0.7)


def printed_K(mp, mode, c, t):
    """Eqs. 24 to 26 as printed, at high precision."""
    a = mp.atan(t)
    if mode == 0:
        b = (256 * c - 301) * t**3 + ((346 - c * (20 * c + 281)) * t**2 - 15 * (c - 1) * (4 * c + 9) + 207 * t**4) * a
        return 1 - c * (b + 15 * (c - 1) * (4 * c + 9) * t) / (192 * t**5)
    if mode == 1:
        b = (40 * c + 282) * t**3 - 3 * (t**2 + 1) * (20 * c + 64 * t**2 + 45) * a + 15 * (4 * c + 9) * t
        return 1 - c * b / (288 * t**5)
    return 1 - 5 * c * (3 * (t**2 + 1) ** 2 * a - t * (5 * t**2 + 3)) / (128 * t**5)


@pytest.mark.parametrize("mode", half_space.MODES)
def test_K_is_the_printed_one(mode):
    mp = pytest.importorskip("mpmath").mp
    t = np.array([1e-6, 1e-3, 0.1, 0.9, 1.1, 10.0, 1e4])
    with mp.workdps(60):
        for s in S[2:]:
            c = (1 - mp.mpf(s)) * (1 + mp.mpf(s))
            expected = [float(printed_K(mp, mode, c, mp.mpf(float(x)))) for x in t]
            np.testing.assert_allclose(half_space.K(mode, s, t), expected, rtol=1e-13)


@pytest.mark.parametrize("mode", half_space.MODES)
def test_H_keeps_its_equation(mode):
    """H = 1 + mu H int Psi H / (mu + nu) dnu."""
    mu = np.array([1e-3, 0.1, 0.5, 1.0])
    root, weight = half_space.nodes(200)
    nu = root**3
    for s in S:
        Psi = (1 - s) * (1 + s) * half_space.psi(mode, s) @ [nu**0, nu**2, nu**4]
        found = half_space.H(mode, s, mu)
        integral = (3 * root**2 * weight * Psi * half_space.H(mode, s, nu) / (mu[:, None] + nu)).sum(axis=1)
        np.testing.assert_allclose(found, 1 + mu * found * integral, rtol=1e-12)


def test_energy(monkeypatch):
    """White spheres keep it, and near c = 1 no other root is met: the albedo falls with s."""
    for cosine in (1.0, 0.7, 0.1, 0.01):
        wo = direction(np.arccos(cosine), 0.0)
        values = [half_space.albedo(wo, s) for s in (0.0, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3)]
        assert values[0] == pytest.approx(1, abs=1e-5)
        assert np.all(np.diff(values) < 0) and np.all(np.diff(values)[:3] > -0.03)
        white = Diffuse(albedo=1, diffuse="lambert_sphere")
        assert albedo(white, wo, tolerance=1e-7, most=256) == pytest.approx(1, abs=1e-5)
    # what `excess` takes out is of the first scattering, exact beside further ones of three terms: of three throughout it is 0
    monkeypatch.setattr(half_space, "excess", lambda mu: 0 * mu)
    three = [1 / (4 * np.pi), -4 / (12 * np.pi), 5 / (64 * np.pi)]
    monkeypatch.setattr(half_space, "phase", lambda wo, wi: np.polynomial.legendre.legval(np.sum(-wo * wi, -1), three))
    for cosine in (1.0, 0.7, 0.1, 0.01):
        assert half_space.albedo(direction(np.arccos(cosine), 0.0), 0.0, 48) == pytest.approx(1, abs=1e-6)


def many_terms(s, mu, weight, most=16):
    """Albedo (n,) along nodes mu (n,) by discrete ordinates: light in a half space is a sum of exp(-k depth) on these nodes."""
    legendre = np.polynomial.legendre.Legendre.basis
    root, turn = half_space.nodes(200)
    x, dx = np.cos(np.pi * root), np.pi * turn * np.sin(np.pi * root)
    p = spheres.phase(direction(np.pi * root, 0.0), np.array([0.0, 0.0, -1.0]))
    ahead = behind = 0.0
    for k in range(most + 1):
        P = legendre(k)(mu)
        term = (1 - s) * (1 + s) * np.pi * (2 * k + 1) * ((p * legendre(k)(x)) @ dx) * np.outer(P, P) * weight
        ahead, behind = ahead + term, behind + (-1) ** k * term
    A, B = (np.eye(len(mu)) - ahead) / mu[:, None], behind / mu[:, None]
    k, mode = np.linalg.eig(np.block([[-A, B], [-B, A]]))
    down, up = np.split(mode[:, k < 0], 2)
    return (weight * mu) @ (up @ np.linalg.inv(down)) / (weight * mu)


@pytest.mark.parametrize(
    ("s", "three", "left"), [(1e-3, 1.2e-4, 2e-6), (0.1**0.5, 7.5e-5, 2e-5), (0.5**0.5, 1.5e-5, 7e-6)]
)
def test_three_terms_lose_as_their_header_says(s, three, left, monkeypatch):
    """Against many terms, and what is left beside `excess`."""
    root, turn = half_space.nodes(32)
    mu = root**2
    expected = many_terms(s, mu, 2 * root * turn)
    at = np.searchsorted(mu, [0.01, 0.1, 0.3, 0.7, 0.99])
    for most in (left, three):
        found = [half_space.albedo(direction(np.arccos(mu[i]), 0.0), s, 32) for i in at]
        assert 0.8 * most < np.max(np.abs(found - expected[at])) < most
        monkeypatch.setattr(half_space, "excess", lambda mu: 0 * mu)


def about(rng, n):
    """Directions spread by the cosine about n (..., 3)."""
    v = rng.normal(size=n.shape)
    v = v / np.linalg.norm(v, axis=-1, keepdims=True) + n
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def walked(wo, wi, c, n, rng):
    """f (m,) and its standard error by walks among spheres, each hit at a normal spread as a sphere shows it."""
    depth, w, walk = np.zeros(n), np.tile(-wo, (n, 1)), np.arange(n)
    found = np.zeros((n, len(wi)))
    while len(walk):
        depth = depth - w[:, 2] * rng.exponential(size=len(w))
        on = (depth > 0) & (rng.random(len(w)) < c)
        depth, w, walk = depth[on], w[on], walk[on]
        normal = about(rng, -w)
        with np.errstate(under="ignore"):
            found[walk] += np.maximum(normal @ wi.T, 0) / np.pi * np.exp(-depth[:, None] / wi[:, 2]) / wi[:, 2]
        w = about(rng, normal)
    return found.mean(axis=0), found.std(axis=0) / np.sqrt(n)


@pytest.mark.parametrize(("s", "theta"), [(0.5, 10.0), (0.25, 70.0)])
def test_agrees_with_walks_among_spheres(s, theta):
    wo, wi = direction(np.radians(theta), 0.0), direction(*np.radians([[20, 70, 70, 70, 85], [0, 0, 90, 180, 180]]))
    value, error = walked(wo, wi, 1 - s * s, 150_000, np.random.default_rng(7))
    expected = half_space.f(wo, wi, s)
    assert np.all(np.abs(value - expected) <= np.maximum(3 * error, 2e-3 * expected))
    if theta == 70.0:
        wrong = half_space.f(wo, wi, s, doubled=False)  # Eq. 27 without the 2
        assert np.any(np.abs(value - wrong) > 4 * error)


def test_tables_hold_the_exact_form():
    rng = np.random.default_rng(1)
    z = np.where(rng.random((2, 2000)) < 0.5, 1e-4 ** rng.random((2, 2000)), rng.random((2, 2000)))
    wo, wi = direction(np.arccos(z), rng.uniform(0, 2 * np.pi, z.shape))
    for a in (1.0, 0.999, 0.9, 0.5, 0.05):
        found = Diffuse(albedo=a, diffuse="lambert_sphere").f(wo, wi)[:, 0]
        exact = half_space.f(wo, wi, float(sphere_s(a)))
        assert np.max(np.abs(found / exact - 1)) < 4e-5


def even(n, rng):
    """Pairs of directions (n, 3), even in solid angle."""
    return direction(np.arccos(1 - rng.random((2, n))), rng.uniform(0, 2 * np.pi, (2, n)))


def test_fast_form_is_the_printed_one():
    """Eq. 48 with the inverse cosines that it prints, its 0 / 0 apart."""
    wo, wi = even(2000, np.random.default_rng(3))
    sines = np.sqrt((1 - wo[:, 2] ** 2) * (1 - wi[:, 2] ** 2))
    phi = np.arccos(np.clip(np.sum(wo[:, :2] * wi[:, :2], axis=1) / sines, -1, 1))
    several = (phi + np.sqrt(wo[:, 2] * wi[:, 2])) / (0.113706 + np.arccos(sines) / sines)
    x = np.arccos(np.sum(-wo * wi, axis=1))
    single = 2 * (np.sin(x) - x * np.cos(x)) / (3 * np.pi**2) / (wo[:, 2] + wi[:, 2])
    for a in (1.0, 0.5, 0.1, 0.01, 0.0):
        c = (1 - (1 - a) ** 2.73556) / (1 - 0.184096 * (1 - a) ** 2.48423)
        expected = np.maximum(c * single + 0.234459 * a**1.85432 + 0.0151829 * (c - 0.24998) * several, 0)
        found = Diffuse(albedo=a, diffuse="lambert_sphere_fast").f(wo, wi)[:, 0]
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    ("a", "median", "most"), [(1.0, 0.133, 0.5), (0.5, 0.016, 0.1), (0.1, 0.022, 0.34), (0.08, 0.024, 1.0)]
)
def test_fast_form_errs_as_its_header_says(a, median, most):
    wo, wi = even(20_000, np.random.default_rng(1))
    exact = half_space.f(wo, wi, float(sphere_s(a)))
    error = np.abs(Diffuse(albedo=a, diffuse="lambert_sphere_fast").f(wo, wi)[:, 0] / exact - 1)
    assert np.median(error) == pytest.approx(median, rel=0.03)
    assert 0.88 * most < error.max() <= most


def test_fast_form_gains_energy_as_its_header_says():
    model = Diffuse(albedo=1, diffuse="lambert_sphere_fast")
    cosines = np.array([1.0, 0.2, 1e-3, 1e-6])
    found = albedo(model, direction(np.arccos(cosines), 0.0), tolerance=1e-4, most=128)[:, 0]
    np.testing.assert_allclose(found, [1.03, 1.17, 1.295, 1.297], atol=5e-3)
    assert np.all(found[:3] < model.exceptions()["energy"]) and found[-1] == pytest.approx(
        grazing_albedo(1.0), abs=1e-3
    )
    for a in (0.9, 0.6, 0.3):  # the limit at the horizon is the largest albedo
        model = Diffuse(albedo=a, diffuse="lambert_sphere_fast")
        found = albedo(model, direction(np.arccos(cosines), 0.0), tolerance=1e-4, most=128)[:, 0]
        assert np.all(np.diff(found) > 0) and found[-1] == pytest.approx(grazing_albedo(a), abs=1e-3)
        assert ("energy" in model.exceptions()) == (found[-1] > 1)


def test_albedo_maps_to_c():
    a = np.linspace(0, 1, 1001)
    np.testing.assert_allclose(sphere_c(a), 1 - sphere_s(a) ** 2, atol=4e-10)
    assert sphere_c(0.0) == 0 and sphere_s(1.0) == 0


def test_the_twins_hold_one_table():
    text = (SHADERS / "lib/lambert_sphere.glsl").read_text(encoding="utf-8")
    body = re.sub(r"//.*", "", text[text.index("= float[258](") + 13 : text.index(");")])
    np.testing.assert_array_equal(np.array(body.split(","), dtype=float), TABLE)

"""The float64 twins against formulas of another kind: textbook forms at 50 digits, and another renderer."""

import numpy as np
import pytest

from brdf_explorer.lib import slot
from brdf_explorer.lib.common import vec
from brdf_explorer.measure.grid import direction
from brdf_explorer.model import Choice, declared
from brdf_explorer.models import MODELS

Microfacet, Diffuse = MODELS["microfacet"], MODELS["diffuse"]
CHOICES = declared(Microfacet, Choice)
ALPHAS = [(1e-4, 1e-4), (0.2, 0.2), (1.0, 1.0), (1e-4, 1.0), (0.7, 0.05)]
TOLERANCE = 1e-11
"""Relative. A facet's cosine of 1e-4 is |wo + wi| / 2, off by 1e-16 / 1e-4, and F by up to four times that; the exponent of
Beckmann, up to 660, carries a dozen roundings: both 4e-12."""
SMALLEST = 1e-290
"""Below this, float64 runs out."""


def pairs(alpha, n=40):
    """Directions (m, 3) each: grazing, nearly opposite, alike, and lobes whose slopes are on the scale of alpha."""
    rng = np.random.default_rng(1)
    cosine = 1e-4 ** rng.random(n)
    wo = direction(np.arccos(cosine), rng.uniform(0, 2 * np.pi, n))
    rho, psi = 3 * np.sqrt(rng.random(n)), rng.uniform(0, 2 * np.pi, n)
    wm = vec(alpha[0] * rho * np.cos(psi), alpha[1] * rho * np.sin(psi), np.ones(n))
    wm /= np.linalg.norm(wm, axis=1)[:, None]
    wi = 2 * np.sum(wo * wm, axis=1)[:, None] * wm - wo
    grazing = np.arccos(1e-4)
    corners = [
        ((grazing, 0.3), (grazing, 0.3 + np.pi - 1e-4)),  # nearly opposite
        ((grazing, 1.0), (np.arccos(2e-4), 1.0 + np.pi)),
        ((grazing, 2.0), (grazing, 2.0)),
        ((1.0, 2.0), (1.0, 2.0)),
        ((grazing, 0.0), (1e-5, 0.7)),
        ((0.0, 0.0), (0.0, 0.0)),
        ((0.9, 0.4), (0.9001, 0.4 + np.pi)),
    ]
    wo = np.concatenate([wo, [direction(*a) for a, _ in corners]])
    wi = np.concatenate([wi, [direction(*b) for _, b in corners]])
    up = wi[:, 2] > 1e-5
    return wo[up], wi[up]


class Textbook:
    """A microsurface at 50 digits, from polar angles: Walter et al. 2007 and the complex Fresnel equations."""

    def __init__(self, mp, alpha):
        self.mp = mp
        self.alpha = [mp.mpf(a) for a in alpha]

    def vector(self, w):
        return [self.mp.mpf(float(x)) for x in w]

    def polar(self, w):
        """Cosine and tangent of the polar angle, and the azimuth; of any length."""
        x, y, z = w
        r = self.mp.sqrt(x * x + y * y)
        return z / self.mp.sqrt(r * r + z * z), r / z, self.mp.atan2(y, x)

    def D(self, ndf, wm):
        mp, (ax, ay) = self.mp, self.alpha
        cos, tan, phi = self.polar(wm)
        slope2 = tan**2 * ((mp.cos(phi) / ax) ** 2 + (mp.sin(phi) / ay) ** 2)
        shape = mp.exp(-slope2) if ndf == "beckmann" else 1 / (1 + slope2) ** 2
        return shape / (mp.pi * ax * ay * cos**4)

    def Lambda(self, ndf, smith, w):
        mp, (ax, ay) = self.mp, self.alpha
        _, tan, phi = self.polar(w)
        if tan == 0:
            return mp.mpf(0)
        a = 1 / (mp.sqrt((ax * mp.cos(phi)) ** 2 + (ay * mp.sin(phi)) ** 2) * tan)
        if ndf == "ggx":
            return (mp.sqrt(1 + 1 / a**2) - 1) / 2
        if smith == "exact":
            return mp.exp(-(a**2)) / (2 * a * mp.sqrt(mp.pi)) - mp.erfc(a) / 2
        if a >= 1.6:
            return mp.mpf(0)
        p, q, r, s = (mp.mpf(c) for c in ("3.535", "2.181", "2.276", "2.577"))
        return 1 / min((p * a + q * a**2) / (1 + r * a + s * a**2), 1) - 1

    def G2(self, shadowing, wo, wi, Lambda_o, Lambda_i):
        mp = self.mp
        G1 = [1 / (1 + L) for L in (Lambda_o, Lambda_i)]
        if shadowing == "none":
            return mp.mpf(1)
        if shadowing == "correlated":
            return 1 / (1 + Lambda_o + Lambda_i)
        turn = abs(self.polar(wo)[2] - self.polar(wi)[2])
        turn = min(turn, 2 * mp.pi - turn)
        share = {"separable": 0, "full": 1, "directional": mp.exp(-mp.mpf("7.3") * turn**2)}[shadowing]
        return share * min(G1) + (1 - share) * G1[0] * G1[1]

    def cos_facet(self, wo, wi):
        mp = self.mp
        dot = mp.fdot(wo, wi) / mp.sqrt(mp.fdot(wo, wo) * mp.fdot(wi, wi))
        return mp.cos(mp.acos(dot) / 2)

    def F(self, fresnel, c, eta, k):
        mp = self.mp
        if fresnel == "one":
            return mp.mpf(1)
        n = mp.mpc(eta, 0 if fresnel == "dielectric" else k)
        F0 = abs((n - 1) / (n + 1)) ** 2
        if fresnel == "constant":
            return F0
        schlick = [F0 + (1 - F0) * (1 - x) ** 5 for x in (c, mp.mpf(1) / 7)]
        if fresnel == "schlick":
            return schlick[0]
        if fresnel == "f82":
            edge = min(self.F("conductor", mp.mpf(1) / 7, eta, k), schlick[1])
            bend = c * (1 - c) ** 6 / (mp.mpf(1) / 7 * (mp.mpf(6) / 7) ** 6)
            return max(schlick[0] - (schlick[1] - edge) * bend, mp.mpf(0))
        t = mp.sqrt(1 - (1 - c * c) / n**2)
        rs, rp = (c - n * t) / (c + n * t), (n * c - t) / (n * c + t)
        return (abs(rs) ** 2 + abs(rp) ** 2) / 2


def assert_close(value, expected, case):
    value, expected = np.asarray(value, dtype=float), np.asarray(expected, dtype=float)
    big = expected > SMALLEST
    assert np.any(big), case
    off = np.abs(value[big] / expected[big] - 1)
    assert off.max() <= TOLERANCE, (case, off.max())
    assert np.all(value[~big] <= 2 * SMALLEST), case


@pytest.mark.parametrize("alpha", ALPHAS, ids=str)
@np.errstate(under="ignore")
def test_microfacet_at_50_digits(alpha):
    mp = pytest.importorskip("mpmath").mp
    wo, wi = pairs(alpha)
    eta, k = (0.143, 1.0001, 5.6), (3.983, 0.0, 1.2)
    with mp.workdps(50):
        book = Textbook(mp, alpha)
        exact = [(book.vector(o), book.vector(i)) for o, i in zip(wo, wi, strict=True)]
        facets = [
            [a + b for a, b in zip(o, i, strict=True)] for o, i in exact
        ]  # their direction, from wo and wi as given
        cosines = [[book.polar(w)[0] for w in pair] for pair in exact]
        c = [book.cos_facet(o, i) for o, i in exact]
        F = {
            f: [[book.F(f, x, mp.mpf(e), mp.mpf(b)) for e, b in zip(eta, k, strict=True)] for x in c]
            for f in CHOICES["fresnel"].options
        }
        for f, values in F.items():
            facet = slot("fresnel", *(["spectral", "none"] if f == "spectral" else [f])).F(
                np.array([float(x) for x in c]), np.array(eta), np.array(k)
            )
            assert_close(facet, values, f)
        for ndf in CHOICES["ndf"].options:
            module = slot("ndf", ndf)
            D = [book.D(ndf, m) for m in facets]
            assert_close(module.D(wo + wi, np.array(alpha)), D, (ndf, "D"))
            for smith in CHOICES["smith"].options:
                L = [[book.Lambda(ndf, smith, w) for w in pair] for pair in exact]
                Lambda = slot("smith", ndf, smith).Lambda
                for side, w in enumerate((wo, wi)):  # 1 + Lambda of the fit: Lambda itself goes through 0 there
                    one = 1 if smith == "rational" else 0
                    assert_close(
                        one + Lambda(w, np.array(alpha)), [one + pair[side] for pair in L], (ndf, smith, "Lambda")
                    )
                if smith == "exact":
                    area = [cos[0] * (1 + pair[0]) for cos, pair in zip(cosines, L, strict=True)]
                    assert_close(module.visible_area(wo, np.array(alpha)), area, (ndf, "visible_area"))
                    density = [d / (4 * a) for d, a in zip(D, area, strict=True)]
                    assert_close(Microfacet(alpha=alpha, ndf=ndf).pdf(wo, wi), density, (ndf, "pdf"))
                for shadowing in CHOICES["shadowing"].options:
                    scale = [
                        d * book.G2(shadowing, *pair, *both) / (4 * cos[0] * cos[1])
                        for d, pair, both, cos in zip(D, exact, L, cosines, strict=True)
                    ]
                    for f, values in F.items():
                        model = Microfacet(
                            alpha=alpha, eta=eta, k=k, ndf=ndf, smith=smith, shadowing=shadowing, fresnel=f
                        )
                        expected = [[s * x for x in row] for s, row in zip(scale, values, strict=True)]
                        assert_close(model.f(wo, wi), expected, model)


def test_oren_nayar_at_50_digits():
    mp = pytest.importorskip("mpmath").mp
    wo, wi = pairs((0.5, 0.5))
    model = Diffuse(albedo=(1.0, 0.5, 0.25), sigma=0.7, diffuse="oren_nayar")
    expected = []
    with mp.workdps(50):
        book, s2 = Textbook(mp, (1, 1)), mp.mpf(0.7) ** 2
        for o, i in zip(wo, wi, strict=True):
            (_, tan_o, phi_o), (_, tan_i, phi_i) = (book.polar(book.vector(w)) for w in (o, i))
            steep, flat = max(mp.atan(tan_o), mp.atan(tan_i)), min(mp.atan(tan_o), mp.atan(tan_i))
            B = mp.mpf("0.45") * s2 / (s2 + mp.mpf("0.09")) * max(mp.cos(phi_o - phi_i), 0)
            factor = 1 - s2 / (2 * (s2 + mp.mpf("0.33"))) + B * mp.sin(steep) * mp.tan(flat)
            expected.append([a * factor / mp.pi for a in model.albedo])
    assert_close(model.f(wo, wi), expected, model)


def test_eon_at_50_digits():
    """Listing 1 of the paper as printed, with its quotients of 0 by 0."""
    mp = pytest.importorskip("mpmath").mp
    wo, wi = pairs((0.5, 0.5))
    model = Diffuse(albedo=(1.0, 0.5, 0.25), r=0.875, diffuse="eon")
    expected = []
    with mp.workdps(50):
        book, r = Textbook(mp, (1, 1)), mp.mpf(model.r)
        one, two = mp.mpf(1) / 2 - 2 / (3 * mp.pi), mp.mpf(2) / 3 - 28 / (15 * mp.pi)
        A = 1 / (1 + one * r)

        def E(w):
            c, s = w[2], mp.sqrt(1 - w[2] ** 2)
            G = s * (mp.acos(c) - s * c) + mp.mpf(2) / 3 * (s / c * (1 - s**3) - s)
            return A * (1 + r * G / mp.pi)

        for o, i in zip(wo, wi, strict=True):
            o, i = book.vector(o), book.vector(i)
            s = o[0] * i[0] + o[1] * i[1]
            single = A * (1 + r * (s / max(o[2], i[2]) if s > 0 else s)) / mp.pi
            mean = A * (1 + two * r)
            lobe = (1 - E(o)) * (1 - E(i)) / (1 - mean) / mp.pi
            expected.append([a * single + a * a * mean / (1 - a * (1 - mean)) * lobe for a in model.albedo])
    assert_close(model.f(wo, wi), expected, model)


# --- another renderer ------------------------------------------------------------------------------------------------

MITSUBA_TOLERANCE = 1e-5
"""Relative. Float32 half vectors: their slopes are off by 6e-8 / (alpha cos), at most 2.4e-6 in units of alpha, at the rho
of 2 and less here; Beckmann's exponent by 2 rho times that, GGX's density by at most 2.6 times; and a dozen roundings."""


@pytest.mark.parametrize("alpha", [(0.05, 0.05), (0.3, 0.3), (0.7, 0.1), (0.1, 0.5)], ids=str)
@pytest.mark.parametrize("ndf", CHOICES["ndf"].options)
@np.errstate(under="ignore")
def test_mitsuba_roughconductor(ndf, alpha):
    """Mitsuba 3's G is separable, its G1 of Beckmann Walter's fit, in its pdf too; its eval includes the cosine."""
    mi = pytest.importorskip("mitsuba")
    mi.set_variant("scalar_rgb")
    model = Microfacet(alpha=alpha, ndf=ndf, smith="rational", shadowing="separable")
    spectrum = {name: {"type": "rgb", "value": list(getattr(model, name))} for name in ("eta", "k")}
    names = {
        "type": "roughconductor",
        "distribution": ndf,
        "alpha_u": alpha[0],
        "alpha_v": alpha[1],
        "sample_visible": True,
    }
    other = mi.load_dict({**names, **spectrum})
    rng = np.random.default_rng(2)
    wo = direction(np.arccos(rng.uniform(0.1, 1, 400)), rng.uniform(0, 2 * np.pi, 400))
    rho, psi = 2 * np.sqrt(rng.random(400)), rng.uniform(0, 2 * np.pi, 400)
    wm = vec(alpha[0] * rho * np.cos(psi), alpha[1] * rho * np.sin(psi), np.ones(400))
    wm /= np.linalg.norm(wm, axis=1)[:, None]
    wi = 2 * np.sum(wo * wm, axis=1)[:, None] * wm - wo
    up = wi[:, 2] > 0.1
    for w in (wo, wi):  # where the fit of G1 exceeds 1, Mitsuba's does
        a = w[:, 2] / np.hypot(alpha[0] * w[:, 0], alpha[1] * w[:, 1])
        up &= (ndf == "ggx") | (a < 1.548) | (a > 1.6)
    wo, wi = (np.float32(w[up]).astype(float) for w in (wo, wi))
    assert len(wo) > 100
    context, at = mi.BSDFContext(), mi.SurfaceInteraction3f()
    eval, pdf = [], []
    for o, i in zip(wo, wi, strict=True):
        at.wi = mi.Vector3f(o)
        eval.append(np.array(other.eval(context, at, mi.Vector3f(i))))
        pdf.append(other.pdf(context, at, mi.Vector3f(i)))
    np.testing.assert_allclose(np.array(eval), model.f(wo, wi) * wi[:, 2:], rtol=MITSUBA_TOLERANCE)
    alpha = np.array(alpha)
    fitted = wo[:, 2] * (1 + slot("smith", ndf, "rational").Lambda(wo, alpha))
    expected = model.pdf(wo, wi) * slot("ndf", ndf).visible_area(wo, alpha) / fitted
    np.testing.assert_allclose(np.array(pdf), expected, rtol=MITSUBA_TOLERANCE)

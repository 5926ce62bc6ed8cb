"""Regimes: the corners of their arguments in which formulas fail in float32, and how arguments are drawn there.

A draw maps points u (n, 4) of the unit cube, the number of an argument's components and the arguments drawn before to values
(n, components). So a search can move in the cube.
"""

from dataclasses import dataclass

import numpy as np

from ..lib.common import TWO_PI, dot, mirror, normalize, vec
from ..lib.fresnel import eta2_cos2_t
from ..lib.microfacet import cos_facet
from ..lib.refraction import refracted

LIMIT = 1e-4
"""The relative error that ours must not exceed where the function is well conditioned."""
UNIT = 2.0**-24
"""The relative error of a number that is rounded to float32."""
TINY = float(np.finfo(np.float32).tiny)


def decades(low, high):
    return lambda u, size, drawn: low * (high / low) ** u[:, :size]


def linear(low, high):
    return lambda u, size, drawn: low + (high - low) * u[:, :size]


def some(share, draw, other):
    """`draw` for a share of the points, by the last coordinate, else another."""
    return lambda u, size, drawn: np.where(u[:, 3:] < share, draw(u, size, drawn), other(u, size, drawn))


def about(value, draw):
    """Numbers on either side of a value, the distance drawn."""

    def either(u, size, drawn):
        off = draw(np.abs(2 * u - 1), size, drawn)
        return value + np.where(u[:, :size] < 0.5, -off, off)

    return either


def direction(cosine):
    """Unit vectors by a draw of their cosine."""

    def draw(u, size, drawn):
        z = cosine(u, 1, drawn)[:, 0]
        r, phi = np.sqrt((1 - z) * (1 + z)), TWO_PI * u[:, 1]
        return vec(r * np.cos(phi), r * np.sin(phi), z)

    return draw


def about_normal(sine):
    """Unit vectors by a draw of their sine."""

    def draw(u, size, drawn):
        r, phi = sine(u, 1, drawn)[:, 0], TWO_PI * u[:, 1]
        return vec(r * np.cos(phi), r * np.sin(phi), np.sqrt((1 - r) * (1 + r)))

    return draw


def normals(slope):
    """Facets' normals by a draw of their slope, in units of alpha where there is one."""

    def draw(u, size, drawn):
        rho, psi = slope(u, 1, drawn)[:, 0], TWO_PI * u[:, 1]
        alpha = drawn.get("alpha", np.full((len(u), 2), 0.3))
        return normalize(vec(alpha[:, 0] * rho * np.cos(psi), alpha[:, 1] * rho * np.sin(psi), np.ones(len(u))))

    return draw


def reflected(slope, share=1.0):
    """Directions that facets of a drawn slope reflect wo to, for a share of the points; others, and those below, anywhere."""

    def draw(u, size, drawn):
        z, phi = 0.05 + 0.95 * u[:, 0], TWO_PI * u[:, 1]
        r = np.sqrt((1 - z) * (1 + z))
        anywhere = vec(r * np.cos(phi), r * np.sin(phi), z)
        if "wo" not in drawn:
            return anywhere
        wi = mirror(drawn["wo"], normals(slope)(u, 3, drawn))
        return np.where(((wi[:, 2] > 1e-9) & (u[:, 3] < share))[:, None], wi, anywhere)

    return draw


def near(signs, off):
    """Directions next to wo, or a ray w, with the signs of its components changed, turned by `off`; opposite at any height."""

    def draw(u, size, drawn):
        w = drawn.get("wo", drawn.get("w")) * signs
        turn = off(np.abs(2 * u - 1), 1, drawn)[:, 0] * np.where(u[:, 0] < 0.5, -1, 1)
        if np.all(np.asarray(signs) == (-1, -1, 1)):
            z = np.minimum(w[:, 2] * 10.0 ** (4 * u[:, 1] - 2), 0.5)
        else:
            z = np.clip(w[:, 2] * (1 + off(u[:, 1:], 1, drawn)[:, 0] * np.where(u[:, 2] < 0.5, -1, 1)), 1e-9, 1.0)
        phi = np.arctan2(w[:, 1], w[:, 0]) + turn
        r = np.sqrt((1 - z) * (1 + z))
        return vec(r * np.cos(phi), r * np.sin(phi), z)

    return draw


def critical(off):
    """Indices at which the facet's cosine is next to the critical angle's."""

    def draw(u, size, drawn):
        if "c" in drawn:
            c = drawn["c"]
        else:
            c = cos_facet(drawn["wo"], drawn["wi"]) if "wi" in drawn else 0.05 + 0.95 * u[:, 3]
        sine = np.sqrt(np.maximum((1 - c) * (1 + c), 0.0025))
        return np.clip(sine[:, None] * about(1.0, off)(u, size, drawn), 0.05, 0.99)

    return draw


def unequal(u, size, drawn):
    fine, rough = decades(1e-6, 1e-2)(u, 1, drawn), linear(0.3, 1.0)(u[:, 1:], 1, drawn)
    pair = np.concatenate([fine, rough], axis=1)
    return np.where(u[:, 3:] < 0.5, pair, pair[:, ::-1])


def alike(draw):
    """Half of the pairs of one number."""
    return lambda u, size, drawn: np.where(
        u[:, 3:] < 0.5, draw(u[:, :1], 1, drawn).repeat(size, 1), draw(u, size, drawn)
    )


def through(slope):
    """Directions below the surface that facets of a drawn slope refract wo to; where there is none, anywhere below."""

    def draw(u, size, drawn):
        z, phi = 0.05 + 0.95 * u[:, 0], TWO_PI * u[:, 1]
        r = np.sqrt((1 - z) * (1 + z))
        anywhere = vec(r * np.cos(phi), r * np.sin(phi), -z)
        wm, eta = normals(slope)(u, 3, drawn), drawn["eta"]
        w = refracted(drawn["wo"], wm, eta)
        c = dot(drawn["wo"], wm)
        passes = (c > 1e-3) & (eta2_cos2_t(c, eta) > 0) & (w[:, 2] < -1e-9)
        return np.where(passes[:, None], w, anywhere)

    return draw


def sum_of_refraction(u, size, drawn):
    """The length of wo + eta wi, from straight to nearly grazing incidence."""
    eta = drawn["eta"][:, None]
    least, most = np.abs(eta - 1), 0.999 * np.sqrt(np.abs(eta - 1) * (eta + 1))
    return least * (most / least) ** u[:, :size]


def uniforms(draw):
    """Random numbers of 24 bits, as lib/random.glsl makes them, below 1."""
    return lambda u, size, drawn: np.minimum(np.round(draw(u, size, drawn) / UNIT) * UNIT, 1 - UNIT)


def ends(u, size, drawn):
    """Numbers next to 0 and to 1, and at times 0."""
    low = decades(UNIT / 4, 1e-2)(np.abs(2 * u - 1), size, drawn)
    return np.where(u[:, :size] < 0.5, low, 1 - low)


ZERO = linear(0.0, 0.0)
GRAZING = decades(1e-9, 0.03)
ORDINARY = {
    "alpha": alike(decades(0.05, 0.7)),
    "wo": direction(linear(0.05, 1.0)),
    "w": direction(linear(0.05, 1.0)),
    "m": direction(linear(0.05, 1.0)),
    "wm": normals(decades(1e-2, 4.0)),
    "wi": reflected(decades(1e-2, 4.0), 0.6),
    "u": uniforms(linear(0.01, 0.99)),
    "c": linear(0.05, 1.0),
    "eta": linear(1.2, 4.0),
    "k": linear(0.5, 8.0),
    "Lambda_o": decades(1e-3, 10.0),
    "Lambda_i": decades(1e-3, 10.0),
    "density": decades(1e-3, 1e3),
    "lost_o": decades(1e-8, 0.7),
    "lost_i": decades(1e-8, 0.7),
    "lost_mean": decades(1e-8, 0.7),
    "F0": linear(0.02, 1.0),
    "F": linear(0.02, 1.0),
    "F_1": linear(0.02, 1.0),
    "F_2": linear(0.02, 1.0),
    "F_3": linear(0.02, 1.0),
    "depth": decades(1e-2, 10.0),
    "area": linear(0.05, 1.0),
    "hidden": decades(1e-3, 1.0),
    "wt": through(decades(1e-2, 4.0)),
    "cos_o": linear(0.05, 1.0),
    "cos_t": linear(0.05, 1.0),
    "L": sum_of_refraction,
}
"""Where nothing special happens. A parameter of a model that is not here is drawn from its range."""


@dataclass(frozen=True)
class Regime:
    """A corner of the arguments.

    head     two short lines for the head of a column
    draws    how some arguments are drawn there; others are ordinary
    needs    arguments that a function must have to be concerned; else one of `draws` is enough
    half     values are stored as float16
    below    of functions of a model that transmits, whose light then comes from below
    """

    name: str
    head: tuple[str, str]
    doc: str
    draws: dict
    needs: tuple[str, ...] = ()
    half: bool = False
    below: bool = False

    def concerns(self, subject):
        names = subject.arguments
        if self.below and not subject.model.transmits:
            return False
        if self.half and not subject.is_model:
            return False
        return all(n in names for n in self.needs) and any(n in names for n in self.draws)

    @property
    def largest(self):
        """The largest value that is not rounded to infinity."""
        return 65519.0 if self.half else float(np.finfo(np.float32).max)

    @property
    def tiny(self):
        return 2.0**-14 if self.half else TINY

    @property
    def limit(self):
        return LIMIT + 2.0**-11 * self.half


REGIMES = {
    r.name: r
    for r in (
        Regime("ordinary", ("ordi-", "nary"), "nothing special", ORDINARY),
        Regime(
            "grazing_o",
            ("ωo", "grazes"),
            "viewer down to a cosine of 1e-9",
            {"wo": direction(GRAZING), "w": direction(GRAZING), "c": GRAZING, "Lambda_o": decades(1.0, 1e9)},
        ),
        Regime(
            "grazing_i",
            ("ωi", "grazes"),
            "light down to a cosine of 1e-9",
            {"wi": direction(GRAZING), "Lambda_i": decades(1.0, 1e9)},
        ),
        Regime(
            "grazing_both",
            ("both", "graze"),
            "viewer and light down to a cosine of 1e-9",
            {
                "wo": direction(GRAZING),
                "wi": some(0.5, direction(GRAZING), reflected(decades(1e-3, 10.0))),
                "Lambda_o": decades(1.0, 1e9),
                "Lambda_i": decades(1.0, 1e9),
            },
            ("wo", "wi"),
        ),
        Regime(
            "opposite",
            ("ωi near", "-ωo"),
            "light nearly opposite to the viewer, both grazing",
            {"wo": direction(decades(1e-7, 0.1)), "wi": near((-1, -1, 1), decades(1e-9, 0.1))},
            ("wo", "wi"),
        ),
        Regime(
            "mirror",
            ("mirror,", "normal"),
            "normal incidence, and light in the mirror direction, down to angles of 1e-9",
            {
                "wo": some(0.5, about_normal(decades(1e-9, 1e-2)), ORDINARY["wo"]),
                "w": about_normal(decades(1e-9, 1e-2)),
                "wm": about_normal(decades(1e-9, 1e-2)),
                "wi": some(0.5, near((-1, -1, 1), ZERO), reflected(decades(1e-9, 1e-2))),
                "c": lambda u, size, drawn: 1 - decades(1e-8, 1e-2)(u, size, drawn),
                "Lambda_o": decades(1e-12, 1e-3),
                "Lambda_i": decades(1e-12, 1e-3),
            },
        ),
        Regime(
            "equal",
            ("ωi near", "ωo"),
            "light next to the viewer, down to angles of 1e-9",
            {"wi": near((1, 1, 1), decades(1e-9, 1e-2))},
            ("wo", "wi"),
        ),
        Regime(
            "alpha_0",
            ("α", "to 0"),
            "alpha from 1e-3 down to 1e-6",
            {"alpha": alike(decades(1e-6, 1e-3))},
        ),
        Regime(
            "alpha_1",
            ("α", "to 1"),
            "alpha of 0.9 up to exactly 1",
            {"alpha": alike(lambda u, size, drawn: np.minimum(0.9 + 0.12 * u[:, :size], 1.0))},
        ),
        Regime(
            "anisotropic",
            ("αx, αy", "apart"),
            "alpha of 1e-6 to 1e-2 along one axis, 0.3 to 1 along the other",
            {"alpha": unequal},
        ),
        Regime(
            "eta_1",
            ("η", "to 1"),
            "index within 1e-1 down to 1e-7 of 1, k as small or 0",
            {"eta": about(1.0, decades(1e-7, 0.1)), "k": some(0.5, ZERO, decades(1e-7, 0.1))},
            ("eta",),
        ),
        Regime(
            "total",
            ("η < 1", "total"),
            "index below 1 where total reflection begins, within 1e-7 of it and farther, k small or 0",
            {"eta": critical(decades(1e-7, 0.9)), "k": some(0.7, ZERO, decades(1e-9, 1e-2))},
            ("eta",),
        ),
        Regime(
            "k_0",
            ("k", "to 0"),
            "k of 1e-2 down to 1e-9, any index",
            {"k": decades(1e-9, 1e-2), "eta": linear(0.05, 4.0)},
            ("k",),
        ),
        Regime(
            "through",
            ("through", "it"),
            "light from below the surface, refracted by facets of all slopes, any index",
            {"eta": decades(0.3, 4.0), "wi": through(decades(1e-3, 4.0)), "wt": through(decades(1e-3, 4.0))},
            ("eta",),
            below=True,
        ),
        Regime(
            "straight",
            ("through,", "η to 1"),
            "light from below the surface, nearly straight through: index within 1e-1 down to 1e-4 of 1",
            {
                "eta": about(1.0, decades(1e-4, 0.1)),
                "wi": through(decades(1e-3, 4.0)),
                "wt": through(decades(1e-3, 4.0)),
            },
            ("eta",),
            below=True,
        ),
        Regime(
            "tails",
            ("pdf", "to 0"),
            "normals far out in the tail of D, and random numbers next to 0 and 1",
            {
                "wm": normals(decades(1.0, 1e4)),
                "wi": reflected(decades(1.0, 1e4)),
                "u": uniforms(ends),
                "density": decades(1e-30, 1e-6),
            },
        ),
        Regime(
            "half",
            ("half", "float"),
            "values stored as float16, alpha of 1e-4 to 1",
            {"alpha": alike(decades(1e-4, 1.0)), "wo": direction(decades(1e-3, 1.0))},
            ("wo",),
            half=True,
        ),
    )
}
FIRST = ("alpha", "wo", "w", "wm", "c", "wi", "eta")
"""Arguments that others are drawn by, in this order."""

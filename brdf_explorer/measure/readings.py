"""Where the lecture's formulas have two readings: both, over an angle, and what the wrong one costs.

Each reading takes the active model where its question arises there, else an example; of a model without facets, or whose alpha
is the same along x and y, nothing could be seen. Every value is of the project's own functions and quadrature.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np

from ..lib import slot
from ..lib.common import length, normalize
from ..lib.fresnel import F_dielectric
from ..lib.microfacet import cos_facet
from ..lib.spheres import sphere_c, sphere_s
from ..lib.srgb import luminance
from ..model import Model
from ..models import MODELS
from . import half_space
from .albedo import quadrature
from .grid import direction
from .microsurface import facets
from .mirror_limit import without_facets
from .steps import Steps

MICROFACET = MODELS["microfacet"]
EXAMPLES = {
    "stretching": MICROFACET(alpha=(0.2, 0.7), fresnel="one"),
    "correlated": MICROFACET(alpha=(1.0, 1.0), fresnel="one"),
    "fresnel": MICROFACET(alpha=(0.5, 0.5), eta=(1.5, 1.5, 1.5), k=0.0, fresnel="dielectric"),
    "mirrors": MICROFACET(alpha=(0.5, 0.5), eta=(1.5, 1.5, 1.5), k=0.0, fresnel="dielectric"),
    "slope": MICROFACET(alpha=(0.5, 0.5), ndf="beckmann"),
    "fourier": MODELS["diffuse"](albedo=(0.8, 0.8, 0.8), diffuse="lambert_sphere"),
    "slab": MICROFACET(eta=(1.5, 1.5, 1.5), k=0.0, fresnel="dielectric"),
}
"""The material of a reading where the active one does not raise its question."""
NORMAL = np.array([0.0, 0.0, 1.0])
GRAZING = np.radians(89.0)
COARSE, FINE = (9, 16, 24), (41, 32, 96)
"""Efforts: angles on a curve; rays, and directions a ray, of an albedo on it, and of one among the costs.

For alpha of 0.02 and more, and not above 30 times across the grain, FINE's errors are 2e-3 on curves and 1e-4 of costs.
"""


@dataclass(frozen=True)
class Cost:
    """A quantity, and its values by the printed reading and by the right one."""

    name: str
    printed: float
    right: float


@dataclass(frozen=True)
class Found:
    """What a reading does to a material.

    model    the material that it is shown for, and `about` it, the parameters that count, in words
    x        (n,) degrees, of the angle `angle`; viewer: where on it the viewer is, or None
    curves   name -> (n,) of `quantity`: "printed", "right", and others beside these
    costs    what the printed one costs
    """

    model: Model
    about: str
    angle: str
    x: np.ndarray
    quantity: str
    curves: dict
    costs: tuple
    viewer: float | None = None


@dataclass(frozen=True)
class Reading:
    """applies(model): why the question does not arise for a model, or "".

    find(model, theta_o, phi_o, effort): a generator that yields None after each short step and returns the Found.
    """

    applies: Callable
    find: Callable


@lru_cache(maxsize=16)
def finding(name, model, theta_o, phi_o, effort=FINE):
    """The Steps to (Found, why it is of the example and not of this model, or ""), for a viewer's angles in radians."""

    def steps():
        why = READINGS[name].applies(model)
        return (yield from READINGS[name].find(EXAMPLES[name] if why else model, theta_o, phi_o, effort)), why

    return Steps(steps())


def found(name, model, theta_o, phi_o, effort=FINE):
    """What `finding` finds."""
    return finding(name, model, theta_o, phi_o, effort).all()


# --- whether a question arises ---------------------------------------------------------------------------------------


def without_mirrors(model):
    """Why facets of a model are not the lecture's: mirrors that light meets once."""
    return "" if isinstance(model, MICROFACET) else without_facets(model) or "its facets are no mirrors"


def is_stretched(model):
    return without_mirrors(model) or ("alpha is the same along x and y" if model.alpha[0] == model.alpha[1] else "")


def reflects_a_part(model):
    return without_mirrors(model) or ("facets reflect all" if model.fresnel == "one" else "")


def is_of_gaussian_heights(model):
    return without_mirrors(model) or ("" if model.ndf == "beckmann" else "slopes of GGX have no rms")


def is_of_spheres(model):
    return "" if getattr(model, "diffuse", "").startswith("lambert_sphere") else "no body of spheres"


def is_dielectric(model):
    return without_mirrors(model) or ("k is not 0" if max(model.k) > 0 else "")


# --- what several readings need --------------------------------------------------------------------------------------


def Lambda(model):
    """Smith's Lambda of a model, of directions (..., 3)."""
    of_w = slot("smith", model.ndf, model.smith).Lambda
    return lambda w: of_w(w, np.array(model.alpha))


def joint(shadowing, Lambda):
    """G(wo, wi) by a choice of shadowing."""
    G2 = slot("shadowing", shadowing).G2
    return lambda wo, wi: G2(wo, wi, Lambda(wo), Lambda(wi))


def white(model, G):
    """f of a model with F = 1 and masking and shadowing G(wo, wi)."""
    D = slot("ndf", model.ndf).D
    return lambda wo, wi: D(wo + wi, np.array(model.alpha)) * G(wo, wi) / (4 * wo[..., 2] * wi[..., 2])


def coloured(model):
    """The luminance of f."""
    return lambda wo, wi: luminance(model.f(wo, wi))


def to_grazing(n):
    """Angles (n,) from 0 to 89 degrees, close together where curves bend."""
    return 89.0 * np.sin(np.linspace(0.0, np.pi / 2, n))


def energy(model, values, wo, n):
    """Directional albedos, of each value(wo, wi) (...) one, for one wo (3,), by n rays of n directions."""
    g, weight = quadrature(wo, model.alpha, n)
    return [float(np.sum(value(wo, g.wi) * g.wi[..., 2] * weight)) for value in values]


def energies(model, values, phi_o, effort):
    """The angles (n,) of viewers, degrees, and of each value(wo, wi) the directional albedo (n,); a generator, as find."""
    theta = np.radians(to_grazing(effort[0]))
    albedos = []
    for wo in direction(theta, phi_o):
        albedos.append(energy(model, values, wo, effort[1]))
        yield
    return np.degrees(theta), np.transpose(albedos)


def exchanged(wo, *parts):
    """The Cost of an exchange of light and viewer, one along the normal, by the part of f(wo, wi) that differs: G or F."""
    pairs = [(part(wo, NORMAL), part(NORMAL, wo)) for part in parts]
    return Cost("exchange: f(ωo, n) / f(n, ωo)", *(float(there / back) for there, back in pairs))


def by_albedo(model, about, f, theta_o, phi_o, effort, what, other):
    """The Found of some f(wo, wi) by name, by their directional albedos, called `what`, and one more Cost; as find."""
    x, curves = yield from energies(model, f.values(), phi_o, effort)
    two = f["printed"], f["right"]
    at = {f"{what} E(ωo)": theta_o, f"{what} at 89°": GRAZING}
    costs = []
    for name, theta in at.items():
        costs.append(Cost(name, *energy(model, two, direction(theta, phi_o), effort[2])))
        yield
    curves = dict(zip(f, curves, strict=True))
    return Found(model, about, "θo", x, f"{what} E(ωo)", curves, (*costs, other), np.degrees(theta_o))


def roughness(model):
    """The slopes' distribution and scale in words."""
    ax, ay = model.alpha
    name = {"ggx": "GGX", "beckmann": "Beckmann"}[model.ndf]
    return f"{name}, α = {ax:.3g}" if ax == ay else f"{name}, αx = {ax:.3g}, αy = {ay:.3g}"


def index(model):
    """The index of refraction in words, if it is one number."""
    return f", η = {model.eta[0]:.3g}" if len(set(model.eta)) == 1 and max(model.k) == 0 else ""


# --- the readings ----------------------------------------------------------------------------------------------------


def isotropic_Lambda(model, w, x):
    """Lambda of the isotropic surface of alpha_y at the direction w (..., 3), its first component times x."""
    ay = model.alpha[1]
    return slot("smith", model.ndf, model.smith).Lambda(normalize(w * np.array([x, 1.0, 1.0])), np.array([ay, ay]))


def stretching(model, theta_o, phi_o, effort):
    """The factor of a direction's x: alpha_y / alpha_x as printed, or its inverse. Heitz 2014, section 5.3."""
    ax, ay = model.alpha
    factor = {"printed": ay / ax, "right": ax / ay}
    x = to_grazing(effort[0])
    w = direction(np.radians(x), phi_o)
    curves = {name: 1 / (1 + isotropic_Lambda(model, w, s)) for name, s in factor.items()}
    yield
    wo = direction(theta_o, phi_o)
    costs = [Cost("Λ(ωo)", *(float(isotropic_Lambda(model, wo, s)) for s in factor.values()))]
    f = [white(model, joint(model.shadowing, partial(isotropic_Lambda, model, x=s))) for s in factor.values()]
    costs.append(Cost("white furnace E(ωo)", *energy(model, f, wo, effort[2])))
    wm, solid_angle = facets(NORMAL, model.alpha, 128)
    v = wm * np.array([ay / ax, 1.0, 1.0])
    D = slot("ndf", model.ndf).D(v, np.array([ay, ay])) * wm[..., 2] * solid_angle
    areas = float(np.sum(D)), float(np.sum(D * ay / ax / length(v) ** 4))
    costs.append(Cost("∫ D cos θ dω, without and with sx / |v|⁴", *areas))
    return Found(
        model, roughness(model), "θ", x, "G1(ω) at the viewer's azimuth", curves, tuple(costs), np.degrees(theta_o)
    )


def correlated(model, theta_o, phi_o, effort):
    """G of the light alone as printed, the smaller of both as it is meant, or by the heights' correlation."""
    smith = Lambda(model)
    G = {
        "printed": lambda wo, wi: 1 / (1 + smith(wi)),
        "right": joint("full", smith),
        "by heights": joint("correlated", smith),
    }
    f = {name: white(model, joined) for name, joined in G.items()}
    exchange = exchanged(direction(theta_o, phi_o), G["printed"], G["right"])
    return (yield from by_albedo(model, roughness(model), f, theta_o, phi_o, effort, "white furnace", exchange))


def fresnel(model, theta_o, phi_o, effort):
    """Fresnel's reflectance at the viewer's angle as printed, or at the facet."""

    def F(c):
        return luminance(slot("fresnel", model.slots()["fresnel"]).F(c, np.array(model.eta), np.array(model.k)))

    unpainted = white(model, joint(model.shadowing, Lambda(model)))
    f = {"printed": lambda wo, wi: unpainted(wo, wi) * F(wo[..., 2]), "right": coloured(model)}
    wo = direction(theta_o, phi_o)
    exchange = exchanged(wo, lambda o, i: F(o[..., 2]), lambda o, i: F(cos_facet(o, i)))
    return (yield from by_albedo(model, roughness(model) + index(model), f, theta_o, phi_o, effort, "albedo", exchange))


def mirrors(model, theta_o, phi_o, effort):
    """Facets that are mirrors: with the f_mf that the lecture prints, without F, or with F."""
    f = {"printed": white(model, joint(model.shadowing, Lambda(model))), "right": coloured(model)}
    peak = Cost("f(n, n) [1/sr]", *(float(value(NORMAL, NORMAL)) for value in f.values()))
    return (yield from by_albedo(model, roughness(model) + index(model), f, theta_o, phi_o, effort, "albedo", peak))


AUTOCORRELATIONS = {
    "σ² exp(−r² / 2τ²)": lambda r: np.exp(-(r**2) / 2),
    "σ² exp(−r² / τ²)": lambda r: np.exp(-(r**2)),
}
"""Those that are in use for heights, of r in tau, over sigma^2."""


def slope_scale(autocorrelation, step=1e-3):
    """alpha of Gaussian heights over sigma / tau: the gradient's mean square is -2 C''(0) for an isotropic C."""
    return float(np.sqrt(-2 * 2 * (autocorrelation(step) - autocorrelation(0.0)) / step**2))


def slope(model, theta_o, phi_o, effort):
    """alpha as sqrt(2) sigma / tau where tau is that of the other autocorrelation, or as the mean slope; and alpha."""
    along = float(np.hypot(model.alpha[0] * np.cos(phi_o), model.alpha[1] * np.sin(phi_o)))
    D, smith = slot("ndf", "beckmann").D, slot("smith", "beckmann", "exact").Lambda
    scale = [slope_scale(C) for C in AUTOCORRELATIONS.values()]
    wm, solid_angle = facets(NORMAL, (along, along), 128)
    area = D(wm, np.array([along, along])) * wm[..., 2] * solid_angle
    steep = length(wm[..., :2]) / wm[..., 2]
    mean, square = float(np.sum(area * steep)), float(np.sum(area * steep**2))
    yield
    alphas = {"printed": along * scale[0] / scale[1], "right": along, "α = mean slope": mean}
    x = np.linspace(0.0, min(np.degrees(np.arctan(3 * along)), 89.0), effort[0])
    wm, wo = direction(np.radians(x), 0.0), direction(theta_o, 0.0)
    curves = {name: D(wm, np.array([a, a])) for name, a in alphas.items()}
    pairs = [(curves[name][0], 1 / (1 + smith(wo, np.full(2, alphas[name])))) for name in ("printed", "right")]
    (peak, seen), (right_peak, right_seen) = np.array(pairs, dtype=float).tolist()
    costs = (
        Cost("α of heights with σ² exp(−r² / τ²)", alphas["printed"], along),
        Cost("D along the normal [1/sr]", peak, right_peak),
        Cost("G1(ωo)", seen, right_seen),
        Cost("|grad h|: mean, and rms = α", mean, float(np.sqrt(square))),
    )
    return Found(model, f"Beckmann, α = {along:.3g}", "θm", x, "D(ωm) [1/sr]", curves, costs)


def fourier(model, theta_o, phi_o, effort):
    """Eq. 27 as the factor of cos(phi), or as the Fourier coefficient that it is, which counts twice."""
    albedo = float(luminance(np.array(model.albedo)))
    c, s = float(sphere_c(albedo)), float(sphere_s(albedo))
    x = np.linspace(0.0, 180.0, effort[0])
    wo = direction(theta_o, 0.0)

    def both(theta_i, phi):
        return [half_space.f(wo, direction(theta_i, phi), s, doubled=doubled) for doubled in (False, True)]

    curves = dict(zip(("printed", "right"), both(theta_o, np.radians(x)), strict=True))
    yield
    costs = [
        Cost("f at θi = 85°, φ = 180° [1/sr]", *map(float, both(np.radians(85.0), np.pi))),
        Cost("f at θi = θo, φ = 180° [1/sr]", *map(float, both(theta_o, np.pi))),
        Cost("f at θi = θo, φ = 0° [1/sr]", *map(float, both(theta_o, 0.0))),
    ]
    return Found(model, f"c = {c:.4g}", "φ between ωi and ωo, θi = θo", x, "f [1/sr]", curves, tuple(costs))


PASS = 0.9
"""What is left of light that crosses an absorbing slab once, in an example."""


def slab_series(R, share=1.0, terms=400):
    """(R', T') of a slab by its series, bounce by bounce: `share` is what is left of light that crosses it once."""
    inside = (1 - R) * share  # arrives at the far side
    reflected, transmitted = R, 0.0
    for _ in range(terms):
        transmitted = transmitted + inside * (1 - R)
        inside = inside * R * share  # at the near side
        reflected = reflected + inside * (1 - R)
        inside = inside * R * share
    return reflected, transmitted


def slab_closed(R):
    """R' as printed, with T = 1 - R."""
    T = 1 - np.float64(R)
    with np.errstate(invalid="ignore"):
        return R + T * T * R / (1 - R * R)


def slab(model, theta_o, phi_o, effort):
    """The third term of the transmitted series as printed, T R R R T T, or T R R R R T."""
    eta = float(model.eta[1])
    x = to_grazing(effort[0])

    def third(theta):
        R = F_dielectric(np.cos(theta), eta)
        T = 1 - R
        return T * R * R * R * T * T, T * R * R * R * R * T

    yield
    R = float(F_dielectric(np.cos(theta_o), eta))
    reflected, transmitted = slab_series(R, PASS)
    costs = (
        Cost("third term of T'", *map(float, third(theta_o))),
        Cost("R' where R = 1", float(slab_closed(1.0)), slab_series(1.0)[0]),
        Cost(f"T', {1 - PASS:.0%} absorbed a pass", 1 - reflected, transmitted),
    )
    curves = dict(zip(("printed", "right"), third(np.radians(x)), strict=True))
    return Found(model, f"η = {eta:.3g}", "θ", x, "third term of T'", curves, costs, np.degrees(theta_o))


READINGS = {
    "stretching": Reading(is_stretched, stretching),
    "correlated": Reading(without_mirrors, correlated),
    "fresnel": Reading(reflects_a_part, fresnel),
    "slope": Reading(is_of_gaussian_heights, slope),
    "mirrors": Reading(reflects_a_part, mirrors),
    "fourier": Reading(is_of_spheres, fourier),
    "slab": Reading(is_dielectric, slab),
}
"""The readings by name, in the lecture's order."""

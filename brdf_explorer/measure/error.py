"""How far one method is from another: errors of f over directions, and of pictures, each with its own error.

METRICS lists them. Those of values compare f on a grid of directions to the light that follows the lobe, for the viewers of
measure/laws.py; those of pictures compare linear arrays (H, W, 4), premultiplied by coverage, over the pixels that the
reference covers.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..lib.common import quotient
from ..lib.random import seeded
from ..lib.srgb import luminance
from ..model import Invalid
from .albedo import quadrature
from .itp import delta_e_itp
from .laws import viewers

RAYS = 64
"""Rays about the mirror direction, and directions a ray, of each viewer."""
MATTERS = 1e-3
"""f cos of the reference, over its largest for a viewer, from which on relative errors count."""
ESTIMATES = 4
"""Of a stochastic f for each direction; a metric of it holds their noise."""
ROUNDING = 1e-12
"""What rounding in float64 may add to an error of values: the limit of the law of reciprocity."""


class Measured(NamedTuple):
    """A value, and an estimate of its own error."""

    value: float
    error: float


@dataclass(frozen=True)
class Values:
    """f on the grids of all viewers, float64.

    f, back     f(wo, wi) and f(wi, wo), (viewers, rays, nodes, 3), the latter times n(wo)^2 / n(wi)^2 of their sides
    cosine      of wi, without its sign (viewers, rays, nodes)
    weight      solid angle, sr (viewers, rays, nodes)
    """

    f: np.ndarray
    back: np.ndarray
    cosine: np.ndarray
    weight: np.ndarray


def spread(model, alpha, n=RAYS):
    """Standard deviation of one sample's weight over its mean: sqrt(E[w^2] / E[w]^2 - 1), over colours and viewers.

    E[w^2] is the integral of (f cos)^2 / pdf; squares are averaged over viewers. n samples have a standard error of this over
    sqrt(n), so a method's time for an error goes as its cost times the square.
    """
    squares = []
    for wo in viewers():
        g, weight = quadrature(wo, alpha, n, model.index())
        with np.errstate(under="ignore"):
            f = model.f(wo, g.wi) * np.abs(g.wi[..., 2:])
            pdf = model.pdf(wo, g.wi)[..., None]
            mean = np.einsum("ptc,pt->c", f, weight)
            second = np.einsum("ptc,pt->c", f * quotient(f, pdf), weight)
        squares.append(second.sum() / np.sum(mean**2) - 1)
    return float(np.sqrt(max(np.mean(squares), 0.0)))


def values(evaluator, alpha, n=RAYS, wo=None, index=None, seed=0, estimates=ESTIMATES):
    """The Values of an evaluator, which has f(wo, wi), for slopes of scale alpha (2,); methods are compared at one alpha.

    wo: other viewers (viewers, 3) than those of the laws. index: as Model.index, for both sides of the surface.
    A stochastic f is the mean of some estimates, by the same random numbers for all methods, so that these differ by what they do
    and not by chance; another seed gives independent ones.
    """
    wo = viewers() if wo is None else wo
    grids, weight = zip(*(quadrature(w, alpha, n, index) for w in wo), strict=True)
    wi = np.stack([g.wi for g in grids])
    wo = wo[:, None, None]
    repeats = estimates if getattr(evaluator, "stochastic", False) else 1
    with seeded(seed):
        f, back = (
            sum(np.asarray(evaluator.f(*pair), dtype=float) for _ in range(repeats)) / repeats
            for pair in ((wo, wi), (wi, wo))
        )
    back = back * np.where(wi[..., 2:] < 0, (index or 1.0) ** -2.0, 1.0)
    return Values(f, back, np.abs(wi[..., 2]), np.stack(weight))


# --- errors of values ------------------------------------------------------------------------------------------------


def rmse(found, reference):
    """Root mean square of the difference of f cos over that of the reference's f cos, over wi, colours and viewers.

    A viewer's squares are taken relative to its own reference, so that all count alike.
    """
    with np.errstate(under="ignore"):
        weight = (found.weight * found.cosine**2)[..., None]
        square = np.sum((found.f - reference.f) ** 2 * weight, axis=(1, 2, 3))
        whole = np.sum(reference.f**2 * weight, axis=(1, 2, 3))
    return float(np.sqrt(np.mean(quotient(square, whole))))


def rmse_of_halves(one, other):
    """As `rmse`, of two independent halves of estimates, each (reference, found): squares are products of differences of both
    halves, to which noise adds nothing in the mean.
    """
    with np.errstate(under="ignore"):
        weight = (one[0].weight * one[0].cosine ** 2)[..., None]
        square = np.sum((one[1].f - one[0].f) * (other[1].f - other[0].f) * weight, axis=(1, 2, 3))
        whole = np.sum(one[0].f * other[0].f * weight, axis=(1, 2, 3))
    return float(np.sqrt(max(np.mean(quotient(square, whole)), 0.0)))


def largest(found, reference):
    """The largest relative error of f where the reference's f cos is at least MATTERS of its largest for that viewer."""
    with np.errstate(under="ignore"):
        seen = reference.f * reference.cosine[..., None]
        matters = seen >= MATTERS * seen.max(axis=(1, 2), keepdims=True)
        return float(np.max(np.where(matters, quotient(np.abs(found.f - reference.f), reference.f), 0.0)))


def energy(found, reference):
    """The largest difference of directional albedo, over viewers and colours."""
    weight = found.weight * found.cosine
    with np.errstate(under="ignore"):
        return float(np.max(np.abs(np.einsum("vptc,vpt->vc", found.f - reference.f, weight))))


def reciprocity(found, reference):
    """The largest |f(wo, wi) - f(wi, wo)| over the larger of the two, where the reference's f cos matters as in `largest`."""
    with np.errstate(under="ignore"):
        seen = reference.f * reference.cosine[..., None]
        matters = seen >= MATTERS * seen.max(axis=(1, 2), keepdims=True)
        error = quotient(np.abs(found.f - found.back), np.maximum(found.f, found.back))
    return float(np.max(np.where(matters, error, 0.0)))


# --- errors of pictures ----------------------------------------------------------------------------------------------


def checked(picture, reference):
    """Colours (n, 3) of both pictures where the reference has coverage. Raises Invalid for what cannot be compared."""
    picture, reference = np.asarray(picture, dtype=float), np.asarray(reference, dtype=float)
    if picture.shape != reference.shape or picture.ndim != 3 or picture.shape[-1] != 4:
        raise Invalid(
            f"pictures of shapes {picture.shape} and {reference.shape} cannot be compared: one (H, W, 4) expected"
        )
    for name, colors in (("picture", picture), ("reference", reference)):
        wrong = np.count_nonzero(~np.isfinite(colors).all(axis=-1))
        if wrong:
            raise Invalid(f"the {name} cannot be compared: {wrong} of its pixels are NaN or infinite")
        if colors.min(initial=0.0) < 0:
            raise Invalid(f"the {name} cannot be compared: it has values below 0")
    covered = reference[..., 3] > 0
    if not reference[covered][:, :3].any():
        raise Invalid("the reference is black: no error is relative to it")
    return picture[covered][:, :3], reference[covered][:, :3]


def picture_rmse(picture, reference):
    """Root mean square of the difference, over the reference's mean."""
    a, b = checked(picture, reference)
    return float(np.sqrt(np.mean((a - b) ** 2)) / b.mean())


def brightening(picture, reference):
    """The mean difference over the reference's mean: above 0 where the picture is brighter."""
    a, b = checked(picture, reference)
    return float((a - b).mean() / b.mean())


def picture_energy(picture, reference):
    """The size of `brightening`."""
    return abs(brightening(picture, reference))


def flip(picture, reference):
    """The mean of HDR-FLIP, 0 to 1, at its 67 pixels a degree. Andersson et al. 2021, "Visualizing Errors in Rendered High
    Dynamic Range Images"; by the package flip-evaluator.

    The exposures go from the one that shows the brightest pixel to the one that shows the median, as there, but the median is
    of the lit pixels: that of a sphere in the dark would be 0, and its exposure infinite.
    """
    import flip_evaluator

    _, lit = checked(picture, reference)
    brightness = luminance(lit)
    brightness = brightness[brightness > 0]
    start, stop = (float(np.log2(FLIP_WHITE / b)) for b in (brightness.max(), np.median(brightness)))
    a, b = (np.ascontiguousarray(p[..., :3], dtype=np.float32) for p in (picture, reference))
    options = {"startExposure": start, "stopExposure": stop}
    seen = flip_evaluator.evaluate(b, a, "HDR", applyMagma=False, computeMeanError=False, parameters=options)[0]
    return float(seen.reshape(b.shape[:2])[np.asarray(reference)[..., 3] > 0].mean())


FLIP_WHITE = 2.1188
"""The luminance that FLIP's tone curve, ACES by Narkowicz, shows as 0.85 of white: the end of its exposures."""


def itp(picture, reference):
    """The mean of Delta E ITP, 1 being shown at 203 cd/m2; coverage counts as black behind."""
    return float(np.mean(delta_e_itp(*checked(picture, reference))))


# --- all of them -----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Metric:
    """A measure of error.

    compares "values" or "pictures": function(found, reference) of two of these -> float; "samples": function(model, alpha, n).
    extreme  whether it is the largest of many values, not a mean, which noise makes larger
    """

    title: str
    compares: str
    function: Callable
    unit: str = ""
    extreme: bool = False


METRICS = {
    "rmse": Metric("relative RMSE of f cos θ", "values", rmse),
    "maximum": Metric("largest relative error of f", "values", largest, extreme=True),
    "energy": Metric("largest error of albedo", "values", energy),
    "reciprocity": Metric("largest error of reciprocity", "values", reciprocity, extreme=True),
    "spread": Metric("relative standard error of one sample", "samples", spread),
    "picture": Metric("relative RMSE of the sphere", "pictures", picture_rmse),
    "brightness": Metric("relative error of the sphere's mean", "pictures", picture_energy),
    "flip": Metric("HDR-FLIP of the sphere", "pictures", flip),
    "itp": Metric("ΔE ITP of the sphere", "pictures", itp),
}
"""The metrics by name: of values, of samples, of pictures."""


def between(metric, evaluator, reference, alpha, n=RAYS):
    """The error Measured by a Metric of values between two evaluators: its own error is the change from half the rays."""
    fine, coarse = (metric.function(values(evaluator, alpha, m), values(reference, alpha, m)) for m in (n, n // 2))
    return Measured(fine, abs(fine - coarse) + ROUNDING)

"""The estimator of the reflection equation, 1/N sum f L cos / pdf: its moments for each sampler, and its error in many runs.

All is luminance. L is 1, so that the estimate is of the albedo, or that of Surroundings.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..environment import Environment, environment, turn
from ..lib.common import HORIZON, normalize, quotient
from ..lib.environment import environment_radiance, pdf_environment, sample_environment
from ..lib.random import random2
from ..lib.srgb import luminance
from ..model import Choice, declared
from .albedo import quadrature
from .error import Measured

RUNS = 32
"""Independent runs of an estimator, whose errors are averaged: a root mean square over them is known to 1 / sqrt(2 RUNS)."""
FIRST = 16
"""Samples of a run at the first of its counts, which double."""
FITTED = 64
"""Samples from which on a slope is fitted: the mean square of few samples with rare large ones is too low in most runs."""
BATCH = 4096
"""Samples that are drawn in one step, which takes some milliseconds; a quarter of them by walks."""
KEPT = 2**15
"""Directions and weights of a sampler that are kept for its histograms."""
ROTATIONS = 16


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Light around a point of a surface: an Environment, the rotation (3, 3) from the local frame to its own, and a factor."""

    environment: Environment
    frame: np.ndarray
    gain: float = 1.0

    def radiance(self, wi):
        """Luminance (...) from the direction wi (..., 3)."""
        return self.gain * luminance(environment_radiance(self.environment.map, wi @ self.frame.T))

    def pdf(self, wi):
        return pdf_environment(self.environment.map, wi @ self.frame.T)

    def sample(self, u):
        """Directions (..., 3) in proportion to the radiance, from u (..., 2)."""
        return sample_environment(self.environment.map, self.environment.cdf, u)[0] @ self.frame


def surroundings(light, wo):
    """The Surroundings, in a State's Light, of the place on the sphere that the eye sees along wo in the place's frame.

    The frame is that of views/sphere.frag; None without environment.
    """
    if light.environment == "none" or light.gain <= 0:
        return None
    x, y, z = wo
    # the eye in the frame of a normal n is (-n.x / q, -n.y n.z / q, n.z) with q^2 = n.x^2 + n.z^2
    across = np.sqrt((1 - x) * (1 + x))
    normal = np.array([-x * z / across, -y / across, z])
    tangent = normalize(np.array([normal[2], 0.0, -normal[0]]))
    frame = np.stack([tangent, np.cross(normal, tangent), normal], axis=-1)
    return Surroundings(
        environment(light.environment, light.file), np.reshape(turn(light), (3, 3)).T @ frame, light.gain
    )


class Moments(NamedTuple):
    """The integral that is estimated, the second moment of each sampler's weights f L cos / pdf, and the errors of both."""

    mean: float
    mean_error: float
    second: np.ndarray
    second_error: np.ndarray

    @property
    def variance(self):
        """Of one sample, by sampler (n,)."""
        return np.maximum(self.second - self.mean**2, 0.0)


def samplers(model):
    """{name: model} for each way in which a model draws directions, and the name of its own.

    Of ways that draw the same directions the first stands for all: Beckmann has no caps, and draws visible normals instead.
    """
    choice = declared(model, Choice).get("sampling")
    if choice is None:
        return {"its own": model}, "its own"
    wo, u = np.array([0.6, 0.48, 0.64]), np.random.default_rng(1).random((16, 2))
    found, drawn = {}, {}
    for name in choice.options:
        variant = replace(model, sampling=name)
        wi = variant.sample_f(wo, u)[0].tobytes()
        if drawn.setdefault(wi, name) == name:
            found[name] = variant
    return found, drawn[model.sample_f(wo, u)[0].tobytes()]


def contribution(model, wo, wi, light):
    """Luminance of f L cos (...)."""
    value = luminance(model.f(wo, wi)) * np.abs(wi[..., 2])
    return value * (light.radiance(wi) if light else 1.0)


def _powers(models, wo, wi, light):
    """f L cos and, for each model's pdf, (f L cos)^2 / pdf, stacked (..., 1 + n)."""
    with np.errstate(under="ignore"):  # in the tails of a density
        value = contribution(models[0], wo, wi, light)
        return np.stack([value, *(quotient(value * value, m.pdf(wo, wi)) for m in models)], axis=-1)


def moments(models, wo, light=None, most=256):
    """Yield the Moments of a list of samplers for one viewer wo (3,), better and better; None after each short step between.

    With L = 1 by quadrature that follows the lobe, of `most` rays at last; its error is the difference from half as many. With
    Surroundings by points of a Kronecker sequence in random rotations, half of them drawn from the lobe and half from the
    light, weighed by the balance heuristic (Veach and Guibas 1995, Eq. 14); its error is the standard error over rotations.
    """
    yield from _among_light(models, wo, light, 32 * most) if light else _by_quadrature(models, wo, most)


def _by_quadrature(models, wo, most):
    before, n = None, 32
    while n <= most:
        g, weight = quadrature(wo, models[0].slopes(), n, models[0].index())
        rows, total = max(BATCH // n, 1), 0.0
        for i in range(0, len(weight), rows):
            total = total + np.einsum("ptc,pt->c", _powers(models, wo, g.wi[i : i + rows], None), weight[i : i + rows])
            yield None
        if before is not None:
            error = np.abs(total - before)
            yield Moments(float(total[0]), float(error[0]), total[1:], error[1:])
        before, n = total, 2 * n


def _among_light(models, wo, light, most):
    lobe = replace(models[0], sampling="visible") if "sampling" in models[0].choices() else models[0]
    pixel = np.stack([np.arange(ROTATIONS), np.zeros(ROTATIONS)], axis=-1)[:, None].astype(np.uint32)
    total, done, shown = 0.0, 0, 16
    while done < most:
        count = min(max(done, 16), 32)
        index = np.arange(done, done + count, dtype=np.uint32)[None]
        for stream, draw in ((1, lambda u: lobe.sample_f(wo, u)[0]), (2, light.sample)):
            yield None
            wi = draw(random2(pixel, index, stream))
            up = (np.abs(wi[..., 2]) if lobe.transmits else wi[..., 2]) > HORIZON
            wi = np.where(up[..., None], wi, [0.0, 0.0, 1.0])
            density = lobe.pdf(wo, wi) + light.pdf(wi)
            with np.errstate(under="ignore"):
                found = quotient(_powers(models, wo, wi, light), density[..., None])
                total = total + np.where(up[..., None], found, 0.0).sum(axis=1)
        done += count
        if done == shown:
            means = total / done
            value, error = means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(ROTATIONS)
            yield Moments(float(value[0]), float(error[0]), value[1:], error[1:])
            shown *= 2


class Runs:
    """RUNS independent runs of the estimator with one sampler.

    counts        numbers of samples, FIRST and then doubling
    estimates     of each count and run, (counts, RUNS)
    wi, weight    the first KEPT directions (n, 3) and their weights f cos / pdf (n,), 0 below the horizon
    """

    def __init__(self, model, wo, light=None, seed=1):
        self.model, self.wo, self.light = model, np.asarray(wo, dtype=float), light
        self.random = np.random.default_rng(seed)
        self.counts, self.estimates = [], np.zeros((0, RUNS))
        self.wi, self.weight = np.zeros((0, 3)), np.zeros(0)
        self.sums = np.zeros(RUNS)

    def double(self):
        """Draw as many samples as there are, in short steps: a generator that yields after each."""
        done = self.counts[-1] if self.counts else 0
        goal = 2 * done or FIRST
        while done < goal:
            n = min(goal - done, (BATCH // 4 if self.model.stochastic else BATCH) // RUNS)
            wi, weight = self.model.sample_f(self.wo, self.random.random((RUNS, n, 2)))
            weight = luminance(weight)
            self.sums += (weight * (self.light.radiance(wi) if self.light else 1.0)).sum(axis=1)
            done += n
            if len(self.weight) < KEPT:
                self.wi = np.concatenate([self.wi, wi.reshape(-1, 3)])
                self.weight = np.concatenate([self.weight, weight.ravel()])
            yield
        self.counts.append(goal)
        self.estimates = np.vstack([self.estimates, self.sums / goal])


def rms_error(estimates, mean):
    """Root mean square over runs (..., RUNS) of their error, over the mean: a Measured of arrays (...)."""
    squares = (estimates / mean - 1) ** 2
    value = np.sqrt(squares.mean(axis=-1))
    spread = squares.std(axis=-1, ddof=1) / np.sqrt(squares.shape[-1])
    return Measured(value, quotient(spread, 2 * value))


def slope(counts, estimates, mean):
    """Slope of log error against log N: a Measured, whose error is the jackknife's over runs (counts, RUNS)."""
    fitted = np.asarray(counts) >= FITTED
    x, estimates = np.log(np.asarray(counts)[fitted]), estimates[fitted]
    x = (x - x.mean()) / np.sum((x - x.mean()) ** 2)
    squares = (estimates / mean - 1) ** 2
    n = squares.shape[-1]
    left_out = x @ (0.5 * np.log((squares.sum(axis=-1, keepdims=True) - squares) / (n - 1)))
    error = np.sqrt((n - 1) / n * np.sum((left_out - left_out.mean()) ** 2))
    return Measured(float(x @ (0.5 * np.log(squares.mean(axis=-1)))), float(error))

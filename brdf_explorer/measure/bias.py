"""How far pictures of one model are from those of another, in float64: at places of the sphere's disc instead of pixels.

A pixel averages, so the error of a picture of any size up to LARGEST is at most that at places. Beyond that, towards the
silhouette, an f without masking has no bound, nor has its error. Squares are products of two independent halves, so that the
variance of the directions does not pass for bias.

Work is done in generators that yield every few milliseconds, and whose result is what `return` gives.
"""

from functools import cached_property
from math import inf
from typing import NamedTuple

import numpy as np

from ..environment import environment, toward, turn
from ..lib.common import HORIZON, dot, mirror, normalize, quotient, split, vec
from ..lib.environment import environment_lookup, sample_environment
from ..lib.ndf_ggx import D

SURE = 3.0
"""Standard errors between an estimate and its bounds."""
CHUNK = 512
"""Directions at which f is found between two yields."""
LARGEST = 4096
"""Pixels of a side of the largest pictures that the answer is for."""
EDGE = 1.0 - 0.5 / (0.46 * LARGEST)
"""Largest distance from the disc's centre, in radii, at which views/sphere.frag shades those."""
EYE = np.array([0.0, 0.0, 1.0])


class Estimate(NamedTuple):
    """An error and the bounds that it is surely between."""

    value: float
    low: float
    high: float


NONE = Estimate(0.0, 0.0, 0.0)


def surrounded(light):
    """Whether an environment shines."""
    return light.environment != "none" and light.gain > 0


class Places:
    """Places on the sphere, with directions to the light, at which all combinations are compared.

    Places are drawn evenly over the disc, towards its edge, about the highlight of the directional light, and where a mirror
    would show the bright parts of the environment; directions from the reference's f and from the environment, in two
    independent halves.
    """

    def __init__(self, state, count, rays, seed):
        rng = np.random.default_rng(seed)
        light, model = state.light, state.model
        self.irradiance, self.surrounded = light.irradiance, surrounded(light)
        self.toward = np.array(toward(light))
        parts = [(even(count, rng), lambda normal: np.ones(len(normal))), towards_edge(count, rng)]
        if self.irradiance > 0 and self.toward[2] > -1 + 1e-6:
            parts.append(about_highlight(self.toward, model.slopes(), count, rng))
        if self.surrounded:
            found = environment(light.environment, light.file)
            to_map = np.reshape(turn(light), (3, 3))  # right of a row of vectors
            parts.append(about_bright(found, to_map, count, rng))
        shares = [0.5, *[0.5 / (len(parts) - 1)] * (len(parts) - 1)]
        chosen = [p[rng.permutation(len(p))[: round(s * count)]] for (p, _), s in zip(parts, shares, strict=True)]
        self.count = sum(map(len, chosen))
        shares = [len(c) / self.count for c in chosen]
        normal = np.concatenate(chosen)
        normal = normal[normal[:, 2] > np.sqrt(1 - EDGE**2)]  # those behind count as 0
        self.weight = 1 / sum(s * density(normal) for s, (_, density) in zip(shares, parts, strict=True))
        frame = np.swapaxes(frames(normal), 0, 1)  # tangents, bitangents, normals: (3, places, 3)
        self.wo = normalize(vec(*(f[:, 2] for f in frame)))
        self.straight = vec(*(dot(f, self.toward) for f in frame))
        size = max(CHUNK // (2 * rays if self.surrounded else 1), 1)
        self.parts = [slice(i, i + size) for i in range(0, len(self.wo), size)]
        if self.surrounded:
            around = (self.look_around(p, found, to_map, frame[:, p], model, light.gain, rays, rng) for p in self.parts)
            self.around = Kept(around)

    def look_around(self, part, found, to_map, frame, model, gain, rays, rng):
        """Directions (places, 2, rays, 3), half of them from each sampler, and the light that each stands for."""
        wo = self.wo[part]
        shape = (len(wo), 2, rays // 2)
        own, _ = model.sample_f(np.broadcast_to(wo[:, None, None], (*shape, 3)), rng.random((*shape, 2)))
        lit = sample_environment(found.map, found.cdf, steps(rng, shape))[0] @ to_map.T
        lit = vec(*(np.einsum("phkc,pc->phk", lit, f) for f in frame))
        wi = np.concatenate([own, lit], axis=2)
        seen = environment_lookup(found.map, np.einsum("phki,ipc->phkc", wi, frame) @ to_map)
        both = model.pdf(wo[:, None, None], wi) + seen[..., 3]
        share = np.where(wi[..., 2] > HORIZON, quotient(wi[..., 2], both), 0.0)
        return wi, seen[..., :3] * (share * gain * 2 / rays)[..., None]

    def radiance(self, model):
        """Radiance to the eye (places, 2, 3), as a generator's result: two estimates by other directions to the environment."""
        total = np.zeros((len(self.wo), 2, 3))
        for i, part in enumerate(self.parts):
            with np.errstate(under="ignore"):
                wo = self.wo[part]
                if self.irradiance > 0:
                    wi = self.straight[part]
                    total[part] += (model.f(wo, wi) * (self.irradiance * np.maximum(wi[:, 2:], 0.0)))[:, None]
                if self.surrounded:
                    wi, light = self.around[i]
                    total[part] += np.sum(model.f(wo[:, None, None], wi) * light, axis=2)
            yield
        return total

    @np.errstate(under="ignore")
    def mean(self, values):
        """Mean of values (places,) over the disc, an Estimate."""
        return mean_of(np.append(values * self.weight, np.zeros(self.count - len(values))))


class Kept:
    """The values of an iterator by number, found when they are asked for in order, and kept."""

    def __init__(self, values):
        self.coming, self.values = values, []

    def __getitem__(self, i):
        while len(self.values) <= i:
            self.values.append(next(self.coming))
        return self.values[i]


def steps(rng, shape):
    """Random numbers (*shape, 2) in [0, 1) in steps of 2^-24."""
    return rng.integers(0, 2**24, (*shape, 2)) / 2**24


def even(count, rng):
    """Normals (count, 3) of places that are even over the disc."""
    return on_disc(np.sqrt((np.arange(count) + rng.random(count)) / count), rng)


def on_disc(r, rng):
    """Normals (count, 3) at distances (count,) from the disc's centre."""
    phi = 2 * np.pi * rng.random(len(r))
    return vec(r * np.cos(phi), r * np.sin(phi), np.sqrt((1 - r) * (1 + r)))


def towards_edge(count, rng):
    """Normals (count, 3) whose cosine to the eye is even in its logarithm down to the edge, and their density over even ones'."""
    decay = -0.5 * np.log(1 - EDGE**2)
    cosine = np.exp(-decay * (np.arange(count) + rng.random(count)) / count)
    return on_disc(np.sqrt((1 - cosine) * (1 + cosine)), rng), lambda normal: 1 / (2 * decay * normal[:, 2] ** 2)


def about_highlight(toward, alpha, count, rng):
    """Normals (count, 3) about the one that mirrors the light to the eye, as GGX has them, and their density over even ones'."""
    alpha = np.maximum(alpha, 1e-4)
    frame = frames(normalize(toward + EYE))
    u, phi = (np.arange(count) + rng.random(count)) / count, 2 * np.pi * rng.random(count)
    slope = np.sqrt(u / (1 - u + 1e-12))
    normals = normalize(vec(alpha[0] * slope * np.cos(phi), alpha[1] * slope * np.sin(phi), 1.0)) @ frame

    def density(normal):
        own = normal @ frame.T
        up = own[:, 2] > 1e-9
        with np.errstate(under="ignore"):
            own = np.where(up[:, None], own, EYE)
            return np.where(up, np.pi * D(own, alpha) * own[:, 2] / normal[:, 2], 0.0)

    return normals, density


def about_bright(found, to_map, count, rng):
    """Normals (count, 3) at which a mirror shows the environment by its density, and theirs over even ones'.

    A normal at cos theta mirrors 4 cos theta of its solid angle, and covers cos theta of it on the disc.
    """
    ahead = sample_environment(found.map, found.cdf, steps(rng, (count,)))[0] @ to_map.T + EYE
    normals = normalize(ahead[dot(ahead, ahead) > 1e-12])
    return normals, lambda normal: 4 * np.pi * environment_lookup(found.map, mirror(EYE, normal) @ to_map)[:, 3]


def frames(normal):
    """Rows tangent, bitangent, normal (..., 3, 3) of the sphere at normals (..., 3), as views/sphere.frag has them."""
    x, y, z = split(normal)
    tangent = normalize(vec(z, np.zeros_like(x), -x))
    return np.stack([tangent, np.cross(normal, tangent), normal], axis=-2)


class Bias:
    """Bias of models against a reference at Places: squares without the variance of the directions, by their two halves."""

    def __init__(self, state, size, seed):
        self.state, self.size, self.seed = state, size, seed
        self.reference = state.model
        self.found = {}  # model -> its radiance

    @cached_property
    def places(self):
        return Places(self.state, *self.size, self.seed)

    def radiance(self, model):
        """That at the places, as a generator's result."""
        if model not in self.found:
            self.found[model] = yield from self.places.radiance(model)
        return self.found[model]

    def level(self):
        """The reference's mean over the disc, an Estimate, as a generator's result."""
        reference = yield from self.radiance(self.reference)
        return self.places.mean(reference.mean(axis=(1, 2)))

    def of(self, model, other=None):
        """For a model less another, or the reference, the mean square of the difference over that of the reference's mean,
        an Estimate, and the mean difference over the mean; as a generator's result."""
        other = other or self.reference
        if model == other:
            return NONE, 0.0
        level = yield from self.level()
        own = yield from self.radiance(model)
        less = yield from self.radiance(other)
        difference = own - less
        with np.errstate(under="ignore"):
            square = self.places.mean(np.mean(difference[:, 0] * difference[:, 1], axis=-1))
            shift = self.places.mean(difference.mean(axis=(1, 2)))
        return relative(square, level), shift.value / level.value


def mean_of(values):
    """The mean of independent values (n,), an Estimate.

    A few large values may hide how many more there are, so the lower bound is the best of those of values cut at some size.
    """
    lows = []
    for share in (1.0, 0.99, 0.9):
        cut = np.minimum(values, np.quantile(values, share))
        lows.append(cut.mean() - SURE * cut.std() / np.sqrt(len(cut)))
    mean = values.mean()
    return Estimate(float(mean), float(max(lows)), float(mean + SURE * values.std() / np.sqrt(len(values))))


def relative(square, level):
    """A mean square over the square of a mean, Estimates, the bounds of one over those of the other."""
    low = max(square.low, 0.0) / level.high**2
    high = max(square.high, 0.0) / level.low**2 if level.low > 0 else inf
    return Estimate(square.value / level.value**2, low, high)


def root(*squares):
    """The root of a sum of squares, Estimates."""
    return Estimate(*(float(np.sqrt(max(sum(s), 0.0))) for s in zip(*squares, strict=True)))

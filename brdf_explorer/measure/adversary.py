"""Directions at which formulas fail: on the horizon and next to it, on the axes, opposite, equal, mirrored, not quite unit."""

import numpy as np

from ..lib.common import TWO_PI, vec


def adversarial(rng, n, both=False):
    """n directions wo and wi (n, 3), and points u (n, 2) in [0, 1), by a numpy Generator.

    Cosines go over decades down to 1e-30, and are 0, 1, or below the horizon; wi is drawn like wo, or is wo, its opposite or
    its mirror image, each exactly or off by 1e-8 to 0.1, or is the opposite azimuth at any height. Some lengths err by 1e-6.
    both: half of the directions are on the other side of the surface.
    """
    wo, wi = _hemisphere(rng, n), _hemisphere(rng, n)
    kind = rng.integers(0, 8, n)
    flip = np.array([[1, 1, 1], [-1, -1, -1], [-1, -1, 1]], dtype=float)
    related = wo * flip[kind % 3]
    near = _unit(related + rng.normal(size=(n, 3)) * 10.0 ** rng.uniform(-8, -1, (n, 1)))
    wi = np.where((kind < 3)[:, None], related, np.where((kind < 6)[:, None], near, wi))
    behind = _direction(wi[:, 2], np.arctan2(-wo[:, 1], -wo[:, 0]))
    wi = np.where((kind == 6)[:, None], behind, wi)
    wo, wi = (w * (1 + 1e-6 * rng.choice((0, 0, -1, 1), (n, 1))) for w in (wo, wi))
    if both:
        wo, wi = (w * np.where(rng.random((n, 1)) < 0.5, [1, 1, -1], [1, 1, 1]) for w in (wo, wi))
    ends = np.array([0.0, 2.0**-24, 0.5, 1 - 2.0**-24])
    u = np.where(rng.random((n, 2)) < 0.3, rng.choice(ends, (n, 2)), rng.integers(0, 2**24, (n, 2)) * 2.0**-24)
    return wo, wi, u


def above(rng, n, lowest=1e-4, both=False):
    """n unit directions (n, 3), half of them with a cosine over decades from `lowest` on, half with an even one.

    both: half of them are below the surface.
    """
    z = np.where(rng.random(n) < 0.5, lowest ** rng.random(n), rng.uniform(lowest, 1, n))
    if both:
        z = z * rng.choice((-1, 1), n)
    return _direction(z, rng.uniform(0, TWO_PI, n))


def _hemisphere(rng, n):
    kind = rng.integers(0, 10, n)
    z = np.where(kind < 5, 10.0 ** rng.uniform(-30, 0, n), rng.uniform(0, 1, n))
    z = np.where(kind == 5, 0.0, np.where(kind == 6, 1.0, z))
    z = np.where(rng.random(n) < 0.05, -z, z)
    w = _direction(z, rng.uniform(0, TWO_PI, n))
    axis = rng.integers(0, 8, n)
    r = np.sqrt((1 - z) * (1 + z))
    w[axis == 0, :2] = np.column_stack([r, 0 * r])[axis == 0]
    w[axis == 1, :2] = np.column_stack([0 * r, -r])[axis == 1]
    return w


def _direction(z, phi):
    r = np.sqrt((1 - z) * (1 + z))
    return vec(r * np.cos(phi), r * np.sin(phi), z)


def _unit(w):
    return w / np.sqrt(np.sum(w * w, axis=-1, keepdims=True))

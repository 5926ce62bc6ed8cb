"""Constants, and GLSL's words for numpy: vectors are the last axis."""

import numpy as np

PI = np.pi
TWO_PI = 2 * np.pi
INV_PI = 1 / np.pi

HORIZON = 1e-12
"""A direction with a cosine below this lies on the horizon, where f is 0: there 4 cos cos would leave float32's range."""


def dot(a, b):
    return np.sum(np.asarray(a) * b, axis=-1)


def length(a):
    return np.sqrt(dot(a, a))


def normalize(a):
    a = np.asarray(a, dtype=float)
    return a / length(a)[..., None]


def mix(a, b, t):
    return a * (1 - t) + b * t


def quotient(a, b):
    """a / b, and 0 where b is 0."""
    return np.where(b == 0, 0.0, a / np.where(b == 0, 1.0, b))


def vec(*components):
    """Components (...) stacked to vectors (..., n)."""
    return np.stack(np.broadcast_arrays(*components), axis=-1)


def split(a):
    """The components of vectors (..., n): n arrays (...)."""
    return np.moveaxis(np.asarray(a, dtype=float), -1, 0)


def mirror(w, m):
    """The direction w mirrored about the normal m, both away from the surface."""
    return 2 * dot(w, m)[..., None] * m - w


def above_horizon(function, wo, wi, *shape):
    """function(wo, wi) -> (..., *shape) where both directions are above the horizon, 0 elsewhere.

    Underflow to 0 is the right answer in the tails of a density, so it is not an error here.
    """
    wo, wi = np.broadcast_arrays(np.asarray(wo, dtype=float), np.asarray(wi, dtype=float))
    up = (wo[..., 2] > HORIZON) & (wi[..., 2] > HORIZON)
    out = np.zeros(up.shape + shape)
    with np.errstate(under="ignore"):
        out[up] = function(wo[up], wi[up])
    return out

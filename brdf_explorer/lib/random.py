"""Random numbers by pixel and pass, equal to those of the shaders to the bit: numpy uint32 throughout."""

from contextlib import contextmanager

import numpy as np

from .common import vec

STREAM_PIXEL, STREAM_BSDF, STREAM_LIGHT = 0, 1, 2
"""The streams of a pixel, each two dimensions of one sequence in six: place in the pixel, direction drawn from the
BSDF, direction drawn from the light."""

STEPS = np.array([[2053070967, 792579173], [3714908163, 3413342483], [1944220111, 1286625007]], dtype=np.uint32)
"""Steps of a Kronecker sequence by stream: the fractions of 2 cos(2 pi k / 17), k = 2 4, 1 6, 5 7, as odd multiples of
2^-32.

They belong to an algebraic field of degree 8: no combination with small whole numbers comes near a whole number, so
that the points of a stream spread evenly, and so do those of two or three together. Hua and Wang 1981, "Applications of
Number Theory to Numerical Analysis".
"""


def pcg3d(v):
    """Hash of three numbers to three, uint32 (..., 3): Jarzynski and Olano 2020, "Hash Functions for GPU Rendering"."""
    v = np.asarray(v, dtype=np.uint32)
    with np.errstate(over="ignore"):  # arithmetic modulo 2^32 is meant
        x, y, z = np.moveaxis(v * np.uint32(1664525) + np.uint32(1013904223), -1, 0)
        x = x + y * z
        y = y + z * x
        z = z + x * y
        x, y, z = (a ^ (a >> np.uint32(16)) for a in (x, y, z))
        x = x + y * z
        y = y + z * x
        z = z + x * y
    return vec(x, y, z)


def unit_interval(bits):
    """The highest 24 bits as a number in [0, 1)."""
    return (bits >> np.uint32(8)) * 2.0**-24


ROW = 1024
"""Rows of a table that lie beside each other where views/probe.frag evaluates it: a row's pixel is (row % ROW, row // ROW)."""
_next = [0]  # the pass of the next call that draws


@contextmanager
def seeded(seed):
    """Within it calls of stochastic functions draw the passes seed, seed + 1 ...: the same numbers each time, in both twins."""
    before, _next[0] = _next[0], seed
    try:
        yield
    finally:
        _next[0] = before


def next_pass():
    """The pass that a call draws: 0 for the first of a process, and then another one for each, so that calls are independent."""
    _next[0] = (_next[0] + 1) % 2**32
    return (_next[0] - 1) % 2**32


def random_states(count, index):
    """States (count, 3) of the generator of formulas that draw numbers of their own, for Draws.

    As the shaders seed theirs by pixel and pass `index`, of which all bits are turned, so that none is a stream of random2.
    """
    row = np.arange(count, dtype=np.uint32)
    return vec(row % np.uint32(ROW), row // np.uint32(ROW), np.uint32(~np.uint32(index)))


class Draws:
    """The generators of walks that are under way, one for each: states (n, 3), which drawing moves on."""

    def __init__(self, states):
        self.states = states

    def drawn(self):
        """Three numbers in [0, 1) for each walk, (n, 3)."""
        self.states = pcg3d(self.states)
        return unit_interval(self.states)

    def keep(self, which):
        """Go on with those walks alone that the mask (n,) has."""
        self.states = self.states[which]


def third(u):
    """A third number (...) in [0, 1) from points u (..., 2): their hash, for a sampler that has one decision more to make."""
    bits = (np.asarray(u, dtype=float) * 2.0**24).astype(np.uint32)
    return unit_interval(pcg3d(np.concatenate([bits, np.zeros_like(bits[..., :1])], axis=-1))[..., 0])


def random2(pixel, index, stream):
    """Point `index` (...) in the unit square (..., 2), by pixel (..., 2) and stream (...), all unsigned integers.

    The Kronecker sequence of the stream, rotated by the pixel's hash: Cranley and Patterson 1976.
    """
    x, y = np.moveaxis(np.asarray(pixel, dtype=np.uint32), -1, 0)
    index, stream = np.asarray(index, dtype=np.uint32), np.asarray(stream, dtype=np.uint32)
    with np.errstate(over="ignore"):
        return unit_interval(pcg3d(vec(x, y, stream))[..., :2] + index[..., None] * STEPS[stream])

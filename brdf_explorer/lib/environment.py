"""Light from all around, as a lat-long map: y is up, the middle column at -z, columns run towards +x, row 0 on top.

`map` (H, W, 4) holds the radiance at the texels' centres in rgb, and in a the density per solid angle of
sample_environment, which is constant over a texel. `cdf` (H + 1, W, 4) are the cumulative sums by which a random
number finds its texel, in units of 2^-24: its row j < H has a step for each column of row j of the map, its row H one
for each row of the map, in its first H columns. Of a step, r and g are the sums before and after it, b and a the
first and the last step that a number can lie in when its place in the row, of as many equal ones as there are steps,
is here (Chen and Asau 1974, "On Generating Random Variates from an Empirical Distribution").
brdf_explorer.environment makes both; here they are what the samplers are in the shader.
"""

import numpy as np

from .common import PI, TWO_PI, length, split, vec
from .transcendental import atan2_precise


def environment_uv(w):
    """Place in the map, (..., 2) in [0, 1]^2, of directions w (..., 3)."""
    x, y, z = split(w)
    return vec(0.5 + atan2_precise(x, -z) / TWO_PI, atan2_precise(length(vec(x, z)), y) / PI)


def environment_direction(u, s, c):
    """Directions (..., 3) at the longitude u in [0, 1] where s = sin^2(theta / 2) and c = cos^2(theta / 2)."""
    phi = TWO_PI * (u - 0.5)
    r = 2 * np.sqrt(s * c)
    return vec(r * np.sin(phi), c - s, -r * np.cos(phi))


def environment_lookup(map, w):
    """Radiance (..., 3) and density (...) of sample_environment per solid angle along w (..., 3), together (..., 4).

    The radiance is bilinear between the texels' centres; columns wrap, the rows end at the poles. The density is above
    0 wherever the radiance is.
    """
    height, width = map.shape[:2]
    place = environment_uv(w) * (width, height) - 0.5
    corner = np.floor(place)
    t = place - corner
    left = (corner[..., 0].astype(int) + width) % width
    right = (left + 1) % width
    top = np.maximum(corner[..., 1].astype(int), 0)
    bottom = np.minimum(corner[..., 1].astype(int) + 1, height - 1)
    a, b, c, d = (map[i, j].astype(float) for i in (top, bottom) for j in (left, right))
    tx, ty = t[..., :1], t[..., 1:]
    nearest = np.where(ty < 0.5, np.where(tx < 0.5, a, b), np.where(tx < 0.5, c, d))
    a = a + tx * (b - a)
    c = c + tx * (d - c)
    return np.concatenate([(a + ty * (c - a))[..., :3], nearest[..., 3:]], axis=-1)


def environment_radiance(map, w):
    """Radiance (..., 3) along w (..., 3)."""
    return environment_lookup(map, w)[..., :3]


def pdf_environment(map, w):
    """Density (...) of sample_environment per solid angle, at w (..., 3)."""
    return environment_lookup(map, w)[..., 3]


def environment_step(cdf, row, count, x):
    """The step in rows (...) of `count` that x (...), whole and below 2^24, lie in, and the place (...) within it."""
    low, high = np.moveaxis(cdf[row, x.astype(int) // ((2**24 - 1 + count) // count), 2:].astype(int), -1, 0)
    while True:
        found = (low + high) // 2
        before, after = split(cdf[row, found, :2])
        if np.all((low >= high) | (x >= before) & (x < after)):
            return found, (x - before + 0.5) / (after - before)
        low, high = np.where(x >= after, found + 1, low), np.where(x < before, found - 1, high)


def sample_environment(map, cdf, u):
    """Directions (..., 3) and their density (...) per solid angle, from u (..., 2) in [0, 1)^2 in steps of 2^-24.

    In proportion to the luminance of the radiance averaged over each texel, uniform by area within the texel.
    Inversion, rows by u.y and then columns by u.x.
    """
    height, width = map.shape[:2]
    x = np.floor(np.asarray(u) * 2.0**24)
    row, ty = environment_step(cdf, np.full(x.shape[:-1], height), height, x[..., 1])
    column, tx = environment_step(cdf, row, width, x[..., 0])
    half_theta = 0.5 * PI * vec(row, row + 1) / height
    s0, s1 = split(np.sin(half_theta) ** 2)
    c0, c1 = split(np.cos(half_theta) ** 2)
    w = environment_direction((column + tx) / width, s0 + ty * (s1 - s0), c0 + ty * (c1 - c0))
    return w, map[row, column, 3].astype(float)

"""Rough surfaces whose slopes follow a known law, and rays cast over them: what Smith's masking says, measured.

Every surface here is periodic, isotropic (the brushed one apart) and has alpha = 1; its lengths are in units of tau. Any other
is one of these stretched: heights times alpha_max, and from slopes of scale 1 along x, y to alpha_x, alpha_y by lengths times
alpha_max / alpha along each (Heitz 2014, section 5.3, stretches the directions instead). Along a direction at azimuth phi its
slopes have the scale `along`, and what a ray at theta meets depends on a = 1 / (alpha tan theta) alone.

    gaussian     heights with the autocorrelation sigma^2 exp(-r^2 / (2 tau^2)), whose slopes are Beckmann's with
                 alpha = sqrt(2) sigma / tau (Beckmann and Spizzichino 1963; Walter et al. 2007, Eq. 25). With
                 sigma^2 exp(-r^2 / tau^2), as others write it, alpha would be 2 sigma / tau. alpha is the root mean square of
                 the gradient's length.
    ellipsoids   the upper halves of ellipsoids z = alpha sqrt(R^2 - x^2 - y^2), whose slopes are Trowbridge and Reitz's
                 (Walter et al. 2007, Eq. 33): packed greedily, the largest with R = tau. Left out is the floor between them,
                 which is flat: `covered` is the share of the area that is not.
    brushed      a Gaussian profile extruded along y: alpha_y = 0.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..lib import slot
from ..lib.common import quotient, vec
from ..lib.transcendental import erfcx_precise, exp_precise
from .steps import Steps

LAWS = {"gaussian": "beckmann", "ellipsoids": "ggx", "brushed": "beckmann"}
"""The distribution of normals of each surface."""

HORIZON = 1e-3
"""Cosine below which a direction is taken for one below the horizon."""
PERIOD = 64.0  # of a Gaussian surface, in tau
FINE = 8  # its samples a tau: facets between them have an alpha that is 0.2 % small
CAPS = 12.0  # period of the ellipsoids, in tau
GRID = 16  # places a tau where an ellipsoid may stand
NOISE = 0.05  # of a gap, in tau: what chance adds where the next ellipsoid is chosen
SMALLEST = 0.08  # radius of the smallest ellipsoid, in tau
CAST = 48  # samples a tau of ellipsoids that rays are cast over
ROWS = 64  # that rays are cast over, of a surface
A = np.geomspace(0.1, 4.0, 20)
"""Where visibility is measured: a = 1 / (alpha tan theta)."""
BINS = np.linspace(-3.0, 3.0, 50)
"""Edges of the histogram of slopes, in units of alpha; 0 is the middle of a bin."""


# --- surfaces --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Surface:
    """Heights (ny, nx) of a periodic surface with alpha = 1, `pitch` apart, rows along x. All lengths in tau."""

    heights: np.ndarray
    pitch: float
    covered: float = 1.0

    def height(self, x, y):
        """Heights at places x, y (...), by Catmull and Rom's cubic through the samples."""
        ny, nx = self.heights.shape
        (ix, wx), (iy, wy) = _cubic(x / self.pitch), _cubic(y / self.pitch)
        return sum(
            wy[j] * sum(wx[i] * self.heights[(iy + j - 1) % ny, (ix + i - 1) % nx] for i in range(4)) for j in range(4)
        )


@dataclass(frozen=True)
class Caps(Surface):
    """Half ellipsoids that do not overlap. caps: x, y, radius (3, n); nearest: the cap by each sample, of (ny, nx)."""

    caps: np.ndarray = None
    nearest: np.ndarray = None

    def height(self, x, y):
        """Heights at places x, y (...): exact."""
        return np.sqrt(np.maximum(inside(self.cap(x, y)), 0.0))

    def cap(self, x, y):
        """Where places x, y (...) lie from the middle of the cap that holds them, or of another, and its radius: (3, ...).

        The middles are on samples, so of the four samples around a place in a cap that towards its middle is in it too.
        """
        n = len(self.nearest)
        i, j = (np.floor(p / self.pitch).astype(int) for p in (x, y))
        first = self.nearest[j % n, i % n]
        found = self.within(first, x, y)
        for right, up in ((1, 0), (0, 1), (1, 1)):
            other = self.nearest[(j + up) % n, (i + right) % n]
            at = other != first
            before, tried = found[:, at], self.within(other[at], x[at], y[at])
            found[:, at] = np.where(inside(tried) > inside(before), tried, before)
        return found

    def within(self, number, x, y):
        """Places x, y (...) from the middle of the caps of these numbers, and their radius: (3, ...)."""
        period = len(self.nearest) * self.pitch
        cx, cy, radius = self.caps[:, number]
        return np.stack([*((p - c + period / 2) % period - period / 2 for p, c in ((x, cx), (y, cy))), radius])


def inside(cap):
    dx, dy, radius = cap
    return radius**2 - dx**2 - dy**2


def _cubic(p):
    """The sample before each place and the weights of the four around it."""
    i = np.floor(p)
    t = p - i
    weights = (
        t * (-0.5 + t * (1 - 0.5 * t)),
        1 + t * t * (-2.5 + 1.5 * t),
        t * (0.5 + t * (2 - 1.5 * t)),
        t * t * (-0.5 + 0.5 * t),
    )
    return i.astype(int), weights


@np.errstate(under="ignore")  # in the tail of the spectrum
def gaussian(rng, n, period):
    """The Gaussian Surface of n x n samples and that period: white noise times the root of the heights' spectrum.

    The spectrum is that of exp(-r^2 / 2) / 2, pi exp(-k^2 / 2): sigma = 1 / sqrt(2) at tau = 1 gives alpha = 1.
    """
    pitch = period / n
    kx, ky = 2 * np.pi * np.fft.rfftfreq(n, pitch), 2 * np.pi * np.fft.fftfreq(n, pitch)
    noise = np.fft.rfft2(rng.standard_normal((n, n)))
    root = np.sqrt(np.pi) / pitch * np.exp(-(kx**2) / 4) * np.exp(-(ky**2) / 4)[:, None]
    return Surface(np.fft.irfft2(noise * root, (n, n)), pitch)


@np.errstate(under="ignore")
def gaussian_profiles(rng, count, n, period):
    """Heights (count, n) of independent Gaussian profiles: rows of different Gaussian surfaces, or brushed surfaces."""
    pitch = period / n
    k = 2 * np.pi * np.fft.rfftfreq(n, pitch)
    root = np.sqrt(np.sqrt(np.pi / 2) / pitch) * np.exp(-(k**2) / 4)
    return np.fft.irfft(np.fft.rfft(rng.standard_normal((count, n))) * root, n)


def ellipsoids(rng, n, period):
    """The Surface of half ellipsoids on a grid of n x n places: the largest that has room, at random, until all are small."""
    pitch = period / n
    noise = NOISE * rng.random((n, n))
    gap = np.ones((n, n))  # radius of the cap that has room at each place
    score = gap + noise
    nearest = np.zeros((n, n), dtype=int)
    caps = []
    while True:
        y, x = np.unravel_index(np.argmax(score), score.shape)
        radius = gap[y, x]
        if radius < SMALLEST:
            break
        reach = int(np.ceil((2 * radius + NOISE) / pitch)) + 1  # no gap is larger than radius + NOISE
        offset = np.arange(-reach, reach + 1)
        rows, columns = np.ix_((y + offset) % n, (x + offset) % n)
        away = pitch * np.hypot(offset[:, None], offset) - radius
        closer = away < gap[rows, columns]
        gap[rows, columns] = np.where(closer, away, gap[rows, columns])
        score[rows, columns] = gap[rows, columns] + noise[rows, columns]
        nearest[rows, columns] = np.where(closer, len(caps), nearest[rows, columns])
        caps.append((x * pitch, y * pitch, radius))
    caps = np.array(caps).T
    covered = float(np.pi * np.sum(caps[2] ** 2) / period**2)
    grid = pitch * np.arange(n)
    shape = Caps(np.empty((0, 0)), pitch, covered, caps, nearest)
    return Caps(shape.height(*np.meshgrid(grid, grid)), pitch, covered, caps, nearest)


@lru_cache(maxsize=4)
def surface(kind, seed):
    """The Surface of a kind in LAWS."""
    rng = np.random.default_rng(seed)
    if kind == "ellipsoids":
        return ellipsoids(rng, int(CAPS * GRID), CAPS)
    n = int(PERIOD * FINE)
    if kind == "gaussian":
        return gaussian(rng, n, PERIOD)
    return Surface(gaussian_profiles(rng, 1, n, PERIOD), PERIOD / n)


def along(kind, alpha, phi):
    """Scale of the slopes of a surface stretched to alpha (2,) along the azimuth phi: Heitz 2014, section 5.3."""
    ax, ay = alpha
    return float(np.hypot(ax * np.cos(phi), 0.0 if kind == "brushed" else ay * np.sin(phi)))


@dataclass(frozen=True)
class Patch:
    """A square of a stretched surface for a picture, in tau of the steeper direction; its rows run towards the viewer.

    rows (n, 3 n - 2): heights, `pitch` apart, of the square and as much to either side, so that rays come from afar.
    """

    rows: np.ndarray
    pitch: float

    @property
    def middle(self):
        n = len(self.rows)
        return slice(n - 1, 2 * n - 1)

    @property
    def heights(self):
        return self.rows[:, self.middle]

    def seen(self, theta):
        """Share of each segment (n, n - 1) of the square that a direction at theta, in radians, sees; 0 below the horizon."""
        n = len(self.rows)
        if np.cos(theta) < HORIZON:
            return np.zeros((n, n - 1))
        return seen(self.rows, self.pitch, (np.sin(theta), np.cos(theta)), False)[:, n - 1 : 2 * n - 2]


def patch(kind, seed, alpha, phi, extent, n):
    """The Patch of n x n heights, `extent` wide, of a surface stretched to alpha (2,), with rows along the azimuth phi."""
    steep = alpha[0] if kind == "brushed" else max(alpha)
    pitch = extent / (n - 1)
    u, v = np.meshgrid(pitch * np.arange(1 - n, 2 * n - 1), pitch * np.arange(n))
    x, y = u * np.cos(phi) - v * np.sin(phi), u * np.sin(phi) + v * np.cos(phi)
    return Patch(steep * surface(kind, seed).height(x * alpha[0] / steep, y * alpha[1] / steep), pitch)


# --- rays ------------------------------------------------------------------------------------------------------------


def seen(heights, pitch, ray, periodic=True):
    """Share (..., n) of each segment of polylines (..., n + 1) that rays leave for the sky without meeting the polyline.

    ray: (along, up > 0), towards the viewer or the light; a segment that faces away has 0. A periodic polyline ends with the
    height that it began with. Heights are compared in the ray's frame: a point is seen if none further along is higher above
    the ray, so one running maximum from the far end does; exact for any number of points.
    """
    run, up = ray
    if run < 0:
        return seen(heights[..., ::-1], pitch, (-run, up), periodic)[..., ::-1]
    n = heights.shape[-1] - 1
    g = run * heights - up * pitch * np.arange(n + 1)
    beyond = np.maximum.accumulate(g[..., :0:-1], axis=-1)[..., ::-1]
    if periodic:  # the next period is lower by the ray's rise, all others by more
        beyond = np.maximum(beyond, g.max(axis=-1, keepdims=True) - up * pitch * n)
    drop = g[..., :-1] - g[..., 1:]
    return np.clip(quotient(g[..., :-1] - beyond, np.maximum(drop, 0.0)), 0.0, 1.0)


def first_hit(heights, pitch, index, ray):
    """Where a ray from the middle of segment `index` of a polyline (n + 1,) first meets it: a place in pitches, or None."""
    run, up = ray
    step = 1 if run > 0 else -1
    start = index + (run > 0)  # the first corner along the ray
    corners = np.arange(start, len(heights) if run > 0 else -1, step)
    if run == 0 or not corners.size:
        return None
    middle = 0.5 * (heights[index] + heights[index + 1])
    above = heights[corners] - middle - up / abs(run) * pitch * np.abs(corners - index - 0.5)
    hit = np.flatnonzero(above > 0)
    if not hit.size or hit[0] == 0:  # at once: the segment faces away
        return None
    k = hit[0]
    return float(corners[k] - step * above[k] / (above[k] - above[k - 1]))


# --- Smith -----------------------------------------------------------------------------------------------------------


def P2(law, slope):
    """Density of the slope along a line for alpha = 1: the integral of P22 over the slope across it."""
    if law == "beckmann":
        return exp_precise(-(slope**2)) / np.sqrt(np.pi)
    return 0.5 / (1 + slope**2) ** 1.5


def G1(law, a):
    """Share of the projected area of the facets that face a direction which is visible from it: 1 / (1 + Lambda)."""
    w = vec(1 / np.sqrt(1 + a * a), 0.0, a / np.sqrt(1 + a * a))
    return 1 / (1 + slot("smith", law, "exact").Lambda(w, np.array([1.0, 1.0])))


def lit(law, a):
    """Share of the area, projected along the normal, that a direction sees: the slopes below a, times G1 (Smith 1967).

    For Gaussian slopes (1 - erfc(a) / 2) / (1 + Lambda).
    """
    if law == "beckmann":
        facing = 1 - 0.5 * exp_precise(-a * a) * erfcx_precise(a)
    else:
        facing = 0.5 + 0.5 * a / np.sqrt(1 + a * a)
    return facing * G1(law, a)


# --- measuring -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Measured:
    """What polylines with alpha = 1 showed, each with its standard error over the surfaces, NaN for one.

    alpha    () scale of the slopes; of the ellipsoids without the floor
    slopes   (BINS.size - 1,) density of the slope
    visible  (A.size,) as G1
    lit      (A.size,) as lit
    """

    count: int
    alpha: tuple
    slopes: tuple
    visible: tuple
    lit: tuple


def cast(heights, pitch, a):
    """(visible, lit) of periodic polylines (..., n + 1) from a direction with a = 1 / tan theta, as G1 and lit say them."""
    share = seen(heights, pitch, (1.0, a))
    drop = np.maximum(a * pitch - np.diff(heights, axis=-1), 0.0)  # the projected area of each segment
    return float(np.sum(share * drop) / np.sum(drop)), float(np.mean(share))


def slope_scale(law, slopes):
    """alpha of slopes along a line: from their root mean square, or of GGX, which has none, from the median of their size."""
    if law == "beckmann":
        return float(np.sqrt(2 * np.mean(slopes**2)))
    return float(np.sqrt(3) * np.median(np.abs(slopes)))


def profiles(kind, seed):
    """(heights (rows, n + 1) of periodic polylines across a surface, their pitch, slopes (rows, n) along them)."""
    if kind == "ellipsoids":
        made, pitch = surface(kind, seed), 1 / CAST
        off = np.random.default_rng(seed).random((2, ROWS, 1))  # else places of rays and of caps go in step
        x, y = np.broadcast_arrays(
            pitch * (np.arange(CAPS * CAST) + off[0]), CAPS / ROWS * (np.arange(ROWS)[:, None] + off[1])
        )
        heights = made.height(x, y)
        slopes = -quotient(made.cap(x, y)[0], heights)  # chords would cut the steep rims off
    else:
        # all rows of a brushed surface are the same: each of these is of another
        n = int(PERIOD * FINE)
        many = gaussian_profiles(np.random.default_rng(seed), ROWS, n, PERIOD) if kind == "brushed" else None
        heights = surface(kind, seed).heights[:: n // ROWS] if many is None else many
        pitch = PERIOD / n
        slopes = np.diff(heights, axis=-1, append=heights[:, :1]) / pitch
    return np.concatenate([heights, heights[:, :1]], axis=1), pitch, slopes


@lru_cache(maxsize=128)
def measuring(kind, seed):
    """The Steps to (alpha, slopes, visible, lit) of one surface."""

    def steps():
        surface(kind, seed)
        yield
        heights, pitch, slopes = profiles(kind, seed)
        yield
        rough = slopes[heights[:, :-1] > 0] if kind == "ellipsoids" else slopes
        density = np.histogram(slopes, BINS)[0] / slopes.size / np.diff(BINS)
        shares = []
        for a in A:
            yield
            shares.append(cast(heights, pitch, a))
        return slope_scale(LAWS[kind], rough), density, *np.transpose(shares)

    return Steps(steps())


def seeds(seed, count):
    """Of `count` surfaces: that of `seed`, and others."""
    return [(seed, i) if i else seed for i in range(count)]


def measured(kind, seed, count):
    """Measured of `count` surfaces of a kind: that of `seed` and others."""
    found = [measuring(kind, one).all() for one in seeds(seed, count)]
    columns = []
    for values in zip(*found, strict=True):
        error = np.std(values, axis=0, ddof=1) / np.sqrt(count) if count > 1 else np.nan * np.asarray(values[0])
        columns.append((np.mean(values, axis=0), error))
    return Measured(count, *columns)

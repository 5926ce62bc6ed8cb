"""Light from all around: the built-in surroundings, pictures from files, and the tables from which they are sampled.

World frame: x to the right, y up, the eye looks along -z. Radiance is linear RGB with the primaries of Rec. 709; files
are taken to be so. lib/environment tells how a map is laid out and looked up.
"""

import os
import re
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from .lib.common import PI, mix, normalize, split, vec
from .lib.environment import environment_direction
from .lib.srgb import LUMINANCE
from .model import Invalid, nearest

WIDEST = 4096
"""Texels in the widest row of a file's picture: with its table that is 0.3 GB of textures."""

UNITS = 2**24
"""Counts in a row of the table: the steps of a random number with 24 bits, all exact in float32."""


@dataclass(frozen=True, eq=False)
class Environment:
    """A map and the table to sample it by, both float32 and read-only, for textures without filtering.

    map    (H, W, 4): radiance in rgb, density of sample_environment in 1/sr in a
    cdf  (H + 1, W, 4): cumulative sums of the density along the rows and, in row H, over them; see lib/environment
    """

    name: str
    map: np.ndarray
    cdf: np.ndarray

    @property
    def radiance(self):
        """Linear RGB (H, W, 3)."""
        return self.map[..., :3]


def environment(name, file=""):
    """The Environment called furnace, sky or studio, or that of an .exr or .hdr file; kept in memory.

    Raises Invalid with one line that names the file, what is wrong with it and what would be right.
    """
    if name == "file":
        if not file:
            raise Invalid("environment = 'file': no file given; an .exr or .hdr lat-long picture is expected")
        path = Path(file)
        try:
            stat = path.stat()
        except (OSError, ValueError):  # ValueError: a NUL in the name
            raise Invalid(f"{file}: no such file") from None
        return _from_file(str(path.resolve()), str(file), stat.st_mtime_ns, stat.st_size)
    if name not in BUILT_IN:
        raise Invalid(f"environment = {name!r} is not known{nearest(name, [*BUILT_IN, 'file'])}")
    return _built_in(name)


@lru_cache
def _built_in(name):
    return with_tables(name, BUILT_IN[name]())


@lru_cache(maxsize=2)  # the largest takes 0.3 GB
def _from_file(path, shown, changed, size):
    return with_tables(shown, read_picture(path, shown))


# --- light in the eye's frame ----------------------------------------------------------------------------------------


def toward(light):
    """Unit vector to the directional light in the eye's frame: x to the right, y up, z to the eye."""
    theta, phi = np.radians(light.theta), np.radians(light.phi)
    return (np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta))


def turn(light):
    """The rotation about y from the eye's frame to the environment's, column by column."""
    c, s = np.cos(np.radians(light.rotation)), np.sin(np.radians(light.rotation))
    return (c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c)


# --- the tables ------------------------------------------------------------------------------------------------------


def with_tables(name, radiance):
    """The Environment of a lat-long picture (H, W, 3), finite and not negative, somewhere above 0, with W >= H."""
    height, width = radiance.shape[:2]
    solid_angle = texel_solid_angle(height, width)
    # The bilinear lookup spreads a texel over its neighbours: averaged over a texel, it weighs them 1, 6, 1 along each
    # axis. So the density is positive wherever the lookup is.
    luminance = np.matmul(radiance, LUMINANCE, dtype=float)  # float64: the ends of float32's range are radiances, too
    luminance = (np.roll(luminance, 1, 1) + 6 * luminance + np.roll(luminance, -1, 1)) / 8
    luminance = (luminance[_neighbours(height, -1)] + 6 * luminance + luminance[_neighbours(height, 1)]) / 8
    cdf = np.zeros((height + 1, width, 4), dtype=np.float32)
    for row in range(height):
        cdf[row] = cdf_of(luminance[row])
    cdf[height, :height] = cdf_of(luminance.sum(axis=1) * solid_angle)
    counts = (cdf[..., 1] - cdf[..., 0]).astype(float) / UNITS
    map = np.empty((height, width, 4), dtype=np.float32)
    map[..., :3] = radiance
    map[..., 3] = counts[:height] * (counts[height, :height] / solid_angle)[:, None]
    for array in (map, cdf):
        array.flags.writeable = False
    return Environment(name, map, cdf)


def texel_solid_angle(height, width):
    """Solid angle in sr of a texel, by row (H,)."""
    return 4 * PI / width * np.sin(PI * (np.arange(height) + 0.5) / height) * np.sin(PI / (2 * height))


def cdf_of(weights):
    """Steps (n, 4) of lib/environment for weights (n,), in whole UNITS, one or more if above 0; all 0 if none is."""
    count = len(weights)
    sums = np.cumsum(weights)
    least = np.cumsum(weights > 0)
    if least[-1] == 0:
        return np.zeros((count, 4))
    sums = np.floor(sums / sums[-1] * (UNITS - least[-1])) + least
    places = np.arange(count + 1) * ((UNITS - 1 + count) // count)  # as environment_step divides
    first = np.minimum(np.searchsorted(sums, places, side="right"), count - 1)
    return vec(np.concatenate([[0.0], sums[:-1]]), sums, first[:-1], first[1:])


def _neighbours(height, step):
    return np.clip(np.arange(height) + step, 0, height - 1)


# --- built-in surroundings -------------------------------------------------------------------------------------------


def directions(height, width, rows=None, columns=None):
    """Directions (h, w, 3) of texels' centres, or of places given in rows (h,) and columns (w,)."""
    rows = np.arange(height) + 0.5 if rows is None else rows
    columns = np.arange(width) + 0.5 if columns is None else columns
    half_theta = PI * rows[:, None] / (2 * height)
    return environment_direction(columns / width, np.sin(half_theta) ** 2, np.cos(half_theta) ** 2)


def furnace():
    """Radiance 1 from everywhere: what a lossless surface shows it cannot be told from."""
    return np.ones((8, 16, 3), dtype=np.float32)


TURBIDITY = 2.5  # a clear day
SUN = np.array([-0.46, 0.66, 0.6]) / np.sqrt(
    0.46**2 + 0.66**2 + 0.6**2
)  # behind the eye's left shoulder, 41 degrees up
SUN_RADIUS = np.radians(0.533 / 2)  # mean angular radius of the disc
SUN_OUTSIDE = 133.0  # klx, illuminance outside the atmosphere: Darula, Kittler and Gueymard 2005
GROUND = np.array([0.24, 0.20, 0.15])  # albedo of dry soil


def sky():
    """Clear sky, sun and bare ground, white balanced: a white Lambert surface that faces up has radiance 1.

    Preetham, Shirley and Smits 1999, "A Practical Analytic Model for Daylight": distribution and colour of the sky from
    their Appendix 2, sunlight from Appendix 1 at one wavelength per channel. Their zenith would make the sky shed 25
    klx on the ground; a clear sky sheds 13, and does so here ("Recommended Practice for the Calculation of Daylight
    Availability", J. IES 13, 1984). The sun is a disc of uniform radiance, averaged over each texel. The ground has the
    radiance that this light gives it.
    """
    height, width = 1024, 2048
    solid_angle = texel_solid_angle(height, width)[:, None, None]
    w = directions(height, width)
    above = height // 2
    level = (w[..., 1:2] * solid_angle)[:above]  # a texel's share in the light on the ground
    radiance = np.zeros((height, width, 3))
    radiance[:above] = preetham_sky(w[:above], SUN, TURBIDITY)
    radiance *= sky_illuminance(SUN[1]) / np.sum(radiance[:above] @ LUMINANCE * level[..., 0])
    cover = disc_cover(w, SUN, SUN_RADIUS)[..., None]
    radiance += cover * (preetham_sun(SUN[1], TURBIDITY) / np.sum(cover * solid_angle))
    radiance *= PI / np.sum(radiance[:above] * level, axis=(0, 1))
    radiance[above:] = GROUND
    return radiance.astype(np.float32)


def sky_illuminance(cos_theta):
    """Light in klx of a clear sky without its sun on the ground, by the sun's cos(theta)."""
    return 0.8 + 15.5 * np.sqrt(cos_theta)


# Perez's five coefficients (rows) as a T + b, for the luminance Y and the chromaticities x and y, and the zenith's x
# and y as polynomials in T^2, T, 1 (rows) and theta^3, theta^2, theta, 1 of the sun, T being the turbidity: Appendix 2.
PEREZ = {
    "Y": ((0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)),
    "x": ((-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)),
    "y": ((-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529)),
}
ZENITH = {
    "x": (
        (0.00166, -0.00375, 0.00209, 0),
        (-0.02903, 0.06377, -0.03202, 0.00394),
        (0.11693, -0.21196, 0.06052, 0.25886),
    ),
    "y": (
        (0.00275, -0.00610, 0.00317, 0),
        (-0.04214, 0.08970, -0.04153, 0.00516),
        (0.15346, -0.26756, 0.06670, 0.26688),
    ),
}
XYZ_TO_RGB = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])
"""CIE XYZ to linear RGB, IEC 61966-2-1."""


def preetham_sky(w, sun, turbidity):
    """Linear RGB (..., 3) of the sky along w (..., 3) above the horizon, relative to the zenith's luminance."""
    cos_theta = w[..., 1]
    cos_gamma = np.clip(w @ sun, -1, 1)
    sun_theta = np.arccos(sun[1])
    zenith = {"Y": 1.0}
    for name, coefficients in ZENITH.items():
        zenith[name] = (
            (turbidity ** np.arange(2, -1, -1)) @ np.array(coefficients) @ (sun_theta ** np.arange(3, -1, -1))
        )

    def perez(name, cos_theta, cos_gamma):
        a, b, c, d, e = np.array(PEREZ[name]) @ (turbidity, 1)
        return (1 + a * np.exp(b / cos_theta)) * (1 + c * np.exp(d * np.arccos(cos_gamma)) + e * cos_gamma**2)

    Y, x, y = (zenith[n] * perez(n, cos_theta, cos_gamma) / perez(n, 1.0, sun[1]) for n in ("Y", "x", "y"))
    return np.maximum(vec(x / y * Y, Y, (1 - x - y) / y * Y) @ XYZ_TO_RGB.T, 0)  # its deepest blue is outside Rec. 709


def preetham_sun(cos_theta, turbidity):
    """Linear RGB (3,), in klx, of the sunlight that falls on a surface facing the sun. White outside the air."""
    wavelength = np.array([0.612, 0.549, 0.465])  # um, dominant wavelengths of the primaries
    ozone = np.array([0.117, 0.085, 0.008])  # 1/cm
    mass = 1 / (cos_theta + 0.15 * (93.885 - np.degrees(np.arccos(cos_theta))) ** -1.253)
    beta = 0.04608 * turbidity - 0.04586
    depth = 0.008735 * wavelength**-4.08 + beta * wavelength**-1.3 + 0.35 * ozone
    return SUN_OUTSIDE * np.exp(-mass * depth)


def disc_cover(w, centre, radius, parts=16):
    """Share (H, W) of each texel that a disc of `radius` about the direction `centre` covers, by parts^2 points each.

    w: the directions (H, W, 3) of the texels' centres.
    """
    height, width = w.shape[:2]
    cover = np.zeros((height, width))
    offsets = (np.arange(parts) + 0.5) / parts
    for row, column in np.argwhere(w @ centre > np.cos(radius + PI / height)):
        points = directions(height, width, row + offsets, column + offsets)
        cover[row, column] = np.mean(points @ centre > np.cos(radius))
    return cover


def studio():
    """Soft boxes in a dark neutral room, for shiny things. A white Lambert facet at its brightest has radiance 1."""
    height, width = 256, 512
    w = directions(height, width)
    x, y, z = split(w)
    # The room: a backdrop that a lamp lights from below, brighter behind the subject, over a darker floor.
    wall = 0.08 + 0.45 * np.exp(-((y + 0.05) ** 2) / 0.12 - (1 + z) ** 2 / 0.5)
    floor = 0.05 + 0.16 * np.exp(-((1 + y) ** 2) / 0.4) + 0.08 * smoothstep(0.2, 1.0, -z)
    radiance = np.repeat(mix(floor, wall, smoothstep(-0.16, -0.06, y))[..., None], 3, axis=-1)
    for centre, size, strength, colour in SOFT_BOXES:
        light, cover = soft_box(w, np.array(centre), size)
        radiance = mix(radiance, strength * light[..., None] * np.array(colour), cover[..., None])
    solid_angle = texel_solid_angle(height, width)[:, None]
    facets = normalize(directions(16, 32).reshape(-1, 3))
    coarse = radiance.reshape(32, 8, 64, 8, 3)  # the boxes are far larger than 6 degrees
    weights = (solid_angle * np.ones(width)).reshape(32, 8, 64, 8, 1)
    flux = np.sum(coarse * weights, axis=(1, 3)).reshape(-1, 3) @ LUMINANCE
    cosines = np.maximum(facets @ directions(32, 64).reshape(-1, 3).T, 0)
    return (radiance * (PI / np.max(cosines @ flux))).astype(np.float32)


# Direction of the centre, tangents of half the width and height seen from the subject, radiance, tint.
SOFT_BOXES = (
    ((-0.75, 0.70, 0.75), (0.50, 0.42), 10.0, (1.0, 0.97, 0.93)),  # key: above the left shoulder
    ((1.0, 0.05, 0.12), (0.15, 0.72), 5.0, (0.92, 0.96, 1.0)),  # strip: draws the right contour
    ((-1.0, -0.05, -0.55), (0.10, 0.60), 4.0, (0.96, 0.98, 1.0)),  # rim: draws the left contour
    ((0.10, 1.0, -0.50), (0.55, 0.26), 3.0, (1.0, 1.0, 1.0)),  # overhead
)


def soft_box(w, centre, size):
    """Radiance relative to the middle, and cover, both (...), along w (..., 3), of a rectangle facing the subject."""
    axis = normalize(centre)
    side = normalize(np.cross((0, 1, 0), axis))
    depth = w @ axis
    front = depth > 1e-3  # the rest is behind the rectangle's plane, or so oblique that no box reaches it
    scale = 1 / np.where(front, depth, 1.0)
    across, along = abs(w @ side) * scale / size[0], abs(w @ np.cross(axis, side)) * scale / size[1]
    edge = 0.03 / np.array(size)
    cover = smoothstep(1 + edge[0], 1 - edge[0], across) * smoothstep(1 + edge[1], 1 - edge[1], along)
    light = 1 - 0.45 * np.clip(across**2 + along**2, 0, 2) / 2  # the lamp behind the cloth is in the middle
    return light, np.where(front, cover, 0.0)


def smoothstep(low, high, x):
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


BUILT_IN = {"furnace": furnace, "sky": sky, "studio": studio}


# --- files -----------------------------------------------------------------------------------------------------------


def read_picture(path, shown=None):
    """Linear RGB float32 (H, W, 3) of a lat-long .exr or .hdr file. Raises Invalid; `shown` is the name it tells."""
    shown = str(shown or path)
    readers = {".exr": read_exr, ".hdr": read_hdr}
    if os.path.isdir(path):
        raise Invalid(f"{shown}: is a folder; an .exr or .hdr file is expected")
    reader = readers.get(Path(path).suffix.lower())
    if reader is None:
        raise Invalid(f"{shown}: is neither .exr nor .hdr; save the lat-long picture as one of them")
    try:
        if os.path.getsize(path) == 0:
            raise Invalid("is empty")
        picture = reader(path)
        check_radiance(picture)
    except Invalid as error:
        raise Invalid(f"{shown}: {error}") from None
    except UnicodeDecodeError:
        raise Invalid(f"{shown}: is corrupt: a name in its header is not text") from None
    except OSError as error:
        raise Invalid(f"{shown}: cannot be read: {error.strerror or error}") from None
    return picture


def check_size(width, height):
    if width != 2 * height or width < 2:
        raise Invalid(f"is {width} x {height}; a lat-long picture is twice as wide as high")
    if width > WIDEST:
        raise Invalid(f"is {width} x {height}; at most {WIDEST} x {WIDEST // 2} fit, scale it down")


def check_radiance(picture):
    for bad, what in ((~np.isfinite(picture), "not finite"), (picture < 0, "negative")):
        if count := np.count_nonzero(bad):
            row, column, channel = np.argwhere(bad)[0]
            many = f"{count} values are" if count > 1 else "1 value is"
            where = f"row {row}, column {column}, {'RGB'[channel]}"
            raise Invalid(f"{many} {what}, the first at {where}; radiance is finite and not negative")
    if not picture.any():
        raise Invalid("is black everywhere; a light is expected")


def read_exr(path):
    """Channels R, G, B, or Y as grey; half or float, scan lines or tiles."""
    import OpenEXR

    parts = _open_exr(path, header_only=True).parts
    if len(parts) != 1:
        raise Invalid(f"holds {len(parts)} parts; one with the channels R, G, B is expected")
    header = parts[0].header
    low, high = header["dataWindow"]
    width, height = (int(n) for n in high.astype(int) - low + 1)
    if not (np.array_equal(low, header["displayWindow"][0]) and np.array_equal(high, header["displayWindow"][1])):
        raise Invalid("holds a cut-out (data window and display window differ); the whole sphere is expected")
    check_size(width, height)
    if header["type"] not in (OpenEXR.scanlineimage, OpenEXR.tiledimage):
        raise Invalid("holds deep pixels; a flat picture is expected")
    names = [channel.name for channel in header["channels"]]
    colours = "RGB" if set("RGB") <= set(names) else "YYY" if "Y" in names and not {"RY", "BY"} & set(names) else ""
    if not colours:
        raise Invalid(f"has the channels {', '.join(names)}; R, G, B, or Y for grey, are expected")
    whole = _open_exr(path)
    if not whole.parts:  # OpenEXR drops a part whose pixels it cannot read, and prints why
        raise Invalid("is truncated or corrupt: its pixels cannot be read")
    channels = whole.channels()
    picture = np.empty((height, width, 3), dtype=np.float32)
    for i, name in enumerate(colours):
        if channels[name].pixels.shape != (height, width):
            raise Invalid(f"its channel {name} is subsampled; a value for each pixel is expected")
        picture[..., i] = channels[name].pixels
    return picture


def _open_exr(path, header_only=False):
    import OpenEXR

    try:
        return OpenEXR.File(str(path), separate_channels=True, header_only=header_only)
    except (RuntimeError, ValueError, TypeError) as error:  # UnicodeDecodeError is a ValueError
        reason = " ".join(str(error).split())
        raise Invalid(f"is not a whole OpenEXR file ({reason})") from None


def read_hdr(path):
    """Radiance RGBE, flat or run-length encoded: Ward, "Real Pixels", Graphics Gems II; decoded as in Walter's rgbe.c.

    All eight orders of lines and columns; EXPOSURE is divided out.
    """
    data = Path(path).read_bytes()
    head, blank, rest = data.partition(b"\n\n")
    lines = head.decode("latin-1").splitlines()
    if not lines or not lines[0].startswith("#?"):
        raise Invalid("is not a Radiance file: it does not begin with '#?RADIANCE'")
    settings = [line.partition("=")[::2] for line in lines[1:] if "=" in line and not line.startswith("#")]
    form = dict(settings).get("FORMAT", "32-bit_rle_rgbe").strip()
    if form != "32-bit_rle_rgbe":
        raise Invalid(f"has FORMAT {form}; 32-bit_rle_rgbe is expected")
    resolution, _, body = rest.partition(b"\n")
    match = re.fullmatch(rb"([-+])([XY]) +(\d{1,9}) +([-+])([XY]) +(\d{1,9})\s*", resolution)
    if not blank or not match or match[2] == match[5]:
        raise Invalid("has no line with its resolution, such as '-Y 512 +X 1024', after its header")
    lines, length = int(match[3]), int(match[6])
    by_rows = match[2] == b"Y"
    check_size(*((length, lines) if by_rows else (lines, length)))
    rgbe = decode_rgbe(np.frombuffer(body, dtype=np.uint8), lines, length)
    if not by_rows:
        rgbe = rgbe.swapaxes(0, 1)
    signs = {match[2]: match[1], match[5]: match[4]}
    rgbe = rgbe[:: -1 if signs[b"Y"] == b"+" else 1, :: -1 if signs[b"X"] == b"-" else 1]
    exposure = 1.0
    for name, value in settings:
        if name == "EXPOSURE":
            try:
                exposure *= float(value)
            except ValueError:
                raise Invalid(f"has EXPOSURE {value.strip()}, which is not a number") from None
    if not (np.isfinite(exposure) and exposure > 0):
        raise Invalid(f"has EXPOSURE {exposure}; a number above 0 is expected")
    scale = np.ldexp(1.0, np.arange(256) - (128 + 8)) / exposure
    scale[0] = 0.0  # exponent 0 is black
    return (rgbe[..., :3] * scale[rgbe[..., 3:]]).astype(np.float32)


def decode_rgbe(data, lines, length):
    """RGBE bytes (lines, length, 4) of uint8 data: lines in runs by component, or pixels, some being repeat counts."""
    if 8 <= length < 32768 and len(data) >= 4 and data[0] == data[1] == 2 and data[2] < 128:
        return _decode_components(data.tobytes(), lines, length)
    pixels = data[: len(data) // 4 * 4].reshape(-1, 4)
    # A pixel 1, 1, 1, n repeats the last one n times; further such pixels in a row are higher bytes of the count.
    repeats = np.all(pixels[:, :3] == 1, axis=1)
    if repeats.any():
        last = np.maximum.accumulate(np.where(repeats, -1, np.arange(len(pixels))))
        place = np.arange(len(pixels)) - last - 1
        if last[0] < 0 or np.max(place[repeats]) > 2:
            raise Invalid("is corrupt: a repeat count without a pixel or out of range")
        counts = np.where(repeats, pixels[:, 3].astype(int) << (8 * place.clip(0)), 1)
        needed = np.searchsorted(np.cumsum(counts), lines * length) + 1
        pixels = pixels[np.repeat(last[:needed], counts[:needed])]
    if len(pixels) < lines * length:
        raise Invalid(f"is truncated: {len(pixels)} of {lines * length} pixels")
    return pixels[: lines * length].reshape(lines, length, 4)


def _decode_components(data, lines, length):
    out = np.empty((lines, 4, length), dtype=np.uint8)
    start = bytes((2, 2, length >> 8, length & 255))
    i = 0
    try:
        for line in range(lines):
            if data[i : i + 4] != start:
                raise Invalid(f"is {'truncated' if i + 4 > len(data) else 'corrupt'} at line {line} of {lines}")
            i += 4
            row = bytearray()
            for component in range(1, 5):
                while len(row) < component * length:
                    count = data[i]
                    if count > 128:  # a run of count - 128 equal bytes, else `count` bytes as they are
                        row += data[i + 1 : i + 2] * (count - 128)
                        i += 2
                    else:
                        row += data[i + 1 : i + 1 + count]
                        i += 1 + count
                    if count == 0 or len(row) > component * length or i > len(data):
                        raise Invalid(f"is {'truncated' if i > len(data) else 'corrupt'} at line {line} of {lines}")
            out[line] = np.frombuffer(row, dtype=np.uint8).reshape(4, length)
    except IndexError:
        raise Invalid(f"is truncated at line {line} of {lines}") from None
    return out.swapaxes(1, 2)

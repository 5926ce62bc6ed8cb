"""Laws of the surroundings, their sampling, the random numbers, and the files they come from."""

import struct

import numpy as np
import OpenEXR
import pytest
from scipy import stats

from brdf_explorer import environment as surroundings
from brdf_explorer.environment import LUMINANCE, environment, texel_solid_angle, with_tables
from brdf_explorer.glsl import assemble
from brdf_explorer.lib.common import PI, normalize
from brdf_explorer.lib.environment import (
    environment_direction,
    environment_radiance,
    environment_uv,
    pdf_environment,
    sample_environment,
)
from brdf_explorer.lib.random import STEPS, pcg3d, random2
from brdf_explorer.lib.warp import cosine_hemisphere
from brdf_explorer.model import Invalid

SIGNIFICANT = 1e-4  # probability of a false alarm of a statistical test


def rng(seed):
    return np.random.default_rng(seed)


def sphere(count, seed):
    return normalize(rng(seed).standard_normal((count, 3)))


def unit_square(count, seed):
    """Points in steps of 2^-24, as random2 gives them."""
    return rng(seed).integers(0, 2**24, (count, 2)) * 2.0**-24


def spots():
    """A map with black regions, black rows, a single texel far brighter than the rest, and one far dimmer."""
    radiance = rng(1).lognormal(0, 1.5, (16, 32, 3)).astype(np.float32)
    radiance[3:6, 5:20] = 0
    radiance[11:15] = 0
    radiance[4, 12] = 3e4, 2e4, 1e4
    radiance[12, 31] = 0, 0, 1e-6
    return with_tables("spots", radiance)


ENVIRONMENTS = {
    "furnace": lambda: environment("furnace"),
    "sky": lambda: environment("sky"),
    "studio": lambda: environment("studio"),
    "spots": spots,
}


def extremes():
    """The ends of float32's range."""
    radiance = np.full((4, 8, 3), np.finfo(np.float32).smallest_subnormal)
    radiance[1, 2] = np.finfo(np.float32).max
    return with_tables("extremes", radiance)


@pytest.fixture(params=ENVIRONMENTS)
def light(request):
    return ENVIRONMENTS[request.param]()


# --- sampling --------------------------------------------------------------------------------------------------------


def test_density_integrates_to_one(light):
    density = light.map[..., 3].astype(float)
    assert np.sum(density * texel_solid_angle(*density.shape)[:, None]) == pytest.approx(1, abs=1e-6)


def test_density_is_positive_where_there_is_light(light):
    w = sphere(200_000, 2)
    lit = np.any(environment_radiance(light.map, w) > 0, axis=-1)
    assert np.all(pdf_environment(light.map, w)[lit] > 0)


def test_extreme_radiance():
    light = extremes()
    density = light.map[..., 3].astype(float)
    assert np.all(density > 0)
    assert np.sum(density * texel_solid_angle(*density.shape)[:, None]) == pytest.approx(1, abs=1e-6)


def test_samples_follow_the_density():
    light = spots()
    count = 400_000
    w, _ = sample_environment(light.map, light.cdf, unit_square(count, 3))
    u, v = np.moveaxis(environment_uv(w), -1, 0)
    height, width = light.map.shape[:2]
    # Quarters of texels, of equal area: a texel's halves in s = sin^2(theta / 2) = (1 - cos theta) / 2.
    row, column = np.minimum((v * height).astype(int), height - 1), np.minimum((u * width).astype(int), width - 1)
    s = np.sin(PI * np.arange(height + 1) / (2 * height)) ** 2
    lower = (1 - w[:, 1]) / 2 > (s[row] + s[row + 1]) / 2
    right = u * width - column > 0.5
    seen = np.bincount(((row * width + column) * 2 + lower) * 2 + right, minlength=height * width * 4)
    expected = count * np.repeat(light.map[..., 3] * texel_solid_angle(height, width)[:, None], 4).astype(float) / 4
    assert seen[expected == 0].sum() == 0
    rare = expected < 5
    seen = np.append(seen[~rare], seen[rare].sum())
    expected = np.append(expected[~rare], expected[rare].sum())
    assert stats.chisquare(seen, expected * seen.sum() / expected.sum()).pvalue > SIGNIFICANT


def test_sampler_tells_its_own_density(light):
    w, pdf = sample_environment(light.map, light.cdf, unit_square(100_000, 4))
    assert np.allclose(np.sum(w * w, axis=-1), 1, atol=1e-12)
    same = pdf_environment(light.map, w) == pdf
    assert np.mean(same) > 0.9999  # the rest lie on a texel's border


def test_estimate_of_the_total_is_unbiased(light):
    w, pdf = sample_environment(light.map, light.cdf, unit_square(400_000, 5))
    estimate = environment_radiance(light.map, w) / pdf[:, None]
    exact = total(light)
    error = estimate.std(axis=0) / np.sqrt(len(w)) + 1e-6 * exact
    assert np.all(abs(estimate.mean(axis=0) - exact) < stats.norm.isf(SIGNIFICANT / 6) * error)


def test_estimate_has_little_noise():
    """Importance sampling does its work: the estimate varies by less than half its mean from sample to sample."""
    for name in ("sky", "studio"):
        light = environment(name)
        w, pdf = sample_environment(light.map, light.cdf, unit_square(100_000, 6))
        estimate = environment_radiance(light.map, w) @ LUMINANCE / pdf
        assert estimate.std() < 0.5 * estimate.mean()


def total(light, order=4):
    """Integral (3,) of the lookup over the sphere. It is linear between texels: along rows that gives the mean, across
    rows Gauss-Legendre on halves of texels meets no kink."""
    height = len(light.map)
    nodes, weights = np.polynomial.legendre.leggauss(order)
    v = (np.arange(2 * height)[:, None] + 0.5 + nodes / 2) / (2 * height)
    across = 2 * PI * PI * np.sin(PI * v) * weights / (4 * height)
    rows = light.radiance.mean(axis=1, dtype=float).T
    return np.array([np.sum(across * np.interp(v * height - 0.5, np.arange(height), row)) for row in rows])


# --- the built-in surroundings ---------------------------------------------------------------------------------------


def test_furnace_is_exactly_one(gpu):
    light = environment("furnace")
    w = sphere(50_000, 7).astype(np.float32)
    assert np.all(environment_radiance(light.map, w) == 1)
    assert np.all(evaluate(gpu, light, "vec3 environment_radiance(sampler2D map, vec3 w)", w)[0] == 1)
    assert np.allclose(light.map[..., 3], 1 / (4 * PI), rtol=2e-6)  # the least row has 6e5 of the 2^24 counts


def upward(light):
    """Light that falls on each texel's share of a surface facing up, (H, W, 3)."""
    height, width = light.map.shape[:2]
    cosine = np.maximum(np.cos(PI * (np.arange(height) + 0.5) / height), 0)
    return light.radiance * (cosine * texel_solid_angle(height, width))[:, None, None]


def test_sky_lights_a_white_surface_to_one():
    assert np.allclose(upward(environment("sky")).sum(axis=(0, 1)) / PI, 1, rtol=1e-5)


def test_sun_is_realistic():
    """On a clear day with the sun 41 degrees up, 75 to 90 % of the light on the ground comes straight from the disc."""
    light = environment("sky")
    height, width = light.map.shape[:2]
    cosine = surroundings.directions(height, width) @ surroundings.SUN
    disc = cosine > np.cos(2 * surroundings.SUN_RADIUS)
    flux = upward(light) @ LUMINANCE
    assert 0.75 < flux[disc].sum() / flux.sum() < 0.9
    cover = surroundings.disc_cover(surroundings.directions(height, width), surroundings.SUN, surroundings.SUN_RADIUS)
    solid_angle = np.sum(cover * texel_solid_angle(height, width)[:, None])
    assert solid_angle == pytest.approx(2 * PI * (1 - np.cos(surroundings.SUN_RADIUS)), rel=0.01)
    sun = surroundings.preetham_sun(surroundings.SUN[1], surroundings.TURBIDITY)
    assert 80 < sun @ LUMINANCE < 110  # klx, direct beam
    assert sun[0] > sun[1] > sun[2]


def test_sky_at_known_places():
    """The zenith is the unit of the sky's luminance, and blue; the disc is the brightest; the ground is plain."""
    zenith = surroundings.preetham_sky(np.array([0.0, 1.0, 0.0]), surroundings.SUN, surroundings.TURBIDITY)
    assert zenith @ LUMINANCE == pytest.approx(1, rel=1e-3)
    assert zenith[2] > zenith[1] > zenith[0]
    radiance = environment("sky").radiance
    row, column = np.unravel_index(np.argmax(radiance[..., 1]), radiance.shape[:2])
    brightest = surroundings.directions(*radiance.shape[:2])[row, column]
    assert brightest @ surroundings.SUN > np.cos(surroundings.SUN_RADIUS)
    assert np.allclose(radiance[radiance.shape[0] // 2 :], surroundings.GROUND)


def test_studio_is_exposed_for_white():
    light = environment("studio")
    w, pdf = sample_environment(light.map, light.cdf, unit_square(20_000, 8))
    weight = environment_radiance(light.map, w) / pdf[:, None] / PI
    facets = sphere(2_000, 9)
    lambert = np.maximum(facets @ w.T, 0) @ weight / len(w)
    assert np.max(lambert @ LUMINANCE) == pytest.approx(1, abs=0.02)
    assert np.max(light.radiance) > 3  # a mirror shows highlights
    assert np.allclose(light.radiance / (light.radiance @ LUMINANCE)[..., None], 1, atol=0.08)  # neutral


def test_kept_in_memory(tmp_path):
    assert environment("studio") is environment("studio")
    file = tmp_path / "a.exr"
    write_exr(file, picture(10))
    first = environment("file", str(file))
    assert environment("file", file) is first
    write_exr(file, 2 * picture(10, height=16))
    assert environment("file", str(file)).map.shape == (16, 32, 4)


def test_textures_are_not_written_to(light):
    for array in (light.map, light.cdf):
        assert array.dtype == np.float32 and array.flags.c_contiguous and not array.flags.writeable


# --- twins -----------------------------------------------------------------------------------------------------------

CHUNK = 'uniform highp sampler2D map;\nuniform highp sampler2D cdf;\n#include "lib/environment.glsl"\n'


def evaluate(gpu, light, signature, *arguments):
    """Values of a function of lib/environment.glsl, whose samplers are the light's."""
    head, _, tail = signature.partition("(")
    parameters = [p.strip() for p in tail.rstrip(")").split(",")]
    plain = [p for p in parameters if "sampler2D" not in p]
    kind, name = head.split()
    names = ", ".join(p.split()[-1] for p in parameters)
    wrapper = f"{kind} wrapped({', '.join(plain)}) {{ return {name}({names}); }}\n"

    def source(call):
        return assemble("views/probe.frag", generated={"chunk.glsl": CHUNK + wrapper, "call.glsl": call})

    textures = {"map": (gpu.texture(light.map), 8), "cdf": (gpu.texture(light.cdf), 9)}
    for texture, unit in textures.values():
        texture.use(unit)
    units = {name: unit for name, (_, unit) in textures.items()}
    results = gpu.evaluate(source, f"{kind} wrapped({', '.join(plain)})", *arguments, uniforms=units)
    for texture, _ in textures.values():
        texture.release()
    return results


def corners():
    """Directions along the axes and near the poles and the seam."""
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    near = normalize(np.array([[1e-4, 1, 1e-4], [1e-4, -1, -1e-4], [1e-7, 0.3, 1], [-1e-7, 0.3, 1], [0, 0.3, 1]]))
    return np.concatenate([axes, near]).astype(np.float32)


def test_twin_uv(gpu):
    w = np.concatenate([sphere(50_000, 11).astype(np.float32), corners()])
    value = gpu.evaluate_chunk("lib/environment.glsl", "vec2 environment_uv(vec3 w)", w)[0]
    assert np.allclose(value, environment_uv(w), rtol=0, atol=2e-7)


def test_twin_direction(gpu):
    u, s = unit_square(50_000, 12).T.astype(np.float32)
    s = np.float32(s) ** 4  # many near the pole
    signature = "vec3 environment_direction(float u, float s, float c)"
    value = gpu.evaluate_chunk("lib/environment.glsl", signature, u, s, 1 - s)[0]
    assert np.allclose(value, environment_direction(u.astype(float), s, 1 - s), rtol=0, atol=1e-6)


def test_uv_and_direction_are_inverse():
    w = sphere(50_000, 13)
    u, v = np.moveaxis(environment_uv(w), -1, 0)
    back = environment_direction(u, np.sin(PI * v / 2) ** 2, np.cos(PI * v / 2) ** 2)
    assert np.allclose(back, w, atol=1e-12)


def test_orientation():
    """The middle of the map is ahead of the eye, columns run to its right, rows downwards."""
    directions = [(0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)]
    places = environment_uv(np.array(directions, dtype=float))
    assert np.allclose(places, [(0.5, 0.5), (0.75, 0.5), (0.25, 0.5), (0.5, 0), (0.5, 1)])


def test_twin_radiance(gpu, light):
    """Within float32's error of the place times the steepest slope that the neighbourhood allows."""
    w = np.concatenate([sphere(50_000, 14).astype(np.float32), corners()])
    value = evaluate(gpu, light, "vec3 environment_radiance(sampler2D map, vec3 w)", w)[0]
    height, width = light.map.shape[:2]
    row, column = place(w, height, width)
    around = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    neighbours = [light.radiance[np.clip(row + i, 0, height - 1), (column + j) % width] for i, j in around]
    brightest = np.max(neighbours, axis=0)
    assert np.all(abs(value - environment_radiance(light.map, w)) <= (4e-7 * width + 1e-6) * brightest)


def place(w, height, width):
    u, v = np.moveaxis(environment_uv(w), -1, 0)
    return np.minimum((v * height).astype(int), height - 1), np.minimum((u * width).astype(int), width - 1)


def test_twin_pdf(gpu, light):
    w = sphere(50_000, 15).astype(np.float32)
    value = evaluate(gpu, light, "float pdf_environment(sampler2D map, vec3 w)", w)[0]
    assert (
        np.mean(value == pdf_environment(light.map, w).astype(np.float32)) > 0.999
    )  # the rest lie on a texel's border


def test_twin_sample(gpu, light):
    u = np.concatenate([unit_square(50_000, 16), [(0, 0), (0, 1 - 2.0**-24), (1 - 2.0**-24, 0), (1 - 2.0**-24,) * 2]])
    signature = "vec3 sample_environment(sampler2D map, sampler2D cdf, vec2 u, out float pdf)"
    w, pdf = evaluate(gpu, light, signature, u)
    expected_w, expected_pdf = sample_environment(light.map, light.cdf, u)
    assert np.array_equal(pdf, expected_pdf.astype(np.float32))  # the same texel for every u, exactly
    assert np.allclose(w, expected_w, rtol=0, atol=2e-6)


@pytest.mark.parametrize("dialect", ["330 core", "300 es"])
@pytest.mark.parametrize("chunk", ["environment", "random", "warp"])
def test_compiles(gpu, dialect, chunk):
    body = CHUNK.replace("environment", chunk) if chunk == "environment" else f'#include "lib/{chunk}.glsl"\n'
    generated = {
        "chunk.glsl": '#include "lib/common.glsl"\n' + body,
        "call.glsl": "out vec4 c;\nvoid main() { c = vec4(1.0); }\n",
    }
    gpu.program(
        assemble("views/probe.frag", generated=generated, dialect=dialect), assemble("views/full.vert", dialect=dialect)
    )


# --- random numbers --------------------------------------------------------------------------------------------------


def test_hash_twin(gpu):
    v = rng(20).integers(0, 2**32, (10_000, 3), dtype=np.uint32)
    halves = (
        "vec3 high(uvec3 v) { return vec3(pcg3d(v) >> 16u); }\nvec3 low(uvec3 v) { return vec3(pcg3d(v) & 65535u); }\n"
    )

    def source(call):
        chunk = '#include "lib/random.glsl"\n' + halves
        return assemble("views/probe.frag", generated={"chunk.glsl": chunk, "call.glsl": call})

    high = gpu.evaluate(source, "vec3 high(uvec3 v)", v)[0].astype(np.uint32)
    low = gpu.evaluate(source, "vec3 low(uvec3 v)", v)[0].astype(np.uint32)
    assert np.array_equal((high << np.uint32(16)) + low, pcg3d(v))


def test_random_twin(gpu):
    pixel = rng(21).integers(0, 8192, (10_000, 2), dtype=np.uint32)
    index = rng(22).integers(0, 2**32, 10_000, dtype=np.uint32)
    index[0] = 2**32 - 1
    for stream in range(3):
        signature = "vec2 random2(uvec2 pixel, uint index, uint stream)"
        value = gpu.evaluate_chunk("lib/random.glsl", signature, pixel, index, np.uint32(stream))[0]
        assert np.array_equal(value, random2(pixel, index, stream))
        assert np.all((value >= 0) & (value < 1))


def test_steps_are_of_the_cyclotomic_field():
    k = np.array([[2, 4], [1, 6], [5, 7]])
    assert np.allclose(STEPS, 2**32 * (2 * np.cos(2 * PI * k / 17) % 1), rtol=0, atol=1.5)
    assert np.all(STEPS % 2 == 1)  # odd: the period is 2^32


def test_points_of_a_pixel_spread_evenly():
    """The means of smooth functions of one stream, and of two together, err far less than those of random points."""
    count = 1024
    pixel = np.stack(np.meshgrid(np.arange(16), np.arange(16)), axis=-1).reshape(-1, 1, 2)
    a, b, c = (random2(pixel, np.arange(count), stream) for stream in range(3))
    joint = [np.concatenate(streams, axis=-1) for streams in ([a, b], [b, c], [a, c], [a, b, c])]
    for points in (a, b, c, *joint):
        dimensions = points.shape[-1]
        means = np.prod(2 * points, axis=-1).mean(axis=-1)
        random = np.sqrt(((4 / 3) ** dimensions - 1) / count)
        assert np.sqrt(np.mean((means - 1) ** 2)) < (0.2 if dimensions == 2 else 0.6) * random


def test_pixels_are_independent():
    """First points of neighbouring pixels: uniform, and uncorrelated with each other and between streams."""
    pixel = np.stack(np.meshgrid(np.arange(256), np.arange(256)), axis=-1)
    values = np.concatenate([random2(pixel, 0, stream) for stream in range(3)], axis=-1)
    right, below = values[:-1, 1:], values[1:, :-1]
    table = np.concatenate([values[:-1, :-1], right, below], axis=-1).reshape(-1, 18)
    for column in table.T[:6]:
        assert stats.kstest(column, "uniform").pvalue > SIGNIFICANT
    correlation = np.corrcoef(table.T) - np.eye(18)
    assert np.max(abs(correlation)) < stats.norm.isf(SIGNIFICANT / 153) / np.sqrt(len(table))


def test_cosine_hemisphere():
    x, _ = np.polynomial.legendre.leggauss(64)
    u = np.stack(np.meshgrid((x + 1) / 2, (np.arange(64) + 0.5) / 64), axis=-1).reshape(-1, 2)
    weights = np.tile(np.polynomial.legendre.leggauss(64)[1] / 2, 64) / 64
    w = cosine_hemisphere(u)
    assert np.allclose(np.sum(w * w, axis=-1), 1)
    assert np.allclose(weights @ w[:, 2] ** 2, 1 / 2) and np.allclose(weights @ w[:, 2] ** 4, 1 / 3)
    assert np.allclose(weights @ w[:, :2], 0) and np.allclose(weights @ w[:, :2] ** 2, 1 / 4)


def test_cosine_hemisphere_twin(gpu):
    u = np.concatenate([unit_square(20_000, 23), [(0, 0), (1 - 2.0**-24, 0.5)]])
    value = gpu.evaluate(
        lambda call: assemble(
            "views/probe.frag",
            generated={"chunk.glsl": '#include "lib/common.glsl"\n#include "lib/warp.glsl"\n', "call.glsl": call},
        ),
        "vec3 cosine_hemisphere(vec2 u)",
        u,
    )[0]
    assert np.allclose(value, cosine_hemisphere(u), rtol=0, atol=1e-6)
    assert np.allclose(value[:, 2], cosine_hemisphere(u)[:, 2], rtol=2e-7)


# --- files -----------------------------------------------------------------------------------------------------------


def picture(seed, height=8):
    return rng(seed).lognormal(0, 2, (height, 2 * height, 3)).astype(np.float32)


def write_exr(file, array, names="RGB", dtype=np.float32, tiled=False, header=None):
    array = array.astype(dtype)
    channels = {name: np.ascontiguousarray(array[..., i]) for i, name in enumerate(names)}
    settings = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.tiledimage if tiled else OpenEXR.scanlineimage}
    if tiled:
        settings["tiles"] = OpenEXR.TileDescription()
    OpenEXR.File({**settings, **(header or {})}, channels).write(str(file))


@pytest.mark.parametrize("tiled", [False, True], ids=["lines", "tiles"])
@pytest.mark.parametrize("dtype", [np.float16, np.float32])
@pytest.mark.parametrize("names", ["RGB", "RGBA", "Y", "ZRGB"])
def test_exr_round_trip(tmp_path, names, dtype, tiled):
    file = tmp_path / "a.exr"
    values = np.concatenate([picture(30), picture(31)], axis=-1)[..., : len(names)].astype(dtype)
    write_exr(file, values, names, dtype, tiled)
    first = names.find("R") if "R" in names else None
    expected = values[..., first : first + 3] if first is not None else np.repeat(values, 3, axis=-1)
    assert np.array_equal(environment("file", str(file)).radiance, expected.astype(np.float32))


def rgbe(array):
    """Walter's float2rgbe: uint8 (H, W, 4) of linear RGB (H, W, 3)."""
    _, exponent = np.frexp(array.max(axis=-1))
    mantissa = np.floor(array * np.ldexp(256.0, -exponent)[..., None])
    return np.concatenate([mantissa, exponent[..., None] + 128], axis=-1).astype(np.uint8)


def decoded(pixels):
    return np.ldexp(pixels[..., :3].astype(float), pixels[..., 3:].astype(int) - 136).astype(np.float32)


def runs(pixels):
    """Lines of RGBE, each component in runs of equal bytes and stretches of others."""
    out = b""
    for line in pixels:
        out += struct.pack(">BBH", 2, 2, len(line))
        for component in line.T:
            i = 0
            while i < len(component):
                same = 1
                while same < 127 and i + same < len(component) and component[i + same] == component[i]:
                    same += 1
                out += bytes((128 + same, component[i])) if same > 2 else bytes((same, *component[i : i + same]))
                i += same
    return out


def repeats(pixels):
    """The older form: a pixel 1, 1, 1, n repeats the one before."""
    out, flat = b"", pixels.reshape(-1, 4)
    i = 0
    while i < len(flat):
        same = 1
        while i + same < len(flat) and np.array_equal(flat[i + same], flat[i]):
            same += 1
        out += flat[i].tobytes()
        more = same - 1
        while more:
            out += bytes((1, 1, 1, more & 255))
            more >>= 8
        i += same
    return out


def flat(pixels):
    return pixels.tobytes()


def write_hdr(file, body, resolution, settings="FORMAT=32-bit_rle_rgbe\n"):
    file.write_bytes(f"#?RADIANCE\n# a comment = nothing\n{settings}\n{resolution}\n".encode() + body)


def plain():
    """RGBE pixels with stretches of equal ones, longer than 255."""
    array = picture(32, height=32)
    array[4:20] = array[4, 5]
    array[20, :, 1] = 0.5
    array[25] = 0
    pixels = rgbe(array)
    pixels[25] = 0
    return pixels


@pytest.mark.parametrize("encode", [flat, runs, repeats])
def test_hdr_round_trip(tmp_path, encode):
    pixels = plain()
    write_hdr(tmp_path / "a.hdr", encode(pixels), "-Y 32 +X 64")
    assert np.array_equal(environment("file", str(tmp_path / "a.hdr")).radiance, decoded(pixels))


@pytest.mark.parametrize("resolution", ["-Y 32 +X 64", "+Y 32 +X 64", "-Y 32 -X 64", "+X 64 -Y 32", "-X 64 +Y 32"])
def test_hdr_orders(tmp_path, resolution):
    """Seen through each order of lines and columns, the picture is the same."""
    pixels = plain()
    stored = pixels[:: -1 if "+Y" in resolution else 1, :: -1 if "-X" in resolution else 1]
    if resolution[1] == "X":
        stored = stored.swapaxes(0, 1)
    write_hdr(tmp_path / "a.hdr", runs(stored), resolution)
    assert np.array_equal(environment("file", str(tmp_path / "a.hdr")).radiance, decoded(pixels))


def test_hdr_exposure_is_divided_out(tmp_path):
    pixels = plain()
    write_hdr(tmp_path / "a.hdr", runs(pixels), "-Y 32 +X 64", "EXPOSURE=2\nEXPOSURE= 4.0\n")
    assert np.allclose(environment("file", str(tmp_path / "a.hdr")).radiance, decoded(pixels) / 8)


def test_hdr_of_another_program(tmp_path):
    mitsuba = pytest.importorskip("mitsuba")
    mitsuba.set_variant("scalar_rgb")
    array = picture(33, height=16)
    mitsuba.Bitmap(array).write(str(tmp_path / "a.hdr"))
    radiance = environment("file", str(tmp_path / "a.hdr")).radiance
    assert np.all(abs(radiance - array) <= array.max(axis=-1, keepdims=True) / 128)


def changed(array, *places):
    array = array.copy()
    for *place, value in places:
        array[tuple(place)] = value
    return array


def hdr_bytes(body, resolution="-Y 32 +X 64", settings=""):
    return f"#?RADIANCE\n{settings}\n{resolution}\n".encode() + body


def truncated_exr(file):
    write_exr(file, picture(34, height=64))
    file.write_bytes(file.read_bytes()[:3000])


def corrupt_exr(file):
    write_exr(file, picture(34))
    data = bytearray(file.read_bytes())
    data[40:60] = b"\xff" * 20
    file.write_bytes(data)


def two_parts(file):
    parts = [OpenEXR.Part({"name": n}, {"RGB": picture(35)}) for n in "ab"]
    OpenEXR.File(parts).write(str(file))


def cut_out(file):
    window = (np.array([0, 0], np.int32), np.array([31, 15], np.int32))
    write_exr(file, picture(36), header={"displayWindow": window})


def huge_exr(file):
    write_exr(file, picture(36))
    data = bytearray(file.read_bytes())
    for name in (b"dataWindow\0box2i\0", b"displayWindow\0box2i\0"):
        at = data.index(name) + len(name) + 4
        data[at : at + 16] = struct.pack("<4i", 0, 0, 199999, 99999)
    file.write_bytes(data)


BAD = {
    "missing": ("a.exr", None, "no such file"),
    "folder": ("a.exr", lambda f: f.mkdir(), "folder"),
    "other type": ("a.png", lambda f: f.write_bytes(b"\x89PNG"), "neither .exr nor .hdr"),
    "empty exr": ("a.exr", lambda f: f.write_bytes(b""), "empty"),
    "empty hdr": ("a.hdr", lambda f: f.write_bytes(b""), "empty"),
    "exr: other content": ("a.exr", lambda f: f.write_bytes(b"#?RADIANCE\n" * 50), "not a whole OpenEXR file"),
    "exr: truncated": ("a.exr", truncated_exr, "truncated or corrupt"),
    "exr: corrupt": ("a.exr", corrupt_exr, "not a whole OpenEXR file"),
    "exr: huge": ("a.exr", huge_exr, "at most 4096 x 2048"),
    "exr: square": ("a.exr", lambda f: write_exr(f, picture(37)[:, :8]), "8 x 8; a lat-long picture is twice as wide"),
    "exr: depth only": ("a.exr", lambda f: write_exr(f, picture(37), "Z"), "has the channels Z"),
    "exr: luma and chroma": ("a.exr", lambda f: write_exr(f, picture(37), ("BY", "RY", "Y")), "BY, RY, Y"),
    "exr: parts": ("a.exr", two_parts, "2 parts"),
    "exr: cut-out": ("a.exr", cut_out, "cut-out"),
    "nan": (
        "a.exr",
        lambda f: write_exr(f, changed(picture(38), (2, 5, 1, np.nan))),
        "1 value is not finite, the first at row 2, column 5, G",
    ),
    "inf": (
        "a.exr",
        lambda f: write_exr(f, changed(picture(38), (2, 5, 1, np.inf), (3, 0, 0, -np.inf))),
        "2 values are",
    ),
    "negative": (
        "a.exr",
        lambda f: write_exr(f, changed(picture(38), (7, 15, 2, -1e-9))),
        "negative, the first at row 7",
    ),
    "black": ("a.exr", lambda f: write_exr(f, 0 * picture(38)), "black everywhere"),
    "hdr: other content": ("a.hdr", lambda f: f.write_bytes(b"P6 4 2 255\n" + bytes(24)), "not a Radiance file"),
    "hdr: xyz": (
        "a.hdr",
        lambda f: f.write_bytes(hdr_bytes(b"", settings="FORMAT=32-bit_rle_xyze\n")),
        "32-bit_rle_xyze",
    ),
    "hdr: header only": ("a.hdr", lambda f: f.write_bytes(b"#?RADIANCE\n"), "no line with its resolution"),
    "hdr: resolution": ("a.hdr", lambda f: f.write_bytes(hdr_bytes(b"", "-Y 32 +Y 64")), "no line with its resolution"),
    "hdr: size": ("a.hdr", lambda f: f.write_bytes(hdr_bytes(b"", "-Y 64 +X 64")), "64 x 64; a lat-long"),
    "hdr: huge": ("a.hdr", lambda f: f.write_bytes(hdr_bytes(b"", "-Y 400000 +X 800000")), "at most 4096"),
    "hdr: zero": ("a.hdr", lambda f: f.write_bytes(hdr_bytes(b"", "-Y 0 +X 0")), "0 x 0"),
    "hdr: exposure": (
        "a.hdr",
        lambda f: f.write_bytes(hdr_bytes(flat(plain()), settings="EXPOSURE=x\n")),
        "EXPOSURE x",
    ),
    "hdr: truncated": ("a.hdr", lambda f: f.write_bytes(hdr_bytes(flat(plain())[:-1])), "truncated"),
    "hdr: truncated runs": ("a.hdr", lambda f: f.write_bytes(hdr_bytes(runs(plain())[:-300])), "truncated at line"),
    "hdr: corrupt runs": (
        "a.hdr",
        lambda f: f.write_bytes(hdr_bytes(bytes((2, 2, 0, 64)) + bytes(9999))),
        "corrupt at line 0",
    ),
    "hdr: overlong run": (
        "a.hdr",
        lambda f: f.write_bytes(hdr_bytes(bytes((2, 2, 0, 64)) + b"\xff" * 999)),
        "corrupt at line",
    ),
    "hdr: repeats nothing": (
        "a.hdr",
        lambda f: f.write_bytes(hdr_bytes(b"\1\1\1\5" * 4000)),
        "corrupt: a repeat count",
    ),
    "hdr: black": ("a.hdr", lambda f: f.write_bytes(hdr_bytes(bytes(32 * 64 * 4))), "black everywhere"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_file(tmp_path, case):
    name, make, message = BAD[case]
    file = tmp_path / name
    if make:
        make(file)
    with pytest.raises(Invalid) as caught:
        environment("file", str(file))
    text = str(caught.value)
    assert text.startswith(f"{file}: ") and message in text and "\n" not in text


@pytest.mark.parametrize("name", ["exr", "hdr"])
def test_damaged_file_is_read_or_refused(tmp_path, name):
    """Bytes changed or cut off at random: a picture or Invalid, nothing else."""
    file = tmp_path / f"a.{name}"
    write_exr(file, picture(40)) if name == "exr" else write_hdr(file, runs(plain()), "-Y 32 +X 64")
    whole = file.read_bytes()
    random = rng(41)
    for _ in range(300):
        data = bytearray(whole)
        for at in random.integers(0, len(data), random.integers(1, 4)):
            data[at] = random.integers(0, 256)
        if random.random() < 0.3:
            data = data[: random.integers(1, len(data))]
        file.write_bytes(data)
        try:
            surroundings.read_picture(file)
        except Invalid as error:
            assert "\n" not in str(error)


def test_unknown_name():
    with pytest.raises(Invalid, match="did you mean studio"):
        environment("studo")
    with pytest.raises(Invalid, match="no file given"):
        environment("file")
    with pytest.raises(Invalid, match="no such file"):
        environment("file", "a\0b.exr")

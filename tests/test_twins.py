"""Each formula's twins agree: the GLSL in float32 and the numpy in float64, function by function.

Signatures are read from the shaders; an argument's name says from where it is drawn, over decades. The float64 twin gets the
arguments that float32 holds. A new chunk or model is covered as soon as its files are there.
"""

import importlib
import inspect
import re
from itertools import combinations

import numpy as np
import pytest
from oracles.cases import CASES, SLOW, case_label, choices_of, pairwise, typed

from brdf_explorer.glsl import SHADERS, Signature, assemble, functions
from brdf_explorer.lib import fresnel, schlick
from brdf_explorer.lib.common import PI, TWO_PI, dot, length, normalize, quotient, vec
from brdf_explorer.lib.fresnel import eta2_cos2_t
from brdf_explorer.lib.random import seeded
from brdf_explorer.lib.refraction import T_spread, cos_refracted, refracted, sum_refracted, upward
from brdf_explorer.measure.laws import doubt
from brdf_explorer.model import Param, declared
from brdf_explorer.models import MODELS

COMMON, COMMON_SHARE = 1e-5, 0.999
"""The relative error that this share of the values must not exceed."""
WORST = 1e-3
"""The relative error that no value may exceed."""
WALKS, WALKS_SHARE = 1e-3, 0.995
"""The same of walks by equal random numbers, over up to 64 facets in a row."""

CHUNKS = sorted(p.stem for p in (SHADERS / "lib").glob("*.glsl"))

BY_QUADRATURE = 2e-3
"""COMMON for SLOW models, of values from 1e-4 of the largest on: rounding moves the nodes, so values differ by a share of the
rule's own error, and where two planes are as far apart as two others it may choose the other two."""
NEEDS = {  # what stands before a chunk that declares functions of other slots
    "facets": ("ndf_ggx", "gauss_8"),
    "facets_ggx": ("gauss_8",),
    "facets_beckmann": ("gauss_8",),
    "facet_lobe": ("ndf_ggx", "sampling_ggx_caps", "fresnel_one"),
}

ONLY_NUMPY = {
    "common": {"dot", "length", "normalize", "mix", "quotient", "vec", "split", "above_horizon"},  # words that GLSL has
    "srgb": {"srgb_decode"},  # colours of the interface become linear once, on their way in
    "lost": {"interpolated", "lost_by", "lost_mean_by"},  # numpy is handed the tables
    "lambert_sphere": {"polynomial"},  # a series of one variable
    "diffuse_lambert_sphere_fast": {"grazing_albedo"},  # of a law's limit
    "gauss_8": {"gauss"},  # of whole numbers, as their twins; in f of nonspecular
    "gauss_12": {"gauss"},
    "gauss_16": {"gauss"},
    "random": {"seeded", "next_pass", "random_states"},  # which of a table's rows a shader's pixel knows by its place
}
GIVEN = {  # functions of other slots, which the GLSL declares and finds where it is included, and the twin is given
    "facets": {"facets": ["D", "gauss"]},
    "facet_lambert": {"facet_scale": ["F"], "facet_wi": ["sample_wi"], "facet_pdf": ["D", "pdf_wi"]},
    "facet_lobe": {"facet_scale": ["F"], "facet_wi": ["sample_wi"], "facet_pdf": ["D", "pdf_wi"]},
}
ONLY_GLSL = {
    "ndf_beckmann": {"leading"},  # of float32's rounding
    "lambert_sphere": {"series"},
    "gauss_8": {"gauss"},
    "gauss_12": {"gauss"},
    "gauss_16": {"gauss"},
    "random": {"drawn"},  # the method of Draws
    "refraction": {"leading12"},
}
COLORS = {"f", "diffuse_f", "F", "tonemap", "srgb_encode"}
"""Functions whose components are compared each; other vectors are compared relative to their length."""


# --- signatures ------------------------------------------------------------------------------------------------------


def own(module):
    """The public functions that a module defines itself, by name."""
    found = inspect.getmembers(module, inspect.isfunction)
    return {name: f for name, f in found if f.__module__ == module.__name__ and not name.startswith("_")}


def twin(chunk):
    return importlib.import_module(f"brdf_explorer.lib.{chunk}")


def chunk_of(function):
    return function.file.split("/")[1].removesuffix(".glsl")


LIB = [function for chunk in CHUNKS for function in functions(f"lib/{chunk}.glsl")]


def label(function):
    return f"{chunk_of(function)}.{function.name}"


# --- arguments -------------------------------------------------------------------------------------------------------
# A draw is called with a generator, a count, the components of the type, and the arguments drawn before.


def decades(low, high):
    return lambda rng, n, size, drawn: np.exp(rng.uniform(np.log(low), np.log(high), (n, size)))


def uniform(low, high):
    return lambda rng, n, size, drawn: rng.uniform(low, high, (n, size))


def integers(high):
    return lambda rng, n, size, drawn: rng.integers(0, high, (n, size))


def either(*draws):
    def draw(rng, n, size, drawn):
        which = rng.integers(0, len(draws), n)
        return np.choose(which[:, None], [d(rng, n, size, drawn) for d in draws])

    return draw


def signed(draw):
    return lambda rng, n, size, drawn: draw(rng, n, size, drawn) * rng.choice((-1, 1), (n, size))


def one_plus(draw):
    return lambda rng, n, size, drawn: 1 + draw(rng, n, size, drawn)


ZERO = uniform(0, 0)
COSINE = either(decades(1e-4, 1), uniform(1e-4, 1))


def hemisphere(rng, n, size, drawn):
    z = COSINE(rng, n, 1, drawn)[:, 0]
    phi = rng.uniform(0, TWO_PI, n)
    r = np.sqrt((1 - z) * (1 + z))
    return vec(r * np.cos(phi), r * np.sin(phi), z)


def normals(rng, n, size, drawn):
    """Half of them with slopes on the scale of alpha, where there is one, as the lobe's normals have."""
    w = hemisphere(rng, n, size, drawn)
    if "alpha" in drawn:
        near = rng.random(n) < 0.5
        phi = rng.uniform(0, TWO_PI, n)
        slope = (
            drawn["alpha"] * either(decades(1e-3, 10), uniform(0, 10))(rng, n, 1, drawn) * vec(np.cos(phi), np.sin(phi))
        )
        w[near] = normalize(np.concatenate([slope, np.ones((n, 1))], axis=-1))[near]
    return w


def visible(rng, n, size, drawn):
    """Directions above the horizon, and below it those from which some facet of slopes up to 5 alpha is seen."""
    w = hemisphere(rng, n, size, drawn)
    below = rng.random(n) < 0.5
    phi, a = rng.uniform(0, TWO_PI, n), either(decades(1e-4, 5), uniform(0, 5))(rng, n, 1, drawn)
    w[below] = normalize(np.concatenate([vec(np.cos(phi), np.sin(phi)) / drawn["alpha"], -a], axis=-1))[below]
    return w


def cosine_visible(rng, n, size, drawn):
    a = either(decades(1e-4, 5), uniform(0, 5))(rng, n, 1, drawn)
    return np.where(rng.random((n, 1)) < 0.5, COSINE(rng, n, 1, drawn), -a / np.sqrt(1 + a * a))


def sphere(rng, n, size, drawn):
    return rng.permuted(hemisphere(rng, n, size, drawn), axis=-1) * rng.choice((-1, 1), (n, 1))


def behind(rng, n, size, drawn):
    """Below the surface; half of them where a facet with slopes over decades refracts wo to."""
    below = hemisphere(rng, n, size, drawn) * [1, 1, -1]
    phi = rng.uniform(0, TWO_PI, n)
    slope = decades(1e-4, 10)(rng, n, 1, drawn) * vec(np.cos(phi), np.sin(phi))
    wm, eta = normalize(np.concatenate([slope, np.ones((n, 1))], axis=-1)), drawn["eta"][:, 0]
    w = refracted(drawn["wo"], wm, eta)
    near = (rng.random(n) < 0.5) & (eta2_cos2_t(dot(drawn["wo"], wm), eta) > 0) & (w[:, 2] < -1e-4)
    return np.where(near[:, None], w, below)


def facing(rng, n, size, drawn):
    """Normals that face w, and w itself where light from there would all be reflected."""
    wm = hemisphere(rng, n, size, drawn)
    wm = wm - 2 * np.minimum(dot(drawn["w"], wm)[:, None], 0) * drawn["w"]
    passes = eta2_cos2_t(dot(drawn["w"], wm), drawn["eta"][:, 0]) > 0
    return np.where(passes[:, None], wm, drawn["w"])


def sum_length(rng, n, size, drawn):
    """Of wo + eta wt, from grazing to straight incidence, on the denser side."""
    eta = drawn["eta"]
    least, most = np.abs(eta - 1), np.sqrt(np.abs(eta - 1) * (eta + 1))
    return least * (most / least) ** rng.random((n, 1))


def refracting_facet(rng, n, size, drawn):
    return hemisphere(rng, n, size, drawn) * sum_length(rng, n, 1, drawn)


def sine_of(cosine):
    return lambda rng, n, size, drawn: np.sqrt((1 - drawn[cosine]) * (1 + drawn[cosine]))


DRAWS = {
    "wo": hemisphere,
    "wi": hemisphere,
    "w": hemisphere,
    "wm": normals,
    "m": hemisphere,
    "u": lambda rng, n, size, drawn: rng.integers(0, 2**24, (n, size)) * 2.0**-24,
    "alpha": decades(1e-4, 1),
    "eta": either(decades(0.05, 6), uniform(0.05, 6), one_plus(signed(decades(1e-4, 0.9)))),
    "k": either(ZERO, uniform(0, 15), decades(1e-4, 15)),
    "c": COSINE,
    "F0": either(decades(1e-6, 1), uniform(0, 1)),
    "F82": uniform(0, 1),
    "sigma": either(decades(1e-4, 1), uniform(0, 1)),
    "r": either(ZERO, uniform(0, 1)),
    "mu": COSINE,
    "s": uniform(0, 1),
    "albedo": either(ZERO, uniform(0, 1)),
    "Lambda_o": either(ZERO, decades(1e-6, 1e4)),
    "Lambda_i": either(ZERO, decades(1e-6, 1e4)),
    "lost_o": either(ZERO, decades(1e-8, 0.7)),
    "lost_i": either(ZERO, decades(1e-8, 0.7)),
    "lost_mean": decades(1e-8, 0.7),
    "F": uniform(0, 1),
    "F_1": uniform(0, 1),
    "F_2": uniform(0, 1),
    "F_3": uniform(0, 1),
    "f": uniform(0, 1),
    "color": decades(1e-4, 1e3),
    "linear": either(decades(1e-6, 1), uniform(0, 1)),
    "cos_o": COSINE,
    "sin_o": sine_of("cos_o"),
    "density": decades(1e-6, 1e7),
    "kappa": decades(1, 1e6),
    "pixel": integers(2**14),
    "index": integers(2**32),
    "stream": integers(3),
    "v": integers(2**32),
    "bits": integers(2**32),
    "depth": either(ZERO, decades(1e-6, 20), uniform(0, 3)),
    "area": either(decades(1e-6, 1), uniform(0, 1)),
    "hidden": either(decades(1e-6, 1), uniform(0, 1)),
    "wt": behind,
    "cos_t": COSINE,
    "L": sum_length,
    "z": one_plus(decades(1e-6, 1e6)),
    # of one function, whose argument's name says less than its domain
    "expm1_precise.x": either(uniform(0, 88), decades(1e-6, 80)),
    "exp_precise.x": either(uniform(-87, 88), signed(decades(1e-6, 80))),
    "log_precise.x": either(decades(1e-6, 1e6), one_plus(signed(decades(1e-6, 0.9)))),
    "erfcx_precise.x": either(decades(1e-6, 6.5), uniform(0, 6.5)),
    "atan2_precise.x": signed(decades(1e-6, 1e6)),
    "atan2_precise.y": signed(decades(1e-6, 1e6)),
    "h_beckmann.a": either(decades(1e-6, 9.4), uniform(0, 9.4)),
    "sum_with_cap.v": hemisphere,
    "projected_area.w": visible,
    "sample_wm.wo": visible,
    "visible_slope_beckmann.cos_o": cosine_visible,
    "mean_exp.x": either(ZERO, decades(1e-6, 100), uniform(0, 3)),
    "meets.w": sphere,
    "passage.w": sphere,
    "flight.w": sphere,
    "depth_below.depth": either(decades(1e-6, 20), uniform(1e-6, 3)),
    "cut": either(ZERO, decades(1e-8, 1), uniform(0, 1)),
    "beta_one_plus.x": either(ZERO, decades(1e-6, 1e6)),
    "beta_one_plus.y": either(ZERO, decades(1e-6, 1e6), uniform(0, 60)),
    "refracted.wm": facing,
    "T_spread.m": refracting_facet,
    "upward.w": sphere,
    "viridis.x": uniform(-0.1, 1.1),
    "diverging.x": uniform(-1.1, 1.1),
    "environment_uv.w": sphere,
    "environment_direction.u": uniform(0, 1),
    "environment_direction.s": COSINE,
}
FIRST = ("alpha", "cos_o", "eta", "w", "wo")
"""Arguments that others are drawn by, in this order."""


def draw(function, n, rng):
    """Arguments of the function, n of each, as float32 or uint32 holds them, in its order."""
    drawn = {}
    kinds = dict(zip((n for _, n in function.arguments), Signature(function.signature).inputs, strict=True))
    for name in sorted(kinds, key=lambda name: FIRST.index(name) if name in FIRST else len(FIRST)):
        how = DRAWS.get(f"{function.name}.{name}", DRAWS.get(name))
        assert how, f"{function.file}: {function.name}: say in DRAWS from where the argument {name} is drawn"
        drawn[name] = how(rng, n, kinds[name].components, drawn).astype(kinds[name].dtype)
        if kinds[name].dtype == "f4":
            drawn[name] = drawn[name].astype(float)
    return [drawn[name][:, 0] if kinds[name].components == 1 else drawn[name] for _, name in function.arguments]


# --- comparison ------------------------------------------------------------------------------------------------------

TINY = float(np.finfo(np.float32).tiny)

# Where float32 cannot know the value, derived:
FLOORS = {
    # z Lambda leaves float32's normal range before Lambda does.
    "smith_beckmann_exact.Lambda": lambda w, alpha: TINY / w[:, 2],
    # The fit's numerator 1 - 1.259 a + 0.396 a^2 cancels to 0 at a = 1.548: terms up to 2 round to 1.2e-7, and so does a, over a
    # denominator above 5.7 for a > 1. Lambda is used as 1 + Lambda.
    "smith_beckmann_rational.Lambda": lambda w, alpha: np.where(
        w[:, 2] > length(alpha * w[:, :2]), 4 * 1.2e-7 / 5.7, TINY
    ),
    # A ray that goes up ends higher than it begins: depth less the flight, each known to a few roundings.
    "walk.flight": lambda depth, w, area, u: 4 * 1.2e-7 * depth,
    # The exponential leaves float32's range before what it is multiplied by brings the product back.
    "walk.passage": lambda depth, w, area, wi, hidden: TINY * np.maximum(1, area * depth / np.abs(w[:, 2])) / wi[:, 2],
    # A difference, known to two roundings of each of its terms.
    "fresnel.eta2_cos2_t": lambda c, eta: (
        1.2e-7 * np.where(eta < 0.7, eta**2 + (1 - c) * (1 + c), np.abs(eta**2 - 1) + c**2)
    ),
    # Schlick's curve less what bends it, each known to 8 roundings.
    "schlick.F_f82": lambda c, F0, F82: 8 * 6e-8 * schlick.F_schlick(c, F0),
    "fresnel_f82.F": lambda c, eta, k: 8 * 6e-8 * schlick.F_schlick(c[:, None], fresnel.F0(eta, k)),
    # eta cos_t = t is the root of what is known to 2.4e-7.
    "refraction.refracted": lambda w, wm, eta: refraction_floor(dot(w, wm), eta),
    # A polynomial that changes its sign, of terms that add up to 7.9e-3 at most, each known to four roundings.
    "lambert_sphere.excess": lambda mu: 4 * 6e-8 * 7.9e-3,
    # Twice the smaller cosine is |eta^2 - 1| / L - L, of eight roundings; what passes goes as its square.
    "refraction.T_spread": lambda m, eta: (
        8 * 6e-8 * T_spread(m, eta) * length(m) / np.maximum(grazing(m, eta), TINY) + TINY
    ),
    # Blacks are differences of numbers near 0.1, and a display value below 1e-6 is black on any screen.
    "tonemap_aces.tonemap": lambda color: 1e-6,
    "tonemap_agx.tonemap": lambda color: 1e-6,
    "tonemap_neutral.tonemap": lambda color: 1e-6,
}


def refraction_floor(c, eta):
    t = np.sqrt(np.maximum(eta2_cos2_t(c, eta), 1e-7))
    return 1.2e-7 / t * np.abs(eta * eta - 1) / ((c + t) ** 2 * eta)


def grazing(m, eta):
    """The smaller of the cosines at a facet of normal m, times the index on its side, its sign left out."""
    return np.abs(cos_refracted(length(m), eta) * vec(1.0, eta)).min(axis=-1)


def near_critical(c, eta, k=0.0, share=1e-6):
    """Where total internal reflection begins: F falls from 1 as -2 (1 + 1/eta^2) t / c with t^2 = eta^2 - sin^2.

    float32 knows t^2 to about 1e-7 c^2 from an exact c and eta, so F errs by more than WORST only where |t^2| < 1e-6 c^2.
    """
    if np.ndim(eta) > np.ndim(c):  # a cosine for each triple
        c = c[:, None]
    return np.abs((eta + 1j * k) ** 2 - (1 - c) * (1 + c)) < share * c * c


EXEMPT = {
    "fresnel.F_dielectric": near_critical,
    "fresnel.F_conductor": near_critical,
    "fresnel_dielectric.F": lambda c, eta, k: near_critical(c, eta),
    "fresnel_conductor.F": near_critical,
    "refraction.refracted": lambda w, wm, eta: near_critical(dot(w, wm), eta, share=1e-5),
    "refraction.T_spread": lambda m, eta: grazing(m, eta) < 1e-6 * length(m),
}


def relative_error(value, expected, floor=TINY, components=False):
    """Errors of float32 values relative to float64 ones; what is below the floor may be any number below it."""
    value, expected = np.asarray(value, dtype=float), np.asarray(expected, dtype=float)
    assert value.shape == expected.shape
    error, size = np.abs(value - expected), np.abs(expected)
    if not components and expected.ndim > 1:
        error, size = length(error), length(size)
    return np.maximum(error - floor, 0) / np.maximum(size, floor)


def check(error, common=COMMON, least=COMMON_SHARE, worst=WORST):
    """The requirement on relative errors."""
    __tracebackhide__ = True
    assert np.all(np.isfinite(error))
    share, largest = np.mean(error > common), np.max(error)
    found = f"{share:.3%} of the values err by more than {common:g}; the largest error is {largest:.2g}"
    print(found)
    assert share <= 1 - least and largest <= worst, found


def check_model(cls, error):
    """The requirement on f and on weights. Of estimates by equal numbers, walks part where rounding decides."""
    if cls.stochastic:
        check(error, WALKS, WALKS_SHARE, np.inf)
    elif cls.name() in SLOW:
        check(error, BY_QUADRATURE, worst=np.inf)
    else:
        check(error)


def lowest(cls, expected):
    """The value below which errors of f and of weights do not count."""
    return 1e-4 * expected.max() if cls.name() in SLOW else 0.0


def included(chunk):
    """GLSL that includes a chunk, after what it needs."""
    return "".join(f'#include "lib/{name}.glsl"\n' for name in (*NEEDS.get(chunk, ()), chunk))


def chunk_error(gpu, function, twin, text=None, n=40_000):
    """Relative errors of a chunk's GLSL function, or of another text with the same signature, against its twin."""
    arguments = draw(function, n, np.random.default_rng(0))
    include = {"chunk.glsl": text or included(chunk_of(function))}
    value = gpu.evaluate(
        lambda call: assemble("views/probe.frag", generated={**include, "call.glsl": call}),
        function.signature,
        *arguments,
    )[0]
    with np.errstate(under="ignore"):  # 0 is the right answer in the tails
        expected = twin(*arguments)
    if function.name == "visible_slope_beckmann":  # as the direction that it stands for
        value, expected = vec(value, np.ones(n)), vec(expected, np.ones(n))
    floor = np.asarray(FLOORS.get(label(function), lambda *_: TINY)(*arguments))
    error = relative_error(value, expected, floor, function.name in COLORS)
    exempt = np.broadcast_to(EXEMPT.get(label(function), lambda *_: False)(*arguments), error.shape)
    assert np.mean(exempt) < 1e-4
    return error[~exempt]


# --- chunks ----------------------------------------------------------------------------------------------------------


def test_files_have_twins():
    package = SHADERS.parent / "brdf_explorer"
    package = package if package.is_dir() else SHADERS.parent
    for folder in ("lib", "models"):
        numpy = {p.stem for p in (package / folder).glob("*.py")} - {"__init__"}
        assert numpy == {p.stem for p in (SHADERS / folder).glob("*.glsl")}


@pytest.mark.parametrize("chunk", CHUNKS)
def test_functions_and_arguments_have_the_same_names(chunk):
    numpy = own(twin(chunk))
    glsl = {f.name: f for f in functions(f"lib/{chunk}.glsl")}
    assert set(glsl) - ONLY_GLSL.get(chunk, set()) == set(numpy) - ONLY_NUMPY.get(chunk, set())
    for name in set(glsl) & set(numpy):
        given = GIVEN.get(chunk, {}).get(name, [])
        arguments = [n for _, n in glsl[name].arguments]
        assert [*arguments, *given] == list(inspect.signature(numpy[name]).parameters), name


@pytest.mark.parametrize("chunk", CHUNKS)
def test_constants_are_the_same(chunk):
    text = (SHADERS / f"lib/{chunk}.glsl").read_text(encoding="utf-8")
    for name, value in re.findall(r"^const (?:float|uint) (\w+) = ([\d.e+-]+)u?;", text, re.M):
        assert float(value) == pytest.approx(getattr(twin(chunk), name), rel=1e-14)


@pytest.mark.parametrize(
    "function",
    [
        f
        for f in LIB
        if not f.over_maps
        and f.name != "F_spectral"  # tested by each metal's F, which brings its tables
        and f.name not in ONLY_GLSL.get(chunk_of(f), ())
        and f.name not in GIVEN.get(chunk_of(f), ())
    ],
    ids=label,
)
def test_chunk(gpu, function):
    check(chunk_error(gpu, function, own(twin(chunk_of(function)))[function.name]))


# --- models ----------------------------------------------------------------------------------------------------------


def within(value, low, high):
    """The float32 number nearest to `value` that lies in [low, high]."""
    value = np.float32(value)
    if float(value) < low:
        value = np.nextafter(value, np.float32(np.inf))
    if float(value) > high:
        value = np.nextafter(value, np.float32(-np.inf))
    return float(value)


def random_params(cls, rng):
    """Values of a model's params over their ranges, logarithmic and linear, at the low end one time in eight if it is 0."""
    values = {}
    for name, p in declared(cls, Param).items():
        positive = p.low if p.low > 0 else 1e-4 * p.high
        draws = [decades(positive, p.high)] if p.scale == "log" else [decades(positive, p.high), uniform(p.low, p.high)]
        value = either(*draws)(rng, p.size, 1, {})[:, 0]
        if p.low == 0 and rng.random() < 0.125:
            value[:] = 0
        values[name] = typed(p, [within(v, p.low, p.high) for v in value])
    return values


def materials(cls, choices, rng, count=12):
    """A model at the ends of its params' ranges and at random places."""
    params = declared(cls, Param)
    for end in ("low", "high"):
        yield cls(**choices, **{n: typed(p, within(getattr(p, end), p.low, p.high)) for n, p in params.items()})
    for _ in range(count - 2):
        yield cls(**choices, **random_params(cls, rng))


def pair(model, rng):
    """wo and wi (n, 3), as float32 holds them: half of the wi are drawn by the model's sampler, so near the lobe."""
    slow = model.name() in SLOW or model.choices().get("diffuse") == "facets"
    n = 150 if model.stochastic else 300 if slow else 3_000
    wo, wi = (hemisphere(rng, n, 3, {}).astype(np.float32) for _ in range(2))
    sampled = model.sample_f(wo, rng.random((n, 2)))[0].astype(np.float32)
    height = sampled[:, 2]
    if model.transmits:
        wo, wi = (w * rng.choice((-1, 1), (n, 1)).astype("f4") for w in (wo, wi))
        sampled = model.sample_f(wo, rng.random((n, 2)))[0].astype(np.float32)
        height = np.abs(sampled[:, 2])
    near = (rng.random(n) < 0.5) & (height >= 1e-4)
    return wo.astype(float), np.where(near[:, None], sampled, wi).astype(float)


def exempt(model, wo, wi):
    """near_critical in a model that computes the facet's cosine, (n, 3).

    The cosine has an error of 1.2e-7, so t^2 one of 2.4e-7 c^2. Beyond t = eta^2 / c the slope of F falls as 2 eta^2 / t^2: for
    eta = 0.1, the worst, F errs by more than WORST where t^2 < 1.8e-4 c^2. In angle that is 0.005 degrees.
    """
    if model.index() is not None:
        return np.repeat(exempt_of_refraction(wo, wi, np.array(model.index()))[:, None], 3, axis=1)
    facet = model.slots().get("fresnel")
    if facet not in ("dielectric", "conductor", "spectral_none"):
        return np.zeros((len(wo), 3), dtype=bool)
    k = 0.0 if facet == "dielectric" else np.array(model.k)
    found = near_critical(0.5 * length(wo + wi)[:, None], np.array(model.eta), k, 2e-4)
    # even directions meet 8e-4 at most; 15 of 3000 instead of 2.4 are a chance of 1e-8
    assert np.sum(found) < max(5e-3 * found.size, 12)
    return found


def refracting(wo, wi, eta):
    """Of pairs of directions: whether the surface is between them (n,), their sum_refracted, and its facet's cosines (n, 2)."""
    crosses, above = wo[:, 2] * wi[:, 2] < 0, wo[:, 2:] > 0
    sum = sum_refracted(np.where(above, wo, wi), np.where(above, wi, wo), eta)
    sum = np.where(crosses[:, None], sum, [0.0, 0.0, 1.0])
    return crosses, sum, cos_refracted(length(sum), eta) * vec(1.0, eta)


def exempt_of_refraction(wo, wi, eta):
    """near_critical of what is reflected, (n,); and where the facet is on edge to the surface or to a direction, its normal known
    to 1e-7: there D ends, for GGX by a step, and what passes.
    """
    crosses, sum, c = refracting(wo, wi, eta)
    outside = near_critical(0.5 * length(upward(wo) + upward(wi)), np.where(wo[:, 2] > 0, eta, 1 / eta), share=2e-4)
    edge = (np.abs(c).min(axis=-1) < 1e-6 * c.sum(axis=-1)) | (np.abs(sum[:, 2]) < 1e-6 * length(sum))
    found = np.where(crosses, edge, outside)
    assert np.sum(found) < max(5e-3 * len(wo), 4)
    return found


def known_to(model, wo, wi):
    """The relative error (n,) that a model's f has where a facet that refracts is seen on edge; 0 of other models."""
    return np.zeros(len(wo)) if model.index() is None else doubt(model, wo, wi)


def doubt_of_walk(model):
    """The relative error of f by what a walk's roundings, some eighty of 6e-8, are in units of the slopes' scale."""
    return 5e-6 / min(model.alpha) if model.stochastic else 0.0


@pytest.mark.parametrize(("cls", "choices"), CASES, ids=case_label)
def test_f(gpu, cls, choices):
    rng, errors = np.random.default_rng(1), []
    for model in materials(cls, choices, rng):
        wo, wi = pair(model, rng)
        # D leaves float32's normal range before f = D F G / (4 cos cos) does
        floor = TINY / np.minimum(np.abs(4 * wo[:, 2:] * wi[:, 2:]), 1)
        with seeded(1):
            found = gpu.f(model, wo, wi)
        with seeded(1):
            expected = model.f(wo, wi)
        with np.errstate(under="ignore"):
            floor = np.maximum(floor, expected * (known_to(model, wo, wi)[:, None] + doubt_of_walk(model)))
        floor = np.maximum(floor, lowest(cls, expected))
        errors.append(relative_error(found, expected, floor, True)[~exempt(model, wo, wi)])
    check_model(cls, np.concatenate(errors))


@pytest.mark.parametrize(("cls", "choices"), CASES, ids=case_label)
def test_pdf(gpu, cls, choices):
    rng, errors = np.random.default_rng(2), []
    for model in materials(cls, choices, rng):
        wo, wi = pair(model, rng)
        floor = TINY / np.minimum(np.abs(4 * wo[:, 2]), 1)  # as f, with 4 cos (1 + Lambda) below
        expected = model.pdf(wo, wi)
        with np.errstate(under="ignore"):
            floor = np.maximum(floor, expected * known_to(model, wo, wi))
        error = relative_error(gpu.pdf(model, wo, wi), expected, floor)
        errors.append(error[~exempt(model, wo, wi)[:, 0]] if model.transmits else error)
    check(np.concatenate(errors))


@pytest.mark.parametrize(("cls", "choices"), CASES, ids=case_label)
def test_sample_f(gpu, cls, choices):
    """The direction, and the weight as f cos / pdf of that direction, which near the horizon float32's u does not fix."""
    rng, directions, weights = np.random.default_rng(3), [], []
    for model in materials(cls, choices, rng):
        wo, _ = pair(model, rng)
        u = rng.integers(0, 2**24, (len(wo), 2)) * 2.0**-24
        with seeded(1):
            wi, weight = gpu.sample_f(model, wo, u)
        directions.append(relative_error(wi, model.sample_f(wo, u)[0]))
        wi = wi.astype(float)
        with np.errstate(under="ignore"), seeded(1):  # in the tails of a density
            expected = quotient(model.f(wo, wi) * np.abs(wi[:, 2:]), model.pdf(wo, wi)[:, None])
            # a weight may hold D, which leaves float32's range as in test_f
            area = np.abs(wo[:, 2] * wi[:, 2])
            floor = quotient(TINY * quotient(np.abs(wi[:, 2]), np.minimum(4 * area, 1)), model.pdf(wo, wi))
            floor = np.maximum(floor[:, None], expected * doubt_of_walk(model))
        floor = np.maximum(np.maximum(floor, TINY), lowest(cls, expected))
        weights.append(relative_error(weight, expected, floor, True)[~exempt(model, wo, wi)])
    check(np.concatenate(directions))
    check_model(cls, np.concatenate(weights))


# --- the harness itself ----------------------------------------------------------------------------------------------


def lib(name):
    """The GLSL function and the twin of a label, such as ndf_ggx.D."""
    function = next(f for f in LIB if label(f) == name)
    return function, own(twin(chunk_of(function)))[function.name]


WRONG = {
    "lost 1/pi": ("ndf_ggx.D", lambda D, wm, alpha: PI * D(wm, alpha)),
    "exchanged alpha": ("ndf_beckmann.D", lambda D, wm, alpha: D(wm, alpha[:, ::-1])),
    "mean alpha": ("smith_ggx_exact.Lambda", lambda L, w, alpha: L(w, alpha.mean(axis=-1, keepdims=True) * [1, 1])),
    "exchanged arguments": ("schlick.F_schlick", lambda F, c, F0: F(F0, c)),
    "a last digit": ("shadowing_directional.G2", lambda G, *a: G(*a) * (1 + 2e-5)),
    "no number": ("fresnel.F0", lambda F0, eta, k: np.where(k > 14, np.nan, F0(eta, k))),
}


@pytest.mark.parametrize("fault", WRONG)
def test_harness_catches_a_wrong_twin(gpu, fault):
    name, wrong = WRONG[fault]
    function, right = lib(name)
    with pytest.raises(AssertionError):
        check(chunk_error(gpu, function, lambda *arguments: wrong(right, *arguments)))


CANCELLING = {
    "smith_ggx_exact.Lambda": "vec2 a = alpha * w.xy / w.z; return 0.5 * (sqrt(1.0 + dot(a, a)) - 1.0);",
    "fresnel.F_dielectric": "float s = sqrt(1.0 - c * c) / eta; if (s >= 1.0) return 1.0; float t = sqrt(1.0 - s * s);"
    "float rs = (c - eta * t) / (c + eta * t), rp = (eta * c - t) / (eta * c + t); return 0.5 * (rs * rs + rp * rp);",
}


@pytest.mark.parametrize("name", CANCELLING)
def test_harness_catches_cancellation(gpu, name):
    function, right = lib(name)
    with pytest.raises(AssertionError):
        check(chunk_error(gpu, function, right, f"{function.signature} {{ {CANCELLING[name]} }}"))


def test_signatures_are_read():
    (sampler,) = (f for f in functions("models/microfacet.glsl") if f.name == "sample_f")
    assert sampler.arguments == [("vec3", "wo"), ("vec2", "u")]
    assert {f.name for f in functions("models/microfacet.glsl")} == {"f", "pdf", "sample_f"}


@pytest.mark.parametrize("cls", MODELS.values(), ids=lambda cls: cls.name())
def test_models_have_the_functions_of_their_shaders(cls):
    for function in functions(f"models/{cls.name()}.glsl"):
        names = list(inspect.signature(getattr(cls, function.name)).parameters)
        assert names == ["self", *(n for _, n in function.arguments)]


def test_cases_hold_all_pairs_of_options():
    for cls in MODELS.values():
        choices = choices_of(cls)
        if cls.name() in SLOW:
            held = {item for c, case in CASES if c is cls for item in case.items()}
            assert held == {(name, o) for name, options in choices.items() for o in options}
            continue
        held = {pair for c, case in CASES if c is cls for pair in combinations(case.items(), 2)}
        sizes = [len(options) for options in choices.values()]
        assert len(held) == sum(a * b for a, b in combinations(sizes, 2))
        assert all(option in choices[name] for pair in held for name, option in pair)


@pytest.mark.parametrize("options", [{}, {"a": "xy"}, {"a": "xy", "b": "xyz", "c": "xy"}], ids=len)
def test_pairwise(options):
    cases = pairwise(options)
    assert cases and all(case.keys() == options.keys() for case in cases)
    assert {(a, x) for case in cases for a, x in case.items()} == {(a, x) for a in options for x in options[a]}
    held = {pair for case in cases for pair in combinations(case.items(), 2)}
    assert len(held) == sum(len(options[a]) * len(options[b]) for a, b in combinations(options, 2))

"""The laws of physics and of sampling, each as a measured error of one material and the limit it must keep."""

from dataclasses import dataclass, replace

import numpy as np

from ..lib.common import length, quotient
from ..lib.random import seeded
from ..lib.refraction import cos_refracted, sum_refracted
from ..model import Param, declared
from .adversary import above, adversarial
from .albedo import albedo_with_error, shares
from .grid import direction
from .microsurface import G1, projected_area
from .noise import mean_f
from .sampling import chi_square, mean_weight

THETAS = (0.0, 40.0, 70.0, 85.0)
"""Polar angles of the viewers that a law is measured for, degrees; their azimuth lies between the axes."""
PHI = 35.0
QUADRATURE = 1e-9
"""What quadrature may add to an albedo."""
GLSL = " (GLSL)"
"""Ends the names of the laws that the GLSL's values keep."""
TINY = float(np.finfo(np.float32).tiny)


@dataclass(frozen=True)
class Law:
    """A law by name, the error measured, its limit, and where the error is largest or what is known about it."""

    name: str
    measured: float
    limit: float
    note: str = ""

    @property
    def ok(self):
        return bool(self.measured <= self.limit)  # NaN is not


def laws(model, gpu=None, seed=1):
    """Yield the Laws that apply to a material, the GLSL's too if a Gpu is given. Some take a tenth of a second.

    A limit that the model gives in Model.exceptions(), by the law's name, replaces the one here.
    """
    exceptions = model.exceptions()
    for law in _laws(model, gpu, seed):
        if law.name in exceptions:
            note = f"{law.note}; known, the law's own limit is {law.limit:.3g}"
            law = Law(law.name, law.measured, exceptions[law.name], note)
        yield law


def _laws(model, gpu, seed):
    rng = np.random.default_rng(seed)
    yield reciprocity(model, rng)
    yield finite("finite, not negative", model, model, rng)
    if gpu is not None:
        yield finite(f"finite, not negative{GLSL}", Shader(gpu, model), model, rng)
        yield twins(model, gpu, rng)
    yield energy(model)
    if "ndf" in model.choices():
        yield normalisation(model)
    if "smith" in model.choices():
        yield furnace(model)
    for kind, sample in [("", model.sample_f)] + ([(GLSL, Shader(gpu, model).sample_f)] if gpu is not None else []):
        yield from samples(kind, model, sample)
        yield weights(f"mean weight is albedo{kind}", model, sample)


@dataclass(frozen=True)
class Shader:
    """The GLSL of a model under the names of its twin."""

    gpu: object
    model: object

    @property
    def stochastic(self):
        return self.model.stochastic

    def f(self, wo, wi):
        return self.gpu.f(self.model, wo, wi)

    def pdf(self, wo, wi):
        return self.gpu.pdf(self.model, wo, wi)

    def sample_f(self, wo, u):
        return self.gpu.sample_f(self.model, wo, u)


def viewers():
    """wo (len(THETAS), 3)."""
    return direction(np.radians(THETAS), np.radians(PHI))


def reciprocity(model, rng, n=4000):
    """|f(wo, wi) - f(wi, wo)| relative to the larger one, over directions of all heights and near the lobe.

    Each is divided by n^2 of the viewer's side: what passes from one medium to another changes as that. Of a stochastic model in
    standard errors of the difference of two means: of 32 pairs and 3 colours 6 is a chance of 2e-7.
    """
    dense = (model.index() or 1.0) ** -2.0
    if model.stochastic:
        with np.errstate(under="ignore"):  # in the tails of a density
            wo, wi, walks = *(above(rng, 32, 0.05, model.transmits) for _ in range(2)), n // 8
            sampled = model.sample_f(wo, rng.random((32, 2)))[0]
            wi = np.where(((rng.random(32) < 0.5) & (np.abs(sampled[:, 2]) > 0.05))[:, None], sampled, wi)
            means = [
                np.array(mean_f(model, a, b, walks)) * np.where(a[:, 2:] < 0, dense, 1.0)
                for a, b in ((wo, wi), (wi, wo))
            ]
            (there, back), errors = np.array(means)[:, 0], np.array(means)[:, 1]
            # a difference of what rounding leaves of two equal numbers is none, and of what is rare all or nothing is found
            known = there + back > 1e-6 * np.max(there + back)
            error = np.where(known, quotient(np.abs(there - back), np.hypot(*errors) + 1e-12 * there), 0.0)
        note = f"sigma, of the means of {walks} estimates, largest {_where(wo, wi, error)}"
        return Law("reciprocity", float(error.max()), 6.0, note)
    wo, wi, u = adversarial(rng, n, model.transmits)
    sampled = model.sample_f(wo, u)[0]
    wi = np.where((rng.random(n) < 0.5)[:, None], sampled, wi)
    with np.errstate(under="ignore"):  # in the tails of a density
        there, back = (model.f(a, b) * np.where(a[:, 2:] < 0, dense, 1.0) for a, b in ((wo, wi), (wi, wo)))
    larger = np.maximum(there, back)
    # a value below float64's normal range has lost digits
    error = np.abs(there - back) / np.where(larger > 1e-290, larger, np.inf)
    return Law("reciprocity", float(error.max()), 1e-12, f"largest {_where(wo, wi, error)}")


def finite(name, evaluator, model, rng, n=8192):
    """Number of NaN, infinite and negative values of f, pdf and the samples, over adversarial directions."""
    wo, wi, u = adversarial(rng, n, model.transmits)
    sampled, weight = evaluator.sample_f(wo, u)
    values = [evaluator.f(wo, wi), evaluator.pdf(wo, wi)[:, None], weight]
    wrong = np.column_stack([~(np.isfinite(v) & (v >= 0)) for v in values] + [~np.isfinite(sampled)])
    note = f"of {wrong.size} values" + (f", first {_where(wo, wi, wrong)}" if wrong.any() else "")
    return Law(name, float(np.sum(wrong)), 0.0, note)


def twins(model, gpu, rng, n=8192):
    """Relative difference of float32 f and pdf from float64, which 99.9 % of the values keep, for cosines of 1e-4 and more.

    Of values from 1e-20 of the largest on: further out in a Gaussian tail, exp(-x) multiplies the rounding of wo + wi by x > 46,
    and float32's range ends. Of a model that transmits less its `doubt`, and with parameters as float32
    holds them: half a digit of the index turns a lobe of alpha = 1e-3 by 1e-4 of its width. Walks of a stochastic one are by
    equal random numbers, and 99 % keep it: the rest part where rounding decides whether a ray leaves.
    """
    if model.stochastic:
        n //= 4
    model = held(model) if model.transmits else model
    wo, wi = (above(rng, n, both=model.transmits).astype(np.float32).astype(float) for _ in range(2))
    sampled = model.sample_f(wo, rng.random((n, 2)))[0].astype(np.float32).astype(float)
    height = np.abs(sampled[:, 2]) if model.transmits else sampled[:, 2]
    wi = np.where(((rng.random(n) < 0.5) & (height > 1e-4))[:, None], sampled, wi)

    def values(evaluator, wo):
        with seeded(1):
            return np.column_stack([evaluator.f(wo, wi), evaluator.pdf(wo, wi)])

    expected, found = values(model, wo), values(Shader(gpu, model), wo)
    known = expected > np.maximum(1e-20 * expected.max(axis=0), TINY)
    errors = np.abs(found[known] - expected[known]) / expected[known]
    if model.index() is not None:
        errors = np.maximum(errors - np.broadcast_to(doubt(model, wo, wi)[:, None], known.shape)[known], 0.0)
    share, limit = (0.99, 1e-3) if model.stochastic else (0.999, 1e-5)
    note = f"relative, of {100 * share:g} % of {errors.size} values; the worst {errors.max(initial=0.0):.1e}"
    return Law("float32 is float64", float(np.quantile(np.append(errors, 0.0), share)), limit, note)


def doubt(model, wo, wi):
    """The relative error (n,) that float32's f has where light passes a facet that is seen on edge.

    f goes as the square of the smaller cosine, which is a difference of numbers known to four roundings, 2.4e-7.
    """
    above, index = wo[:, 2:] > 0, np.array(model.index())
    L = np.maximum(length(sum_refracted(np.where(above, wo, wi), np.where(above, wi, wo), index)), TINY)
    c = np.abs(cos_refracted(L, index) * [1.0, index])
    return np.where(wo[:, 2] * wi[:, 2] < 0, 4.8e-7 * c.sum(axis=-1) / np.maximum(c.min(axis=-1), 1e-7), 0.0)


def held(model):
    """The model with its parameters as float32 holds them."""
    params = {n: p for n, p in declared(model, Param).items() if p.glsl != "int"}
    rounded = {n: np.clip(np.float32(getattr(model, n)).astype(float), p.low, p.high) for n, p in params.items()}
    return replace(model, **rounded)


def energy(model):
    """The largest share of the energy from one direction that is scattered: more than 1 and the surface would shine."""
    wo = direction(np.radians([0.0, 40.0, 60.0, 75.0, 83.0, 87.0, 89.5]), np.radians(PHI))
    value, error = (part.sum(axis=1).max(axis=1) for part in shares(model, wo, tolerance=1e-6, most=256))
    k = int(np.argmax(value))
    theta = np.degrees(np.arccos(min(wo[k, 2], 1.0)))
    what = "R + T" if model.transmits else "albedo"
    if (
        model.stochastic
    ):  # with 15 degrees of freedom the largest of 21 is 5 standard errors too large by a chance of 2e-3
        note = f"largest {what} less 5 standard errors, at theta {theta:.3g}: {value[k]:.4f}, error {error[k]:.0e}"
        return Law("energy", float(np.max(value - 5 * error)), 1 + QUADRATURE, note)
    note = f"largest {what}, at theta {theta:.3g}, by quadrature within {error[k]:.0e}"
    return Law("energy", float(value[k] - error[k]), 1 + QUADRATURE, note)


def normalisation(model):
    """D cos integrates to 1."""
    return Law("integral of D cos is 1", abs(projected_area(model, (0.0, 0.0, 1.0)) - 1), 1e-8, "by quadrature")


def furnace(model):
    """Weak white furnace: without shadowing from the light no energy is lost. Heitz 2014, "Understanding the
    Masking-Shadowing Function in Microfacet-Based BRDFs": the integral of G1(wo) D / (4 wo.z) over all wi is 1.
    """
    wo = viewers()
    error = [abs(G1(model, w) * projected_area(model, w) / w[2] - 1) for w in wo]
    k = int(np.argmax(error))
    return Law("weak white furnace", float(error[k]), 1e-6, f"largest at theta {THETAS[k]:g}")


def samples(kind, model, sample=None):
    """Yield the laws of how directions are spread: on which side of the horizon, and over bins above it.

    Both in standard deviations: of the share of the samples above the horizon less the integral of pdf, and of a normal number
    as unlikely as the least likely chi-square, of as many as there are viewers (Sidak); 4.3 is a chance of 1e-5.
    """
    from scipy.stats import norm

    count = 20_000 if model.stochastic else 50_000  # as each costs a walk
    found = [chi_square(model, wo, count, sample=sample) for wo in viewers()]
    z = [abs(c.share - c.mass) / (np.sqrt(max(c.mass * (1 - c.mass), 0.0) / c.samples) + 1 / c.samples) for c in found]
    k = int(np.argmax(z))
    note = f"sigma, largest at theta {THETAS[k]:g}: integral {found[k].mass:.6f}, share of samples {found[k].share:.6f}"
    yield Law(f"pdf integrates to the share above the horizon{kind}", float(z[k]), 5.0, note)
    k = int(np.argmin([c.p for c in found]))
    p = -np.expm1(len(found) * np.log1p(-min(found[k].p, 1 - 1e-16)))
    note = f"sigma, p = {p:.3g}; least at theta {THETAS[k]:g}: {found[k].statistic:.0f} for {found[k].freedom + 1} bins"
    yield Law(f"samples follow pdf{kind}", float(np.clip(norm.isf(p), 0.0, 99.0)), 4.3, note)


def weights(name, model, sample=None):
    """The mean weight of samples less the albedo by quadrature, in standard errors.

    Of 16 rotations, so by Student's t with 15 degrees of freedom 6 is a chance of 3e-4 for three colours of four viewers.
    """
    wo = viewers()
    value, error = albedo_with_error(model, wo, tolerance=1e-6, most=256)
    means = [mean_weight(model, w, sample=sample) for w in wo]
    z = [np.max(quotient(np.abs(m.value - v), m.error + e)) for m, v, e in zip(means, value, error, strict=True)]
    k = int(np.argmax(z))
    note = f"sigma, largest at theta {THETAS[k]:g}: {means[k].value[0]:.6f} and {value[k][0]:.6f}"
    return Law(name, float(z[k]), 6.0, note)


def _where(wo, wi, error):
    k = int(np.argmax(error.reshape(len(wo), -1).max(axis=1)))
    return f"at cosines {wo[k, 2]:.2g} and {wi[k, 2]:.2g}"

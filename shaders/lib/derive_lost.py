"""Writes lost_*.glsl and their twins, from albedos by quadrature: python shaders/lib/derive_lost.py [NDF SHADOWING]

Isotropic facets lose s^n y^2 times a quadratic spline of s (1 + alpha) and alpha, where y = alpha / (cos + alpha), s = 1 - y; n
is 1 where shadowing is correlated with masking, since of what a grazing viewer sees nothing is then shadowed. No coefficient is
negative, so that nothing cancels, and along s each is at least LEAST times the one before, so that float32 keeps its digits
where a lobe ends. They are found by least squares, reweighted until the largest error is least. The mean over directions is
that of the fit, not of what it fits: so what is put back is what was taken. Rows are written from the normal to the horizon, by
1 - s (1 + alpha), which loses no digits where a lobe ends.
"""

import sys
import textwrap
from pathlib import Path

import numpy as np
from scipy.optimize import nnls

from brdf_explorer.lib.common import vec
from brdf_explorer.measure.albedo import albedo, gauss
from brdf_explorer.models import MODELS

ROWS, COLUMNS = 24, 10
"""Coefficients along t and along alpha."""
LEAST = 0.1
MEAN_ROWS, MEAN_COLUMNS = 20, 8
"""Of the mean: along alpha^(1/4) and along the root of the ratio of the two alphas."""
ALPHA = np.concatenate([np.geomspace(1e-4, 0.05, 9), np.linspace(0.075, 1, 38)])
T = np.sort(np.concatenate([np.linspace(1 / 48, 1, 48), 0.5 * (1 - np.cos(np.pi * (np.arange(24) + 0.5) / 24))]))
ABOUT = {"ggx": "GGX", "beckmann": "Beckmann"}
HERE = Path(__file__).parent
TWINS = HERE.parents[1] / "brdf_explorer" / "lib"


def splines(x, n):
    """The n quadratic B-splines of [0, 1] at x (...,): (..., n)."""
    place = x * (n - 2)
    first = np.clip(place.astype(int), 0, n - 3)
    f = place - first
    found = np.zeros((*x.shape, n))
    for k, weight in enumerate((0.5 * (1 - f) ** 2, 0.5 + f * (1 - f), 0.5 * f * f)):
        np.put_along_axis(found, (first + k)[..., None], weight[..., None], -1)
    return found


def power(shadowing):
    """n of the factor s^n."""
    return int(shadowing in ("correlated", "full"))


def cosines(alpha, t):
    return np.clip(alpha * t / (1 + alpha - t), 1e-9, 1.0)


def tabulated(ndf, shadowing):
    """1 - albedo of white facets (ALPHA, T); not below 0, where quadrature errs."""
    smooth = shadowing in ("correlated", "separable")  # others have kinks, where quadrature is slow
    tolerance, most = (1e-6, 256) if smooth else (3e-5, 128)
    found = []
    for alpha in ALPHA:
        mu = cosines(alpha, T)
        model = MODELS["microfacet"](alpha=alpha, ndf=ndf, shadowing=shadowing, fresnel="one")
        found.append(1 - albedo(model, vec(np.sqrt((1 - mu) * (1 + mu)), 0 * mu, mu), tolerance, most)[:, 0])
    return np.maximum(found, 0.0)


def factor(mu, alpha, n):
    y = alpha / (mu + alpha)
    return (1 - y) ** n * y * y


def fitted(lost, n):
    """Coefficients (ROWS, COLUMNS) and the largest error."""
    alpha = np.broadcast_to(ALPHA[:, None], lost.shape)
    mu = cosines(alpha, T)
    t = mu * (1 + alpha) / (mu + alpha)
    parts = splines(t, ROWS)[..., :, None] * splines(alpha, COLUMNS)[..., None, :]
    # of the coefficients' excesses over LEAST times the one before
    decay = np.tril(LEAST ** np.maximum(np.subtract.outer(np.arange(ROWS), np.arange(ROWS)), 0))
    parts = np.einsum("...ij,ik->...kj", parts, decay)
    basis = (parts * factor(mu, alpha, n)[..., None, None]).reshape(lost.size, -1)
    weight, best = np.ones(lost.size), (np.inf, None)
    for _ in range(40):
        root = np.sqrt(weight)
        found = nnls(basis * root[:, None], lost.ravel() * root, maxiter=20_000)[0]
        error = np.abs(basis @ found - lost.ravel())
        if error.max() < best[0]:
            best = error.max(), found
        weight *= np.maximum(error / error.max(), 1e-2) ** 0.7
        weight /= weight.max()
    return decay @ best[1].reshape(ROWS, COLUMNS), best[0]


def fit_of(table, mu, alpha, n):
    t = mu * (1 + alpha) / (mu + alpha)
    weights = splines(np.broadcast_to(alpha, t.shape), COLUMNS)
    return factor(mu, alpha, n) * np.einsum("...i,...j,ij->...", splines(t, ROWS), weights, table)


def mean_of(table, alpha, ratio, n):
    """The fit's mean over directions, cosine-weighted, for alphas (...,) and ratios (...,) of the smaller to the larger one.

    In the plane of slopes that is stretched to isotropy, of tangents r: the mean over azimuths is in closed form.
    """
    x, dx = gauss(2000)
    # mu from below alpha to 1, evenly in its logarithm
    mu = 1e-6 ** (1 - x)
    larger = alpha * np.sqrt(2 / (1 + ratio**2))
    r2 = (1 - mu**2) / mu**2
    p, q = (1 + (alpha / one)[..., None] ** 2 * r2 for one in (larger, larger * ratio))
    density = (p + q) / (2 * (p * q) ** 1.5)
    d_r2 = 2 / mu**2 * np.log(1e6)  # of d mu / mu
    lost = fit_of(table, mu, alpha[..., None], n)
    return alpha**2 / (larger**2 * ratio) * np.sum(lost * density * d_r2 * dx, axis=-1)


def mean_table(table, n):
    """Coefficients (MEAN_ROWS, MEAN_COLUMNS) of the mean over alpha^2, and their largest relative error."""
    u, v = np.linspace(0.1, 1, 60), np.linspace(0.0, 1, 24) ** 2
    v[0] = 1e-4
    u, v = np.meshgrid(u, v, indexing="ij")
    mean = mean_of(table, u**4, v**2, n) / u**8
    parts = splines(u, MEAN_ROWS)[..., :, None] * splines(v, MEAN_COLUMNS)[..., None, :]
    basis = parts.reshape(mean.size, -1) / mean.reshape(-1, 1)
    found = nnls(basis, np.ones(mean.size), maxiter=20_000)[0]
    return found.reshape(MEAN_ROWS, MEAN_COLUMNS), np.max(np.abs(basis @ found - 1))


GLSL = """// Slot lost: {about} facets whose shadowing is {shadowing}. Made by derive_lost.py; lost.glsl says what it is.
// Of isotropic facets the fit errs by {error:.1e} of the light.
#include "lib/lost.glsl"

const float LOST[{size}] = float[{size}](
{lost}
);
const float LOST_MEAN[{mean_size}] = float[{mean_size}](
{mean}
);

float lost(vec3 w, vec2 alpha) {{
  float a = alpha_mean(alpha);
  vec2 s = parts(w, alpha);
  float x = {rows:.1f} * (s.y - a * s.x), y = {columns:.1f} * a;
  int i = clamp(int(x), 0, {last_row}), j = clamp(int(y), 0, {last_column}), k = {stride} * i + j;
  vec3 u = spline(x - float(i)), v = spline(y - float(j));
  float sum = u.x * dot(v, vec3(LOST[k], LOST[k + 1], LOST[k + 2]));
  sum += u.y * dot(v, vec3(LOST[k + {stride}], LOST[k + {stride1}], LOST[k + {stride2}]));
  sum += u.z * dot(v, vec3(LOST[k + {twice}], LOST[k + {twice1}], LOST[k + {twice2}]));
  return {factor}s.y * s.y * sum;
}}

float lost_mean(vec2 alpha) {{
  float a = alpha_mean(alpha);
  float x = {mean_rows:.1f} * sqrt(sqrt(a)), y = {mean_columns:.1f} * sqrt(min(alpha.x, alpha.y) / max(alpha.x, alpha.y));
  int i = clamp(int(x), 0, {mean_last_row}), j = clamp(int(y), 0, {mean_last_column}), k = {mean_stride} * i + j;
  vec3 u = spline(x - float(i)), v = spline(y - float(j));
  float sum = u.x * dot(v, vec3(LOST_MEAN[k], LOST_MEAN[k + 1], LOST_MEAN[k + 2]));
  sum += u.y * dot(v, vec3(LOST_MEAN[k + {m1}], LOST_MEAN[k + {m11}], LOST_MEAN[k + {m12}]));
  sum += u.z * dot(v, vec3(LOST_MEAN[k + {m2}], LOST_MEAN[k + {m21}], LOST_MEAN[k + {m22}]));
  return sum * a * a;
}}
"""

PYTHON = '''"""Slot lost: {about} facets whose shadowing is {shadowing}. Made by derive_lost.py; lost.py says what it is.

Of isotropic facets the fit errs by {error:.1e} of the light.
"""

import numpy as np

from .lost import lost_by, lost_mean_by

# fmt: off
LOST = np.array([
{lost}
]).reshape({all_rows}, {stride})
LOST_MEAN = np.array([
{mean}
]).reshape({all_mean_rows}, {mean_stride})
# fmt: on


def lost(w, alpha):
    return lost_by(LOST, {n}, w, alpha)


def lost_mean(alpha):
    return lost_mean_by(LOST_MEAN, alpha)
'''


def numbers(table):
    text = " ".join(f"{x:.6e}," if x else "0.0," for x in table.ravel())
    return textwrap.fill(text, 120, initial_indent="  ", subsequent_indent="  ").rstrip(",")


def write(ndf, shadowing):
    n = power(shadowing)
    table, error = fitted(tabulated(ndf, shadowing), n)
    text(ndf, shadowing, n, table, error)


def text(ndf, shadowing, n, table, error):
    mean, mean_error = mean_table(table, n)
    print(f"{ndf} {shadowing}: {error:.1e}, of the mean {mean_error:.1e}", flush=True)
    c, m = COLUMNS, MEAN_COLUMNS
    fields = {
        "about": ABOUT[ndf], "shadowing": shadowing, "error": error, "n": n, "factor": "s.x * " * n,
        "lost": numbers(table[::-1]), "mean": numbers(mean), "size": table.size, "mean_size": mean.size,
        "all_rows": ROWS, "all_mean_rows": MEAN_ROWS,
        "rows": ROWS - 2, "columns": c - 2, "last_row": ROWS - 3, "last_column": c - 3,
        "stride": c, "stride1": c + 1, "stride2": c + 2, "twice": 2 * c, "twice1": 2 * c + 1, "twice2": 2 * c + 2,
        "mean_rows": MEAN_ROWS - 2, "mean_columns": m - 2, "mean_last_row": MEAN_ROWS - 3, "mean_last_column": m - 3,
        "mean_stride": m, "m1": m, "m11": m + 1, "m12": m + 2, "m2": 2 * m, "m21": 2 * m + 1, "m22": 2 * m + 2,
    }  # fmt: skip
    name = f"lost_{ndf}_{shadowing}"
    (HERE / f"{name}.glsl").write_text(GLSL.format(**fields), encoding="utf-8")
    (TWINS / f"{name}.py").write_text(PYTHON.format(**fields), encoding="utf-8")


if __name__ == "__main__":
    wanted = [tuple(sys.argv[1:])] if sys.argv[1:] else [
        (ndf, shadowing) for ndf in ABOUT for shadowing in ("correlated", "separable", "directional", "full")
    ]  # fmt: skip
    for pair in wanted:
        write(*pair)

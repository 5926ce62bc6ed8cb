"""Prints the numbers of lambert_sphere.glsl and of its twin, from the exact solution: python shaders/lib/derive_lambert_sphere.py

H = 1 + c mu (Psi / c log((1 + mu) / mu) + B): the logarithm is that of the first order in c; what is left, B, is smooth in
s = sqrt(1 - c) and nearly so in sqrt(mu). Chebyshev series in both: in s by interpolation, in sqrt(mu) by least squares weighted
by sqrt(mu), as B counts times mu. The polynomials' coefficients over c are series in s.
"""

import textwrap

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from brdf_explorer.lib.lambert_sphere import excess
from brdf_explorer.measure.grid import direction
from brdf_explorer.measure.half_space import H, albedo, coefficients, psi

ROWS, POINTS = 16, 40
SIZES = {0: (11, 10), 1: (6, 8), 2: (4, 7)}
"""Terms in s and in sqrt(mu), by mode."""
POLYNOMIAL = {0: 10, 1: 6}


def points(n):
    """Chebyshev points on [0, 1], none at an end."""
    return 0.5 * (1 + np.cos((np.arange(n) + 0.5) * np.pi / n))


def tables():
    """(what, coefficients): rows of s and columns of sqrt(mu); of a polynomial's coefficient one row of s."""
    s, root = points(ROWS), points(POINTS)
    mu, c = root**2, (1 - s) * (1 + s)
    in_s = np.linalg.inv(chebvander(2 * s - 1, ROWS - 1))
    made = []
    for mode, (rows, columns) in SIZES.items():
        series = np.array([psi(mode, a) @ [mu**0, mu**2, mu**4] for a in s]) * np.log1p(1 / mu)
        B = np.array([(H(mode, a, mu) - 1) / mu for a in s]) / c[:, None] - series
        fit = np.linalg.lstsq(chebvander(2 * root - 1, columns - 1) * root[:, None], ((in_s @ B)[:rows] * root).T)[0]
        made.append((f"B of mode {mode}, {rows} x {columns}", fit.T))
    for mode, rows in POLYNOMIAL.items():
        x = np.array([coefficients(mode, float(a)) for a in s])
        made.append((f"q of mode {mode}", (in_s @ ((x - coefficients(mode, 1.0)) / c[:, None]))[:rows].T))
    return made


def excess_polynomial(terms=5):
    """Coefficients in sqrt(mu) of `excess`: what is left of it, beside what `albedo` has taken out already."""
    root = points(24)
    left = [albedo(direction(np.arccos(x * x), 0.0), 0.0, 64) - 1 for x in root]
    powers = np.polynomial.polynomial.polyvander(root, terms - 1) + 4 / (np.arange(terms) + 4)
    taken = np.linalg.lstsq(np.vander(root, terms, increasing=True), excess(root**2))[0]
    return taken + np.linalg.lstsq(powers, left)[0]


def text(start, end, comment):
    lines, first = [], 0
    for what, table in tables():
        lines.append(f"  {comment} {what}, from {first} on")
        lines += textwrap.wrap(
            " ".join(f"{x:.8e}," for x in table.ravel()), 120, initial_indent="  ", subsequent_indent="  "
        )
        first += table.size
    return "\n".join([start.format(first), *lines])[:-1] + "\n" + end


if __name__ == "__main__":
    print(text("const float TABLE[{0}] = float[{0}](", ");", "//"))
    print(text("TABLE = np.array([", "])", "#"))
    print("excess:", excess_polynomial())

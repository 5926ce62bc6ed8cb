"""Directional albedo by quadrature that follows the lobe."""

import numpy as np

from .grid import grid


def albedo(model, wo, tolerance=1e-10, most=4096):
    """Directional albedo of a model, the integral of f cos over wi: wo (..., 3) -> (..., 3).

    Gauss-Legendre along the rays of `grid` and the trapezoidal rule, exponentially convergent for a period, around them, both
    doubled until two results differ by less than `tolerance`, or to `most` rays.
    """
    wo = np.asarray(wo, dtype=float)
    values = [_albedo(model, w, tolerance, most) for w in wo.reshape(-1, 3)]
    return np.array(values).reshape(wo.shape)


def _albedo(model, wo, tolerance, most):
    if wo[2] <= 0:
        return np.zeros(3)
    n, before = 32, None
    while True:
        nodes, weights = np.polynomial.legendre.leggauss(n)
        t, dt = 0.5 * (nodes + 1), 0.5 * weights
        psi = 2 * np.pi * (np.arange(n) + 0.5) / n
        g = grid(wo, model.slopes(), t, psi)
        weight = g.density * g.wi[..., 2] * dt * (2 * np.pi / n)
        value = np.einsum("ptc,pt->c", model.f(wo, g.wi), weight)
        if before is not None and np.all(np.abs(value - before) <= tolerance) or 2 * n > most:
            return value
        before, n = value, 2 * n

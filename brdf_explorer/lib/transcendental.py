"""Elementary functions under the names of their GLSL twins."""

import numpy as np


def exp_precise(x):
    with np.errstate(under="ignore"):
        return np.exp(x)


def expm1_precise(x):
    """exp(x) - 1 for x >= 0."""
    return np.expm1(x)


def log_precise(x):
    """Natural logarithm of x > 0."""
    return np.log(x)


def atan2_precise(y, x):
    """Angle of the point (x, y) from the x axis, in [-pi, pi]; 0 at the origin."""
    return np.arctan2(y, np.where((x == 0) & (y == 0), 1.0, x))


def erfcx_precise(x):
    """exp(x^2) erfc(x), x >= 0."""
    from scipy.special import erfcx

    return erfcx(x)

"""What diagrams share: the quantity along the radius, its scale, arrows and numbers."""

from dataclasses import dataclass

import numpy as np

from ..model import choice, param
from .picture import View

QUANTITIES = {"f": "f  [1/sr]", "f_cos": "f cos θ  [1/sr]"}


@dataclass(frozen=True)
class Diagram(View):
    """A view in which the radius shows f or f cos over directions to the light."""

    quantity: str = choice("f", QUANTITIES, "what the radius shows: f, or f times the cosine at the light")
    radius: str = choice("linear", ("linear", "log"), "scale of the radius")
    decades: int = param(4, 1, 8, "decades that a logarithmic radius shows below the peak")

    def factor(self, wi):
        """What f is multiplied by, for directions wi (..., 3)."""
        return np.abs(wi[..., 2]) if self.quantity == "f_cos" else 1.0


def radius(share, scale, decades):
    """Radius in [0, 1] of a share of the largest value; "log": 0 is `decades` decades below it."""
    if scale == "linear":
        return share
    return np.maximum(1 + np.log10(np.maximum(share, 1e-300)) / decades, 0.0)


def arrow(start, tip, scale):
    """Polylines of an arrow, in pixels."""
    along = (tip - start) / max(np.linalg.norm(tip - start), 1e-9)
    across = np.array([along[1], -along[0]])
    head = [tip - 9 * scale * along + side * 4.5 * scale * across for side in (1, -1)]
    return [np.array([start, tip]), np.array([head[0], tip, head[1]])]


def nice_step(step):
    """The least of 1, 2, 5 times a power of ten that is not below `step`."""
    power = 10.0 ** np.floor(np.log10(step))
    return power * next(m for m in (1, 2, 5, 10) if m * power >= step * (1 - 1e-12))


def powers_below(top, decades):
    """The powers of ten in the `decades` decades up to `top`, rising; none for 0."""
    if top <= 0:
        return np.array([])
    return 10.0 ** (np.floor(np.log10(top)) - np.arange(decades)[::-1])


def number(value, digits=3):
    """A value with few digits for a label."""
    if value != 0 and not 1e-2 <= abs(value) < 1e4:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{float(mantissa):g}e{int(exponent)}"
    return f"{float(f'{value:.{digits}g}'):g}"


def apart(places, widths):
    """Indices of labels that do not overlap along a line, the last first; rising places, each label centred on its own."""
    kept = []
    for i in reversed(range(len(places))):
        if not kept or places[kept[-1]] - places[i] >= (widths[kept[-1]] + widths[i]) / 2:
            kept.append(i)
    return kept

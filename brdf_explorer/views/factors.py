"""The factors of a microfacet model along the plane of incidence: D, G, F, the Jacobian, and their product, which is f."""

from dataclasses import dataclass, replace

import numpy as np

from ..lib.srgb import luminance
from ..measure.grid import direction
from ..measure.microsurface import projected_area
from ..model import Invalid, choice, param
from .axes import Axes, Axis
from .diagram import number
from .drawing import Drawing, Drawn, nothing
from .picture import Curves
from .polar import NODES
from .table import tables

SHOWN = ("on", "off")
FACTORS = {  # name -> words of the legend, and what they are where there is little room
    "D": ("D(ωm)  [1/sr]", "D [1/sr]"),
    "G": ("G(ωo, ωi)", "G"),
    "F": ("F(ωo · ωm)", "F"),
    "jacobian": ("1 / (4 cos θo cos θi)", "Jacobian"),
    "product": ("product = f  [1/sr]", "f [1/sr]"),
}
BELOW = 0.3  # of each curve where f is largest, on each side of the surface: where the axis ends at the latest
WIDE, NARROW = 158, 74  # points of a column of the legend


@dataclass(frozen=True)
class Factors(Drawn):
    """The factors of a microfacet model, curve by curve, over the direction to the light in the plane of incidence.

    Of one reflection, whatever the material puts back of more.
    """

    title = "Factors"

    D: str = choice("on", SHOWN, "density of the facets' normals")
    G: str = choice("on", SHOWN, "share of the facets that light reaches and the viewer sees")
    F: str = choice("on", SHOWN, "reflectance of a facet, its luminance")
    jacobian: str = choice("on", SHOWN, "from facets' normals to directions, and from areas to the surface's")
    product: str = choice("on", SHOWN, "their product: f")
    axis: str = choice(
        "log", ("log", "linear"), "scale of the values; on a logarithmic one a product is a sum of heights"
    )
    decades: int = param(5, 1, 12, "decades that a logarithmic axis shows; more where a factor lies lower")

    def shows(self, state):
        return (self, state.material, state.directions, state.look.theme)

    @np.errstate(under="ignore")  # in the tails of a density
    def curves(self, gpu, state):
        """theta (n,) in radians, positive on the viewer's side, and name -> values (n,); f by the shader, the rest float64.

        Of a material that transmits theta goes on below the surface, beyond -90 degrees.
        """
        found = tables(gpu, alone(state.model), state.directions, rays=2, nodes=NODES)[::-1]
        theta, wi, f = (np.concatenate(parts) for parts in zip(*(t.plane() for t in found), strict=True))
        values = {name: np.asarray(v) for name, v in state.model.factors(found[0].wo, wi).items()}
        return theta, values | {"F": luminance(values["F"]), "product": luminance(f)}

    def table_of(self, gpu, state):
        """The factors as Curves over theta in degrees. Raises Invalid where f is no product of them."""
        if not hasattr(state.model, "factors"):
            raise Invalid(" ".join(none(state)))
        theta, values = self.curves(gpu, state)
        return Curves("theta_i [deg]", np.degrees(theta), values)

    def drawings(self, gpu, state, size, scale=1.0):
        if not hasattr(state.model, "factors"):
            yield nothing(size, scale, state.look.theme, *none(state)), "", True
            return
        draw = Drawing(size, scale, state.look.theme)
        width, height = size
        theta, values = self.curves(gpu, state)
        shown = {name: values[name] for name in FACTORS if getattr(self, name) == "on"}
        # the Jacobian grows without bound at the horizon, and does not decide the range
        top = 1.3 * max([1.0, *(float(v.max()) for name, v in shown.items() if name != "jacobian")])
        low = 0.0
        if self.axis == "log":
            sides = (side for side in (theta < -np.pi / 2, theta >= -np.pi / 2) if side.any())
            peaks = [np.argmax(np.where(side, values["product"], -1.0)) for side in sides]
            known = (BELOW * float(v[at]) for v in shown.values() for at in peaks if v[at] > 0)
            low = min([top / 10**self.decades, *known])
        y = Axis(low, top, "", self.axis)
        short = width < (52 + 3 * WIDE) * scale
        columns = max(int((width / scale - 52) // (NARROW if short else WIDE)), 1) if short else 3
        rows = -(-len(shown) // columns) + (1 if short else len(shown) % columns == 0)
        foot, head = 62 * scale, (28 + 18 * rows) * scale
        box = (52 * scale, foot, max(width - 18 * scale, 60 * scale), max(height - head, foot + 8 * scale))
        both = state.model.index() is not None
        title = "θi in the plane of incidence"
        title += "; below the surface F is 1 − F, the Jacobian that of refraction" * both
        x = Axis(-270.0 if both else -90.0, 90.0, title)
        axes = Axes(draw, box, x, y)
        angles = np.arange(x.low, 91, (30 if box[2] - box[0] < 420 * scale else 15) * (3 if both else 1))
        axes.frame(angles, [f"{min(abs(a), 360 - abs(a)):g}°" for a in angles])
        theta_o = state.directions.theta_o
        axes.line([theta_o, theta_o], [y.low, y.high], "accent", 1.2)
        dashes = np.linspace(y.share(y.low), y.share(y.high), 41) * (box[3] - box[1]) + box[1]
        at = axes.place(-theta_o, y.low)[..., 0]
        for i in range(0, 40, 2):
            draw.stroke([(at, dashes[i]), (at, dashes[i + 1])], "accent", 1.0)
        for words, theta_i in (("ωo", theta_o), ("ωr", -theta_o))[: 2 if theta_o > 4 else 1]:
            draw.text(words, axes.place(theta_i, y.high) + [0, 9 * scale], "accent", size=12.0)
        draw.over()
        colors = dict(zip(FACTORS, (*draw.colors["curves"][:4], draw.colors["ink"]), strict=True))
        for name, v in shown.items():
            axes.line(np.degrees(theta), v, colors[name], 2.6 if name == "product" else 1.8)
        area = projected_area(state.model, (0.0, 0.0, 1.0))
        words = [(FACTORS[name][short], colors[name]) for name in shown] + [(f"∫ D cos θ dω = {area:.10f}", "muted")]
        for i, (text, color) in enumerate(words):
            place = i if i < len(shown) or not short else (rows - 1) * columns
            at = np.array([place % columns * (NARROW if short else WIDE), -14 - 18 * (place // columns)]) * scale
            draw.text(text, at + [box[0], height], color, (0.0, 0.5), 12.5)
        yield draw, f"f in the mirror direction {number(self.mirror(state), 4)} / sr", True

    def mirror(self, state):
        """Luminance of f in the mirror direction."""
        wo = direction(np.radians(state.directions.theta_o), np.radians(state.directions.phi_o))
        return float(luminance(alone(state.model).f(wo, wo * [-1, -1, 1])))


def none(state):
    """Lines that say that a material has no factors, and why."""
    return "No factors to show:", f"{state.material.name} ({state.model.name()}) is no product of D, G and F"


def alone(model):
    """The material without what its choice `energy` puts back: of that f is no product."""
    return replace(model, energy="none") if "energy" in model.choices() else model

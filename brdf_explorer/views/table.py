"""f over a grid that follows the lobe: the one table that lobe, slice, CSV and the albedo shown beside them read."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..glsl import of_model
from ..measure.grid import Grid, Side, direction, grid, plane_of_incidence, sides
from ..model import Invalid

RAYS = 96
NODES = 49
EDGE = 1 - 1e-5  # the last node, just above the horizon: on it f is 0 and its limit could not be drawn


@dataclass(frozen=True)
class Table:
    """float32 f of the GLSL on a Grid of one side of the surface. Rays 0 and RAYS / 2 are the plane of incidence."""

    grid: Grid
    t: np.ndarray  # (nodes,)
    wo: np.ndarray  # (3,)
    phi: float  # azimuth of wo, radians
    side: Side
    directions: object  # texture of wi, a row a ray
    target: object  # framebuffer of (f, 0)
    gpu: object

    @cached_property
    def f(self):
        """Values read back, (rays, nodes, 3). Raises Invalid for NaN and infinity, of which no diagram could be drawn."""
        values = self.gpu.pixels(self.target)[::-1, :, :3].astype(float)
        wrong = np.count_nonzero(~np.isfinite(values))
        if wrong:
            raise Invalid(
                f"f is not a finite number: {wrong} of {values.size} values of the shader are NaN or infinite"
            )
        return values

    @cached_property
    def weight(self):
        """Solid angle per node (rays, nodes), sr, by Simpson's rule along rays: sum f weight integrates f."""
        nodes = self.t.size
        simpson = np.where(np.arange(nodes) % 2 == 1, 4.0, 2.0)
        simpson[[0, -1]] = 1.0
        return self.grid.density * simpson * ((self.t[1] - self.t[0]) / 3 * 2 * np.pi / len(self.grid.wi))

    @property
    def albedo(self):
        """Share of the energy scattered to this side, (3,), by this table; `measure.shares` is the accurate one."""
        return self.side.dense * np.einsum("ptc,pt->c", self.f, self.weight * np.abs(self.grid.wi[..., 2]))

    def plane(self):
        """The plane of incidence from horizon to horizon: theta (n,), wi (n, 3), f (n, 3).

        theta rises from the far side, where the mirror direction is at -theta_o, to the viewer's side. Below the surface it goes
        on through -180 degrees, straight down, and rises as well.
        """
        half = len(self.grid.wi) // 2
        # ray 0 tilts facets away from the viewer, so it holds the directions beyond the mirror direction
        wi = np.concatenate([self.grid.wi[0, ::-1], self.grid.wi[half, 1:]])
        f = np.concatenate([self.f[0, ::-1], self.f[half, 1:]])
        side = wi[:, 0] * np.cos(self.phi) + wi[:, 1] * np.sin(self.phi)
        theta = np.arctan2(side, wi[:, 2])
        if self.side.up > 0:
            return theta, wi, f
        return theta[::-1] - 2 * np.pi * (theta[::-1] > 0), wi[::-1], f[::-1]


def table(gpu, model, directions, rays=RAYS, nodes=NODES):
    """The Table of a model for the viewer's Directions, of the viewer's side of the surface."""
    return tables(gpu, model, directions, rays, nodes, most=1)[0]


def tables(gpu, model, directions, rays=RAYS, nodes=NODES, most=2):
    """The Tables of a model for the viewer's Directions: above the surface and, where light is transmitted, below it."""
    phi = np.radians(directions.phi_o)
    wo = direction(np.radians(directions.theta_o), phi)
    t = np.linspace(0.0, EDGE, nodes)
    program = gpu.program(of_model("views/table.frag", model))
    found = []
    for side in sides(wo, model.slopes(), model.index())[:most]:
        psi = plane_of_incidence(phi, side.alpha) + 2 * np.pi * np.arange(rays) / rays
        g = grid(side.wo, side.alpha, t, psi)
        g = Grid(side.turned(g.wi), g.density)
        texture = gpu.texture(np.concatenate([g.wi, np.ones((rays, nodes, 1))], axis=-1))
        target = gpu.ctx.framebuffer([gpu.ctx.texture((nodes, rays), 4, dtype="f4")])
        gpu.draw(program, target, {"material": model, "wo": tuple(wo)}, {"directions": texture})
        found.append(Table(g, t, wo, phi, side, texture, target, gpu))
    return found

"""f over a grid that follows the lobe: the one table that lobe, slice, CSV and the albedo shown beside them read."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..glsl import of_model
from ..measure.grid import Grid, Side, direction, grid, plane_of_incidence, sides
from ..measure.noise import Running
from ..model import Invalid

RAYS = 96
NODES = 49
WALKS = 13_000  # estimates of a pass: 3 to 10 ms on a software renderer
PASSES = 48
LONGEST = 1536
NOISE = 2e-3  # over the peak: less is thinner than a line
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
    error: np.ndarray | None = None  # standard error of f where it is a mean of estimates, (rays, nodes, 3)
    walks: int = 1  # estimates of each value

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
        wi, f = self.along(self.grid.wi), self.along(self.f)
        side = wi[:, 0] * np.cos(self.phi) + wi[:, 1] * np.sin(self.phi)
        theta = np.arctan2(side, wi[:, 2])
        return theta - 2 * np.pi * ((theta > 0) & (self.side.up < 0)), wi, f

    def along(self, values):
        """Values (rays, nodes, n) of the plane of incidence (m, n), in the order of `plane`."""
        half = len(self.grid.wi) // 2
        # ray 0 tilts facets away from the viewer, so it holds the directions beyond the mirror direction
        found = np.concatenate([values[0, ::-1], values[half, 1:]])
        return found if self.side.up > 0 else found[::-1]


def table(gpu, model, directions, rays=RAYS, nodes=NODES):
    """The Table of a model for the viewer's Directions, of the viewer's side of the surface."""
    return tables(gpu, model, directions, rays, nodes, most=1)[0]


def tables(gpu, model, directions, rays=RAYS, nodes=NODES, most=2, passes=PASSES):
    """The Tables of a model for the viewer's Directions: above the surface and, where light is transmitted, below it.

    Of a stochastic model after some passes, or when its noise is low enough.
    """
    return next(found for found, done in progressive(gpu, model, directions, rays, nodes, most, passes) if done)


def progressive(gpu, model, directions, rays=RAYS, nodes=NODES, most=2, passes=LONGEST):
    """Yield (Tables, done) of a model for the viewer's Directions: once, or of a stochastic model better and better ones.

    These are means of f over all passes, until their noise, as of `noise`, is at most NOISE, or `passes` are done.
    """
    phi = np.radians(directions.phi_o)
    wo = direction(np.radians(directions.theta_o), phi)
    t = np.linspace(0.0, EDGE, nodes)
    program = gpu.program(of_model("views/table.frag", model))
    walks = max(WALKS // (rays * nodes), 1)
    uniforms = {"material": model, "wo": tuple(wo), "walks": walks}
    found = []
    for side in sides(wo, model.slopes(), model.index())[:most]:
        psi = plane_of_incidence(phi, side.alpha) + 2 * np.pi * np.arange(rays) / rays
        g = grid(side.wo, side.alpha, t if rays > 2 else even(side, psi, nodes), psi)
        g = Grid(side.turned(g.wi), g.density)
        texture = gpu.texture(np.concatenate([g.wi, np.ones((rays, nodes, 1))], axis=-1))
        target = gpu.ctx.framebuffer([gpu.ctx.texture((nodes, rays), 4, dtype="f4")])
        found.append(Table(g, t, wo, phi, side, texture, target, gpu))
    if not model.stochastic:
        for one in found:
            gpu.draw(program, one.target, uniforms, {"directions": one.directions})
        yield found, True
        return
    sums = [Running() for _ in found]
    for n in range(passes):
        for i, (one, running) in enumerate(zip(found, sums, strict=True)):
            gpu.draw(program, one.target, uniforms | {"pass": 2 * n + i}, {"directions": one.directions})
            running.add(replace(one).f[None])  # which is not kept
            mean, error = running.mean()
            texels = np.concatenate([mean, np.zeros((rays, nodes, 1))], axis=-1)
            one.target.color_attachments[0].write(texels.astype(np.float32).tobytes())
            found[i] = replace(one, error=error, walks=walks * running.count)
        done = n + 1 == passes or noise(found) <= NOISE
        yield [replace(one) for one in found], done


def even(side, psi, nodes):
    """Nodes t (rays, nodes) of a slice: half of them follow the lobe, as even t do, and half are spread over the angle, so that a
    curve has no corners where a lobe is far wider than it was taken for.
    """
    t = np.linspace(0.0, EDGE, 8 * nodes)
    turned = np.linalg.norm(np.diff(grid(side.wo, side.alpha, t, psi).wi, axis=1), axis=-1).cumsum(axis=1)
    share = 0.5 * (t / EDGE + np.pad(turned / turned[:, -1:], ((0, 0), (1, 0))))
    return np.stack([np.interp(np.linspace(0.0, 1.0, nodes), one, t) for one in share])


def noise(found):
    """The standard error of f in Tables, the root of its mean square, over the largest value; infinite where nothing was found,
    which may be there, and after one pass.
    """
    peak = max(float(one.f.max()) for one in found)
    return float(np.sqrt(np.mean([np.mean(one.error**2) for one in found]))) / peak if peak > 0 else np.inf

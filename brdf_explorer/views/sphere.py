"""A sphere of the material, lit by a directional light and by an environment.

A material that transmits is a solid ball: light enters, is refracted, and leaves where it meets the surface from inside, which is
as rough there (shaders/views/body_ball.glsl).
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from ..environment import environment, toward, turn
from ..glsl import assemble, of_model
from ..model import choice, param
from .diagram import number
from .pace import Pace, chords
from .picture import R2, Picture, View

SIDES = 32  # of the polygon that disc.vert draws around the sphere
SMOOTH = 16  # jittered passes after which edges and highlights of a directional light are smooth


@dataclass(frozen=True)
class Sphere(View):
    """A sphere of the material under the light of the state; a solid ball if the material transmits."""

    title = "Sphere"

    background: str = choice("plain", ("plain", "environment"), "what lies behind the sphere")
    formulas: str = choice(
        "stable", ("stable", "textbook"), "as we rearranged them for float32, or as they are printed"
    )
    estimator: str = choice(
        "mis",
        ("mis", "bsdf", "light"),
        "where directions to the environment come from: the material's sampler, the map's, or both by multiple importance",
    )
    samples: int = param(1024, 1, 65536, "most samples a pixel", scale="log")
    noise: float = param(0.01, 1e-6, 0.1, "standard error of a pixel, over the mean, that ends sampling", scale="log")

    def shows(self, state):
        return (self, state.model, state.light)

    def radius(self, size):
        """Radius of the sphere in a picture of that size, pixels; its centre is the picture's."""
        return 0.46 * min(size)

    def pictures(self, gpu, state, size, scale=1.0):
        light = state.light
        uniforms, textures = {"material": state.model}, {}
        lights = []
        if light.irradiance > 0:
            lights.append("directional")
            uniforms |= {"light": toward(light), "irradiance": light.irradiance}
        if light.environment != "none" and light.gain > 0:
            lights.append("environment")
            uniforms |= {"turn": turn(light), "gain": light.gain}
            textures = environment_textures(gpu, light)
        lighting = "both" if len(lights) == 2 else lights[0] if lights else "dark"
        body = "opaque" if state.model.index() is None else "ball"
        slots = {"lighting": lighting, "estimator": self.estimator, "body": body}
        fragment = of_model("views/sphere.frag", state.model, slots=slots, formulas=self.formulas)
        program = gpu.program(fragment, assemble("views/disc.vert"))
        width, height = map(float, size)
        uniforms |= {"size": (width, height), "center": (width / 2, height / 2), "radius": self.radius(size)}
        uniforms |= {"sides": float(SIDES)}
        target = gpu.target("sphere", size)  # new ones are clear, and what lies outside of the disc stays so
        drawn = bool(textures) or body == "ball" or state.model.stochastic  # by random numbers
        most = self.samples if drawn else SMOOTH
        pace = Pace(gpu, program, chords(size[1], self.radius(size) + 1))

        def draw(box):
            blend = "mean" if n > 1 else None
            gpu.draw(program, target, uniforms, textures, vertices=3 * SIDES, blend=blend, box=box)

        noise, half, picture = None, None, None
        for n in range(1, most + 1):
            jitter = (R2 * (n - 1) + 0.5) % 1.0 - 0.5
            uniforms |= {"jitter": tuple(jitter), "share": 1 / n, "pass": n - 1}
            side = pace.preview(partial(small, gpu, program, size, uniforms, textures)) if n == 1 else 1
            if side > 1:
                magnify(gpu, target, small(gpu, program, size, uniforms, textures, side), side, uniforms)
                shown = self.over_background(gpu, target, uniforms, textures)
                picture = Picture(shown, linear=True, note=f"1 sample in {side} x {side} pixels", done=False)
                yield picture
            for last in pace.strips(draw, size[0]):
                if not last:
                    yield picture
            if drawn and n >= 16 and n & (n - 1) == 0:
                mean = gpu.pixels(target)
                noise = standard_error(mean, half) if half is not None else None
                half = mean
            done = n == most or noise is not None and noise <= self.noise
            note = f"{n} sample{'s' * (n > 1)} a pixel"
            note += f", noise {number(100 * noise, 2)} %" if noise is not None else ""
            shown = self.over_background(gpu, target, uniforms, textures)
            picture = Picture(shown, linear=True, note=note, done=done)
            yield picture
            if done:
                return

    def over_background(self, gpu, target, uniforms, textures):
        """The target, or if asked and lit by an environment one with that behind it."""
        if self.background == "plain" or not textures:
            return target
        shown = gpu.target("sphere.shown", target.size)
        gpu.draw(gpu.program(assemble("views/background.frag")), shown, uniforms, textures)
        over = gpu.program(assemble("views/over.frag"))
        gpu.draw(over, shown, {"share": 1.0}, {"picture": target.color_attachments[0]}, blend="premultiplied")
        return shown


def small(gpu, program, size, uniforms, textures, pixels):
    """The framebuffer with a sphere of that size drawn so small that a pixel stands for `pixels` along a side."""
    target = gpu.target(f"sphere.{pixels}", tuple(-(-n // pixels) for n in size))
    place = {"size": tuple(map(float, target.size)), "center": tuple(c / pixels for c in uniforms["center"])}
    place["radius"] = uniforms["radius"] / pixels
    gpu.draw(program, target, uniforms | place, textures, vertices=3 * SIDES)
    return target


def magnify(gpu, target, drawn, pixels, uniforms):
    """Draw over the sphere of the target what is `drawn` as `small` says."""
    program = gpu.program(assemble("views/magnify.frag"), assemble("views/disc.vert"))
    textures = {"picture": drawn.color_attachments[0]}
    gpu.draw(program, target, uniforms | {"pixels": float(pixels)}, textures, vertices=3 * SIDES)


def standard_error(mean, half):
    """Standard error of a pixel of a running mean over the mean of all, from the mean of the first half of its passes.

    The halves are independent, and their means differ by twice what the whole differs from the first, so that difference has
    the variance of the whole's mean.
    """
    covered = mean[..., 3] > 0
    average = mean[covered][:, :3].mean()
    return float(np.sqrt(np.mean((mean[covered] - half[covered])[:, :3] ** 2)) / average) if average > 0 else 0.0


def environment_textures(gpu, light):
    """The textures of the light's environment, kept with the Gpu until another one is asked for."""
    found = environment(light.environment, light.file)
    if gpu.buffers.get("environment", (None,))[0] is not found:
        gpu.buffers["environment"] = (found, {"map": gpu.texture(found.map), "cdf": gpu.texture(found.cdf)})
    return gpu.buffers["environment"][1]

"""From a picture to the colours of a screen."""

from ..glsl import assemble
from ..lib.srgb import srgb_decode
from .picture import PALETTES, rgb


def develop(gpu, picture, look):
    """The picture as a framebuffer of 8-bit sRGB colours: exposure, tone curve, sRGB, over the theme's backdrop."""
    if not picture.linear:
        return picture.target
    target = gpu.target("develop", picture.target.size, 4, "f1")
    program = gpu.program(assemble("views/develop.frag", look.choices()))
    backdrop = tuple(srgb_decode(rgb(PALETTES[look.theme]["backdrop"])))
    uniforms = {"exposure": 2.0**look.exposure, "backdrop": backdrop}
    gpu.draw(program, target, uniforms, {"picture": picture.target.color_attachments[0]})
    return target

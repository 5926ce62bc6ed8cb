"""Small pictures of the material presets, drawn one a frame when they are first seen."""

from dataclasses import replace

from ..gpu import Gpu
from ..model import Invalid
from ..state import load
from ..views.develop import develop

SCENE = "studio"
SAMPLES = 48


class Thumbnails:
    """Framebuffers by preset, theme and size."""

    def __init__(self, gpu):
        self.gpu = Gpu(gpu.ctx)  # its targets are not those of the panels' pictures
        self.gpu.programs = gpu.programs
        self.drawn = {}
        self.spent = False

    def next_frame(self):
        self.spent = False

    def get(self, name, theme, side):
        """The framebuffer with the preset on a sphere of `side` pixels, or None in the frames before its turn."""
        key = (name, theme, side)
        if key not in self.drawn and not self.spent:
            self.spent = True
            try:
                self.drawn[key] = self.draw(name, theme, side)
            except Invalid:
                self.drawn[key] = None  # opening the preset will say why
        return self.drawn.get(key)

    def draw(self, name, theme, side):
        state = load(name, load(SCENE)).with_view("sphere", samples=SAMPLES, noise=0.1, background="plain")
        look = replace(state.look, theme=theme)
        pictures = state.views["sphere"].pictures(self.gpu, replace(state, look=look), (side, side))
        *_, picture = pictures
        target = self.gpu.target(f"{name} {theme}", (side, side), 4, "f1")
        self.gpu.ctx.copy_framebuffer(target, develop(self.gpu, picture, look))
        self.gpu.ctx.screen.use()
        return target

"""Small pictures of the material presets, drawn one a frame when they are first seen."""

from dataclasses import replace

from ..model import Invalid
from ..state import load
from ..views.develop import develop

SCENE = "studio"
SAMPLES = 48


class Thumbnails:
    """Framebuffers by preset and theme."""

    def __init__(self, gpu):
        self.gpu = gpu.beside("thumbnails")
        self.drawn = {}
        self.spent = False

    def next_frame(self):
        self.spent = False

    def get(self, name, theme, side):
        """The framebuffer with the preset on a sphere of `side` pixels; before its turn that of another size, or None."""
        drawn_side, drawn = self.drawn.get((name, theme), (0, None))
        if drawn_side != side and not self.spent:
            self.spent = True
            try:
                drawn = self.draw(name, theme, side)
            except Invalid:
                drawn = None  # opening the preset will say why
            self.drawn[name, theme] = side, drawn
        return drawn

    def draw(self, name, theme, side):
        state = load(name, load(SCENE)).with_view("sphere", samples=SAMPLES, noise=0.1, background="plain")
        look = replace(state.look, theme=theme)
        pictures = state.views["sphere"].pictures(self.gpu, replace(state, look=look), (side, side))
        *_, picture = pictures
        target = self.gpu.target(f"{name} {theme}", (side, side), 4, "f1")
        self.gpu.ctx.copy_framebuffer(target, develop(self.gpu, picture, look))
        self.gpu.ctx.screen.use()
        return target

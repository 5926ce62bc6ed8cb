"""Small pictures of the material presets, which get better in each frame that shows them, by a little."""

import time
from dataclasses import replace

from ..model import Invalid
from ..state import load
from ..views.develop import develop

SCENE = "studio"
SAMPLES, NOISE = 2048, 0.02  # options of the sphere; etched glass takes most of them
ROUGH = 0.5  # seconds of its own after which a picture waits until nothing else is drawn
BUDGET = 0.006  # seconds of a frame, and of a step
END = object()


class Thumbnails:
    """Framebuffers by preset and theme."""

    def __init__(self, gpu):
        self.gpu = gpu
        self.drawn = {}
        self.seen = []

    def get(self, name, theme, side):
        """The framebuffer with the preset on a sphere of `side` pixels; before its turn that of another size, or None."""
        found = self.drawn.get((name, theme))
        if not found or found.side != side:
            found = self.drawn[name, theme] = Thumbnail(self.gpu, name, theme, side, found and found.shown)
        self.seen.append(found)
        return found.shown

    @property
    def busy(self):
        return any(t.pictures for t in self.seen)

    def advance(self, idle):
        """Bring those further that were asked for since the last call. idle: whether nothing else is being drawn."""
        start, seen = time.perf_counter(), self.seen
        self.seen = []
        while time.perf_counter() - start < BUDGET:
            wanting = [t for t in seen if t.pictures and (idle or t.took < ROUGH)]
            if not wanting:
                break
            min(wanting, key=lambda t: t.took).step()


class Thumbnail:
    """The picture of a preset, and its generator while it gets better."""

    def __init__(self, gpu, name, theme, side, shown):
        self.side, self.shown = side, shown
        self.took = 0.0  # seconds, of all steps
        self.gpu = gpu.beside(f"thumbnail {name} {theme}").paced(BUDGET)
        self.pictures = pictures(self.gpu, name, theme, side)

    def step(self):
        start = time.perf_counter()
        try:
            shown = next(self.pictures, END)
        except Invalid:
            shown = END  # opening the preset will say why
        if shown is END:
            self.pictures = None
        else:
            self.shown = shown or self.shown
        self.gpu.ctx.finish()
        self.took += time.perf_counter() - start


def pictures(gpu, name, theme, side):
    """Framebuffers of the preset on a sphere, from the first to the best; None while there is none."""
    state = load(name, load(SCENE)).with_view("sphere", samples=SAMPLES, noise=NOISE, background="plain")
    state = replace(state, look=replace(state.look, theme=theme))
    before = None
    for picture in state.views["sphere"].pictures(gpu, state, (side, side)):
        if picture is not before:
            before, shown = picture, gpu.target("shown", (side, side), 4, "f1")
            gpu.ctx.copy_framebuffer(shown, develop(gpu, picture, state.look))
        yield before and shown

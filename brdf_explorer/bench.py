"""What pictures cost, as ratios within one run on one context; the figures the project holds itself to."""

import subprocess
import sys
import time
from collections import deque
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from .glsl import assemble, of_model
from .gpu import offscreen
from .ladder import LADDERS
from .measure import cost
from .measure.cost import interleaved
from .measure.estimator import Runs, moments, samplers, slope
from .measure.grid import direction
from .measure.tradeoff import tradeoffs, works
from .models import MODELS
from .state import State, load
from .views.pace import STEP

SIZE = (1024, 1024)
SMALL = (256, 256)
PROGRESSIVE = (
    "sphere lobe polar factors facets hemisphere sampling compare readings microsurface".split()
)  # views whose pictures get better
SLOW = ("gold", "etched_glass", "white_plaster", "sandpaper")  # a mirror, and the slowest of each kind of model
WINDOW = (676, 210)  # the size at which the best known peer's lobe was timed
BARE = "import numpy, imgui_bundle, moderngl; moderngl.create_context(standalone=True, require=330{backend})"
PICTURE = """
from brdf_explorer.gpu import offscreen
from brdf_explorer.state import load
from brdf_explorer.views.develop import develop
with offscreen() as gpu:
    state = load("gold")
    gpu.pixels(develop(gpu, next(state.views["sphere"].pictures(gpu, state, (512, 512))), state.look))
"""
# the window on what it opens on, without a screen, up to its first frame or the one that shows all pictures
OPENED = """
from imgui_bundle import hello_imgui
import glfw
glfw.init_hint(glfw.PLATFORM, glfw.PLATFORM_NULL)
glfw.init()
glfw.window_hint(glfw.CONTEXT_CREATION_API, glfw.EGL_CONTEXT_API)
from brdf_explorer.state import load
from brdf_explorer.ui.window import Window
window = Window(load("gold", load("studio")))
parameters = window.parameters()
parameters.ini_disable = True

def swapped():
    window.gpu.ctx.finish()
    parameters.app_shall_exit = {until}

parameters.callbacks.after_swap = swapped
hello_imgui.run(parameters)
"""


@dataclass(frozen=True)
class Figure:
    """A measured ratio or time: median and quartiles, and the limit the project sets itself, if any."""

    name: str
    median: float
    low: float
    high: float
    unit: str = ""
    limit: float | None = None

    @property
    def ok(self):
        return self.limit is None or self.median <= self.limit


def figure(name, samples, unit="", limit=None):
    low, median, high = np.quantile(samples, [0.25, 0.5, 0.75])
    return Figure(name, float(median), float(low), float(high), unit, limit)


def report(repeats=31, processes=5):
    """Figures, as they are measured: of the chart, of drawing, then of starting."""
    with offscreen() as gpu:
        yield from charting(gpu)
        yield from drawing(gpu, repeats)
        yield from walking(gpu, repeats)
        yield from answering(gpu)
    yield from sampling(State().model)
    yield from sampling(MODELS["multiscatter"](alpha=0.5, fresnel="one"), mean=1.0, groups=4)
    yield from starting(processes)


def charting(gpu, runs=5):
    """Seconds to the first point of each question that arises for gold and to all of them, and how ratios of costs repeat."""
    state = load("gold", load("studio"))
    ladders = [ladder for ladder in LADDERS.values() if ladder.applies(state)]
    firsts, begun = {}, time.perf_counter()
    for ladder in ladders:
        start = time.perf_counter()
        for found in tradeoffs(gpu, ladder, state):
            if any(p.known for p in found.points):
                firsts.setdefault(ladder.name, time.perf_counter() - start)
    whole = time.perf_counter() - begun
    slowest = max(firsts, key=firsts.get)
    yield figure(f"first points of a chart; the slowest: {slowest}", firsts[slowest], "s", limit=2)
    yield figure(f"chart of all questions for gold: {', '.join(firsts)}", whole, "s", limit=180)
    spreads = {}
    for ladder in ladders:
        kind, size = ("frame", SMALL) if ladder.measures == "picture" else ("evaluation", cost.SIZE)
        kind = "sample" if ladder.measures == "samples" else kind
        medians = []
        for _ in range(runs):
            gpu.costs.clear()
            (times,) = deque(cost.costs(gpu, works(gpu, ladder, state, kind, size)), 1)
            medians.append([np.median(seconds) for seconds in times.values()])
        ratios = np.array(medians) / np.array(medians)[:, -1:]
        spreads[ladder.name] = np.max(np.ptp(ratios, axis=0) / np.median(ratios, axis=0))
    worst = max(spreads, key=spreads.get)
    name = f"ratios of methods' costs, over {runs} charts, largest less smallest; the worst: {worst}"
    yield figure(name, 100 * spreads[worst], "%", limit=10)


def drawing(gpu, repeats):
    """Costs of the views against bare fills and evaluations, one draw a finish."""
    state = State()
    target = gpu.target("bench", SIZE)
    fill = gpu.program(assemble("views/fill.frag"))
    evaluate = gpu.program(of_model("views/evaluate.frag", state.model))
    sphere, lobe, polar = (state.views[name] for name in ("sphere", "lobe", "polar"))

    def finished(draw):
        def run():
            draw()
            gpu.ctx.finish()

        return run

    def first(view, size):
        return finished(lambda: next(view.pictures(gpu, state, size)))

    uniforms = {"material": state.model, "size": tuple(map(float, SIZE))}
    times = interleaved(
        {
            "fill": finished(lambda: gpu.draw(fill, target)),
            "evaluate": finished(lambda: gpu.draw(evaluate, target, uniforms)),
            "sphere": first(sphere, SIZE),
            "lobe": first(lobe, WINDOW),
            "polar": first(polar, WINDOW),
        },
        repeats,
    )
    share = np.pi * sphere.radius(SIZE) ** 2 / (SIZE[0] * SIZE[1])
    bare = np.maximum(times["evaluate"] - times["fill"], 0.0)
    yield figure("fill of 1024x1024 RGBA32F", times["fill"] * 1e3, "ms")
    yield figure("one evaluation of f, fill subtracted", bare / (SIZE[0] * SIZE[1]) * 1e9, "ns")
    yield figure("sphere 1024x1024", times["sphere"] * 1e3, "ms")
    yield figure(
        "sphere / (covered pixels x evaluation + fill)", times["sphere"] / (share * bare + times["fill"]), limit=1.5
    )
    yield figure("lobe 676x210", times["lobe"] * 1e3, "ms")
    yield figure("lobe 676x210 / fill", times["lobe"] / times["fill"], limit=4)
    yield figure("polar slice 676x210", times["polar"] * 1e3, "ms")


def walking(gpu, repeats, size=(512, 512)):
    """Costs of walks over the microsurface against what they cannot do without."""
    yield from map(partial(walk, gpu, repeats, size), ("ggx", "beckmann"))


def answering(gpu, size=(512, 512), repeats=5, seconds=0.5):
    """Of each view at the window's pace: the time to its first picture and its longest step, each by its slowest material.

    Each repeat has other parameters, so that nothing that was measured before is shown again; shaders are compiled before.
    """
    for view in PROGRESSIVE:
        firsts, steps = {}, {}
        for name in SLOW:
            state = load(name, load("studio"))
            state = replace(state, materials=(*state.materials, *load("gold").materials))
            if view == "hemisphere":
                state = state.with_view(view, quantity="f")
            runs = [paced(gpu, moved(state, k), view, size, seconds) for k in range(repeats + 1)]
            firsts[name], steps[name] = ([run[i] for run in runs[1:]] for i in (0, 1))
        for what, found, limit in (("first picture", firsts, 100), ("longest step", steps, 50)):
            slowest = max(found, key=lambda name: np.median(found[name]))
            samples = np.array(found[slowest]) * 1e3
            yield figure(f"{what} of {view}, {size[0]}x{size[1]}; the slowest: {slowest}", samples, "ms", limit=limit)


def moved(state, k):
    """The state with other parameters, so little that it costs as much."""
    model = state.model
    return state.with_model(replace(model, alpha=tuple(a * (1 - 1e-3 * k) for a in model.alpha)))


def paced(gpu, state, view, size, seconds):
    """Seconds to the first picture of a view in the window, and of its longest step before `seconds` are over."""
    begun, first, longest = time.perf_counter(), None, 0.0
    pictures = state.views[view].pictures(gpu.paced(STEP), state, size)
    while first is None or time.perf_counter() - begun < seconds:
        start = time.perf_counter()
        picture = next(pictures)
        gpu.ctx.finish()
        end = time.perf_counter()
        longest, first = max(longest, end - start), first or picture and end - begun
        if picture and picture.done:
            break
    return first, longest


def walk(gpu, repeats, size, ndf):
    """What a walk costs over its least: the facets that it meets, times the evaluations for one of them without a loop."""
    material = MODELS["multiscatter"](alpha=0.5, ndf=ndf)
    target = gpu.target("bench walk", size)
    shaders = {
        "fill": assemble("views/fill.frag"),
        "walk": of_model("views/evaluate.frag", material),
        "step": assemble("views/step.frag", material.choices()),
    }
    uniforms = {"size": tuple(map(float, size)), "material": material}
    uniforms |= {name: getattr(material, name) for name in ("alpha", "eta", "k")}

    def drawn(source):
        program = gpu.program(source)

        def run():
            gpu.draw(program, target, uniforms)
            gpu.ctx.finish()

        return run

    times = interleaved({name: drawn(source) for name, source in shaders.items()}, repeats)
    bare = {name: np.maximum(t - times["fill"], 1e-9) for name, t in times.items()}
    # what is scattered from order k on is, where nothing is lost, the chance to meet k facets
    white = replace(material, fresnel="one")
    wo, u = direction(np.radians(25.0), 0.0), np.random.default_rng(1).random((50_000, 2))
    facets = sum(float(gpu.sample_f(replace(white, lowest=k), wo, u)[1][:, 0].mean()) for k in range(1, 13))
    name = f"a walk of {ndf}, alpha = 0.5, over its {facets:.2f} facets x the evaluations for one"
    return figure(name, bare["walk"] / (facets * bare["step"]), limit=3)


def sampling(model, theta_o=60.0, samples=4096, groups=8, mean=None):
    """How the error of the estimator falls with the number of samples: slopes of log error to log N, of groups of runs.

    mean: the albedo, where it is known; else it is by quadrature.
    """
    wo = direction(np.radians(theta_o), 0.0)
    models, own = samplers(model)
    mean = mean or [m for m in moments([models[own]], wo) if m][-1].mean
    slopes = []
    for seed in range(groups):
        runs = Runs(models[own], wo, seed=seed)
        while not runs.counts or runs.counts[-1] < samples:
            deque(runs.double(), 0)
        slopes.append(slope(runs.counts, runs.estimates, mean).value)
    what = f"{own} samples" if own != "its own" else f"samples of {model.name()}"
    name = f"slope of the error of {what} over N, log to log, where 1/sqrt(N) has -0.5"
    yield figure(name, slopes, limit=-0.45)


def starting(processes):
    """Costs of imports and of the first picture, each in a new process."""

    def run(code):
        return lambda: subprocess.run([sys.executable, "-c", code], check=True)

    linux = sys.platform.startswith("linux")
    runs = {
        "numpy": run("import numpy"),
        "package": run("import numpy, brdf_explorer.state"),
        "bare": run(BARE.format(backend=', backend="egl"' if linux else "")),
        "picture": run(PICTURE),
    }
    if linux:  # elsewhere glfw's null platform has no OpenGL
        runs["frame"] = run(OPENED.format(until="True"))
        runs["pictures"] = run(
            OPENED.format(until="all(window.canvases[name].shown for name in ('sphere', 'lobe', 'polar'))")
        )
    times = interleaved(runs, processes)
    yield figure("import of the package over numpy", times["package"] - times["numpy"], "s", limit=0.1)
    yield figure("imports of numpy, moderngl, imgui_bundle and a context", times["bare"], "s")
    yield figure("first picture from a cold process", times["picture"], "s")
    yield figure("first picture / those imports and a context", times["picture"] / times["bare"], limit=2)
    if linux:
        yield figure("window's first frame / those imports and a context", times["frame"] / times["bare"], limit=2)
        yield figure("window's first pictures / those imports and a context", times["pictures"] / times["bare"])

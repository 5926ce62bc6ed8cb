"""The commands that draw views: in the window, into a file, into a gallery."""

import os
import sys
from dataclasses import replace

import click

from .flags import Flagged, loaded
from .options import Number, Size, ViewName, output_option, preset_argument, scene_option, seconds_option, with_option
from .output import progress

QUICK = 1.0  # most seconds for a picture of the gallery that is drawn in place of the window


def beside(state, others):
    """The state with materials of other presets after its own."""
    return replace(state, materials=(*state.materials, *(m for name in others for m in loaded(name).materials)))


@click.command("open", cls=Flagged, sections=("material", "directions", "light", "look"), scene="studio")
@click.argument("preset", required=False)
@scene_option
@with_option
def open_(state, preset, others):
    """Open the window, or with no display draw a gallery.

    The gallery goes to the folder gallery/.
    """
    state = beside(state, others)
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        click.echo(
            "No display: neither DISPLAY nor WAYLAND_DISPLAY is set. Drawing a gallery: gallery/index.html, which grows for a"
            " minute or so."
        )
        return write_gallery("gallery", [(preset, state)] if preset else None, seconds=QUICK)
    from ..state import CARRIERS
    from ..ui import run

    # where Save writes: not over a preset of the package, nor over a picture
    mine = preset and os.path.isfile(preset) and not preset.lower().endswith(CARRIERS)
    return run(state, preset if mine else None)


@click.command(cls=Flagged, sections=("material", "directions", "light", "look", "view"))
@preset_argument
@scene_option
@with_option
@click.option("--view", type=ViewName(), default="sphere", show_default=True, help="What to draw, such as lobe.")
@click.option("--size", type=Size(), default="512x512", show_default=True, help="Pixels.")
@click.option(
    "--scale", type=Number(0.25, 16), default=1.0, show_default=True, help="Pixels a point of lines and text."
)
@seconds_option
@output_option
def render(state, preset, others, view, size, scale, seconds, output):
    """Draw a view of PRESET into a file.

    FILE is a .png or .exr picture; of all views but sphere and lobe also an .svg or .pdf drawing; of polar, factors, facets,
    sampling, readings and microsurface also a .csv table of their curves. The command table has f over all directions.
    """
    from ..export import save_view
    from ..gpu import offscreen

    state = beside(state, others)
    with offscreen() as gpu, progress() as show:
        note = save_view(gpu, state, view, output, size, scale, seconds, lambda note: show(f"{view}: {note}"))
    click.echo(f"{output}: {size[0]} x {size[1]}{note and f', {note}'}")


@click.command()
@click.argument("presets", nargs=-1)
@click.option("--scene", default="studio", show_default=True, metavar="PRESET", help="The light and the look.")
@click.option("--size", type=Size(), default="480x360", show_default=True, help="Pixels of each picture.")
@click.option("--time", "seconds", type=Number(0, 1e6), default=3.0, show_default=True, help="Most seconds a picture.")
@click.option(
    "-o", "--output", default="gallery", show_default=True, metavar="FOLDER", help="The folder to write into."
)
def gallery(presets, scene, size, seconds, output):
    """Draw all materials in all views, and a page of them.

    Or only the PRESETS that are given. The page is index.html, which grows as pictures come.
    """
    return write_gallery(output, [(name, loaded(name, scene)) for name in presets] or None, scene, size, seconds)


def write_gallery(folder, states=None, scene="studio", size=(480, 360), seconds=3.0):
    from ..gallery import materials, save_gallery
    from ..gpu import offscreen

    states = states or materials(scene)
    with offscreen() as gpu, progress() as show:
        for i, n, what in save_gallery(gpu, states, folder, size, seconds):
            show(f"{i} of {n}: {what}")
    click.echo(f"{os.path.join(folder, 'index.html')}: {n} pictures")

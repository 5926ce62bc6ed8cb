"""Files out, and the preset back from them: PNG and EXR of a view's picture, SVG, PDF and CSV of its curves, tables of f.

Every file but PDF carries the whole state as a preset, and `embedded` reads it back. A file is written beside its place and
then moved there, so it is whole or as it was before.
"""

import os
import sys
import time
import warnings
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from . import __version__
from .lib.srgb import srgb_decode
from .measure.grid import angles
from .model import Invalid
from .state import LARGEST, State, dumps, replacing
from .views.develop import develop
from .views.drawing import Drawn, Fill, Raster
from .views.picture import PALETTES, Label
from .views.table import NODES, RAYS, tables

KEY = "brdf-explorer"  # the PNG text, EXR attribute and NPZ array that holds the preset
SOFTWARE = f"brdf-explorer {__version__}"
MOST_PIXELS = 2**26  # the picture, its linear values and their copies then fit into 4 GB
FONT = Path("assets/fonts/Roboto/Roboto-Regular.ttf")  # of imgui_bundle: the window's own


@dataclass(frozen=True)
class Rendered:
    """A finished picture of a view.

    pixels  uint8 (H, W, 3), developed sRGB, without labels
    linear  float32 (H, W, 4), scene-linear RGB premultiplied by coverage; of a diagram the decoded pixels
    """

    pixels: np.ndarray
    linear: np.ndarray
    labels: list[Label]
    note: str
    state: State
    view: str
    scale: float


def render(gpu, state, view, size, scale=1.0, seconds=None, watch=None):
    """The Rendered picture of a view's name. It gets better until it is done or `seconds` have passed.

    size: (width, height) in pixels; scale: pixels per point of lines and text; watch(picture) is called with each Picture.
    Raises Invalid for a size that this driver cannot draw.
    """
    check_size(gpu, size)
    start = time.monotonic()
    for picture in state.views[view].pictures(gpu, state, tuple(size), scale):
        if seconds is not None or watch:
            gpu.ctx.finish()
        if watch:
            watch(picture)
        if seconds is not None and time.monotonic() - start >= seconds:
            break
    pixels = gpu.pixels(develop(gpu, picture, state.look))[..., :3]
    if picture.linear:
        linear = gpu.pixels(picture.target)
    else:
        linear = np.ones((*pixels.shape[:2], 4), np.float32)
        linear[..., :3] = srgb_decode(np.arange(256) / 255.0)[pixels]
    return Rendered(np.ascontiguousarray(pixels), linear, picture.labels, picture.note, state, view, scale)


def check_size(gpu, size):
    most = gpu.ctx.info["GL_MAX_TEXTURE_SIZE"]
    if not all(isinstance(n, int | np.integer) and 1 <= n <= most for n in size) or size[0] * size[1] > MOST_PIXELS:
        shown = "x".join(map(str, size))
        raise Invalid(
            f"size = {shown} cannot be drawn: each side is 1 to {most}, and their product at most {MOST_PIXELS}"
        )


# --- pictures --------------------------------------------------------------------------------------------------------


def save_view(gpu, state, view, path, size, scale=1.0, seconds=None, watch=None):
    """Write a view of the state in the format that the path's suffix names; its note, one line.

    .png and .exr hold the picture; .svg and .pdf the drawing of a view that is one; .csv the curves of a view that has some.
    watch(note) is called with the note of each picture that it got better by. Raises Invalid.
    """
    writers = dict(PICTURES)
    if isinstance(state.views[view], Drawn):
        writers |= DRAWINGS
    if hasattr(state.views[view], "table_of"):
        writers |= CURVES
    write = writers[known_suffix(path, writers, f"a picture of {view}")]
    if write in PICTURES.values():
        rendered = render(gpu, state, view, size, scale, seconds, watch and (lambda picture: watch(picture.note)))
        write(rendered, path)
        return rendered.note
    check_size(gpu, size)
    if write in DRAWINGS.values():
        return write(gpu, state, view, path, size, scale, seconds, watch)
    write(gpu, state, view, path)
    return ""


def known_suffix(path, known, what):
    """The path's suffix in lower case, or Invalid that lists those of `known`."""
    suffix = Path(path).suffix.lower()
    if suffix not in known:
        given = f"the suffix {suffix}" if suffix else "a name without suffix"
        raise Invalid(f"{path}: {given} names no format for {what}; there are: {', '.join(known)}")
    return suffix


def write_png(rendered, path):
    """8-bit sRGB with the labels drawn over the picture; the preset as iTXt."""
    from PIL.PngImagePlugin import PngInfo

    info = PngInfo()
    info.add(b"sRGB", b"\0")  # perceptual
    info.add_itxt("Title", title(rendered.state, rendered.view))
    info.add_itxt("Software", SOFTWARE)
    info.add_itxt(KEY, dumps(rendered.state))
    with replacing(path) as temporary:
        labelled(rendered).save(temporary, format="png", pnginfo=info)


def write_exr(rendered, path):
    """float32 linear RGB and coverage, without labels; the preset as a string attribute."""
    attributes = {"comments": title(rendered.state, rendered.view), "software": SOFTWARE, KEY: dumps(rendered.state)}
    save_exr(path, {"RGBA": rendered.linear}, attributes)


def save_exr(path, channels, attributes):
    import OpenEXR

    # OpenEXR writes an array that is not contiguous wrong, without a word
    channels = {name: np.ascontiguousarray(values, dtype=np.float32) for name, values in channels.items()}
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **attributes}
    with replacing(path) as temporary:
        try:
            OpenEXR.File(header, channels).write(str(temporary))
        except RuntimeError as error:
            raise Invalid(f"{path}: cannot write: {error}") from None


def labelled(rendered):
    """The picture with its labels as a Pillow image."""
    from PIL import Image, ImageDraw

    image = Image.fromarray(rendered.pixels)
    draw = ImageDraw.Draw(image)
    for label in rendered.labels:
        face = font(label.size * rendered.scale)
        ascent, descent = face.getmetrics()
        left = label.x - label.anchor[0] * face.getlength(label.text)
        top = label.y - label.anchor[1] * (ascent + descent)
        # on whole pixels letters are as crisp as they get
        draw.text((round(left), round(top) + ascent), label.text, label.color, face, anchor="ls")
    return image


def font_path():
    """Roboto, which the window uses too: found without importing the library that holds it."""
    return Path(find_spec("imgui_bundle").submodule_search_locations[0]) / FONT


def font(height):
    """Pillow's font whose lines are `height` pixels high, as imgui counts it."""
    from PIL import ImageFont

    em = ImageFont.truetype(font_path(), 1000, layout_engine=ImageFont.Layout.BASIC)
    return em.font_variant(size=max(height * 1000 / sum(em.getmetrics()), 1.0))


def title(state, view):
    return f"{legible(state.material.name)}: {state.views[view].title}"


# --- curves ----------------------------------------------------------------------------------------------------------


def write_drawing(gpu, state, view, path, size, scale, seconds=None, watch=None):
    """The drawing of a view as a vector file by matplotlib, 1/72 inch a pixel of `size`."""
    start = time.monotonic()
    for last in state.views[view].drawings(gpu, state, size, scale):
        if watch:
            watch(last[1])
        if seconds is not None and time.monotonic() - start >= seconds:
            break
    drawing, note, _ = last
    with matplotlib_style(state.look.theme), replacing(path) as temporary:
        metadata = {"Title": title(state, view), "Creator": SOFTWARE}
        # no date: the same state gives the same file
        metadata |= {"Description": dumps(state), "Date": None} if path_is(path, ".svg") else {"CreationDate": None}
        figure_of(gpu, drawing).savefig(temporary, format=Path(path).suffix[1:].lower(), metadata=metadata)
    return note


def path_is(path, suffix):
    return Path(path).suffix.lower() == suffix


@contextmanager
def matplotlib_style(theme):
    """matplotlib with the window's font and the theme's paper."""
    import matplotlib
    from matplotlib import font_manager

    font_manager.fontManager.addfont(str(font_path()))
    style = {"figure.facecolor": PALETTES[theme]["paper"], "font.family": ["Roboto", "DejaVu Sans"]}
    style |= {"svg.hashsalt": KEY, "text.parse_math": False}
    with matplotlib.rc_context(style), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing")  # a name in another script shows boxes
        yield


def figure_of(gpu, drawing):
    """matplotlib's figure of a Drawing, a unit a pixel."""
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

    width, height = drawing.size
    figure = Figure(figsize=(width / 72, height / 72))
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(0, height))
    axes.set_axis_off()
    for order, (_, item) in enumerate(drawing.items):
        if isinstance(item, Fill):
            left, bottom, right, top = item.box
            corner = (left, bottom)
            axes.add_patch(Rectangle(corner, right - left, top - bottom, color=item.color, linewidth=0, zorder=order))
        elif isinstance(item, Raster):
            left, bottom, right, top = item.box
            x0, y0, x1, y1 = item.part
            pixels = gpu.pixels(item.target)[::-1][y0:y1, x0:x1, :3]
            extent = (left, right, bottom, top)
            axes.imshow(pixels, origin="lower", extent=extent, interpolation="none", zorder=order)
        else:
            look = {"color": item.color, "alpha": item.opacity, "linewidth": item.width}
            axes.plot(*item.points.T, **look, solid_capstyle="round", solid_joinstyle="round", zorder=order)
    axes.set(xlim=(0, width), ylim=(0, height), aspect="auto")  # as imshow may have changed them
    ascent, descent = font(1000.0).getmetrics()
    for label in drawing.labels:
        line = label.size * drawing.scale
        baseline = height - label.y + (label.anchor[1] - ascent / (ascent + descent)) * line
        side = ("left", "center", "right")[round(2 * label.anchor[0])]
        size = font(line).size  # of an em
        axes.text(
            label.x, baseline, legible(label.text), color=label.color, size=size, ha=side, va="baseline", zorder=1e6
        )
    return figure


def legible(name):
    """A name on one line, without control characters."""
    return "".join(c if c.isprintable() else " " for c in name)


def write_curves(gpu, state, view, path):
    """The curves of a view as CSV: the axis, then float32 and float64 values of each."""
    curves = state.views[view].table_of(gpu, state)
    write_csv(path, state, [title(state, view)], {curves.x_name: curves.x, **curves.y})


def write_csv(path, state, about, columns):
    """Columns under their names, after lines '# ...' that say what they are and '#| ...' that hold the preset."""
    head = [f"# {line}" for line in (*about, f"written by {SOFTWARE} from this preset:")]
    head += [f"#| {line}" for line in dumps(state).split("\n")]
    names = [legible(name).replace('"', '""') for name in columns]
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as file:
        file.write("\n".join([*head, ",".join(f'"{n}"' if set(n) & set(',"#') else n for n in names), ""]))
        np.savetxt(file, np.stack(list(columns.values()), axis=-1), fmt="%.9g", delimiter=",")


# --- tables ----------------------------------------------------------------------------------------------------------


def save_table(gpu, state, path, rays=RAYS, steps=NODES):
    """Write f of the active material for the state's viewer, over directions to the light on a grid that follows the lobe.

    .csv: a row a direction; .npz: arrays (rays, steps, ...); .exr: an image of rays by steps with a channel a column.
    Simpson's rule along rays needs an odd number of steps, the plane of incidence an even one of rays. Raises Invalid.
    """
    write = TABLES[known_suffix(path, TABLES, "a table")]
    most = gpu.ctx.info["GL_MAX_TEXTURE_SIZE"]
    if not (4 <= rays <= most and rays % 2 == 0):
        raise Invalid(f"rays = {rays} is not an even number from 4 to {most}")
    if not (3 <= steps <= most and steps % 2 == 1):
        raise Invalid(f"steps = {steps} is not an odd number from 3 to {most}")
    found = tables(gpu, state.model, state.directions, rays, steps, passes=128)
    wi, f, weight = (np.concatenate(parts) for parts in zip(*((t.grid.wi, t.f, t.weight) for t in found), strict=True))
    theta, phi = np.degrees(angles(wi))
    columns = {"theta_i": theta, "phi_i": phi}
    columns |= {f"f_{c}": f[..., i] for i, c in enumerate("rgb")}
    if state.model.stochastic:
        error = np.concatenate([t.error for t in found])
        columns |= {f"error_{c}": error[..., i] for i, c in enumerate("rgb")}
    columns |= {"pdf": gpu.pdf(state.model, found[0].wo, wi), "weight": weight}
    about = [
        f"f of {state.material.name!r} ({state.model.name()}) over directions to the light, by the shader in float32",
        f"direction to the viewer wo: theta_o = {state.directions.theta_o:.9g} deg, phi_o = {state.directions.phi_o:.9g} deg",
        "theta_i, phi_i: direction to the light, degrees; f_r, f_g, f_b: BSDF at linear R, G, B in 1/sr, cosine not included",
        "pdf: density of sample_f in 1/sr; weight: solid angle in sr, so that the sum of f weight |cos(theta_i)| is the albedo",
        f"{rays} rays of {steps} directions, each from the mirror direction to the horizon; ray 0 and ray {rays // 2} are the"
        " plane of incidence",
    ]
    if state.model.stochastic:
        about.append(f"f is a mean of {found[0].walks} estimates; error_r, error_g, error_b: its standard error")
    if len(found) > 1:
        about.append(
            f"{rays} more rays, of directions below the surface, begin at the direction that a flat surface refracts to"
        )
    write(path, state, about, columns)


def write_table_csv(path, state, about, columns):
    write_csv(path, state, about, {name: values.ravel() for name, values in columns.items()})


def write_table_npz(path, state, about, columns):
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, about=np.array("\n".join(about)), **{KEY: np.array(dumps(state))}, **columns)


def write_table_exr(path, state, about, columns):
    channels = {name.replace("f_", "").upper() if name.startswith("f_") else name: v for name, v in columns.items()}
    save_exr(path, channels, {"comments": "\n".join(about), "software": SOFTWARE, KEY: dumps(state)})


PICTURES = {".png": write_png, ".exr": write_exr}
DRAWINGS = {".svg": write_drawing, ".pdf": write_drawing}
CURVES = {".csv": write_curves}
TABLES = {".csv": write_table_csv, ".npz": write_table_npz, ".exr": write_table_exr}


# --- the preset back -------------------------------------------------------------------------------------------------


def embedded(path):
    """The text of the preset inside a picture or table. Raises Invalid: there is none, or the file is not whole."""
    path = Path(path)
    read = READERS[known_suffix(path, READERS, "a file that carries a preset")]
    if path.is_dir():
        raise Invalid(f"{path}: a folder, not a file that carries a preset")
    try:
        with path.open("rb") as file:
            if not file.read(1):
                raise Invalid("it is empty")
        text = read(path)
        if text is None:
            raise Invalid(f"it carries no preset of {KEY.replace('-', '_')}")
        check_length(len(text))
    except Invalid as error:
        raise Invalid(f"{path}: {error}") from None
    except OSError as error:
        raise Invalid(f"{path}: cannot read: {error.strerror or error}") from None
    return text


def check_length(length):
    if length > LARGEST:
        raise Invalid(f"its preset is too large: {length} characters, at most {LARGEST}")


def png_preset(path):
    from PIL import Image

    try:
        with Image.open(path, formats=["PNG"]) as image:
            text = image.info.get(KEY)
            image.verify()  # the check sums of all chunks, without decoding them
        if text is None:  # other programs may write texts after the pixels
            with Image.open(path, formats=["PNG"]) as image:
                text = image.text.get(KEY)
    except Image.UnidentifiedImageError:
        raise Invalid("not a PNG picture, or corrupt") from None
    except Image.DecompressionBombError as error:
        raise Invalid(f"too large a picture: {error}") from None
    except (OSError, SyntaxError, ValueError, EOFError) as error:
        if getattr(error, "errno", None):
            raise
        raise Invalid(f"a truncated or corrupt PNG picture ({error})") from None
    return text and str(text)


def exr_preset(path):
    import OpenEXR

    try:
        with quiet():
            parts = OpenEXR.File(str(path), header_only=True).parts
            whole = parts and OpenEXR.File(str(path)).parts  # it drops a part whose pixels it cannot read
        text = parts[0].header.get(KEY) if parts else None
    except (RuntimeError, ValueError, TypeError, MemoryError) as error:
        reason = " ".join(str(error).split())
        raise Invalid(f"not an EXR picture, or a truncated or corrupt one ({reason})") from None
    if not whole:
        raise Invalid("a truncated or corrupt EXR picture: its pixels cannot be read")
    return text if isinstance(text, str) else None


@contextmanager
def quiet():
    """Nothing on stdout and stderr, not from native code either: OpenEXR prints beside what it raises."""
    sys.stderr.flush()
    kept = os.dup(2)
    with open(os.devnull, "w") as nothing, redirect_stdout(nothing):
        os.dup2(nothing.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(kept, 2)
            os.close(kept)


def svg_preset(path):
    from xml.etree import ElementTree

    if path.stat().st_size > 100 * LARGEST:
        raise Invalid("too large an SVG drawing")
    try:
        tree = ElementTree.parse(path)
    except ElementTree.ParseError as error:
        raise Invalid(f"not an SVG drawing, or a truncated or corrupt one ({error})") from None
    creator = tree.findtext(".//{*}creator//{*}title", default="").strip()
    text = tree.findtext(".//{*}metadata//{http://purl.org/dc/elements/1.1/}description")
    return text if creator.startswith(KEY) else None


def csv_preset(path):
    found = []
    size = 0
    try:
        with path.open(encoding="utf-8", newline="\n") as file:
            while (line := file.readline(2 * LARGEST)).startswith("#"):
                size += len(line)
                check_length(size - LARGEST)  # comments besides have room
                if line.startswith("#| "):
                    found.append(line[3:].rstrip("\n"))
    except UnicodeDecodeError:
        raise Invalid("not UTF-8 text, so not a table") from None
    return "\n".join(found) if found else None


def npz_preset(path):
    import io
    import tokenize
    import zipfile
    import zlib

    broken = (zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError)  # of the archive
    broken += (ValueError, EOFError, SyntaxError, tokenize.TokenError)  # of the array in it
    try:
        with zipfile.ZipFile(path) as file:
            if f"{KEY}.npy" not in file.namelist():
                return None
            check_length(file.getinfo(f"{KEY}.npy").file_size // 4 - 1000)  # four bytes a character
            array = io.BytesIO(file.read(f"{KEY}.npy"))  # which compares check sums
        return str(np.load(array, allow_pickle=False))
    except Invalid:
        raise
    except broken as error:
        raise Invalid(f"not an NPZ file, or a truncated or corrupt one ({' '.join(str(error).split())})") from None


READERS = {".png": png_preset, ".exr": exr_preset, ".svg": svg_preset, ".csv": csv_preset, ".npz": npz_preset}

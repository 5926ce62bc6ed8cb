"""The command line. A preset's parameters are flags, made by loops over declarations once it is known which preset.

Only click is imported here at first; all else is imported inside the command that needs it, so that none waits for another.
"""

import os
import re
import sys
import textwrap
from contextlib import contextmanager
from dataclasses import dataclass

import click

from . import __version__

BAD_INPUT = 2
DOMAIN = 56  # letters of a line of a parameter's choices
NUMBER = re.compile(r"[+-]?(\.?\d|inf|nan)", re.IGNORECASE)  # what begins so is a value, not a flag


class Group(click.Group):
    """The commands; a first argument that is none of them is a preset to open. Errors are one line and an exit status."""

    def main(self, args=None, prog_name="brdf-explorer", standalone_mode=True, **extra):
        if not standalone_mode:
            return super().main(args, prog_name, standalone_mode=False, **extra)
        sys.stdout.reconfigure(errors="backslashreplace")  # on Windows a pipe knows few letters
        try:
            status = super().main(args, prog_name, standalone_mode=False, **extra) or 0
            sys.stdout.flush()
        except click.ClickException as error:
            status = complain(error.format_message())
        except (click.Abort, KeyboardInterrupt):
            status = 130
        except OSError as error:  # of stdout; other files are Invalid when they fail
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            # a reader that had enough, such as `head`, is no error
            status = (
                141
                if isinstance(error, BrokenPipeError)
                else complain(f"{error.filename or 'output'}: {error.strerror}")
            )
        except ValueError as error:
            from .model import Invalid

            if not isinstance(error, Invalid):
                raise
            status = complain(str(error))
        sys.exit(status)

    def parse_args(self, ctx, args):
        own = {*self.commands, *(name for option in self.get_params(ctx) for name in option.opts)}
        return super().parse_args(ctx, args if args and args[0] in own else ["open", *args])


def complain(message):
    """Say what is wrong, on one line."""
    click.echo(f"brdf-explorer: {' '.join(message.split())}", err=True)
    return BAD_INPUT


class Flagged(click.Command):
    """A command on a preset: PRESET, `--scene`, and a flag for each parameter of some sections of the preset.

    sections: "material", "directions", "light", "look", and "view" for that of the option --view. The callback gets the State.
    scene: the one without `--scene`.
    """

    def __init__(self, *args, sections=("material",), scene=None, **kwargs):
        super().__init__(*args, **kwargs)
        self.sections = sections
        self.scene = scene

    def parse_args(self, ctx, args):
        view = after(args, "--view") or next((p.default for p in self.params if p.name == "view"), None)
        preset = self.preset(args)
        state = loaded(preset, after(args, "--scene") or self.scene)
        ctx.meta["state"] = state
        flags = ctx.meta["flags"] = flags_of(state, [view if s == "view" else s for s in self.sections])
        rest, given = split(args, flags)
        self.check_names(ctx, rest, flags)
        super().parse_args(ctx, rest)
        if ctx.params["preset"] != preset:
            raise click.UsageError(f"{ctx.params['preset']} must come before the flags of its parameters")
        del ctx.params["scene"]
        ctx.params["state"] = changed(state, flags, given)
        return []

    def preset(self, args):
        """PRESET of arguments that are not parsed yet: it is the first, or follows options of the command itself."""
        takes = {name: int(not p.is_flag) for p in self.params if isinstance(p, click.Option) for name in p.opts}
        i = 0
        while i < len(args) and args[i].startswith("-"):
            i += 1 if "=" in args[i] else 1 + takes.get(args[i], len(args))
        return args[i] if i < len(args) else None

    def check_names(self, ctx, args, flags):
        """Raise UsageError with the nearest right one for a flag that neither the command nor the preset has."""
        from .model import nearest

        own = [name for param in self.get_params(ctx) for name in param.opts if name.startswith("-")]
        for arg in args:
            name = arg.partition("=")[0]
            if name.startswith("-") and not NUMBER.match(name) and name not in own and name[:2] not in own:
                raise click.UsageError(f"no flag {name}{nearest(name, [*own, *flags])}")

    def format_options(self, ctx, formatter):
        super().format_options(ctx, formatter)
        tables = {}
        for name, flag in ctx.meta["flags"].items():
            tables.setdefault(flag.section, []).append((f"{name} {flag.values}", flag.help))
        state = ctx.meta["state"]
        titles = {"material": f"Material {state.material.name}, model {state.model.name()}"}
        titles |= {view: f"View {view}" for view in state.views}
        for section, rows in tables.items():
            with formatter.section(titles.get(section, section.capitalize())):
                formatter.write_dl(rows)


@dataclass(frozen=True)
class Flag:
    """A declared parameter of a section of the state, or of a view, as a flag."""

    section: str
    name: str
    declaration: object
    value: object

    @property
    def numbers(self):
        return getattr(self.declaration, "size", 0)

    @property
    def values(self):
        return " ".join("N" * self.numbers) or "TEXT"

    @property
    def help(self):
        d = self.declaration
        domain = (
            f"{d.low:g} to {d.high:g}{d.unit and ' '}{d.unit}" if self.numbers else ", ".join(getattr(d, "options", ()))
        )
        value = " ".join(f"{v:g}" for v in self.value) if isinstance(self.value, tuple) else self.value
        return f"{d.doc}{domain and f' ({domain})'}{f'; now {value}' if value != '' else ''}"

    def parsed(self, words):
        """The value that `words` of the command line mean; its range is checked where it is set."""
        if not self.numbers:
            return words[0]
        numbers = [number(part) for word in words for part in word.split(",")]
        if None in numbers:
            raise click.UsageError(f"{self.name} = {' '.join(words)} is not a number")
        return tuple(numbers) if len(numbers) > 1 else numbers[0]


def number(word):
    """The int or float that a word means, or None."""
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            pass
    return None


def flags_of(state, sections):
    """The Flags of sections and views, by name "--alpha". Where two share a name the later one's is "--light-alpha"."""
    from .model import declared

    flags = {}
    for section in sections:
        if section in state.views:
            instance = state.views[section]
        else:
            instance = state.model if section == "material" else getattr(state, section, None)
        for name, declaration in declared(instance).items() if instance else ():
            words = name.replace("_", "-")
            key = f"--{words}" if f"--{words}" not in flags else f"--{section}-{words}"
            flags[key] = Flag(section, name, declaration, getattr(instance, name))
    return flags


def split(args, flags):
    """`args` without the flags, and the words that each flag got: one, or for numbers all that follow it."""
    rest, given = [], {}
    args = list(args)
    while args:
        arg = args.pop(0)
        name, equals, value = arg.partition("=")
        if name not in flags:
            rest.append(arg)
            continue
        words = [value] if equals else []
        if not words and args and (NUMBER.match(args[0]) or not args[0].startswith("-")):
            words.append(args.pop(0))
        while flags[name].numbers and args and NUMBER.match(args[0]):
            words.append(args.pop(0))
        if not words:
            raise click.UsageError(f"{name} needs a value: {flags[name].help}")
        given[name] = words
    return rest, given


def changed(state, flags, given):
    """The state with the given flags set. Raises Invalid for a value outside its range."""
    from dataclasses import replace

    changes = {}
    for name, words in given.items():
        flag = flags[name]
        changes.setdefault(flag.section, {})[flag.name] = flag.parsed(words)
    for section, values in changes.items():
        if section == "light" and values.get("file"):
            values["file"] = os.path.abspath(values["file"])  # a state knows no working folder
        if section == "material":
            state = state.with_model(replace(state.model, **values))
        elif section in state.views:
            state = state.with_view(section, **values)
        else:
            state = replace(state, **{section: replace(getattr(state, section), **values)})
    return state


def after(args, name):
    """The value of an option among arguments that are not parsed yet, or None."""
    for i, arg in enumerate(args):
        if arg.startswith(f"{name}="):
            return arg.partition("=")[2]
        if arg == name and i + 1 < len(args):
            return args[i + 1]
    return None


def loaded(preset, scene=None):
    """The State of a preset's name or path, or of a model's name with its defaults, over that of a scene."""
    from dataclasses import replace

    from .model import nearest
    from .models import MODELS
    from .state import Material, State, load, presets

    preset = "gold" if preset is None else preset
    base = load(scene) if scene else State()
    if preset not in presets() and re.fullmatch(r"[\w-]*", preset) and not os.path.exists(preset):
        if preset in MODELS:
            return replace(base, materials=(Material(preset, MODELS[preset]()),), active=0)
        known = [*presets(), *MODELS, *main.commands]
        raise click.UsageError(
            f"{preset or repr(preset)}: no such preset, model, command or file{nearest(preset, known)}"
        )
    return load(preset, base)


# --- the commands ----------------------------------------------------------------------------------------------------


@click.group(cls=Group, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 120})
@click.version_option(__version__, prog_name="brdf-explorer", message="%(prog)s %(version)s")
def main():
    """Explore reflection models.

    With no COMMAND, `brdf-explorer [PRESET]` opens the window. A PRESET is a name that the command `presets` lists, the name
    of a model, or the path of a preset file or of a picture or table that carries one. Its parameters are flags: `render
    PRESET --help` lists them.
    """


class Size(click.ParamType):
    name = "WxH"

    def convert(self, value, param, ctx):
        if match := re.fullmatch(r"([0-9]{1,9})x([0-9]{1,9})", value, re.IGNORECASE):
            return int(match[1]), int(match[2])
        self.fail(f"{value!r} is not a size in pixels such as 512x512", param, ctx)


class Number(click.ParamType):
    """A float in a range; click's own takes NaN."""

    name = "N"

    def __init__(self, low, high):
        self.low = low
        self.high = high

    def convert(self, value, param, ctx):
        found = number(str(value))
        if found is None or not self.low <= found <= self.high:
            self.fail(f"{value} is not a number from {self.low:g} to {self.high:g}", param, ctx)
        return float(found)


class Angles(click.ParamType):
    name = "THETA,PHI"

    def convert(self, value, param, ctx):
        parts = [number(part) for part in value.split(",")]
        if len(parts) != 2 or None in parts:
            self.fail(f"{value!r} is not a direction in degrees such as 40,0", param, ctx)
        theta, phi = parts
        if not (0 <= theta <= 180 and -360 <= phi <= 360):
            self.fail(f"{value!r} is no direction: theta is 0 to 180 degrees, phi -360 to 360", param, ctx)
        return float(theta), float(phi)


class ViewName(click.ParamType):
    name = "VIEW"

    def convert(self, value, param, ctx):
        from .model import nearest
        from .views import VIEWS

        if value not in VIEWS:
            self.fail(f"{value!r} is no view{nearest(value, list(VIEWS))}", param, ctx)
        return value


preset_argument = click.argument("preset")
scene_option = click.option("--scene", metavar="PRESET", help="A preset under PRESET, for what PRESET does not hold.")
output_option = click.option("-o", "--output", required=True, metavar="FILE", help="The file to write.")
seconds_option = click.option("--time", "seconds", type=Number(0, 1e6), help="Most seconds to sample.")


@main.command("open", cls=Flagged, sections=("material", "directions", "light", "look"), scene="studio")
@click.argument("preset", required=False)
@scene_option
def open_(state, preset):
    """Open the window, or with no display draw a gallery.

    The gallery goes to the folder gallery/.
    """
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        click.echo(
            "No display: neither DISPLAY nor WAYLAND_DISPLAY is set. Drawing a gallery into gallery/, which takes a minute or so."
        )
        return write_gallery("gallery", [(preset, state)] if preset else None)
    from .state import CARRIERS
    from .ui import run

    # where Save writes: not over a preset of the package, nor over a picture
    mine = preset and os.path.isfile(preset) and not preset.lower().endswith(CARRIERS)
    return run(state, preset if mine else None)


@main.command(cls=Flagged, sections=("material", "directions", "light", "look", "view"))
@preset_argument
@scene_option
@click.option("--view", type=ViewName(), default="sphere", show_default=True, help="What to draw, such as lobe.")
@click.option("--size", type=Size(), default="512x512", show_default=True, help="Pixels.")
@click.option(
    "--scale", type=Number(0.25, 16), default=1.0, show_default=True, help="Pixels a point of lines and text."
)
@seconds_option
@output_option
def render(state, preset, view, size, scale, seconds, output):
    """Draw a view of PRESET into a file.

    FILE is a .png or .exr picture; for polar also an .svg or .pdf drawing, or a .csv table of its curves.
    """
    from .export import save_view
    from .gpu import offscreen

    with offscreen() as gpu, progress() as show:
        note = save_view(gpu, state, view, output, size, scale, seconds, lambda note: show(f"{view}: {note}"))
    click.echo(f"{output}: {size[0]} x {size[1]}{note and f', {note}'}")


@main.command("eval", cls=Flagged)
@preset_argument
@scene_option
@click.option("--wo", type=Angles(), required=True, help="Direction to the viewer, degrees.")
@click.option("--wi", type=Angles(), required=True, help="Direction to the light, degrees.")
@click.option("--gpu", "shader", is_flag=True, help="f and pdf by the shader in float32, not in float64.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def eval_(state, preset, wo, wi, shader, as_json):
    """Print f, pdf and albedo of PRESET.

    The directional albedo is for wo, by quadrature in float64. Of a stochastic model f and albedo are means of estimates, with
    their standard errors.
    """
    import json

    import numpy as np

    from .gpu import offscreen
    from .lib.random import seeded
    from .measure import albedo_with_error
    from .measure.grid import direction
    from .measure.laws import Shader
    from .measure.noise import WALKS, mean_f
    from .state import values

    model = state.model

    def evaluated(evaluator):
        """f, its error if it is a mean, and pdf."""
        if not model.stochastic:
            return evaluator.f(**directions), None, evaluator.pdf(**directions)
        with seeded(0):  # the same numbers each time
            return *mean_f(evaluator, **directions), evaluator.pdf(**directions)

    directions = {name: direction(*np.radians(angles)) for name, angles in (("wo", wo), ("wi", wi))}
    if shader:
        with offscreen() as gpu:
            f, error, pdf = evaluated(Shader(gpu, model))
    else:
        f, error, pdf = evaluated(model)
    with seeded(0):
        albedo = albedo_with_error(model, directions["wo"], tolerance=1e-8, most=1024)
    answer = {
        "material": state.material.name,
        "model": model.name(),
        "parameters": values(model),
        "precision": "float32" if shader else "float64",
        "wo": {"theta": wo[0], "phi": wo[1], "direction": directions["wo"].tolist()},
        "wi": {"theta": wi[0], "phi": wi[1], "direction": directions["wi"].tolist()},
        "f": np.asarray(f).tolist(),
        "pdf": float(pdf),
        "albedo": albedo.value.tolist(),
    }
    errors = {}
    if model.stochastic:
        errors = {"f": np.asarray(error).tolist(), "albedo": albedo.error.tolist()}
        answer["standard_error"] = errors
        answer["walks"] = WALKS
    if as_json:
        click.echo(json.dumps(answer, indent=2, allow_nan=False))
        return
    digits = 9 if shader else 17
    rows = {"f [1/sr]": answer["f"], "pdf [1/sr]": [answer["pdf"]], "albedo(wo)": answer["albedo"]}
    click.echo(
        f"{state.material.name} ({model.name()}), wo {wo[0]:g},{wo[1]:g}, wi {wi[0]:g},{wi[1]:g}, {answer['precision']}"
    )
    for name, numbers in rows.items():
        off = errors.get(name.split(" ")[0].removesuffix("(wo)"))
        if off is None:
            click.echo(f"{name:<12}" + "  ".join(f"{n:.{digits}g}" for n in numbers))
        else:
            click.echo(f"{name:<12}" + "  ".join(f"{n:.6g} ± {e:.1g}" for n, e in zip(numbers, off, strict=True)))


@main.command(cls=Flagged, sections=("material", "directions"))
@preset_argument
@scene_option
@click.option("--rays", default=96, show_default=True, help="Rays about the mirror direction, an even number.")
@click.option("--nodes", default=49, show_default=True, help="Directions a ray, an odd number.")
@output_option
def table(state, preset, rays, nodes, output):
    """Write a table of f over directions to the light.

    The directions are on a grid that follows the lobe; FILE is a .csv, .npz or .exr.
    """
    from .export import save_table
    from .gpu import offscreen

    with offscreen() as gpu:
        save_table(gpu, state, output, rays, nodes)
    click.echo(f"{output}: {rays} x {nodes} directions, theta_o = {state.directions.theta_o:g} deg")


@main.command()
@click.argument("ladder", required=False)
@click.option("--preset", default="gold", show_default=True, metavar="PRESET", help="The material.")
@click.option("--scene", default="studio", show_default=True, metavar="PRESET", help="The light and the look.")
@click.option("--error", metavar="METRIC", help="Measure of error; without it the one that suits the question.")
@click.option("--cost", metavar="KIND", help="evaluation, of f, or frame, a pass of the sphere.")
@click.option("--tolerance", type=Number(1e-9, 10), help="The error that is small enough; 0.01 without it.")
@click.option("--size", type=Size(), help="Pixels of the picture.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option("-o", "--output", metavar="FILE", help="A .svg, .pdf or .png of the chart, or a .json, to write as well.")
def chart(ladder, preset, scene, error, cost, tolerance, size, as_json, output):
    """Compare methods by speed and accuracy.

    LADDER is the question that they answer; without it all questions that arise for the preset.
    """
    import json

    from .export import DRAWINGS, check_size, known_suffix, save_view, write_png
    from .gpu import offscreen
    from .measure.tradeoff import report
    from .state import dumps, writable

    options = {"ladder": ladder or "all", "error": error, "cost": cost, "tolerance": tolerance}
    state = loaded(preset, scene).with_view("chart", **{name: v for name, v in options.items() if v is not None})
    view = state.views["chart"]
    if output:
        suffix = known_suffix(output, {".json": None, ".png": write_png, **DRAWINGS}, "a chart")
        writable(output)
    with offscreen() as gpu, progress() as show:
        if size:
            check_size(gpu, size)
        for found, _ in view.measured(gpu, state):
            if found:
                show(f"{found[-1].ladder.name}: {found[-1].doing or 'done'}")
        numbers = report(gpu, found, view.tolerance)
        text = json.dumps(numbers | {"preset": dumps(state)}, indent=2, allow_nan=False)
        if output and suffix != ".json":
            rows = -(-len(found) // 2)
            save_view(gpu, state, "chart", output, size or ((1200, 400 * rows + 90) if rows > 1 else (800, 600)))
    if output and suffix == ".json":
        write_text(output, f"{text}\n")
    if as_json:
        click.echo(text)
        return
    for one in numbers["ladders"]:
        print_tradeoff(one)
    click.echo(f"{numbers['driver']}; {numbers['machine']}; medians and quartiles of repeats in turns")
    if output:
        click.echo(f"{output}: {', '.join(one['ladder'] for one in numbers['ladders'])}")


def print_tradeoff(one):
    """The table of one of measure.tradeoff.report's ladders."""
    from .measure.cost import FLOOR

    title = f"{one['ladder']}: {one['question']}"
    if "reason" in one:
        click.echo(f"{title}\n{one['reason']}\n")
        return
    of = one["cost"]["of"]
    unit, per = ("ms", 1e3) if of == "frame" else ("ns", 1e9)
    cheapest = "least time" if of == "sample" else "cheapest"
    rows = []
    for m in one["methods"]:
        cost, error = m["cost"], m["error"]
        marks = ["front"] * m["front"] + [cheapest] * (m["name"] == one["best"])
        known = "exact" if m["exact"] else f"{error['value']:.3g}"
        rows.append(
            (
                m["name"],
                f"{per * cost['median']:.4g} {unit}" if cost["median"] > FLOOR else "lost in noise",
                f"{per * cost['low']:.4g} to {per * cost['high']:.4g}",
                str(cost["repeats"]),
                known,
                f"{error['error']:.1g}",
                ", ".join(marks),
                f"outside: {m['outside']}" if m["outside"] else "",
            )
        )
    heads = (
        "method",
        f"cost of a{'n' * (one['cost']['of'] == 'evaluation')} {one['cost']['of']}",
        "quartiles",
        "repeats",
        one["metric"]["name"],
        "±",
        "",
        "",
    )
    print_table(heads, rows, title=f"{title} {one['metric']['title']}, against {one['reference']['name']}")


@main.command(cls=Flagged, sections=("material",), scene="studio")
@preset_argument
@scene_option
@click.option(
    "--tolerance", type=Number(1e-9, 10), default=0.01, show_default=True, help="Largest error of the picture."
)
@click.option("--metric", metavar="METRIC", help="Measure of error: picture, brightness, flip or itp, of the sphere.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option("--size", type=Size(), default="1200x680", show_default=True, help="Pixels of a picture.")
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    help="The reduced preset (.toml), a picture (.png, .svg, .pdf) or numbers (.json).",
)
def least(state, preset, tolerance, metric, as_json, size, output):
    """Find the cheapest methods that are enough for PRESET.

    In its scene: of all combinations the cheapest whose sphere is surely within the tolerance of the most accurate one's. The
    tolerance is a share of the mean, or for flip and itp their own number.
    """
    import json

    from .export import DRAWINGS, check_size, known_suffix, save_view, write_png
    from .gpu import offscreen
    from .measure.advice import HEADS, report, rows, sentences
    from .measure.least import result
    from .state import dumps, save, writable

    state = state.with_view("least", tolerance=tolerance, **({"metric": metric} if metric else {}))
    if output:
        suffix = known_suffix(output, {".toml": save, ".json": None, ".png": write_png, **DRAWINGS}, "an answer")
        writable(output)
    with offscreen() as gpu, progress() as show:
        check_size(gpu, size)
        answer = result(state.views["least"].answer(gpu, state), show)
        text = json.dumps(report(answer) | {"preset": dumps(answer.reduced)}, indent=2, allow_nan=False)
        if output and suffix == ".toml":
            save(answer.reduced, output)
        elif output and suffix == ".json":
            write_text(output, f"{text}\n")
        elif output:
            save_view(gpu, state, "least", output, size, watch=show)
    if as_json:
        click.echo(text)
        return
    print_table(HEADS, rows(answer), title=state.material.name)
    click.echo("\n".join(sentences(answer)))
    click.echo(answer.device)
    if output:
        click.echo(output)


def write_text(path, text):
    from .state import replacing

    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


@main.command()
@click.argument("presets", nargs=-1)
@click.option("--scene", default="studio", show_default=True, metavar="PRESET", help="The light and the look.")
@click.option("--size", type=Size(), default="480x360", show_default=True, help="Pixels of each picture.")
@click.option("--time", "seconds", type=Number(0, 1e6), default=3.0, show_default=True, help="Most seconds a picture.")
@click.option(
    "-o", "--output", default="gallery", show_default=True, metavar="FOLDER", help="The folder to write into."
)
def gallery(presets, scene, size, seconds, output):
    """Draw all materials in all views, and a page of them.

    Or only the PRESETS that are given. The page is index.html.
    """
    return write_gallery(output, [(name, loaded(name, scene)) for name in presets] or None, scene, size, seconds)


def write_gallery(folder, states=None, scene="studio", size=(480, 360), seconds=3.0):
    from .gallery import materials, save_gallery
    from .gpu import offscreen

    states = states or materials(scene)
    with offscreen() as gpu, progress() as show:
        for i, n, what in save_gallery(gpu, states, folder, size, seconds):
            show(f"{i} of {n}: {what}")
    click.echo(f"{os.path.join(folder, 'index.html')}: {n} pictures")


@main.command()
@click.option("--markdown", is_flag=True, help="Print Markdown: README.md's table.")
def models(markdown):
    """List the models and their parameters."""
    from .model import Choice, declared
    from .models import MODELS

    tables = {}
    for name, cls in MODELS.items():
        rows = tables[name] = []
        for parameter, d in declared(cls).items():
            if isinstance(d, Choice):
                domain, default = ", ".join(d.options), d.default
            else:
                domain = f"{d.low:g} to {d.high:g}{d.unit and ' '}{d.unit}"
                default = ", ".join(f"{v:g}" for v in (d.default if isinstance(d.default, tuple) else (d.default,)))
            rows.append((parameter, domain, default, d.doc))
    heads = ("parameter", "range or choices", "default", "meaning")
    if markdown:
        for name, rows in tables.items():
            click.echo(f"**{name}**: {summary(MODELS[name])}\n\n| {' | '.join(heads)} |\n|{'---|' * len(heads)}")
            for parameter, *others in rows:
                click.echo(f"| `{parameter}` | {' | '.join(others)} |")
            click.echo()
        return
    for name, rows in tables.items():
        rows = [(parameter, textwrap.fill(domain, DOMAIN), *others) for parameter, domain, *others in rows]
        print_table(heads, rows, title=f"{name}: {summary(MODELS[name])}")


def summary(cls):
    """The first sentences of a docstring, on one line."""
    return " ".join(cls.__doc__.split("\n\n")[0].split())


@main.command()
def presets():
    """List the presets."""
    from .model import Invalid
    from .state import load, presets

    rows = []
    for name, path in presets().items():
        kind = path.parent.name
        try:
            state = load(path)
        except Invalid as error:
            rows.append((name, kind, str(error)))
            continue
        if kind == "materials":
            about = f"{state.material.name}: {state.model.name()}, {', '.join(state.model.choices().values())}"
        else:
            lights = [f"directional ({state.light.irradiance:g} W/m2)"] * (state.light.irradiance > 0)
            lights += [state.light.environment] * (state.light.environment != "none")
            about = f"{' and '.join(lights) or 'no'} light, tone curve {state.look.tonemap}"
        rows.append((name, kind, about))
    print_table(("name", "kind", "what it is"), rows)


@main.command(cls=Flagged)
@preset_argument
@scene_option
def check(state, preset):
    """Print how well PRESET obeys the laws of physics.

    A row a law with its measured error. Exit status 1 if one is broken.
    """
    from .gpu import offscreen
    from .measure.laws import laws

    rows, broken = [], 0
    with offscreen() as gpu, progress() as show:
        for law in laws(state.model, gpu):
            show(law.name)
            broken += not law.ok
            mark = "ok" if law.ok else "broken"
            rows.append((law.name, f"{law.measured:.3g}", f"{law.limit:.3g}", mark, law.note))
    print_table(("law", "measured", "limit", "", "note"), rows, title=state.material.name)
    return int(broken > 0)


@main.command(cls=Flagged, sections=("material",))
@preset_argument
@scene_option
@click.option("--all", "everything", is_flag=True, help="Functions of every option of the model's choices.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option("--worst", nargs=2, metavar="ROW COLUMN", help="Write the worst point of a cell as a preset.")
@click.option("--ours", is_flag=True, help="With --worst: of our form, not of the printed one.")
@click.option("--size", type=Size(), default="900x700", show_default=True, help="Pixels of a picture.")
@click.option(
    "-o", "--output", metavar="FILE", help="A picture (.png, .svg, .pdf), the numbers (.json) or a preset (.toml)."
)
def stability(state, preset, everything, as_json, worst, ours, size, output):
    """Map where float32 fails, in our formulas and in the printed ones.

    A row is a function of PRESET, a column a regime of its arguments. Exit status 1 if ours breaks its promise: no NaN, infinite
    or negative value, and an error of at most 1e-4 where the function is well conditioned.
    """
    import json

    from .export import DRAWINGS, check_size, known_suffix, save_view, write_png
    from .gpu import offscreen
    from .measure.stability import stability as maps
    from .state import save, writable
    from .views.stability import shown_at

    suffix = ""
    if worst and not (output or "").endswith(".toml"):
        raise click.UsageError("--worst needs -o FILE.toml, the preset to write")
    if output:
        suffix = known_suffix(output, {".toml": save, ".json": None, ".png": write_png, **DRAWINGS}, "a map")
        writable(output)
    if suffix == ".toml" and not worst:
        raise click.UsageError(f"{output}: a preset is of one cell: --worst ROW COLUMN")
    with offscreen() as gpu, progress() as show:
        check_size(gpu, size)
        for found in maps(gpu, state.model, everything=everything):
            show(f"{100 * found.progress:.0f} %")
        if worst:
            cell = chosen_cell(found, *worst, "stable" if ours else "textbook")
            shown, beyond = shown_at(state, cell)
            save(shown, output)
            click.echo("\n".join([f"{output}: the worst point of {cell.row} {cell.column}, {cell.verdict}", *beyond]))
            return 0
        text = json.dumps(stability_tree(gpu, state, found), indent=1, allow_nan=False)
        if suffix == ".json":
            write_text(output, text)
        elif output:
            rows = "all" if everything else "material"
            save_view(gpu, state.with_view("stability", rows=rows), "stability", output, size)
    if as_json:
        click.echo(text)
    else:
        print_stability(found, state.material.name)
    if output:
        click.echo(output)
    return int(bool(found.broken))


def chosen_cell(found, row, column, form):
    """The cell of a row, named by its function or its whole label, and a column. Raises UsageError."""
    from .measure.stability import REGIMES
    from .model import nearest

    rows = [r for r in found.rows if row in (r, r.partition(" ")[0])]
    if not rows:
        raise click.UsageError(f"{row}: no such row{nearest(row, list(found.rows))}")
    if column not in REGIMES:
        raise click.UsageError(f"{column}: no such column{nearest(column, list(REGIMES))}")
    cell = found.cells.get((rows[0], column, form)) or found.cells.get((rows[0], column, "stable"))
    if cell is None:
        raise click.UsageError(f"{rows[0]} has no argument that {column} is about")
    return cell


def stability_tree(gpu, state, found):
    """All of a Map as JSON holds it; NaN and infinity are text."""
    from dataclasses import asdict

    from .measure.stability import LIMIT, REGIMES, WELL
    from .state import material_table

    def plain(value):
        if isinstance(value, dict):
            return {k: plain(v) for k, v in value.items()}
        if isinstance(value, list | tuple):
            return [plain(v) for v in value]
        return repr(value) if isinstance(value, float) and not abs(value) < float("inf") else value

    return {
        "device": gpu.device,
        "material": material_table(state.material),
        "limit": LIMIT,
        "well_conditioned": {"condition times 2^-24 at most": WELL},
        "columns": {name: regime.doc for name, regime in REGIMES.items()},
        "rows": list(found.rows),
        "broken": [f"{c.row} {c.column}" for c in found.broken],
        "cells": [{**plain(asdict(c)), "verdict": c.verdict} for c in found.cells.values()],
    }


def print_stability(found, name):
    from .measure.stability import FORMS, REGIMES
    from .views.stability import FORM_WORDS, summary

    columns = [column for column in REGIMES if any((row, column, FORMS[0]) in found.cells for row in found.rows)]
    rows = []
    for row in found.rows:
        for form in FORMS:
            cells = [found.cells.get((row, column, form)) for column in columns]
            if any(cells):
                rows.append(
                    (row if form == FORMS[0] else "", FORM_WORDS[form], *(c and summary(c) or "" for c in cells))
                )
    print_table(("function", "form", *(column.replace("_", " ") for column in columns)), rows, title=name)


@main.command()
def bench():
    """Print what pictures cost, and starting.

    Ratios to bare work in the same run. Exit status 1 if one is over its limit.
    """
    from .bench import report

    rows, over = [], 0
    with progress() as show:
        for figure in report():
            show(figure.name)
            over += not figure.ok
            limit = "" if figure.limit is None else f"{figure.limit:g}"
            mark = "" if figure.limit is None else "ok" if figure.ok else "over"
            spread = f"{figure.low:.3g} to {figure.high:.3g}"
            rows.append((figure.name, f"{figure.median:.3g} {figure.unit}", spread, limit, mark))
    print_table(("what", "median", "quartiles", "limit", ""), rows)
    return int(over > 0)


def print_table(heads, rows, title=""):
    """A table on stdout, as wide as the terminal; a pipe gets the whole of it."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console(width=None if sys.stdout.isatty() else 200)
    styles = {"ok": "green", "broken": "bold red", "over": "bold red"}
    view = Table(*heads, box=SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for row in rows:
        view.add_row(*(Text(cell, styles.get(cell, "")) for cell in row))
    if title:
        console.print(Text(title, "bold"), soft_wrap=True)
    console.print(view)
    console.print()


@contextmanager
def progress():
    """A function that shows a line of progress on a terminal's stderr, and nothing elsewhere."""
    from rich.console import Console
    from rich.text import Text

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda text: None
        return
    with console.status("starting") as status:
        yield lambda text: status.update(Text(text))

"""A preset's parameters as flags, made by loops over declarations once it is known which preset."""

import os
import re
from dataclasses import dataclass

import click

NUMBER = re.compile(r"[+-]?(\.?\d|inf|nan)", re.IGNORECASE)  # what begins so is a value, not a flag


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
        from ..model import nearest

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
    from ..model import declared

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

    from ..model import nearest
    from ..models import MODELS
    from ..state import Material, State, load, presets

    preset = "gold" if preset is None else preset
    base = load(scene) if scene else State()
    if preset not in presets() and re.fullmatch(r"[\w-]*", preset) and not os.path.exists(preset):
        if preset in MODELS:
            return replace(base, materials=(Material(preset, MODELS[preset]()),), active=0)
        commands = click.get_current_context().find_root().command.commands
        known = [*presets(), *MODELS, *commands]
        raise click.UsageError(
            f"{preset or repr(preset)}: no such preset, model, command or file{nearest(preset, known)}"
        )
    return load(preset, base)

"""The commands about the program: which models and presets it has, and what it costs."""

import textwrap

import click

from .output import print_table, progress

DOMAIN = 56  # letters of a line of a parameter's choices


@click.command()
@click.option("--markdown", is_flag=True, help="Print Markdown: README.md's table.")
def models(markdown):
    """List the models and their parameters."""
    from ..model import Choice, declared
    from ..models import MODELS

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


@click.command()
def presets():
    """List the presets."""
    from ..model import Invalid
    from ..state import load, presets

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


@click.command()
def bench():
    """Print what pictures cost, and starting.

    Ratios to bare work in the same run. Exit status 1 if one is over its limit.
    """
    from ..bench import report

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

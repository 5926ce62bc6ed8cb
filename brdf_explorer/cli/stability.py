"""The command that maps where float32 fails."""

import click

from .flags import Flagged
from .options import Size, preset_argument, scene_option
from .output import print_table, progress, write_text


@click.command(cls=Flagged, sections=("material",))
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

    from ..export import DRAWINGS, check_size, known_suffix, save_view, write_png
    from ..gpu import offscreen
    from ..measure.stability import stability as maps
    from ..state import save, writable
    from ..views.stability import shown_at

    suffix = ""
    if worst and not (output or "").endswith(".toml"):
        raise click.UsageError("--worst needs -o FILE.toml, the preset to write")
    if output:
        suffix = known_suffix(output, {".toml": save, ".json": None, ".png": write_png, **DRAWINGS}, "a map")
        writable(output)
    if suffix == ".toml" and not worst:
        raise click.UsageError(f"{output}: a preset is of one cell: --worst ROW COLUMN")
    form = "stable" if ours else "textbook"
    wanted = chosen_cell(state.model, everything, *worst, form) if worst else None
    with offscreen() as gpu, progress() as show:
        check_size(gpu, size)
        for found in maps(gpu, state.model, everything=everything):
            show(f"{100 * found.progress:.0f} %")
        if worst:
            cell = found.cells[wanted]
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


def chosen_cell(model, everything, row, column, form):
    """The key of the cell of a row, named by its function or its whole label, and a column. Raises UsageError.

    form: ours if the function has no printed one.
    """
    from ..measure.regimes import REGIMES
    from ..measure.subjects import all_subjects, subjects
    from ..model import nearest

    rows = {s.label: s for s in (all_subjects if everything else subjects)(model)}
    label = next((r for r in rows if row in (r, r.partition(" ")[0])), None)
    if label is None:
        raise click.UsageError(f"{row}: no such row{nearest(row, list(rows))}")
    if column not in REGIMES:
        raise click.UsageError(f"{column}: no such column{nearest(column, list(REGIMES))}")
    if not REGIMES[column].concerns(rows[label]):
        raise click.UsageError(f"{label} has no argument that {column} is about")
    return label, column, form if form in rows[label].forms else "stable"


def stability_tree(gpu, state, found):
    """All of a Map as JSON holds it; NaN and infinity are text."""
    from dataclasses import asdict

    from ..measure.regimes import LIMIT, REGIMES
    from ..measure.stability import WELL
    from ..state import material_table

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
    from ..measure.regimes import REGIMES
    from ..measure.subjects import FORMS
    from ..views.stability import FORM_WORDS, summary

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

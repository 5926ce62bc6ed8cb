"""The commands that compare methods: one question at a time, and all jointly."""

import click

from .flags import Flagged, loaded
from .options import Number, Size, preset_argument, scene_option
from .output import print_table, progress, write_text


@click.command()
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

    from ..export import DRAWINGS, check_size, known_suffix, save_view, write_png
    from ..gpu import offscreen
    from ..measure.tradeoff import report
    from ..state import dumps, writable

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
    from ..measure.cost import FLOOR

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


@click.command(cls=Flagged, sections=("material",), scene="studio")
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

    from ..export import DRAWINGS, check_size, known_suffix, save_view, write_png
    from ..gpu import offscreen
    from ..measure.advice import HEADS, report, rows, sentences
    from ..measure.least import result
    from ..state import dumps, save, writable

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

"""The commands that give numbers about one material: at a direction, over directions, against the laws."""

import click

from .flags import Flagged
from .options import Angles, output_option, preset_argument, scene_option
from .output import print_table, progress


@click.command("eval", cls=Flagged)
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

    from ..gpu import offscreen
    from ..lib.random import seeded
    from ..measure import albedo_with_error
    from ..measure.grid import direction
    from ..measure.laws import Shader
    from ..measure.noise import WALKS, mean_f
    from ..state import values

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


@click.command(cls=Flagged, sections=("material", "directions"))
@preset_argument
@scene_option
@click.option("--rays", default=96, show_default=True, help="Rays about the mirror direction, an even number.")
@click.option("--steps", default=49, show_default=True, help="Directions a ray, an odd number.")
@output_option
def table(state, preset, rays, steps, output):
    """Write a table of f over directions to the light.

    The directions are on a grid that follows the lobe; FILE is a .csv, .npz or .exr.
    """
    from ..export import save_table
    from ..gpu import offscreen

    with offscreen() as gpu:
        save_table(gpu, state, output, rays, steps)
    click.echo(f"{output}: {rays} x {steps} directions, theta_o = {state.directions.theta_o:g} deg")


@click.command(cls=Flagged)
@preset_argument
@scene_option
def check(state, preset):
    """Print how well PRESET obeys the laws of physics.

    A row a law with its measured error. Exit status 1 if one is broken.
    """
    from ..gpu import offscreen
    from ..measure.laws import laws

    rows, broken = [], 0
    with offscreen() as gpu, progress() as show:
        for law in laws(state.model, gpu):
            show(law.name)
            broken += not law.ok
            mark = "ok" if law.ok else "broken"
            rows.append((law.name, f"{law.measured:.3g}", f"{law.limit:.3g}", mark, law.note))
    print_table(("law", "measured", "limit", "", "note"), rows, title=state.material.name)
    return int(broken > 0)

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

    The directional albedo is for wo, by quadrature in float64; of a material that transmits it is two, the shares R and T of the
    energy from wo that are reflected and transmitted. Of a stochastic model f and albedo are means of estimates, with their
    standard errors.
    """
    import json

    import numpy as np

    from ..gpu import offscreen
    from ..lib.random import seeded
    from ..measure.albedo import Integral, albedo_with_error, shares
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
    accuracy = {"tolerance": 1e-8, "most": 1024}
    with seeded(0):
        if model.transmits:
            found = shares(model, directions["wo"], **accuracy)
            albedo = {name: Integral(found.value[i], found.error[i]) for i, name in enumerate("RT")}
        else:
            albedo = {"albedo": albedo_with_error(model, directions["wo"], **accuracy)}
    answer = {
        "material": state.material.name,
        "model": model.name(),
        "parameters": values(model),
        "precision": "float32" if shader else "float64",
        "wo": {"theta": wo[0], "phi": wo[1], "direction": directions["wo"].tolist()},
        "wi": {"theta": wi[0], "phi": wi[1], "direction": directions["wi"].tolist()},
        "f": np.asarray(f).tolist(),
        "pdf": float(pdf),
    }
    answer |= {name: part.value.tolist() for name, part in albedo.items()}
    errors = {}
    if model.stochastic:
        errors = {"f": np.asarray(error).tolist()} | {name: part.error.tolist() for name, part in albedo.items()}
        answer["standard_error"] = errors
        answer["walks"] = WALKS
    if as_json:
        click.echo(json.dumps(answer, indent=2, allow_nan=False))
        return
    digits = 9 if shader else 17
    click.echo(
        f"{state.material.name} ({model.name()}), wo {wo[0]:g},{wo[1]:g}, wi {wi[0]:g},{wi[1]:g}, {answer['precision']}"
    )
    labels = {"f": "f [1/sr]", "pdf": "pdf [1/sr]", "albedo": "albedo(wo)", "R": "reflected", "T": "transmitted"}
    for name in ("f", "pdf", *albedo):
        numbers, off = np.atleast_1d(answer[name]), errors.get(name)
        if off is None:
            words = (f"{n:.{digits}g}" for n in numbers)
        else:
            words = (f"{n:.6g} ± {e:.1g}" for n, e in zip(numbers, off, strict=True))
        click.echo(f"{labels[name]:<13}" + "  ".join(words))


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

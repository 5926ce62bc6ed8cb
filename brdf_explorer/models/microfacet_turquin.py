"""Slot energy of microfacet: single scattering, brighter."""

import numpy as np

from ..lib import slot
from ..lib.energy_turquin import gain_turquin
from .microfacet_none import energy_pdf as energy_pdf
from .microfacet_none import energy_wi as energy_wi


def energy_f(material, single, wo, wi):
    lost = slot("lost", material.ndf, material.shadowing).lost(wo, np.array(material.alpha))
    return single * gain_turquin(material.facet(1.0), lost)


def energy_weight(material, single, wo, wi):
    return energy_f(material, single, wo, wi)

"""Slot energy of microfacet: single scattering and a wide lobe; of the directions drawn the wide lobe has its share."""

import numpy as np

from ..lib import slot
from ..lib.common import mix, split, vec
from ..lib.energy_kulla_conty import COSINES, F_mean, F_multiple, pdf_wide, sample_wide, share_wide, wide

LARGEST = 1 - 2.0**-24
"""The random number next to 1, to which rounding may take a stretched one."""


def wide_f(material, wo, wi):
    alpha, lost = np.array(material.alpha), slot("lost", material.ndf, material.shadowing)
    mean = lost.lost_mean(alpha)
    facet = F_mean(*(material.facet(c) for c in COSINES))
    return F_multiple(facet, mean) * wide(lost.lost(wo, alpha), lost.lost(wi, alpha), mean)[..., None]


def wide_share(material, wo):
    lost = slot("lost", material.ndf, material.shadowing).lost(wo, np.array(material.alpha))
    return share_wide(material.facet(1.0), lost)


def energy_f(material, single, wo, wi):
    return single + wide_f(material, wo, wi)


def energy_pdf(material, single, wo, wi):
    return mix(single, pdf_wide(wi, np.array(material.alpha)), wide_share(material, wo))


def energy_wi(material, wo, u):
    s, (x, y) = wide_share(material, wo), split(u)
    own = x < s
    wi = np.empty(wo.shape)
    wi[own] = sample_wide(vec(x[own] / s[own], y[own]), np.array(material.alpha))
    other = ~own
    wi[other] = material.single_wi(
        wo[other], vec(np.minimum((x[other] - s[other]) / (1 - s[other]), LARGEST), y[other])
    )
    return wi


def energy_weight(material, single, wo, wi):
    own = material.single_pdf(wo, wi)
    both = single * own[..., None] + wide_f(material, wo, wi) * wi[..., 2:]
    return both / energy_pdf(material, own, wo, wi)[..., None]

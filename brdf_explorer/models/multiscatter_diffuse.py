"""Slot facets of multiscatter: diffuse, of a given albedo: Lambert's law about each facet's own normal."""

import numpy as np

from ..lib.common import HORIZON, INV_PI, dot, mirror, normalize, split
from ..lib.walk import flight, meets, passage
from ..lib.warp import cosine_hemisphere
from .multiscatter import CLEAR


def counts(w):
    return split(w)[2] > HORIZON


def walk(material, wo, wi, draws):
    """f (n, 3) by one walk for each row of wo and wi (n, 3), above the horizon."""
    hidden = material.projected_area(-wi)
    total = np.zeros(wo.shape)
    row, w, depth, weight = np.arange(len(wo)), -wo, np.zeros(len(wo)), np.ones(wo.shape)
    for order in range(1, material.last_order() + 1):
        area = material.projected_area(-w)
        ahead = area > CLEAR * split(w)[2]
        u = draws.drawn()
        next = np.full(len(row), -1.0)
        next[ahead] = flight(depth[ahead], w[ahead], area[ahead], u[ahead, :2])
        met = next >= 0
        if not met.any():
            break
        draws.keep(met)
        row, w, depth, weight, area = row[met], w[met], depth[met], weight[met], area[met]
        wm = material.sample_wm(-w, u[met, 1:])
        weight = weight * np.array(material.albedo)
        share = passage(depth, w, area, wi[row], hidden[row]) / meets(depth, w, area)
        if order >= material.lowest:
            total[row] += weight * (INV_PI * np.maximum(dot(wi[row], wm), 0.0) * share)[:, None]
        depth = next[met]
        w = mirror(cosine_hemisphere(draws.drawn()[:, :2]), normalize(wm + [0.0, 0.0, 1.0]))
    return total


def pdf_lobes(material, wo, wi):
    return INV_PI * split(wi)[2]


def sample_lobes(material, wo, u):
    return cosine_hemisphere(u)

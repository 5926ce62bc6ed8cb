"""Slot facets of multiscatter: mirrors, of reflectance F."""

import numpy as np

from ..lib import slot
from ..lib.common import HORIZON, INV_PI, dot, mirror, mix, quotient, split, vec
from ..lib.microfacet import cos_facet
from ..lib.walk import flight, passage
from ..lib.warp import cosine_hemisphere
from .multiscatter import CLEAR


def counts(w):
    return split(w)[2] > HORIZON


def walk(material, wo, wi, draws):
    """f (n, 3) by one walk for each row of wo and wi (n, 3), above the horizon.

    What a facet sends to the end is the mean over the flight that leads to it, so that order 1 is exact. Of two sharp facets
    in a row the walk draws the first and meets the second by chance, so a walk begins at either end, and what it finds
    counts by how likely it was to be found from this one (Veach and Guibas 1995, Eq. 14, of the outer facets alone).
    """
    swap = draws.drawn()[:, :1] < 0.5
    wo, wi = np.where(swap, wi, wo), np.where(swap, wo, wi)
    hidden = material.projected_area(-wi)
    back = 4 * (split(wi)[2] + hidden)
    total = np.zeros(wo.shape)
    row, w, depth, weight = np.arange(len(wo)), -wo, np.zeros(len(wo)), np.ones(wo.shape)
    outer = np.zeros(len(wo))  # density of the first direction drawn

    def keep(which):
        draws.keep(which)
        return row[which], w[which], depth[which], weight[which]

    last = material.last_order()
    for order in range(1, last + 1):
        area = material.projected_area(-w)
        ahead = area > CLEAR * split(w)[2]
        row, w, depth, weight = keep(ahead)
        area = area[ahead]
        if order >= material.lowest:
            density = material.D(wi[row] - w)
            share = density / (4 * area) * passage(depth, w, area, wi[row], hidden[row])
            if order > 1:
                share *= 2 * quotient(outer[row], outer[row] + density / back[row])
            total[row] += weight * material.F(cos_facet(-w, wi[row])) * share[:, None]
        u = draws.drawn()
        depth = flight(depth, w, area, u[:, :2])
        met = depth >= 0
        if order == last or not met.any():
            break
        row, w, depth, weight = keep(met)
        wm = material.sample_wm(-w, u[met, 1:])
        weight = weight * material.F(np.clip(dot(-w, wm), 0.0, 1.0))
        if order == 1:
            outer[row] = material.D(wm) / (4 * area[met])
        w = mirror(-w, wm)
    return total


def broad(material):
    """Chance of the cosine lobe, for light that met more than one facet."""
    return np.ceil(16 * np.max(material.alpha, axis=-1)) / 32


def pdf_lobes(material, wo, wi):
    alpha = np.array(material.alpha)
    visible = slot("sampling", material.ndf, "caps").pdf_wi(wo, wi, material.D(wo + wi), alpha)
    return mix(visible, INV_PI * split(wi)[2], broad(material))


def sample_lobes(material, wo, u):
    share = broad(material)
    x, y = split(u)
    wide = x < share
    wi = np.empty(wo.shape)
    wi[wide] = cosine_hemisphere(vec(x / share, y)[wide])
    u = vec((x - share) / (1 - share), y)[~wide]
    wi[~wide] = slot("sampling", material.ndf, "caps").sample_wi(wo[~wide], u, np.array(material.alpha))
    return wi

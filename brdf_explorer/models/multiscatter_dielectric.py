"""Slot facets of multiscatter: smooth interfaces between two dielectrics, which reflect and refract.

Below the horizon is the medium of index eta_below; radiance is that of the viewer's side, as in models/dielectric.py. A ray below
the surface walks as one above it does, mirrored through the origin: facets keep their normals, and depth is measured from the
lowest facet up.
"""

import numpy as np

from ..lib.common import HORIZON, INV_PI, dot, mirror, mix, quotient, split, vec
from ..lib.fresnel import F_dielectric
from ..lib.microfacet import cos_facet
from ..lib.random import third
from ..lib.refraction import T_spread, refracted, sum_refracted
from ..lib.transcendental import exp_precise
from ..lib.walk import depth_below, flight, passage
from ..lib.warp import cosine_hemisphere
from .multiscatter import CLEAR
from .multiscatter_conductor import broad


def counts(w):
    return np.abs(split(w)[2]) > HORIZON


def eta_seen(material, above):
    """The index of the other side over that of rays above the surface, or below it (...)."""
    return np.where(above, material.index(), 1 / material.index())


def dense(material, above):
    """n^2 of the side."""
    return np.where(above, 1.0, material.index() ** 2)


def turned(w, wo):
    """w as seen with wo above the surface."""
    x, y, z = split(w)
    return vec(x, y, np.where(split(wo)[2] > 0, z, -z))


def passing(material, w, wt, above):
    """Of facets that refract w, on their side `above` or not, to wt: T D cos cos / L^2, the same for the way back.

    Over w's projected area and times n^2 of the other side it is a density. Walter et al. 2007, Eq. 21.
    """
    eta = np.array(material.index())
    sum = sum_refracted(np.where(above[:, None], w, wt), np.where(above[:, None], wt, w), eta)
    wm = np.where(((eta > 1) == above)[:, None], -sum, sum)
    found = T_spread(wm, eta)
    passes = found > 0
    found[passes] *= material.D(wm[passes])
    return found


def mirroring(material, w, wi, above):
    """Of facets that mirror w to wi: F D / 4."""
    return 0.25 * F_dielectric(cos_facet(w, wi), eta_seen(material, above)) * material.D(w + wi)


def walk(material, wo, wi, draws):
    """f (n, 3) by one walk for each row of wo and wi (n, 3), off the horizon.

    As of mirrors, with what is refracted by the depth that was drawn. It begins at either end, as there.
    """
    swap = draws.drawn()[:, 0] < 0.5
    start, end = np.where(swap[:, None], wi, wo), np.where(swap[:, None], wo, wi)
    above = start[:, 2] > 0
    to, w = turned(end, start), -turned(start, start)
    height = np.abs(to[:, 2])
    hidden = material.projected_area(vec(to[:, 0], to[:, 1], -height))
    back = height + hidden
    total, outer = np.zeros(len(wo)), np.zeros(len(wo))
    row, depth = np.arange(len(wo)), np.zeros(len(wo))
    last = material.last_order()
    for order in range(1, last + 1):
        area = material.projected_area(-w)
        ahead = area > CLEAR * w[:, 2]
        draws.keep(ahead)
        row, w, depth, to, above, area = (a[ahead] for a in (row, w, depth, to, above, area))
        next = flight(depth, w, area, draws.drawn()[:, :2])
        met = next >= 0
        if order >= material.lowest:
            density, share, n2 = np.zeros(len(row)), np.zeros(len(row)), np.ones(len(row))
            at = to[:, 2] > 0
            density[at] = mirroring(material, -w[at], to[at], above[at])
            share[at] = passage(depth[at], w[at], area[at], to[at], hidden[row][at])
            at = ~at & met
            density[at] = passing(material, -w[at], to[at], above[at])
            high = height[row][at]
            leaves = exp_precise(-depth_below(next[at]) * hidden[row][at] / high) / high
            share[at] = leaves * dense(material, ~above[at])
            n2[at] = dense(material, above[at])
            share *= density / area
            if order > 1:
                share *= 2 * quotient(outer[row], outer[row] + density * n2 / back[row])
            total[row] += share
        if order == last or not met.any():
            break
        draws.keep(met)
        row, w, depth, to, above, area = (a[met] for a in (row, w, next, to, above, area))
        u = draws.drawn()
        wm = material.sample_wm(-w, u[:, 1:])
        reflects = u[:, 0] < F_dielectric(np.clip(dot(-w, wm), 0.0, 1.0), eta_seen(material, above))
        through = ~reflects
        reflected, wt = mirror(-w, wm), refracted(-w, wm, eta_seen(material, above))
        if order == 1:
            one = mirroring(material, -w, reflected, above)
            other = passing(material, -w, wt, above) * dense(material, ~above)
            outer[row] = np.where(reflects, one, other) / area
        w = np.where(reflects[:, None], reflected, -wt)
        depth[through] = depth_below(depth[through])
        to = np.where(reflects[:, None], to, -to)
        above = above == reflects
    # what arrives at wi of light from wo is f(wi, wo): f(wo, wi) has n^2 of the viewer's side and not of the light's
    sides = dense(material, wo[:, 2] > 0) / dense(material, wi[:, 2] > 0)
    return (total * np.where(swap, 1.0, sides))[:, None] * np.ones(3)


def pdf_lobes(material, wo, wi):
    o, i, above = turned(wo, wo), turned(wi, wo), wo[:, 2] > 0
    one, back = np.empty(len(wo)), i[:, 2] > 0
    one[back] = mirroring(material, o[back], i[back], above[back])
    one[~back] = dense(material, ~above[~back]) * passing(material, o[~back], i[~back], above[~back])
    return mix(one / material.projected_area(o), 0.5 * INV_PI * np.abs(wi[:, 2]), broad(material))


def sample_lobes(material, wo, u):
    """A direction that ends on the wrong side of the surface is lost: it is put on the horizon."""
    share, side = broad(material), third(u)
    x, y = split(u)
    wide = x < share
    wi = np.empty(wo.shape)
    w = cosine_hemisphere(vec(x / share, y)[wide])
    wi[wide] = vec(w[:, 0], w[:, 1], np.where(side[wide] < 0.5, w[:, 2], -w[:, 2]))
    one = ~wide
    o, eta = turned(wo[one], wo[one]), eta_seen(material, wo[one, 2] > 0)
    wm = material.sample_wm(o, vec((x - share) / (1 - share), y)[one])
    reflects = side[one] < F_dielectric(np.clip(dot(o, wm), 0.0, 1.0), eta)
    w = np.where(reflects[:, None], mirror(o, wm), refracted(o, wm, eta))
    z = np.where(reflects, np.maximum(w[:, 2], 0.0), np.minimum(w[:, 2], 0.0))
    wi[one] = turned(vec(w[:, 0], w[:, 1], z), wo[one])
    return wi

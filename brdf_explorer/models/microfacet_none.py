"""Slot energy of microfacet: single scattering as it is."""


def energy_f(material, single, wo, wi):
    return single


def energy_pdf(material, single, wo, wi):
    return single


def energy_wi(material, wo, u):
    return material.single_wi(wo, u)


def energy_weight(material, single, wo, wi):
    return single

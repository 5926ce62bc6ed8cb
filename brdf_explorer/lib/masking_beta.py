"""Slot masking: how the microsurface hides from wo and wi a facet that reflects, and one that transmits.

Both exact for Smith's random heights: a facet with the share C of all heights below it is seen from above with the chance
C^Lambda and from below with (1 - C)^Lambda, and the mean of their product over C is the Beta function. Heitz et al. 2016,
"Multiple-Scattering Microfacet BSDFs with the Smith Model", section 5.2 and its walk's first order.
"""

from .beta import beta_one_plus


def G2_reflected(Lambda_o, Lambda_i):
    return 1 / (1 + Lambda_o + Lambda_i)


def G2_transmitted(Lambda_o, Lambda_i):
    return beta_one_plus(Lambda_o, Lambda_i)

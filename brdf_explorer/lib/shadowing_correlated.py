"""Slot shadowing: masking and shadowing are correlated by the height of the facet. Exact for Smith's random heights.

Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", Eq. 99.
"""


def G2(wo, wi, Lambda_o, Lambda_i):
    return 1 / (1 + Lambda_o + Lambda_i)

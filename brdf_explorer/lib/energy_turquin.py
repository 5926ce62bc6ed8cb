"""Slot energy: single scattering is made as bright as white facets would need, times what a facet reflects along the normal.

Turquin 2019, "Practical multiple scattering compensation for microfacet models", whose E is a table; here it is a fit. Not
reciprocal, by up to 0.69 of the larger value; and it brightens the lobe, where light of more than one reflection is spread wide.
"""

import numpy as np


def gain_turquin(F0, lost_o):
    """F0 (1 - E) / E more (..., 3), where lost_o (...) is 1 - E(wo)."""
    return 1 + F0 * np.asarray(lost_o / (1 - lost_o))[..., None]

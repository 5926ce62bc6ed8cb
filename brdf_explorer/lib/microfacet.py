"""The geometry of reflection by a facet."""

import numpy as np

from .common import length


def cos_facet(wo, wi):
    """wo . wm = wi . wm, the cosine at the facet, as |wo + wi| / 2: 1 + wo . wi would cancel where wi is near -wo."""
    return np.minimum(0.5 * length(wo + wi), 1.0)

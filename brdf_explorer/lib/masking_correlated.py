"""Slot masking: correlated by height in reflection, and the same formula in transmission, as in pbrt.

It lets too much through: a facet that is high, and well seen from above, is hidden from below.
"""


def G2_reflected(Lambda_o, Lambda_i):
    return 1 / (1 + Lambda_o + Lambda_i)


def G2_transmitted(Lambda_o, Lambda_i):
    return 1 / (1 + Lambda_o + Lambda_i)

"""Slot masking: correlated by height in reflection, and the same formula in transmission, as in pbrt.

It lets too much through: a facet that is high, and well seen from above, is hidden from below. Of GGX at alpha = 0.6 and an
index of 1.5 it transmits 0.74 at 80 degrees instead of 0.51, and at worst, alpha = 1 and 85 degrees, 0.69 instead of 0.09.
"""


def G2_reflected(Lambda_o, Lambda_i):
    return 1 / (1 + Lambda_o + Lambda_i)


def G2_transmitted(Lambda_o, Lambda_i):
    return 1 / (1 + Lambda_o + Lambda_i)

"""Slot masking: independent on both sides, Walter et al. 2007, Eq. 23, as in Mitsuba.

Too dark in reflection, too bright in transmission.
"""


def G2_reflected(Lambda_o, Lambda_i):
    return 1 / ((1 + Lambda_o) * (1 + Lambda_i))


def G2_transmitted(Lambda_o, Lambda_i):
    return 1 / ((1 + Lambda_o) * (1 + Lambda_i))

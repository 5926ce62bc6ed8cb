"""Slot fresnel_mean: of Schlick's approximation, exact: the mean of (1 - c)^5 over directions, weighted by c, is 1/21."""

from .fresnel import F0


def F_mean(eta, k):
    normal = F0(eta, k)
    return normal + (1 - normal) / 21

"""Slot smith: GGX's Lambda needs no fit."""

from .smith_ggx_exact import Lambda as Lambda

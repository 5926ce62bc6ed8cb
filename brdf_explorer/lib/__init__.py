"""Formulas in float64: the twins of shaders/lib, file for file and function for function."""

from importlib import import_module


def slot(*names):
    """The module that choices select: slot("ndf", "ggx") is ndf_ggx.py, twin of shaders/lib/ndf_ggx.glsl."""
    return import_module(f"{__name__}.{'_'.join(names)}")

"""An interactive explorer of reflection models: every formula in GLSL and in float64 numpy."""

__version__ = "0.1.0"

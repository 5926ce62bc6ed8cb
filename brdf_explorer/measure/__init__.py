"""Numbers about any model: laws, albedo, chi-square tests, errors."""

from .albedo import albedo

__all__ = ["albedo"]

"""Numbers about any model: laws, albedo, chi-square tests, errors."""

from .albedo import albedo, albedo_with_error, shares
from .laws import laws

__all__ = ["albedo", "albedo_with_error", "laws", "shares"]

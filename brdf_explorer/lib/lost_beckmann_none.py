"""Slot lost: without shadowing nothing is lost, whatever the normals."""

from .lost_none import lost as lost
from .lost_none import lost_mean as lost_mean

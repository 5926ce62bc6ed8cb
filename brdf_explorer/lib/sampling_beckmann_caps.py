"""Slot sampling: Beckmann has no caps; visible normals."""

from .sampling_beckmann_visible import pdf_wi as pdf_wi
from .sampling_beckmann_visible import sample_wi as sample_wi
from .sampling_beckmann_visible import sample_wm as sample_wm
from .sampling_beckmann_visible import weight_wi as weight_wi

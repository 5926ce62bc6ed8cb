"""Slot sampling: the same for all normals."""

from .sampling_uniform import pdf_wi as pdf_wi
from .sampling_uniform import sample_wi as sample_wi
from .sampling_uniform import weight_wi as weight_wi

"""Slot sampling: the same for all normals."""

from .sampling_cosine import pdf_wi as pdf_wi
from .sampling_cosine import sample_wi as sample_wi
from .sampling_cosine import weight_wi as weight_wi

"""Antialiased lines over a target: the segments' coverage is joined by its maximum, so that joints leave no dots."""

import numpy as np

from ..glsl import assemble
from .picture import rgb


def draw_lines(gpu, target, polylines, color, width, opacity=1.0):
    """Draw polylines of one colour. polylines: arrays (n, 2), pixels from the bottom left. width: pixels."""
    rows = []
    for line in polylines:
        row = np.ones((len(line), 3), dtype=np.float32)
        row[:, :2] = line
        row[0, 2] = 0.0  # a new polyline begins
        rows.append(row)
    points = gpu.texture(np.concatenate(rows)[None])
    mask = gpu.target("lines", target.size, 1, "f1")
    mask.clear()
    program = gpu.program(assemble("views/lines.frag"), assemble("views/lines.vert"))
    uniforms = {"size": tuple(map(float, target.size)), "width": float(width)}
    gpu.draw(program, mask, uniforms, {"points": points}, vertices=6, instances=points.width - 1, blend="max")
    ink = gpu.program(assemble("views/ink.frag"))
    gpu.draw(ink, target, {"color": (*rgb(color), opacity)}, {"mask": mask.color_attachments[0]}, blend="over")
    points.release()

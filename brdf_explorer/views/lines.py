"""Antialiased lines over a target."""

from dataclasses import dataclass

import numpy as np

from ..glsl import assemble
from .picture import rgb


@dataclass(frozen=True)
class Stroke:
    """A polyline. points: (n, 2), pixels from the bottom left; width: pixels; color: "#rrggbb"."""

    points: np.ndarray
    color: str
    width: float
    opacity: float = 1.0


def draw_lines(gpu, target, strokes):
    """Draw strokes in one pass. Where some of them meet the one that covers more of a pixel shows, of equal ones the later.

    So the joints of a line leave no dots. A thin line that must show over a thick one needs a call of its own.
    """
    rows = []
    for order, stroke in enumerate(strokes):
        row = np.empty((2, len(stroke.points), 4), dtype=np.float32)
        row[0, :, :2] = stroke.points
        row[0, :, 2] = 1.0 + order
        row[0, 0, 2] = 0.0  # a new polyline begins
        row[0, :, 3] = stroke.width
        row[1] = (*rgb(stroke.color), stroke.opacity)
        rows.append(row)
    points = gpu.texture(np.concatenate(rows, axis=1))
    layer = gpu.target("lines", target.size, 4, "f1", depth=True)
    layer.clear()
    program = gpu.program(assemble("views/lines.frag"), assemble("views/lines.vert"))
    uniforms = {"size": tuple(map(float, target.size)), "strokes": float(len(strokes) + 1)}
    gpu.draw(program, layer, uniforms, {"points": points}, vertices=6, instances=points.width - 1, depth=True)
    over = gpu.program(assemble("views/over.frag"))
    corners = np.concatenate([s.points for s in strokes])
    margin = max(s.width for s in strokes) + 1
    box = (*(corners.min(axis=0) - margin), *(corners.max(axis=0) + margin))
    picture = {"picture": layer.color_attachments[0]}
    gpu.draw(over, target, {"share": 1.0}, picture, blend="premultiplied", box=box)

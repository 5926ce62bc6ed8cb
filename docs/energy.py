"""Draws energy.png, rough metals by each method of the ladder `energy`: python docs/energy.py

Under each sphere stands how much darker or brighter it is than by the walk, on average.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from brdf_explorer.export import font, render
from brdf_explorer.gpu import offscreen
from brdf_explorer.ladder import LADDERS
from brdf_explorer.state import load

ROWS = [(metal, scene) for scene in ("white_furnace", "studio") for metal in ("gold", "copper")]
ALPHA = 0.8
SCENES = {"white_furnace": "in a white furnace", "studio": "in the studio"}
METHODS = {
    "none": ("none", "one reflection"),
    "turquin": ("turquin", "a brighter lobe"),
    "kulla_conty": ("kulla_conty", "a wide lobe"),
    "walk_2": ("walk_2", "up to two reflections"),
    "walk": ("walk", "all of them"),
}
SIDE, LEFT, TOP, GAP = 180, 130, 56, 34
INK, MUTED, PAPER = (31, 41, 55), (107, 114, 128), (255, 255, 255)


def cells(gpu):
    """(row, column, pixels, brightness over the walk's less 1)."""
    ladder = LADDERS["energy"]
    for row, (metal, scene) in enumerate(ROWS):
        state = load(metal, load(scene))
        state = state.with_model(replace(state.model, alpha=ALPHA)).with_view("sphere", samples=256, noise=0.005)
        drawn, means = [], []
        for method in ladder.methods:
            at = ladder.at(state, method)
            drawn.append(render(gpu, at, "sphere", (SIDE, SIDE)).pixels)
            plain = at.with_view("sphere", background="plain", samples=64)
            *_, last = plain.views["sphere"].pictures(gpu, plain, (SIDE, SIDE))
            means.append(gpu.pixels(last.target)[..., :3].mean(dtype=float))
        for column, (pixels, mean) in enumerate(zip(drawn, means, strict=True)):
            yield row, column, pixels, mean / means[-1] - 1


def main():
    size = (LEFT + len(METHODS) * (SIDE + 8) + 8, TOP + len(ROWS) * (SIDE + GAP))
    image = Image.new("RGB", size, PAPER)
    draw = ImageDraw.Draw(image)

    def write(x, y, text, color=INK, height=16, anchor="ms"):
        draw.text((x, y), text, color, font(height), anchor=anchor)

    def middle(column):
        return LEFT + column * (SIDE + 8) + SIDE // 2

    for column, (name, words) in enumerate(METHODS.values()):
        write(middle(column), 24, name, height=19)
        write(middle(column), 44, words, MUTED, 15)
    for row, (metal, scene) in enumerate(ROWS):
        y = TOP + row * (SIDE + GAP) + SIDE // 2
        write(12, y - 8, metal.capitalize(), height=19, anchor="ls")
        write(12, y + 12, SCENES[scene], MUTED, 14, anchor="ls")
        write(12, y + 30, f"α = {ALPHA}", MUTED, 14, anchor="ls")
    with offscreen() as gpu:
        for row, column, pixels, off in cells(gpu):
            x, y = LEFT + column * (SIDE + 8), TOP + row * (SIDE + GAP)
            image.paste(Image.fromarray(np.asarray(pixels)[..., :3]), (x, y))
            text = "the reference" if column == len(METHODS) - 1 else f"{100 * off:+.1f} %".replace("-", "−")
            write(middle(column), y + SIDE + 18, text, height=15)
    image.save(Path(__file__).with_name("energy.png"), optimize=True)


if __name__ == "__main__":
    main()

"""The gallery: each view of each material, and a page that shows them side by side."""

import html
from pathlib import Path

from . import __version__
from .export import render, title, write_png
from .model import Invalid
from .state import load, presets, replacing, save
from .views import VIEWS

SCALE = 1.3  # pixels a point: the page shows pictures smaller than they are
STYLE = """
:root { color-scheme: light dark; --paper: #f6f7f9; --card: #fff; --ink: #1f2937; --muted: #6b7280; --line: #e1e5ea; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #111317; --card: #1a1d23; --ink: #e5e7eb; --muted: #9aa3af; --line: #2b303a; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
main { max-width: 1560px; margin: 0 auto; padding: 40px 28px 64px; }
h1 { font-size: 26px; line-height: 1.2; margin: 0 0 6px; letter-spacing: -0.01em; }
h2 { font-size: 17px; margin: 0; }
p { margin: 0; color: var(--muted); }
a { color: inherit; }
header { margin-bottom: 28px; }
nav { display: grid; grid-template-columns: repeat(auto-fill, minmax(118px, 1fr)); gap: 16px 12px; margin-bottom: 36px; }
nav a { text-decoration: none; font-size: 12px; line-height: 1.3; text-align: center; }
nav img { aspect-ratio: 1; object-fit: cover; border-radius: 10px; margin-bottom: 6px; border: 1px solid var(--line); }
section { background: var(--card); border: 1px solid var(--line); border-radius: 12px; margin-bottom: 24px; overflow: hidden; }
.head { display: flex; flex-wrap: wrap; gap: 4px 16px; align-items: baseline; padding: 14px 18px; }
.head p { font-size: 13px; }
.head p:last-child { margin-left: auto; }
.views { display: grid; grid-template-columns: repeat(auto-fit, minmax(260px, 1fr)); gap: 1px; background: var(--line);
  border-top: 1px solid var(--line); }
.views a { display: block; background: #fff; }
img { display: block; width: 100%; height: auto; }
details { padding: 10px 18px 12px; border-top: 1px solid var(--line); font-size: 13px; color: var(--muted); }
summary { cursor: pointer; }
table { border-collapse: collapse; margin: 8px 0; }
td { padding: 1px 18px 1px 0; vertical-align: top; }
td:first-child { color: var(--ink); font-family: ui-monospace, monospace; }
"""


def materials(scene):
    """[(name, State)] of the material presets that come with the package, over a scene."""
    base = load(scene)
    return [(name, load(path, base)) for name, path in presets().items() if path.parent.name == "materials"]


def save_gallery(gpu, states, folder, size, seconds=None):
    """Write NAME-VIEW.png of each of the [(name, State)] and view, NAME.toml, and index.html into a folder.

    The page is there from the start and grows with each material. Yields (number of the picture, number of all, its name) before
    each. Raises Invalid if the folder cannot be made.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise Invalid(f"{folder}: cannot make this folder: {error.strerror}") from None
    names = unique([Path(name).stem for name, _ in states])
    views = [name for name, view in VIEWS.items() if not view.instrument]
    total = len(views) * len(states)
    done = 0
    sections, links = [], []

    def write_page():
        with replacing(folder / "index.html") as temporary:
            temporary.write_text(page(links, sections, gpu.device, len(states)), encoding="utf-8")

    for name, (_, state) in zip(names, states, strict=True):
        write_page()
        pictures = {}
        for view in views:
            done += 1
            yield done, total, title(state, view)
            pictures[view] = f"{name}-{view}.png"
            rendered = render(gpu, state, view, size, SCALE, seconds)
            write_png(rendered, folder / pictures[view])
        save(state, folder / f"{name}.toml")
        sections.append(section(name, state, pictures, size))
        links.append(link(name, state, next(iter(pictures.values()))))
    write_page()


def unique(names):
    """The names with a number behind those that occur before."""
    found = []
    for name in names:
        same = sum(n == name for n in found)
        found.append(f"{name}-{same + 1}" if same else name)
    return found


def link(name, state, picture):
    e = html.escape
    return f'<a href="#{e(name)}"><img src="{e(picture)}" alt="">{e(state.material.name)}</a>\n'


def section(name, state, pictures, size):
    e = html.escape
    model = state.model
    shown = [f"{k} = {', '.join(f'{x:g}' for x in v) if isinstance(v, tuple) else v}" for k, v in vars(model).items()]
    images = "".join(
        f'<a href="{e(file)}" title="{e(title(state, view))}">'
        f'<img src="{e(file)}" alt="{e(title(state, view))}" width="{size[0]}" height="{size[1]}" loading="lazy"></a>'
        for view, file in pictures.items()
    )
    rows = "".join(f"<tr><td>{e(line.split(' = ')[0])}</td><td>{e(line.split(' = ')[1])}</td></tr>" for line in shown)
    source = f"<p>{e(state.material.source)}</p>" if state.material.source else ""
    return f"""<section id="{e(name)}">
<div class="head"><h2>{e(state.material.name)}</h2><p>{e(", ".join((model.name(), *model.choices().values())))}</p>
<p><a href="{e(name)}.toml">{e(name)}.toml</a></p></div>
<div class="views">{images}</div>
<details><summary>Parameters and source</summary><table>{rows}</table>{source}</details>
</section>
"""


def page(links, sections, device, total):
    so_far = "" if len(sections) == total else f" {len(sections)} of {total} materials are drawn so far: load it again."
    return f"""<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>brdf-explorer gallery</title>
<style>{STYLE}</style>
<main>
<header><h1>Gallery of materials</h1>
<p>Each picture holds the preset that made it: drop it on the window of brdf-explorer to go on from there.{so_far}</p></header>
<nav>{"".join(links)}</nav>
{"".join(sections)}
<p>brdf-explorer {__version__}, {html.escape(device)}</p>
</main>
</html>
"""

"""Shader text: `#include` with slots, generated parameters, two dialects, and errors told by file and line. No GL here.

`#include "lib/ndf_{ndf}.glsl"` is a path from shaders/, its slots filled from the choices. Each file enters once.
`#include "params.glsl"` and other generated files come from a dictionary. With the formulas "textbook" a file of
shaders/textbook stands in for the file of shaders/ at the same place below it: the same functions, typed as they are printed.
"""

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from .model import Invalid, Param, declared

PACKAGE = Path(__file__).parent
SHADERS = next(p for p in (PACKAGE / "shaders", PACKAGE.parent / "shaders") if p.is_dir())

PREAMBLE = {
    "330 core": "#version 330 core\n",
    "300 es": "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n",
}
INCLUDE = re.compile(r'\s*#include "([^"]+)"')
FUNCTION = re.compile(r"^(?!return\b|else\b)(\w+ \w+\([^();]*\))\s*{", re.MULTILINE)
LOCATION = re.compile(r"\b\d+:(\d+)\((\d+)\)|\b\d+\((\d+)\)|ERROR: \d+:(\d+)")


@dataclass(frozen=True)
class Source:
    """Assembled shader text; `lines[i]` is the (file, line) that line i + 1 comes from."""

    text: str
    lines: tuple[tuple[str, int], ...]
    files: tuple[str, ...]  # paths from shaders/, generated ones left out

    def explain(self, log):
        """A compiler's log with its line numbers replaced by file:line; drivers name only the assembled text's lines."""

        def place(match):
            number = int(next(g for g in (match[1], match[3], match[4]) if g))
            file, line = self.lines[number - 1] if 0 < number <= len(self.lines) else ("assembled text", number)
            return f"{file}:{line}" + (f"({match[2]})" if match[2] else "")

        return LOCATION.sub(place, log)


def assemble(path, slots=None, generated=None, dialect="330 core", formulas="stable"):
    """The Source of the shader `path` with its slots filled. Raises Invalid for a missing file, slot or a loop."""
    return _assemble(path, tuple((slots or {}).items()), tuple((generated or {}).items()), dialect, formulas)


def reload():
    """Read all files anew when they are next asked for."""
    _assemble.cache_clear()


@cache
def _assemble(path, slots, generated, dialect, formulas):
    slots, generated = dict(slots), dict(generated)
    text, lines, files = [], [], []
    preamble = PREAMBLE[dialect].splitlines()
    text += preamble
    lines += [("preamble", i + 1) for i in range(len(preamble))]
    seen = set()

    def include(name, chain):
        name = printed(name) if formulas == "textbook" else name
        if name in chain:
            raise Invalid(f"{chain[-1]}: include loop: {' -> '.join([*chain[chain.index(name) :], name])}")
        if name in seen:
            return
        seen.add(name)
        if name in generated:
            body = generated[name]
        else:
            body = read(name, chain)
            files.append(name)
        for number, line in enumerate(body.splitlines(), 1):
            if match := INCLUDE.match(line):
                include(filled(match[1], slots, f"{name}:{number}"), [*chain, name])
            else:
                text.append(line)
                lines.append((name, number))

    include(path, [])
    return Source("\n".join(text) + "\n", tuple(lines), tuple(files))


def filled(path, slots, where):
    """`path` with each {slot} replaced by its choice."""
    missing = [name for name in re.findall(r"{(\w+)}", path) if name not in slots]
    if missing:
        raise Invalid(f"{where}: no choice fills the slot {{{missing[0]}}} of {path}")
    return path.format(**slots)


def printed(name):
    """The file that stands in for a formula's file with the formulas "textbook", or the same where there is none."""
    return f"textbook/{name}" if (SHADERS / "textbook" / name).is_file() else name


def read(name, chain):
    try:
        return (SHADERS / name).read_text(encoding="utf-8")
    except OSError:
        where = f"included by {chain[-1]}" if chain else "asked for"
        raise Invalid(f"shaders/{name}: no such file, {where}") from None


@cache
def params_glsl(name, cls):
    """GLSL that declares the params of a class: `struct Name {...}; uniform Name name;`, empty for none."""
    params = declared(cls, Param)
    if not params:
        return ""
    body = "".join(f"  {p.glsl} {n};  // {p.doc}{p.unit and f', {p.unit}'}\n" for n, p in params.items())
    return f"struct {name.title()} {{\n{body}}};\nuniform {name.title()} {name};\n"


def of_model(path, model, dialect="330 core", slots=None, generated=None, formulas="stable"):
    """A shader that uses the model: {model}, {seeding} and its slots are filled, `params.glsl` declares `material`."""
    own = {"model": model.name(), "seeding": "pixel" if model.stochastic else "none"}
    return assemble(
        path,
        {**own, **model.slots(), **(slots or {})},
        {"params.glsl": params_glsl("material", type(model)), **(generated or {})},
        dialect,
        formulas,
    )


class Signature:
    """A GLSL function's signature, parsed: the types of what goes in and of what comes out."""

    class Kind:
        def __init__(self, glsl):
            self.glsl = glsl
            self.unsigned = glsl.startswith("u")
            self.components = int(glsl[-1]) if glsl[-1].isdigit() else 1
            self.dtype = "u4" if self.unsigned else "f4"

    def __init__(self, text):
        head, _, tail = text.partition("(")
        result, self.name = head.split()
        parts = [p.split() for p in tail.rstrip(") {").split(",") if p]
        self.inputs = [self.Kind(p[-2]) for p in parts if p[0] != "out"]
        self.out = [self.Kind(p[-2]) for p in parts if p[0] == "out"]
        self.order = [p[0] == "out" for p in parts]
        self.outputs = [self.Kind(result), *self.out]

    def call(self, first=""):
        """GLSL of a main that fetches the arguments of this pixel's row, calls the function and writes what it gives.

        first: statements that it begins with, such as "seed_random(pass);".
        """
        lines = ["uniform uint pass;"] if first else []
        for i, kind in enumerate(self.inputs):
            lines.append(f"uniform highp {'u' if kind.unsigned else ''}sampler2D argument{i};")
        for i in range(len(self.outputs)):
            lines.append(f"layout(location = {i}) out vec4 result{i};")
        lines.append(f"void main() {{\n  {first}ivec2 row = ivec2(gl_FragCoord.xy);")
        for i, kind in enumerate(self.out):
            lines.append(f"  {kind.glsl} out{i};")
        inputs, out = iter(range(len(self.inputs))), iter(range(len(self.out)))
        arguments = []
        for is_out in self.order:
            if is_out:
                arguments.append(f"out{next(out)}")
            else:
                i = next(inputs)
                arguments.append(f"texelFetch(argument{i}, row, 0).{'xyzw'[: self.inputs[i].components]}")
        lines.append(f"  {self.outputs[0].glsl} value = {self.name}({', '.join(arguments)});")
        for i, kind in enumerate(self.outputs):
            value = "value" if i == 0 else f"out{i - 1}"
            padding = ", 0.0" * (4 - kind.components)
            lines.append(f"  result{i} = vec4({value}{padding});")
        return "\n".join([*lines, "}\n"])


@dataclass(frozen=True)
class Function:
    """A GLSL function: where it is, its signature, and the names of what goes in."""

    file: str
    signature: str

    @property
    def name(self):
        return Signature(self.signature).name

    @property
    def arguments(self):
        """[(type, name)] of what goes in."""
        inside = self.signature.partition("(")[2].rstrip(")")
        return [tuple(p.split()[-2:]) for p in inside.split(",") if p and p.split()[0] != "out"]

    @property
    def over_maps(self):
        """A function of textures."""
        return any(kind == "sampler2D" for kind, _ in self.arguments)


def functions(file):
    """The functions that a shader file defines itself."""
    return [Function(file, s) for s in FUNCTION.findall(read(file, []))]

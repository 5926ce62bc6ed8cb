"""Shader assembly: includes, slots, errors by file and line; and every shader compiles in both dialects."""

import re
import shutil
import subprocess

import pytest
from oracles.cases import choices_of, pairwise
from test_twins import CHUNKS

from brdf_explorer import glsl
from brdf_explorer.glsl import PREAMBLE, SHADERS, Source, assemble, functions, of_model, params_glsl
from brdf_explorer.model import Choice, Invalid, Param, declared
from brdf_explorer.models import MODELS
from brdf_explorer.state import SECTIONS
from brdf_explorer.views import VIEWS

DIALECTS = list(PREAMBLE)
CONSTANT = "out vec4 color;\nvoid main() { color = vec4(1.0); }\n"


# --- assembly --------------------------------------------------------------------------------------------------------


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Write files of a shader folder of the test's own: write("lib/a.glsl", text)."""
    monkeypatch.setattr(glsl, "SHADERS", tmp_path)
    glsl.reload()

    def write(name, text):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    yield write
    glsl.reload()


def body(source, dialect="330 core"):
    return source.text.removeprefix(PREAMBLE[dialect]).splitlines()


def test_each_file_is_included_once(write):
    write("a.frag", '#include "b.glsl"\n#include "c.glsl"\n#include "b.glsl"\na\n')
    write("b.glsl", "b\n")
    write("c.glsl", '#include "b.glsl"\nc\n')
    source = assemble("a.frag")
    assert body(source) == ["b", "c", "a"]
    assert source.files == ("a.frag", "b.glsl", "c.glsl")


def test_slots_are_filled_by_choices(write):
    write("a.frag", '#include "lib/ndf_{ndf}_{smith}.glsl"\n')
    write("lib/ndf_ggx_exact.glsl", "here\n")
    assert body(assemble("a.frag", {"ndf": "ggx", "smith": "exact"})) == ["here"]


def test_generated_files_take_the_place_of_files(write):
    write("a.frag", '#include "params.glsl"\n')
    assert body(assemble("a.frag", generated={"params.glsl": "made"})) == ["made"]


def test_dialect_is_the_first_line(write):
    write("a.frag", "a\n")
    for dialect in DIALECTS:
        assert assemble("a.frag", dialect=dialect).text.startswith(f"#version {dialect}\n")


def test_loop_is_told_with_its_files(write):
    write("a.frag", '#include "b.glsl"\n')
    write("b.glsl", '#include "c.glsl"\n')
    write("c.glsl", '#include "b.glsl"\n')
    with pytest.raises(Invalid, match=r"^c\.glsl: include loop: b\.glsl -> c\.glsl -> b\.glsl$"):
        assemble("a.frag")


def test_file_that_includes_itself_is_a_loop(write):
    write("a.frag", '#include "a.frag"\n')
    with pytest.raises(Invalid, match=r"a\.frag -> a\.frag"):
        assemble("a.frag")


def test_missing_file_is_told_with_the_file_that_asks_for_it(write):
    write("a.frag", 'one\n#include "lib/gone.glsl"\n')
    with pytest.raises(Invalid, match=r"^shaders/lib/gone\.glsl: no such file, included by a\.frag") as caught:
        assemble("a.frag")
    assert "\n" not in str(caught.value)
    with pytest.raises(Invalid, match=r"^shaders/b\.frag: no such file"):
        assemble("b.frag")


def test_missing_slot_is_told_with_file_and_line(write):
    write("a.frag", 'one\n#include "b.glsl"\n')
    write("b.glsl", 'one\ntwo\n#include "lib/ndf_{ndf}.glsl"\n')
    with pytest.raises(Invalid, match=r"^b\.glsl:3: no choice fills the slot {ndf} of lib/ndf_{ndf}\.glsl$"):
        assemble("a.frag", {"smith": "exact"})


def test_textbook_forms_stand_in_where_there_are_some(write):
    write("a.frag", '#include "lib/b.glsl"\n#include "lib/c.glsl"\n')
    write("lib/b.glsl", "stable b\n")
    write("lib/c.glsl", "stable c\n")
    write("textbook/lib/b.glsl", "printed b\n")
    assert body(assemble("a.frag")) == ["stable b", "stable c"]
    source = assemble("a.frag", formulas="textbook")
    assert body(source) == ["printed b", "stable c"]
    assert source.files == ("a.frag", "textbook/lib/b.glsl", "lib/c.glsl")


def test_reload_sees_changed_files(write):
    write("a.frag", '#include "b.glsl"\n')
    write("b.glsl", "old\n")
    assert body(assemble("a.frag")) == ["old"]
    write("b.glsl", "new\n")
    glsl.reload()
    assert body(assemble("a.frag")) == ["new"]


def test_every_line_knows_where_it_is_from():
    source = of_model("views/table.frag", MODELS["microfacet"]())
    lines = source.text.splitlines()
    assert len(lines) == len(source.lines)
    for text, (file, number) in zip(lines, source.lines, strict=True):
        if (SHADERS / file).is_file():
            assert (SHADERS / file).read_text(encoding="utf-8").splitlines()[number - 1] == text


@pytest.mark.parametrize(
    ("log", "told"),
    [
        ("0:2(7): error: undeclared", "lib/b.glsl:30(7): error: undeclared"),  # Mesa
        ("0(2) : error C1503: undefined", "lib/b.glsl:30 : error C1503: undefined"),  # NVIDIA
        ("ERROR: 0:2: 'x' : undeclared", "lib/b.glsl:30: 'x' : undeclared"),  # ANGLE, Apple, glslang
        ("0:9(1): error", "assembled text:9(1): error"),
    ],
)
def test_drivers_places_are_mapped_to_files(log, told):
    assert Source("", (("a.frag", 1), ("lib/b.glsl", 30)), ()).explain(log) == told


@pytest.mark.parametrize("dialect", DIALECTS)
def test_compile_error_names_the_file_and_line(gpu, dialect):
    generated = {"chunk.glsl": '#include "lib/fresnel.glsl"\n\nfloat g() { return nothing; }\n', "call.glsl": CONSTANT}
    broken = assemble("views/probe.frag", generated=generated, dialect=dialect)
    with pytest.raises(Invalid, match=r"chunk\.glsl:3\(\d+\): error: .*nothing"):
        gpu.program(broken, assemble("views/full.vert", dialect=dialect))


def test_compile_error_of_a_vertex_shader_names_its_file(gpu):
    vertex = assemble("a.vert", generated={"a.vert": "void main() {\n  gl_Position = nothing;\n}\n"})
    with pytest.raises(Invalid, match=r"a\.vert:2\(\d+\): error"):
        gpu.program(assemble("views/fill.frag"), vertex)


def test_programs_are_kept_by_text(gpu):
    model = MODELS["microfacet"]
    one, same, other = (of_model("views/table.frag", model(fresnel=f)) for f in ("one", "one", "schlick"))
    assert gpu.program(one) is gpu.program(same)
    assert gpu.program(one) is not gpu.program(other)


def test_params_are_declared_with_their_documentation():
    for name, cls in MODELS.items():
        text = params_glsl("material", cls)
        for member, p in declared(cls, Param).items():
            assert re.search(rf"^  {p.glsl} {member};  // {re.escape(p.doc)}", text, re.M), f"{name}.{member}"


# --- every shader ----------------------------------------------------------------------------------------------------


def text_of(path):
    return (SHADERS / path).read_text(encoding="utf-8")


def options(slot, pattern):
    """What fills a slot: the options of a declared choice of that name, else what files there are."""
    for cls in (*VIEWS.values(), *SECTIONS.values()):
        if slot in declared(cls, Choice):
            return declared(cls, Choice)[slot].options
    files = SHADERS.glob(pattern.replace(f"{{{slot}}}", "*"))
    before, after = pattern.split(f"{{{slot}}}")
    return tuple(sorted(str(p.relative_to(SHADERS)).removeprefix(before).removesuffix(after) for p in files))


def slots_of(path):
    """{slot: options} of the slots that an entry has itself, the model's left out."""
    found = re.findall(r'#include "([^"]*{(\w+)}[^"]*)"', text_of(path))
    return {slot: options(slot, pattern) for pattern, slot in found if slot != "model"}


def of_choices(path, cls, dialect):
    """The texts of an entry with a model's choices and slots of its own, each pair of options in some."""
    choices, slots = choices_of(cls), slots_of(path)
    for chosen in pairwise(choices | slots):
        model = cls(**{name: chosen[name] for name in choices})
        yield of_model(path, model, dialect, {name: chosen[name] for name in slots})


def sources(path, dialect):
    """The texts of an entry with all models, choices and slots."""
    if '"models/{model}.glsl"' in text_of(path):
        return [source for cls in MODELS.values() for source in of_choices(path, cls, dialect)]
    return [assemble(path, chosen, dialect=dialect) for chosen in pairwise(slots_of(path))]


VIEW_FILES = sorted(f"views/{p.name}" for p in (SHADERS / "views").iterdir())
FRAGMENTS = [f for f in VIEW_FILES if f.endswith(".frag") and f != "views/probe.frag"]
VERTICES = [f for f in VIEW_FILES if f.endswith(".vert")]


def partner(fragment):
    """The vertex shader of the same name, where there is one; else any gives what is needed."""
    vertex = fragment.replace(".frag", ".vert")
    return vertex if vertex in VERTICES else "views/full.vert"


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("fragment", FRAGMENTS)
def test_fragment_shader_compiles(gpu, fragment, dialect):
    vertex = sources(partner(fragment), dialect)[0]
    for source in sources(fragment, dialect):
        gpu.program(source, vertex)


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("vertex", VERTICES)
def test_vertex_shader_compiles(gpu, vertex, dialect):
    fragment = vertex.replace(".vert", ".frag")
    fragment = sources(fragment if fragment in FRAGMENTS else "views/fill.frag", dialect)[0]
    for source in sources(vertex, dialect):
        gpu.program(fragment, source)


def alone(chunk, dialect, formulas="stable"):
    """A shader with nothing but the chunk: it includes all that it needs."""
    generated = {"chunk.glsl": f'#include "lib/{chunk}.glsl"\n', "call.glsl": CONSTANT}
    return assemble("views/probe.frag", generated=generated, dialect=dialect, formulas=formulas)


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("chunk", CHUNKS)
def test_chunk_compiles_alone(gpu, chunk, dialect):
    gpu.program(alone(chunk, dialect), assemble("views/full.vert", dialect=dialect))


PRINTED = sorted(p.relative_to(SHADERS / "textbook").as_posix() for p in (SHADERS / "textbook").glob("*/*.glsl"))


def printed_sources(dialect):
    """The texts in which printed forms stand in: each chunk alone, and the models that they are part of."""
    for file in PRINTED:
        if file.startswith("lib/"):
            yield alone(file[4:-5], dialect, "textbook")
    for cls in MODELS.values():
        for chosen in pairwise(choices_of(cls)):
            yield of_model("views/table.frag", cls(**chosen), dialect, formulas="textbook")


@pytest.mark.parametrize("dialect", DIALECTS)
def test_printed_forms_compile(gpu, dialect):
    for source in printed_sources(dialect):
        gpu.program(source, assemble("views/full.vert", dialect=dialect))


@pytest.mark.parametrize("file", PRINTED)
def test_printed_forms_are_of_the_same_functions(file):
    ours = {f.name: f.signature for f in functions(file)}
    book = {f.name: f.signature for f in functions(f"textbook/{file}")}
    shared = set(ours) & set(book)
    assert shared and {n: ours[n] for n in shared} == {n: book[n] for n in shared}


@pytest.mark.skipif(
    not shutil.which("glslangValidator"), reason="glslangValidator (Debian: glslang-tools) is not there"
)
@pytest.mark.parametrize("dialect", DIALECTS)
def test_reference_compiler_accepts_all(tmp_path, dialect):
    """A second, stricter reader of the standard than Mesa."""
    texts = {source.text: entry[-4:] for entry in FRAGMENTS + VERTICES for source in sources(entry, dialect)}
    texts |= {alone(chunk, dialect).text: "frag" for chunk in CHUNKS}
    texts |= {source.text: "frag" for source in printed_sources(dialect)}
    files = []
    for i, (text, stage) in enumerate(texts.items()):
        files.append(tmp_path / f"{i}.{stage}")
        files[-1].write_text(text, encoding="utf-8")
    run = subprocess.run(["glslangValidator", *files], capture_output=True, text=True)
    assert run.returncode == 0, "\n".join(line for line in run.stdout.splitlines() if "ERROR" in line)


def test_files_carry_no_version():
    for path in SHADERS.rglob("*"):
        if path.is_file():
            assert "#version" not in path.read_text(encoding="utf-8"), path.name


@pytest.mark.parametrize("cls", MODELS.values(), ids=lambda cls: cls.name())
def test_every_param_is_used(gpu, cls):
    programs = [gpu.program(source) for source in of_choices("views/table.frag", cls, "330 core")]
    for name in declared(cls, Param):
        assert any(f"material.{name}" in program for program in programs), f"{cls.name()}.{name} moves nothing"


def test_a_metal_on_the_sphere_is_a_short_shader():
    """The assembled text holds only what this material needs."""
    gold = MODELS["microfacet"]()
    lines = of_model("views/sphere.frag", gold, slots={"lighting": "directional", "body": "opaque"}).text.splitlines()
    code = [line for line in lines if line.strip() and not line.lstrip().startswith("//")]
    print(f"{len(lines)} lines, {len(code)} of code")
    assert len(code) < 160
    assert not any(
        word in "\n".join(code) for word in ("beckmann", "separable", "schlick(c, F0(", "diffuse", "environment")
    )

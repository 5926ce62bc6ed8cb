"""Presets: those that come with the package, what a file must hold, and that bad ones are refused with one clear line."""

import os
import re
import tomllib
from dataclasses import replace

import pytest
import tomli_w
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from brdf_explorer.model import Choice, Invalid, Param, declared
from brdf_explorer.models import MODELS
from brdf_explorer.state import FORMAT, LARGEST, SECTIONS, Material, State, dumps, load, loads, presets, save
from brdf_explorer.views import VIEWS

NAMES = list(presets())
TEXT = dumps(State(materials=(Material("Gold"), Material("Chalk", MODELS["diffuse"]()))))


def refused(call, *arguments):
    """The message of the Invalid that a call raises: one line."""
    with pytest.raises(Invalid) as caught:
        call(*arguments)
    message = str(caught.value)
    assert message and "\n" not in message
    return message


def valid(declaration):
    """Values that a declaration takes."""
    if isinstance(declaration, Choice):
        return st.sampled_from(declaration.options)
    if not isinstance(declaration, Param):
        return st.just("")
    if isinstance(declaration.default, int):
        return st.integers(declaration.low, declaration.high)
    one = st.floats(declaration.low, declaration.high)
    return one if declaration.size == 1 else st.tuples(*[one] * declaration.size)


def instances(cls):
    return st.builds(cls, **{name: valid(d) for name, d in declared(cls).items()})


@st.composite
def states(draw):
    words = st.text(st.characters(exclude_categories=["Cs"]), max_size=20)
    material = st.builds(Material, words, st.one_of([instances(cls) for cls in MODELS.values()]), words)
    materials = tuple(draw(st.lists(material, min_size=1, max_size=3)))
    sections = {name: draw(instances(cls)) for name, cls in SECTIONS.items()}
    views = {name: draw(instances(cls)) for name, cls in VIEWS.items()}
    return State(materials, draw(st.integers(0, len(materials) - 1)), **sections, views=views)


# --- those of the package --------------------------------------------------------------------------------------------


def test_the_ones_that_the_project_promises_are_there():
    promised = {"gold", "copper", "aluminium", "chrome", "brushed_aluminium", "glass", "rubber", "chalk", "ceramic"}
    assert promised <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_material_preset_changes_the_material_alone_and_a_scene_all_else(name):
    other = State((Material("Other", MODELS["diffuse"](sigma=0.123)),))
    other = replace(other, look=replace(other.look, exposure=1.5), directions=replace(other.directions, theta_o=12.0))
    state = load(name, other)
    if presets()[name].parent.name == "materials":
        assert replace(state, materials=other.materials) == other
        assert state.material.name and state.material.source
        assert state.materials != other.materials
    else:
        assert state.materials == other.materials
        assert (state.light, state.look) != (other.light, other.look)


@pytest.mark.parametrize("name", NAMES)
def test_dumps_and_loads_of_presets(name):
    assert loads(dumps(load(name))) == load(name)


@settings(deadline=None, max_examples=60)
@given(states())
def test_dumps_and_loads_of_any_state(state):
    assert loads(dumps(state)) == state


# --- what a preset must hold -----------------------------------------------------------------------------------------

KEYS = [(section, key) for section, cls in SECTIONS.items() for key in declared(cls)]
KEYS += [(f"views.{name}", key) for name, cls in VIEWS.items() for key in declared(cls)]
KEYS += [("materials", key) for key in ("name", "source", "model", *declared(MODELS["microfacet"]))]


def table_of(tree, section):
    if section == "materials":
        return tree["materials"][0]
    for part in section.split("."):
        tree = tree[part]
    return tree


@pytest.mark.parametrize(("section", "key"), KEYS)
def test_a_missing_key_and_a_misspelt_one_are_named(section, key):
    tree = tomllib.loads(TEXT)
    value = table_of(tree, section).pop(key)
    message = refused(loads, tomli_w.dumps(tree), "x.toml")
    assert message.startswith("x.toml: ") and section.split(".")[-1] in message and key in message
    table_of(tree, section)[f"{key}_"] = value
    message = refused(loads, tomli_w.dumps(tree), "x.toml")
    if key not in ("name", "source", "model"):
        assert f"unknown key '{key}_'; did you mean {key}?" in message


@pytest.mark.parametrize(("section", "key"), KEYS)
@pytest.mark.parametrize("value", [True, {}, [], ["x"], [[1.0]], float("nan"), float("inf"), 10**400, -1e300])
def test_a_value_of_a_wrong_type_or_out_of_range_is_named(section, key, value):
    tree = tomllib.loads(TEXT)
    table_of(tree, section)[key] = value
    message = refused(loads, tomli_w.dumps(tree), "x.toml")
    assert message.startswith("x.toml: ") and key in message and len(message) < 400


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no key format"),
        ("format = 2", "format is not 1"),
        ("format = 1.0", "format is not 1"),
        ("format = true", "format is not 1"),
        ("format = 'one'", "format is not 1"),
        ("format = 1\nligth = 1", "did you mean light?"),
        ('format = 1\n"a\\nb" = 1', "unknown key 'a\\nb'"),
        ("format = 1\nlight = 1", "light is not a table"),
        ("format = 1\nviews = 1", "views is not a table"),
        ("format = 1\n[views.lobes]", "did you mean lobe?"),
        ("format = 1\nmaterials = 1", "not a list"),
        ("format = 1\nmaterials = []", "not a list"),
        ("format = 1\nmaterials = [1]", "not a table"),
        ("format = 1\nactive = 1", "active = 1"),
        ("format = 1\nactive = true", "active = True"),
        ("format = 1\nactive = -1", "active = -1"),
        ('format = 1\n[[materials]]\nname=""\nsource=""\nmodel="microfaset"', "did you mean microfacet?"),
        ("{}", "not a TOML preset"),
        ("format = 1\nformat = 1", "not a TOML preset"),
        ("x = " + "[" * 100_000, "nested too deeply"),
        ("x = " + "9" * 5000, "not a TOML preset"),
        ("format = 1\n" + "x" * 100_000 + " = 1", "unknown key"),
    ],
)
def test_a_bad_preset_is_refused_with_its_cause(text, says):
    message = refused(loads, text, "x.toml")
    assert message.startswith("x.toml: ") and says in message and len(message) < 400


@settings(deadline=None, max_examples=300)
@given(st.data())
def test_mutilated_text_is_a_state_or_is_refused(data):
    start = data.draw(st.integers(0, len(TEXT)))
    stop = data.draw(st.integers(start, min(start + 40, len(TEXT))))
    inserted = data.draw(
        st.text(max_size=8) | st.sampled_from(["\n[", "=", '"""', "nan", "1e999", "\ufeff", "\x00", "{"])
    )
    text = TEXT[:start] + inserted + TEXT[stop:]
    try:
        assert isinstance(loads(text), State)
    except Invalid as error:
        assert "\n" not in str(error)


@settings(deadline=None, max_examples=100)
@given(st.integers(0, len(TEXT)))
def test_truncated_text_is_refused_or_holds_whole_sections(length):
    assume(not re.match(r"\d[\d.]", TEXT[length - 1 : length + 1]))  # a number cut short is another number
    try:
        state = loads(TEXT[:length])
    except Invalid as error:
        assert "\n" not in str(error)
    else:
        assert state.views == State().views


# --- files -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "empty"),
        (b" \n", "empty"),
        (b"\xff\xfe\x00", "not UTF-8"),
        (TEXT.encode()[:200], "not a TOML preset"),
        (b"\x89PNG\r\n\x1a\n", "not UTF-8"),
        (b"format = 1 #" + b"x" * LARGEST, "too large"),
    ],
)
def test_a_bad_file_is_refused_with_its_name(tmp_path, content, says):
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    message = refused(load, path)
    assert message.startswith(f"{path}: ") and says in message


def test_what_is_no_file_is_refused(tmp_path):
    assert refused(load, "no/such.toml") == "no/such.toml: no such preset or file"
    assert "did you mean gold?" in refused(load, "gould")
    assert "a folder" in refused(load, tmp_path)
    assert "too long" in refused(load, "x" * 5000)
    refused(load, "a\0b")
    if os.path.exists("/dev/zero"):
        assert "too large" in refused(load, "/dev/zero")


def test_line_ends_and_byte_order_mark_of_other_systems(tmp_path):
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + TEXT.replace("\n", "\r\n").encode())
    assert load(path) == loads(TEXT)


def test_a_file_of_light_is_found_beside_the_preset(tmp_path):
    state = State()
    save(replace(state, light=replace(state.light, file="sky.exr")), tmp_path / "x.toml")
    assert load(tmp_path / "x.toml").light.file == str(tmp_path / "sky.exr")


def test_save_and_load(tmp_path):
    state = loads(TEXT)
    save(state, tmp_path / "x.toml")
    assert load(tmp_path / "x.toml") == state
    assert os.listdir(tmp_path) == ["x.toml"]
    assert f"format = {FORMAT}" in (tmp_path / "x.toml").read_text()


def test_save_goes_through_a_link_and_keeps_the_mode(tmp_path):
    path, link = tmp_path / "x.toml", tmp_path / "link.toml"
    path.write_text("old")
    path.chmod(0o640)
    link.symlink_to(path)
    save(State(), link)
    assert link.is_symlink() and load(path) == State()
    assert path.stat().st_mode & 0o777 == 0o640


def test_what_cannot_be_written_is_refused(tmp_path):
    assert "a folder" in refused(save, State(), tmp_path)
    assert "no folder" in refused(save, State(), tmp_path / "none" / "x.toml")
    assert "cannot write" in refused(save, State(), tmp_path / ("x" * 300))
    if os.path.exists("/dev/null"):
        assert "a device" in refused(save, State(), "/dev/null")
        assert os.path.exists("/dev/null") and not os.path.isfile("/dev/null")


def test_a_save_that_fails_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "x.toml"
    save(State(), path)
    before = path.read_bytes()
    monkeypatch.setattr("brdf_explorer.state.dumps", lambda state: "half\ud800")  # cannot be encoded
    with pytest.raises(UnicodeEncodeError):
        save(State(), path)
    assert path.read_bytes() == before
    assert os.listdir(tmp_path) == ["x.toml"]

"""The state: what is shown, from where, lit how, as one frozen value; and that value as a TOML preset.

A preset holds any of the sections `materials`, `directions`, `light`, `look`, `views.NAME`; a section that is there holds
every one of its parameters, and a section that is not is taken from the state the preset is opened over. So a material
preset changes the material alone, a scene preset everything else. Pictures and tables carry a preset inside.
"""

import os
import tempfile
import tomllib
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

import tomli_w

from .model import Declared, Invalid, Model, choice, declared, nearest, param, shown, text
from .models import MODELS
from .views import VIEWS

FORMAT = 1
CARRIERS = (".png", ".exr", ".svg", ".csv", ".npz")  # files that `export` writes with a preset inside
LARGEST = 1_000_000  # bytes of preset text; the largest real one is a hundredth of this
PACKAGE = Path(__file__).parent
PRESETS = next(p for p in (PACKAGE / "presets", PACKAGE.parent / "presets") if p.is_dir())


@dataclass(frozen=True)
class Directions(Declared):
    """The direction to the viewer, for which the lobe and the slice show all directions to the light."""

    theta_o: float = param(40.0, 0.0, 89.9, "polar angle of the direction to the viewer", unit="deg")
    phi_o: float = param(0.0, -180.0, 180.0, "azimuth of the direction to the viewer", unit="deg")


@dataclass(frozen=True)
class Light(Declared):
    """A directional light and an environment."""

    theta: float = param(50.0, 0.0, 180.0, "angle between the directions to the light and to the eye", unit="deg")
    phi: float = param(125.0, -180.0, 180.0, "azimuth of the light about the view axis, from the right", unit="deg")
    irradiance: float = param(3.0, 0.0, 100.0, "irradiance of the light on a surface that faces it", unit="W/m2")
    environment: str = choice("none", ("none", "furnace", "sky", "studio", "file"), "light from all around")
    file: str = text("", "lat-long picture for environment = file, .exr or .hdr; relative to the preset's folder")
    gain: float = param(1.0, 0.0, 100.0, "factor on the environment's radiance")
    rotation: float = param(0.0, -180.0, 180.0, "rotation of the environment about the vertical axis", unit="deg")


@dataclass(frozen=True)
class Look(Declared):
    """How numbers become colours on a screen."""

    theme: str = choice("light", ("light", "dark"), "colours of the window and of diagrams")
    exposure: float = param(0.0, -10.0, 10.0, "exposure, as a power of two", unit="EV")
    tonemap: str = choice("none", ("none", "aces", "agx", "neutral"), "curve from scene to display values")


@dataclass(frozen=True)
class Material:
    """A model with its parameters, its name, and where their values come from."""

    name: str = "microfacet"
    model: Model = field(default_factory=MODELS["microfacet"])
    source: str = ""


@dataclass(frozen=True)
class State:
    """All that decides what is on screen. `materials[active]` is on the sphere; slices compare all of them."""

    materials: tuple[Material, ...] = (Material(),)
    active: int = 0
    directions: Directions = Directions()
    light: Light = Light()
    look: Look = Look()
    views: dict[str, Declared] = field(default_factory=lambda: {name: view() for name, view in VIEWS.items()})

    @property
    def material(self):
        return self.materials[self.active]

    @property
    def model(self):
        return self.material.model

    def with_model(self, model):
        """This state with another model in place of the active one."""
        materials = list(self.materials)
        materials[self.active] = replace(self.material, model=model)
        return replace(self, materials=tuple(materials))

    def with_view(self, name, **options):
        """This state with some options of one view changed."""
        return replace(self, views={**self.views, name: replace(self.views[name], **options)})


SECTIONS = {"directions": Directions, "light": Light, "look": Look}


def dumps(state):
    """The state as the text of a preset that holds all of it."""
    tree = {"format": FORMAT, "active": state.active, "materials": [material_table(m) for m in state.materials]}
    tree |= {section: values(getattr(state, section)) for section in SECTIONS}
    tree["views"] = {name: values(view) for name, view in state.views.items()}
    return tomli_w.dumps(tree)


def material_table(material):
    return {"name": material.name, "source": material.source, "model": material.model.name(), **values(material.model)}


def values(instance):
    """Parameter values as TOML holds them."""
    return {name: list(v) if isinstance(v := getattr(instance, name), tuple) else v for name in declared(instance)}


def loads(text, where="preset", base=None):
    """The State of a preset's text, over `base` for the sections it does not hold. Raises Invalid, one line."""
    base = base or State()
    try:
        tree = tomllib.loads(text)
    except ValueError as error:  # TOMLDecodeError, or a number of thousands of digits
        raise Invalid(f"{where}: not a TOML preset: {' '.join(str(error).split())}") from None
    except RecursionError:
        raise Invalid(f"{where}: not a TOML preset: nested too deeply") from None
    if "format" not in tree:
        raise Invalid(f"{where}: no key format; a preset begins with format = {FORMAT}")
    version = tree.pop("format")
    if type(version) is not int or version != FORMAT:
        raise Invalid(f"{where}: format is not {FORMAT}, the one this version reads")
    known = ["active", "materials", "views", *SECTIONS]
    for key in tree:
        if key not in known:
            raise Invalid(f"{where}: unknown key {shown(key)}{nearest(key, known)}")
    changes = {}
    for section, cls in SECTIONS.items():
        if section in tree:
            changes[section] = from_table(cls, tree[section], f"{where}: {section}")
    if "views" in tree:
        changes["views"] = base.views | {
            known_key(name, VIEWS, f"{where}: views"): from_table(VIEWS[name], table, f"{where}: views.{name}")
            for name, table in as_table(tree["views"], f"{where}: views").items()
        }
    if "materials" in tree:
        tables = tree["materials"]
        if not isinstance(tables, list) or not tables:
            raise Invalid(f"{where}: materials is not a list of tables [[materials]]")
        changes["materials"] = tuple(material_from(table, f"{where}: materials[{i}]") for i, table in enumerate(tables))
        changes["active"] = 0
    if "active" in tree:
        count = len(changes.get("materials", base.materials))
        active = tree["active"]
        if type(active) is not int or not 0 <= active < count:
            raise Invalid(f"{where}: active = {shown(active)} is not a material's number, 0 to {count - 1}")
        changes["active"] = active
    return replace(base, **changes)


def as_table(table, where):
    if not isinstance(table, dict):
        raise Invalid(f"{where} is not a table")
    return table


def known_key(key, known, where):
    if key not in known:
        raise Invalid(f"{where}: unknown key {shown(key)}{nearest(key, list(known))}")
    return key


def from_table(cls, table, where):
    """An instance of `cls` from a table that must hold each declared key and no other."""
    declarations = declared(cls)
    for key in as_table(table, where):
        known_key(key, declarations, where)
    for key in declarations:
        if key not in table:
            raise Invalid(f"{where}: no key {key}; a section holds all of: {', '.join(declarations)}")
    try:
        return cls(**table)
    except Invalid as error:
        # the class names itself; the section's path already says it
        raise Invalid(f"{where}: {str(error).removeprefix(cls.name() + ': ')}") from None


def material_from(table, where):
    table = dict(as_table(table, where))
    for key in ("name", "model", "source"):
        if not isinstance(table.get(key), str):
            raise Invalid(f"{where}: no text under the key {key}")
    name, source, model = (table.pop(key) for key in ("name", "source", "model"))
    known_key(model, MODELS, f"{where}: model")
    return Material(name, from_table(MODELS[model], table, f"{where}: {model}"), source)


def presets():
    """Paths of the presets that come with the package, by name."""
    return {p.stem: p for kind in ("materials", "scenes") for p in sorted((PRESETS / kind).glob("*.toml"))}


def load(source, base=None):
    """The State of a preset: a name from `presets()`, or the path of a .toml or of a picture or table that carries one."""
    known = presets()
    path = known.get(str(source)) or Path(source)
    try:
        there = path.exists()
    except OSError as error:
        raise Invalid(f"{shown(str(source))}: {error.strerror}") from None
    if not there:
        hint = nearest(source, list(known)) if not path.suffix and path.parent == Path(".") else ""
        raise Invalid(f"{source}: no such preset or file{hint}")
    state = loads(preset_text(path), str(source), base)
    if state.light.file and not Path(state.light.file).is_absolute():
        state = replace(state, light=replace(state.light, file=str(path.resolve().parent / state.light.file)))
    return state


def preset_text(path):
    """The text of the preset in a file."""
    if path.is_dir():
        raise Invalid(f"{path}: a folder, not a preset")
    if path.suffix.lower() in CARRIERS:
        from .export import embedded

        return embedded(path)
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST + 1)
        if len(data) > LARGEST:
            raise Invalid(f"{path}: too large for a preset, which has at most {LARGEST} bytes")
        if not data.strip():
            raise Invalid(f"{path}: empty, so not a preset")
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise Invalid(f"{path}: not UTF-8 text, so not a preset") from None
    except OSError as error:
        raise Invalid(f"{path}: {error.strerror}") from None


def save(state, path):
    """Write the state as a preset; the file is whole, or as it was before."""
    with replacing(path) as temporary:
        temporary.write_text(dumps(state), encoding="utf-8", newline="\n")


def writable(path):
    """The file that a path names, through links, if it can be one to write; else raises Invalid."""
    path = Path(path)
    place = path.resolve()
    if place.is_dir():
        raise Invalid(f"{path}: a folder, not a file to write")
    if place.exists() and not place.is_file():
        raise Invalid(f"{path}: a device, not a file to write")
    if not place.parent.is_dir():
        raise Invalid(f"{path}: cannot write: no folder {path.parent}")
    return place


@contextmanager
def replacing(path):
    """A temporary path beside `path` that takes its place when the block ends well. Raises Invalid if it cannot."""
    temporary = None
    try:
        place = writable(path)
        handle, name = tempfile.mkstemp(suffix=place.suffix, prefix=".writing-", dir=place.parent)
        os.close(handle)
        temporary = Path(name)
        yield temporary
        mask = os.umask(0)
        os.umask(mask)
        temporary.chmod(
            place.stat().st_mode & 0o777 if place.exists() else 0o666 & ~mask
        )  # mkstemp makes files private
        temporary.replace(place)
    except OSError as error:
        raise Invalid(f"{path}: cannot write: {error.strerror or error}") from None
    finally:
        if temporary and temporary.exists():
            temporary.unlink()

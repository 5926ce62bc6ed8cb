"""Declarations: every field says what it is, a value outside its domain is refused with one line, and values travel whole."""

import math
from dataclasses import FrozenInstanceError, dataclass, fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from brdf_explorer.model import Choice, Declared, Invalid, Param, Text, checked, choice, declared, nearest, param, text
from brdf_explorer.models import MODELS
from brdf_explorer.state import SECTIONS, Material, State, dumps, loads, values
from brdf_explorer.views import VIEWS

CLASSES = [*MODELS.values(), *VIEWS.values(), *SECTIONS.values()]


def of_kind(*kinds):
    cases = [(cls, name, d) for cls in CLASSES for name, d in declared(cls, kinds).items()]
    return [pytest.param(*case, id=f"{case[0].__name__}.{case[1]}") for case in cases]


FIELDS, PARAMS, CHOICES = of_kind(Param, Choice, Text), of_kind(Param), of_kind(Choice)


@dataclass(frozen=True)
class Example(Declared):
    alpha: tuple = param((0.3, 0.3), 1e-4, 1.0, "roughness", scale="log")
    tau: float = param(1.0, 0.0, 20.0, "optical depth", unit="nm")
    count: int = param(4, 1, 8, "layers")
    ndf: str = choice("ggx", ("ggx", "beckmann"), "distribution")
    file: str = text("", "a file")


# --- the declarations that there are ---------------------------------------------------------------------------------


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__name__)
def test_classes_are_documented_and_declare_all_their_fields(cls):
    assert cls.__doc__ and not cls.__doc__.startswith(f"{cls.__name__}(")  # the one that dataclass makes
    assert set(declared(cls)) == {f.name for f in fields(cls)}


@pytest.mark.parametrize(("cls", "name", "declaration"), FIELDS)
def test_fields_are_documented_in_one_line(cls, name, declaration):
    assert declaration.doc and "\n" not in declaration.doc and not declaration.doc.endswith(".")


@pytest.mark.parametrize(("cls", "name", "declaration"), FIELDS)
def test_defaults_lie_in_their_domain(cls, name, declaration):
    assert getattr(cls(), name) == declaration.default
    assert checked("", name, declaration, declaration.default) == declaration.default
    if isinstance(declaration, Param):
        assert declaration.low < declaration.high
        assert declaration.scale in ("linear", "log")
        assert declaration.scale == "linear" or declaration.low > 0
        assert not declaration.color or declaration.size == 3
    if isinstance(declaration, Choice):
        assert declaration.default in declaration.options
        assert len(set(declaration.options)) == len(declaration.options) > 1


@pytest.mark.parametrize(("cls", "name", "declaration"), PARAMS)
def test_ends_of_a_range_are_taken_and_what_lies_beyond_is_refused(cls, name, declaration):
    whole = isinstance(declaration.default, int)
    for end, beyond in ((declaration.low, -1), (declaration.high, 1)):
        instance = cls(**{name: end})
        assert getattr(instance, name) == ((end,) * declaration.size if declaration.size > 1 else end)
        outside = end + beyond if whole else math.nextafter(end, beyond * math.inf)
        with pytest.raises(Invalid) as caught:
            cls(**{name: outside})
        for part in (cls.name(), name, repr(outside), f"[{declaration.low}, {declaration.high}]", declaration.unit):
            assert part in str(caught.value)


@pytest.mark.parametrize(("cls", "name", "declaration"), CHOICES)
def test_options_are_taken_and_others_are_refused_with_the_nearest(cls, name, declaration):
    for option in declaration.options:
        assert getattr(cls(**{name: option}), name) == option
        with pytest.raises(Invalid) as caught:
            cls(**{name: option + "_"})
        assert str(caught.value).startswith(f"{cls.name()}: {name} = {option + '_'!r} is not a choice")
        assert option in str(caught.value)


# --- what is refused -------------------------------------------------------------------------------------------------

WRONG = [
    ("alpha", 3, "example: alpha = 3 is outside [0.0001, 1.0]"),
    ("alpha", (0.5, 0.0), "alpha = (0.5, 0.0) is outside [0.0001, 1.0]"),
    ("alpha", (0.5,), "alpha = (0.5,) has 1 values; 2 expected"),
    ("alpha", [0.5, 0.5, 0.5], "has 3 values; 2 expected"),
    ("alpha", np.full(3, 0.5), "has 3 values; 2 expected"),
    ("alpha", (), "has 0 values; 2 expected"),
    ("alpha", (0.5, "x"), "alpha = (0.5, 'x') is not a number each"),
    ("alpha", "0.5", "is not a number"),
    ("alpha", None, "alpha = None is not a number"),
    ("alpha", {"x": 1}, "is not a number"),
    ("alpha", ((0.5, 0.5), 0.5), "is not a number"),
    ("tau", -1e-9, "tau = -1e-09 is outside [0.0, 20.0] nm"),
    ("tau", float("nan"), "tau = nan is outside"),
    ("tau", float("inf"), "tau = inf is outside"),
    ("tau", -np.inf, "tau = -inf is outside"),
    ("tau", 10**400, "is outside"),
    ("tau", True, "tau = True is not a number"),
    ("tau", 1 + 2j, "is not a number"),
    ("tau", (1.0, 2.0), "has 2 values; 1 expected"),
    ("count", 2.0, "count = 2.0 is not a whole number"),
    ("count", np.float64(2), "is not a whole number"),
    ("count", True, "is not a whole number"),
    ("count", 9, "count = 9 is outside [1, 8]"),
    ("ndf", "beckman", "example: ndf = 'beckman' is not a choice; did you mean beckmann?"),
    ("ndf", "phong", "ndf = 'phong' is not a choice; there are: ggx, beckmann"),
    ("ndf", None, "ndf = None is not a choice"),
    ("ndf", ["ggx"], "is not a choice"),
    ("file", 3, "file = 3 is not text"),
]


@pytest.mark.parametrize(("name", "value", "message"), WRONG)
def test_what_is_wrong_is_said_in_one_line(name, value, message):
    with pytest.raises(Invalid) as caught:
        Example(**{name: value})
    assert message in str(caught.value)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 250


def test_replacing_a_value_checks_it():
    with pytest.raises(Invalid, match="tau = 21"):
        replace(Example(), tau=21)


def test_unknown_field_is_refused():
    with pytest.raises(TypeError, match="aplha"):
        Example(aplha=0.3)


def test_nearest_name():
    assert nearest("microfacett", MODELS) == "; did you mean microfacet?"
    assert nearest("x", ["ab", "cd"]) == "; there are: ab, cd"


# --- what is taken ---------------------------------------------------------------------------------------------------


def test_one_number_fills_a_pair_or_triple():
    assert Example(alpha=0.5).alpha == (0.5, 0.5)
    assert MODELS["microfacet"](eta=1.5, k=0).k == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "value",
    [(0.25, 1), [0.25, 1], np.array([0.25, 1.0]), np.array([0.25, 1.0], np.float32)],
    ids=lambda v: type(v).__name__,
)
def test_arrays_and_lists_become_tuples_of_float(value):
    alpha = Example(alpha=value).alpha
    assert alpha == (0.25, 1.0) and type(alpha) is tuple and all(type(a) is float for a in alpha)


def test_numbers_become_plain_ones():
    assert type(Example(tau=np.float32(2)).tau) is float and type(Example(tau=2).tau) is float
    assert type(Example(count=np.int64(2)).count) is int


def test_instances_are_frozen_and_compare_by_value():
    with pytest.raises(FrozenInstanceError):
        Example().tau = 2.0
    assert Example(alpha=0.5) == Example(alpha=(0.5, 0.5)) and hash(Example(alpha=0.5)) == hash(
        Example(alpha=[0.5, 0.5])
    )


def test_declarations_by_kind():
    assert list(declared(Example, Param)) == ["alpha", "tau", "count"]
    assert list(declared(Example, Choice)) == ["ndf"] and list(declared(Example(), Text)) == ["file"]
    assert Example().choices() == {"ndf": "ggx"}
    assert [d.glsl for d in declared(Example, Param).values()] == ["vec2", "float", "int"]


# --- there and back --------------------------------------------------------------------------------------------------


def strategy(declaration):
    """Values that a declaration takes."""
    if isinstance(declaration, Choice):
        return st.sampled_from(declaration.options)
    if isinstance(declaration, Text):
        return st.text(st.characters(exclude_categories=["Cs"]))
    if isinstance(declaration.default, int):
        return st.integers(declaration.low, declaration.high)
    number = st.floats(declaration.low, declaration.high)
    return number if declaration.size == 1 else st.tuples(*[number] * declaration.size)


def instances(cls):
    return st.builds(cls, **{name: strategy(d) for name, d in declared(cls).items()})


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__name__)
def test_values_make_the_same_instance(cls):
    @settings(max_examples=50, deadline=None)
    @given(instances(cls))
    def law(instance):
        assert cls(**values(instance)) == instance

    law()


STATES = st.builds(
    State,
    materials=st.tuples(st.builds(Material, st.text('ab é"\n'), st.one_of(*map(instances, MODELS.values())))),
    views=st.fixed_dictionaries({name: instances(view) for name, view in VIEWS.items()}),
    **{name: instances(cls) for name, cls in SECTIONS.items()},
)


@settings(max_examples=50, deadline=None)
@given(STATES)
def test_preset_text_makes_the_same_state(state):
    assert loads(dumps(state)) == state

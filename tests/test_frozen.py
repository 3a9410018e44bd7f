"""Frozen dataclasses behave as those of the standard library."""

import copy
import dataclasses
import inspect
import json
import pickle
from dataclasses import FrozenInstanceError, asdict, field, fields, is_dataclass, replace
from functools import cached_property

import pytest
from hypothesis import given, strategies as st
from pydantic import TypeAdapter

from uictest.core import frozen


def _classes(dataclass):
    """Return classes that use what the package uses."""

    @dataclass(frozen=True, slots=True)
    class Point:
        """A point."""

        x: float
        y: float = 2.0
        names: tuple[str, ...] = ()
        table: dict[str, int] = field(default_factory=dict)
        hidden: float = field(default=0.0, compare=False, repr=False)

        @property
        def length(self) -> float:
            return abs(self.x)

    @dataclass(frozen=True, slots=True, kw_only=True)
    class Named:
        """A base, of keywords alone."""

        name: str = ""
        size: int

    @dataclass(frozen=True, slots=True, kw_only=True)
    class Further(Named):
        """Fields of a base come first."""

        colour: str | None = None

    @dataclass(frozen=True)
    class Cached:
        """With a dictionary."""

        x: float

        def __post_init__(self) -> None:
            if self.x == -1.0:
                raise ValueError("negative")

        @cached_property
        def twice(self) -> float:
            return 2.0 * self.x

    @dataclass(frozen=True, slots=True, eq=False)
    class Same:
        """Equal to itself alone."""

        x: float = 1.0

    @dataclass(frozen=True)
    class Own:
        """With methods of its own."""

        x: float

        def __repr__(self) -> str:
            return "own"

        def __eq__(self, other: object) -> bool:
            return True

        def __hash__(self) -> int:
            return 7

    @dataclass(frozen=True, slots=True)
    class Nothing:
        """Without fields."""

    return {each.__name__: each for each in (Point, Named, Further, Cached, Same, Own, Nothing)}


OURS, THEIRS = _classes(frozen.dataclass), _classes(dataclasses.dataclass)
# Pickle looks classes up by their names.
for _name, _class in OURS.items():
    _class.__qualname__ = _name
globals().update(OURS)
CALLS = {
    "Point": [
        ((1.0,), {}),
        ((1.0, 3.0), {"names": ("a",)}),
        ((float("nan"),), {"table": {"a": 1}}),
        ((), {}),
    ],
    "Named": [((), {"size": 1}), ((), {"size": 1, "name": "a"}), ((1,), {}), ((), {"name": "a"})],
    "Further": [((), {"size": 1}), ((), {"size": 2, "colour": "red"}), ((), {"wrong": 1})],
    "Cached": [((1.0,), {}), ((-1.0,), {}), ((1.0, 2.0), {})],
    "Same": [((), {}), ((2.0,), {})],
    "Own": [((1.0,), {})],
    "Nothing": [((), {}), ((1,), {})],
}


def _made(kind, call):
    try:
        return kind(*call[0], **call[1])
    except (TypeError, ValueError) as error:
        return type(error)


def _pairs():
    for name, calls in CALLS.items():
        for call in calls:
            yield name, _made(OURS[name], call), _made(THEIRS[name], call)


PAIRS = [pair for pair in _pairs() if not isinstance(pair[1], type)]


def test_the_same_arguments_are_accepted():
    for _, ours, theirs in _pairs():
        assert ours is theirs or not (isinstance(ours, type) or isinstance(theirs, type))


@pytest.mark.parametrize("name", OURS)
def test_signatures_and_fields_are_alike(name):
    ours, theirs = OURS[name], THEIRS[name]
    assert str(inspect.signature(ours)) == str(inspect.signature(theirs))
    assert ours.__match_args__ == theirs.__match_args__
    described = [
        [(each.name, each.type, each.default, each.kw_only) for each in fields(one)] for one in (ours, theirs)
    ]
    assert described[0] == described[1]
    assert is_dataclass(ours)
    assert ours.__doc__ == theirs.__doc__
    assert vars(ours).get("__slots__") == vars(theirs).get("__slots__")


@pytest.mark.parametrize(("name", "ours", "theirs"), PAIRS)
def test_objects_are_alike(name, ours, theirs):
    assert repr(ours).rpartition(".")[2] == repr(theirs).rpartition(".")[2]
    assert asdict(ours) == asdict(theirs)
    others = [(each, their) for other, each, their in PAIRS if other == name]
    assert [ours == each for each, _ in others] == [theirs == each for _, each in others]
    assert (ours == theirs) is (name == "Own")
    assert ours == ours
    for twin in (copy.copy(ours), copy.deepcopy(ours), pickle.loads(pickle.dumps(ours)), replace(ours)):
        assert type(twin) is type(ours)
        assert str(asdict(twin)) == str(asdict(ours))
    if name not in ("Point", "Same"):  # a dictionary has no hash
        assert (hash(ours) == hash(replace(ours))) is (hash(theirs) == hash(replace(theirs)))


@pytest.mark.parametrize(("name", "ours", "theirs"), PAIRS)
def test_nothing_can_be_set_or_deleted(name, ours, theirs):
    for one, further in ((ours, ["new"]), (theirs, [])):
        for attribute in [*(each.name for each in fields(one)), *further]:
            with pytest.raises(FrozenInstanceError, match=f"assign to field '{attribute}'"):
                setattr(one, attribute, 1)
            with pytest.raises(FrozenInstanceError, match=f"delete field '{attribute}'"):
                delattr(one, attribute)


def test_what_is_cached_beside_the_fields_stays():
    cached = OURS["Cached"](3.0)
    assert (cached.twice, vars(cached)) == (6.0, {"x": 3.0, "twice": 6.0})


def test_a_factory_makes_a_value_for_each_object():
    first, second = OURS["Point"](1.0), OURS["Point"](1.0)
    assert first == second
    assert first.table is not second.table
    assert hash(OURS["Cached"](1.0)) == hash(OURS["Cached"](1.0))


def test_pydantic_reads_them_alike():
    content = {"x": 1, "names": ["a"], "table": {"b": 2}}
    ours, theirs = (TypeAdapter(each["Point"]).validate_python(content) for each in (OURS, THEIRS))
    assert type(ours) is OURS["Point"]
    assert asdict(ours) == asdict(theirs)
    assert json.loads(TypeAdapter(OURS["Point"]).dump_json(ours)) == asdict(ours) | {"names": ["a"]}


@given(value=st.from_type(OURS["Further"]))
def test_their_annotations_can_be_read(value):
    assert isinstance(value.size, int)

"""Places of keys and values with either parser, scalars of YAML 1.2, merged trees, and messages."""

import math
from pathlib import Path

import pytest
import yaml
from hypothesis import given, strategies as st

from uictest.plans.scenario.yaml.diagnostics import (
    Document,
    Location,
    ScenarioErrors,
    diagnose,
    in_reading_order,
    nearest,
    quoted,
    suggestion,
    visible,
)
from uictest.plans.scenario.yaml.tree import Map, Scalar, as_written, merge, parse, plain, scalar_value

LOADERS = [yaml.SafeLoader, getattr(yaml, "CSafeLoader", yaml.SafeLoader)]


def tree(text):
    return parse(Document("text", Path(), text))


@pytest.mark.parametrize("loader", LOADERS, ids=["python", "libyaml"])
def test_every_key_and_value_has_its_place(loader, monkeypatch):
    monkeypatch.setattr("uictest.plans.scenario.yaml.tree._LOADER", loader)
    root = tree("rail:\n  friction: 0.10\n  'gradient':  5 permille\ntags: [a, on]\n")
    assert isinstance(root, Map)
    rail = root.entries["rail"].node
    assert isinstance(rail, Map)
    friction, gradient = rail.entries["friction"], rail.entries["gradient"]
    assert (friction.key.line, friction.key.column) == (2, 3)
    assert (friction.node.location.line, friction.node.location.column) == (2, 13)
    assert (gradient.key.line, gradient.node.location.column) == (3, 16)
    assert isinstance(friction.node, Scalar)
    assert (friction.node.value, friction.node.text) == (0.1, "0.10")
    assert plain(root) == {"rail": {"friction": 0.1, "gradient": "5 permille"}, "tags": ("a", "on")}


@pytest.mark.parametrize("loader", LOADERS, ids=["python", "libyaml"])
def test_quoted_numbers_and_blocks_are_texts(loader, monkeypatch):
    monkeypatch.setattr("uictest.plans.scenario.yaml.tree._LOADER", loader)
    assert plain(tree("a: '1'\nb: \"true\"\nc: |\n  1\nd: >-\n  2\n")) == {
        "a": "1",
        "b": "true",
        "c": "1\n",
        "d": "2",
    }


def test_a_byte_order_mark_is_no_character_and_a_piece_keeps_its_place_in_the_whole():
    assert plain(tree("\ufeffname: x\n")) == {"name": "x"}
    document = Document("--set", Path(), "rail.friction=0.1,[")
    with pytest.raises(ScenarioErrors) as caught:
        parse(document, 1, 19, "[")
    assert caught.value.diagnostics[0].column >= 19


@given(st.text())
def test_any_text_is_a_tree_or_refused_with_a_place_in_it(text):
    try:
        tree(text)
    except ScenarioErrors as errors:
        for each in errors.diagnostics:
            assert each.line >= 1
            assert each.column >= 1
            assert str(each).replace("\n", "").isprintable()


@pytest.mark.parametrize("text", ['a: "x\\0.yaml"', '"a\\0": 1', 'a: ["\\x00"]'])
def test_an_escaped_nul_is_refused_at_its_place(text):
    """The system takes no path that has one."""
    with pytest.raises(ScenarioErrors, match=r"text:1:\d+: character '\\x00' is not accepted") as caught:
        tree(text)
    assert caught.value.salvaged is None


@pytest.mark.parametrize(
    "text", ["on", "off", "yes", "no", "y", "12:30", "1_000", "0b11", "2026-01-01", "1e"]
)
def test_what_yaml_1_1_would_convert_is_a_text(text):
    assert scalar_value(text) == text


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e3", 1000.0),
        ("1", 1),
        ("010", 10),
        ("0o10", 8),
        ("0xff", 255),
        ("-.5", -0.5),
        ("5.", 5.0),
        ("true", True),
        ("False", False),
        ("~", None),
        ("", None),
        ("-.inf", -math.inf),
    ],
)
def test_core_schema(text, value):
    assert scalar_value(text) == value
    assert type(scalar_value(text)) is type(value)


def test_numbers_that_are_none_or_too_long_are_numbers():
    assert math.isnan(float(str(scalar_value(".nan"))))
    assert scalar_value("9" * 10_000) == math.inf


def test_trees_merge_map_by_map_and_are_written_as_one_line():
    merged = merge(tree("{a: {b: 1, c: 2}, d: [1, 2], e: 1}"), tree("{a: {c: 3}, d: [4], f: 5}"))
    assert plain(merged) == {"a": {"b": 1, "c": 3}, "d": (4,), "e": 1, "f": 5}
    merged = merge(tree("{mass: {value: 30 t, source: maker}}"), tree("{mass: 31 t}"))
    marked = merge(tree("{mass: {value: 30 t, source: maker}}"), tree("{mass: {value: 31 t}}"))
    assert plain(merged) == {"mass": "31 t"}
    assert plain(marked) == {"mass": {"value": "31 t"}}
    assert as_written(tree("a:\n  - 0.10\n  - {b: 5 bar}\n")) == "{a: [0.10, {b: 5 bar}]}"


def place(text, line, column, display="a.yaml"):
    return Location(Document(display, Path(), text), line, column)


def test_a_message_shows_place_line_caret_and_hint():
    diagnostic = diagnose(place("x\nspeed: 120\n", 2, 8), "'120' has no unit", "speed", "write 120 km/h")
    assert str(diagnostic) == (
        "a.yaml:2:8: speed: '120' has no unit\n    2 | speed: 120\n      |        ^\n      = write 120 km/h"
    )
    for line, column in (("a\t\x1b[2J b: 1", 8), ("\u65e5\u672c b: 1", 4), ("x" * 500 + "b", 501)):
        excerpt, caret = diagnose(place(line, 1, column), "wrong").excerpt.split("\n")
        wide = sum(char > "\u2000" for char in excerpt)
        assert excerpt[len(caret) - 1 - wide] == "b"


def test_each_error_is_told_once_down_each_file_in_turn():
    diagnostic = diagnose(place("a", 1, 1), "wrong")
    assert ScenarioErrors([diagnostic, diagnostic]).diagnostics == (diagnostic,)
    second, first = diagnose(place("a\nb", 2, 1), "x"), diagnose(place("a\nb", 1, 1), "y")
    other = diagnose(place("a", 1, 1, "b.yaml"), "z")
    assert in_reading_order([second, other, first]) == [first, second, other]


def test_escapes_name_the_character_also_in_the_name_of_a_file():
    assert visible("a\x07\u202eb\U000e0001") == "a\\x07\\u202eb\\U000e0001"
    assert quoted("x" * 100) == "'" + "x" * 57 + "...'"
    assert str(diagnose(place("", 1, 1, "\x1b[31m\u202e.yaml"), "wrong")).startswith(
        "\\x1b[31m\\u202e.yaml:1:1:"
    )


def test_the_nearest_name_is_found_in_any_case_of_letters():
    assert nearest("Intercity-108", ["crh380a", "intercity-180"]) == "intercity-180"
    assert nearest("zzz", ["crh380a"]) is None
    assert suggestion("zzz", ["b", "a"]) == "accepted: a, b"

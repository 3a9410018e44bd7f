"""Places of keys and values with either implementation of the parser, scalars of YAML 1.2, merged trees."""

import math
from pathlib import Path

import pytest
import yaml
from hypothesis import given, strategies as st

from uictest.plans.scenario import ScenarioErrors
from uictest.plans.scenario.yaml.diagnostics import Document
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


def test_a_byte_order_mark_is_no_character_of_the_first_key():
    assert plain(tree("\ufeffname: x\n")) == {"name": "x"}


def test_a_piece_keeps_its_place_in_the_whole():
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


def test_not_a_number_is_a_number():
    assert math.isnan(float(str(scalar_value(".nan"))))


def test_thousands_of_digits_are_no_integer():
    assert scalar_value("9" * 10_000) == math.inf


def test_maps_merge_and_lists_replace():
    merged = merge(tree("{a: {b: 1, c: 2}, d: [1, 2], e: 1}"), tree("{a: {c: 3}, d: [4], f: 5}"))
    assert plain(merged) == {"a": {"b": 1, "c": 3}, "d": (4,), "e": 1, "f": 5}


def test_a_changed_number_does_not_keep_the_source_of_the_old_one():
    merged = merge(tree("{mass: {value: 30 t, source: maker}}"), tree("{mass: 31 t}"))
    marked = merge(tree("{mass: {value: 30 t, source: maker}}"), tree("{mass: {value: 31 t}}"))
    assert plain(merged) == {"mass": "31 t"}
    assert plain(marked) == {"mass": {"value": "31 t"}}


def test_a_node_is_written_as_one_line():
    assert as_written(tree("a:\n  - 0.10\n  - {b: 5 bar}\n")) == "{a: [0.10, {b: 5 bar}]}"

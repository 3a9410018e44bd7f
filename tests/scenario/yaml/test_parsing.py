"""Places of keys and values, with either implementation of the parser."""

from pathlib import Path

import pytest
import yaml
from hypothesis import given, strategies as st

from uictest.plans.scenario import ScenarioErrors
from uictest.plans.scenario.yaml import parsing
from uictest.plans.scenario.yaml.parsing import parse
from uictest.plans.scenario.yaml.tree import Document, Map, Scalar, plain

LOADERS = [yaml.SafeLoader, getattr(yaml, "CSafeLoader", yaml.SafeLoader)]


def tree(text):
    return parse(Document("text", Path(), text))


@pytest.mark.parametrize("loader", LOADERS, ids=["python", "libyaml"])
def test_every_key_and_value_has_its_place(loader, monkeypatch):
    monkeypatch.setattr(parsing, "_LOADER", loader)
    root = tree("rail:\n  friction: 0.10\n  'gradient':  5 permille\ntags: [a, on]\n")
    assert isinstance(root, Map)
    rail = root.entries["rail"].node
    assert isinstance(rail, Map)
    friction, gradient = rail.entries["friction"], rail.entries["gradient"]
    assert (friction.key.line, friction.key.column) == (2, 3)
    assert (friction.node.place.line, friction.node.place.column) == (2, 13)
    assert (gradient.key.line, gradient.node.place.column) == (3, 16)
    assert isinstance(friction.node, Scalar)
    assert (friction.node.value, friction.node.text) == (0.1, "0.10")
    assert plain(root) == {"rail": {"friction": 0.1, "gradient": "5 permille"}, "tags": ("a", "on")}


@pytest.mark.parametrize("loader", LOADERS, ids=["python", "libyaml"])
def test_quoted_numbers_and_blocks_are_texts(loader, monkeypatch):
    monkeypatch.setattr(parsing, "_LOADER", loader)
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

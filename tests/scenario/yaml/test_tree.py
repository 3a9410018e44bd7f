"""Merging: maps merge, everything else is replaced."""

from pathlib import Path

from uictest.plans.scenario.yaml.parsing import parse
from uictest.plans.scenario.yaml.tree import Document, as_written, merge, plain


def tree(text):
    return parse(Document("text", Path(), text))


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

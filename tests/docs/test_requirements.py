"""Requirements are numbered without a gap; their tests exist, and the error analysis leads to them."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "requirements.md"
ERRORS = PAGE.with_name("tool-errors.md")
_ROW = re.compile(r"^\| (TOOL-\d+): ([^|]+) \| ([^|]+) \|$", re.MULTILINE)
_TEST = re.compile(r"\[(test_\w+)\]\(([^)]+\.py)\)")
ROWS = {match[1]: (match[2], match[3]) for match in _ROW.finditer(PAGE.read_text("utf-8"))}


@cache
def names_in(path):
    tree = ast.parse(path.read_text("utf-8"))
    return frozenset(node.name for node in tree.body if isinstance(node, ast.FunctionDef))


def test_requirements_are_numbered_without_a_gap_and_each_once():
    assert list(ROWS) == [f"TOOL-{number}" for number in range(1, len(ROWS) + 1)]
    assert len(_ROW.findall(PAGE.read_text("utf-8"))) == len(ROWS) > 20


@pytest.mark.parametrize("requirement", ROWS)
def test_the_tests_of_a_requirement_exist(requirement):
    named = _TEST.findall(ROWS[requirement][1])
    assert named, f"{requirement} names no test"
    assert len(named) == ROWS[requirement][1].count("[")
    for name, link in named:
        assert name in names_in((PAGE.parent / link).resolve()), f"{requirement}: no {name} in {link}"


FUNCTIONS = [line for line in ERRORS.read_text("utf-8").splitlines() if line.startswith("| ")][1:]
_COLUMNS = 4
_NUMBER = re.compile(r"TOOL-\d+")


def test_every_function_of_the_tool_says_how_it_could_lie_what_finds_it_and_what_remains():
    cells = [[cell.strip() for cell in row.strip("|").split("|")] for row in FUNCTIONS]
    assert len(cells) > 15
    assert all(len(row) == _COLUMNS and all(row) for row in cells)
    assert [row[0] for row in cells if not _NUMBER.search(row[2])] == []


def test_the_error_analysis_names_every_requirement_and_no_other():
    assert set(_NUMBER.findall(ERRORS.read_text("utf-8"))) == set(ROWS)


def test_the_error_analysis_names_no_test_that_no_requirement_has():
    assert _TEST.findall(ERRORS.read_text("utf-8")) == []

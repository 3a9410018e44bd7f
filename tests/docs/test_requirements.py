"""What the tool must never do has a test that exists, and so has every function of the error analysis."""

import ast
import re
from functools import cache
from pathlib import Path

PAGE = Path(__file__).parents[2] / "docs" / "requirements.md"
ERRORS = PAGE.with_name("tool-errors.md")
_TEST = re.compile(r"\[(test_\w+)\]\(([^)]+\.py)\)")


@cache
def names_in(path):
    tree = ast.parse(path.read_text("utf-8"))
    return frozenset(node.name for node in tree.body if isinstance(node, ast.FunctionDef))


def rows(page):
    """Return the cells of every row of the tables of a page but their heads."""
    lines = re.findall(r"^\| (.+) \|$", page.read_text("utf-8"), re.MULTILINE)
    return [[cell.strip() for cell in line.split(" | ")] for line in lines][1:]


REQUIREMENTS, FUNCTIONS = rows(PAGE), rows(ERRORS)


def test_each_requirement_stands_once_and_has_one_test():
    assert len({requirement for requirement, _ in REQUIREMENTS}) == len(REQUIREMENTS) > 10
    assert [row for row in REQUIREMENTS if len(_TEST.findall(row[1])) != 1 or row[1].count("[") != 1] == []


def test_the_tests_that_are_named_exist(page):
    for name, link in _TEST.findall(page.read_text("utf-8")):
        assert name in names_in((page.parent / link).resolve()), f"no {name} in {link}"


def test_every_function_of_the_tool_says_how_it_could_lie_what_finds_it_and_what_remains():
    assert len(FUNCTIONS) > 15
    assert all(len(row) == 4 and all(row) for row in FUNCTIONS)
    assert [row[0] for row in FUNCTIONS if not _TEST.search(row[2])] == []

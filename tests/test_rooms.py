"""How the rooms of the package depend on each other."""

import ast
import re
import sys
from functools import cache
from graphlib import TopologicalSorter
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

import uictest

PACKAGE = Path(uictest.__file__).parent
LONGEST = 500
"""Lines that a file may have: beyond, it holds two ideas."""


def module_name(path):
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_name(path): path for path in PACKAGE.rglob("*.py")}
FACES = {
    name: path.with_suffix(".pyi") for name, path in MODULES.items() if path.with_suffix(".pyi").is_file()
}


def room(module):
    """Return the room or the module of the top level that a module belongs to."""
    return ".".join(module.split(".")[:2])


COMPOSED = ("analysis", "core", "judging", "plans", "recorded", "running")
"""Rooms without a face of their own: each of their parts has one."""


def part(module):
    """Return the room that a module belongs to, or its part where the room is composed."""
    words = module.split(".")
    return ".".join(words[: 3 if words[1:2] and words[1] in COMPOSED else 2])


@cache
def names_of_face(module):
    """Return the names that a face offers, none where a module is no face."""
    if module not in FACES:
        return []
    nodes = ast.parse(FACES[module].read_text("utf-8")).body
    return [alias.name for node in nodes if isinstance(node, ast.ImportFrom) for alias in node.names]


@cache
def imports(module):
    """Return the modules of the package that a module imports anywhere, for types alone included."""
    return frozenset(_imports(ast.parse(MODULES[module].read_text("utf-8"))))


def _imports(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "uictest":
            for alias in node.names:
                name = f"{node.module}.{alias.name}"
                of_a_face = alias.name in names_of_face(str(node.module))
                yield name if name in MODULES and not of_a_face else str(node.module)


def test_rooms_import_each_other_by_their_faces():
    past_the_face = [
        f"{module} imports {imported}"
        for module in MODULES
        for imported in imports(module)
        if part(imported) not in (part(module), "uictest")
        and imported not in FACES
        and imported != part(imported)
    ]
    assert past_the_face == []


@pytest.mark.parametrize("unit", [room, part, str], ids=["rooms", "parts", "modules"])
def test_imports_run_in_one_direction(unit):
    graph = {}
    for module in MODULES:
        needed = {unit(imported) for imported in imports(module)} - {unit(module), "uictest"}
        graph.setdefault(unit(module), set()).update(needed)
    # Raises CycleError, which names the circle.
    assert len(list(TopologicalSorter(graph).static_order())) > 1


def listed_parts():
    """Yield the rooms, and the parts of composed ones, in the order of the list for contributors."""
    above = ""
    for indent, names in re.findall(
        r"^(    |      )((?:\w+(?:/|\.py) )+)",
        (PACKAGE.parents[1] / "CONTRIBUTING.md").read_text("utf-8"),
        re.MULTILINE,
    ):
        for name in re.findall(r"\w+(?=/|\.py)", names):
            above = name if len(indent) == 4 else above
            if len(indent) == 4 and name not in COMPOSED:
                yield f"uictest.{name}"
            elif len(indent) == 6 and above in COMPOSED:
                yield f"uictest.{above}.{name}"


def test_the_list_of_rooms_names_each_and_imports_run_down_it():
    listed = list(listed_parts())
    parts = {part(module) for module in MODULES} - {"uictest", *(f"uictest.{name}" for name in COMPOSED)}
    assert sorted(listed) == sorted(parts)
    upwards = [
        f"{module} imports {imported}"
        for module in MODULES
        for imported in imports(module)
        if part(module) in parts and part(imported) in parts
        if listed.index(part(imported)) < listed.index(part(module))
    ]
    assert upwards == []


@pytest.mark.parametrize("face", FACES)
def test_every_name_of_a_face_is_there(face):
    names = names_of_face(face)
    module = import_module(face)
    assert sorted(module.__all__) == sorted(names)
    assert [name for name in names if not resolves(module, name)] == []


def resolves(module, name):
    """Return whether a name of a face leads somewhere; one that needs an extra may lack the extra."""
    try:
        return hasattr(module, name)
    except ModuleNotFoundError as error:
        return not str(error.name).startswith("uictest")


def test_no_file_is_too_long():
    lengths = {name: len(path.read_text("utf-8").splitlines()) for name, path in MODULES.items()}
    assert {name: length for name, length in lengths.items() if length > LONGEST} == {}


def test_every_room_can_be_mutated_and_has_tests():
    """`scripts/mutate.py` finds the code of each room and what tests it."""
    script = spec_from_file_location("mutate", PACKAGE.parents[1] / "scripts/mutate.py")
    assert script is not None
    assert script.loader is not None
    mutate = sys.modules[script.name] = module_from_spec(script)
    script.loader.exec_module(mutate)
    rooms = {module.split(".")[1] for module in MODULES if module.count(".")} - {"__main__"}
    assert set(mutate.rooms()) == rooms
    assert [room for room in mutate.rooms() if not mutate.tests_of(room)] == []

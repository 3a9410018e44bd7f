"""What sets the manifests of two sweeps apart, in words."""

import ast
from pathlib import Path

import pytest

import uictest
from uictest.plans.sweeps import load_sweep
from uictest.running.chunked import CaseSelection, sweep_manifest
from uictest.running.chunked.store import SOURCES, manifest_differences

PACKAGE = Path(uictest.__file__).parent
WITHOUT_INFLUENCE = {"report"}
"""Rooms that write what was found."""


def manifest(plan):
    return sweep_manifest(CaseSelection(plan), expression=None, overrides=(), seed=None)


def test_a_sweep_has_one_manifest_from_every_working_folder(load, monkeypatch):
    here = manifest(load())
    Path("below").mkdir()
    for folder, file in (("below", "../study.sweep.yaml"), ("/", str(Path("study.sweep.yaml").absolute()))):
        monkeypatch.chdir(folder)
        there = manifest(load_sweep(Path(file)))
        assert list(manifest_differences(here, there)) == []
        assert {**there, "file": here["file"]} == here
        monkeypatch.chdir(Path(file).absolute().parent)


def test_a_comment_in_the_sweep_file_changes_no_case(load):
    def of(text):
        Path("again.sweep.yaml").write_text(f"{Path('study.sweep.yaml').read_text()}{text}")
        return manifest(load_sweep(Path("again.sweep.yaml")))

    load("sample: {size: 8, parameters: {rail.friction: {uniform: [0.1, 0.2]}}}\n")
    plain, explained = of(""), of("# drawn alike\n")
    assert plain["inputs"] != explained["inputs"]
    assert list(manifest_differences(plain, explained)) == []
    Path("study.sweep.yaml").write_text(Path("study.sweep.yaml").read_text().replace("0.2]", "0.21]"))
    assert list(manifest_differences(plain, of(""))) == ["the cases that the sweep file asks for"]


def test_files_of_one_name_in_two_folders_are_told_apart():
    inputs = {"left/a.csv": "1", "right/a.csv": "2"}
    exchanged = {"left/a.csv": "2", "right/a.csv": "1"}
    assert list(manifest_differences({"inputs": inputs}, {"inputs": exchanged})) == [
        "inputs: left/a.csv, right/a.csv"
    ]


@pytest.mark.parametrize(
    ("name", "one", "other", "message"),
    [
        ("cases", 10, 16, "cases: 10 before, 16 now"),
        ("cases_in_a_part", 16, 32, "cases per chunk: 16 before, 32 now"),
        ("seed", None, 7, "seed: none before, 7 now"),
        ("selected", "wet and cold", None, "selection: wet and cold before, none now"),
        ("set", [], ["a=1", "b=2"], "set: none before, a=1 and b=2 now"),
        ("parameters", ["a", "b", "c"], ["d"], "parameters: a, b and c before, d now"),
        ("versions", {"numpy": "1", "scipy": "1"}, {"numpy": "2", "scipy": "1"}, "versions: numpy"),
        ("program", "1", "2", "the program itself"),
    ],
)
def test_differences_are_named_as_users_know_them(name, one, other, message):
    assert list(manifest_differences({name: one}, {name: other})) == [message]


def imported_rooms(path):
    """Return the rooms and modules of the top level that a module imports."""
    rooms = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module == "uictest":
            rooms |= {alias.name for alias in node.names if alias.name != "__version__"}
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("uictest."):
            rooms.add(str(node.module).split(".")[1])
    return rooms


def test_the_digest_of_the_program_covers_what_its_sources_import():
    covered = {name.removesuffix(".py") for name in SOURCES}
    modules = [
        path
        for name in SOURCES
        for path in ([PACKAGE / name] if name.endswith(".py") else (PACKAGE / name).rglob("*.py"))
    ]
    imported = set().union(*map(imported_rooms, modules))
    assert imported <= covered | WITHOUT_INFLUENCE

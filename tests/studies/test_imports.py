"""The studies use the public interface of the package, and behind it only what it does not offer."""

import ast
import re
from pathlib import Path

import uictest

SOURCES = Path(uictest.__file__).parents[1]
STUDIES = Path(__file__).parents[2] / "studies"
BEHIND = {
    "uictest.rig.bench",
    "uictest.rig.identification",
    "uictest.rig",
    "uictest.plans.scenario",
    "uictest.report",
    "uictest.report.page",
    "uictest.core.files",
    "uictest.rig.kernel.arguments",
    "uictest.rig.kernel.library",
}
"""Rooms behind the public interface; studies/README.md says what each is needed for."""
LONGEST = 300
FILES = sorted(STUDIES.rglob("*.py"))


def imported(path):
    """Yield the modules of the package that a file imports; for a public name, the package."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (each.name for each in node.names if each.name.startswith("uictest"))
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("uictest"):
            for each in node.names:
                name = f"{node.module}.{each.name}"
                yield name if Path(SOURCES, *name.split(".")).is_dir() else str(node.module)


def test_studies_import_the_public_interface_and_the_rooms_behind_it_that_the_readme_names():
    found = {name for path in FILES if path.name != "survey_step.py" for name in imported(path)}
    assert found - {"uictest", "uictest.units"} == BEHIND
    text = (STUDIES / "README.md").read_text("utf-8")
    assert {name for name in BEHIND if f"`{name.removesuffix('.page')}`" not in text} == set()


def test_the_independent_rig_has_no_code_of_the_rig():
    files = sorted((STUDIES / "independent").glob("*.py"))
    assert len(files) > 3
    assert {name for path in files for name in imported(path)} == {"uictest"}


def test_public_names_are_those_that_the_package_offers():
    names = {
        each.name
        for path in FILES
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.ImportFrom) and node.module == "uictest"
        for each in node.names
    }
    assert names - {"rig", "report"} <= set(uictest.__all__)


def test_the_package_imports_no_study():
    importing = re.compile(r"^\s*(from|import) studies\b", re.MULTILINE)
    package = Path(uictest.__file__).parent
    assert [path for path in package.rglob("*.py") if importing.search(path.read_text("utf-8"))] == []


def test_no_file_is_too_long():
    assert {path.name for path in FILES if len(path.read_text("utf-8").splitlines()) > LONGEST} == set()

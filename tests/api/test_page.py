"""docs/python.md: every public name and argument is there, and its examples are typed."""

import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import uictest

REPOSITORY = Path(__file__).parents[2]
PAGE = (REPOSITORY / "docs" / "python.md").read_text("utf-8")
FUNCTIONS = [name for name in uictest.__all__ if name.islower()]
CLASSES = {name: getattr(uictest, name) for name in ("Results", "SweepResults", "Validation", "Recording")}
MISUSE = """import uictest

cases: int = uictest.load("stop.yaml")
uictest.run("stop.yaml", record="sometimes")
uictest.simulate("stop.yaml", rate=100)
uictest.run("stop.yaml").frames()
"""


def words(text):
    return set(re.findall(r"\w+", text))


@pytest.mark.parametrize("name", uictest.__all__)
def test_every_public_name_is_on_the_page(name):
    assert f"`{name}`" in PAGE or f"`uictest.{name}" in PAGE or f"a `{name}`" in PAGE


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_argument_is_on_the_page_and_in_the_docstring(name):
    function = getattr(uictest, name)
    arguments = set(inspect.signature(function).parameters)
    (signature,) = re.findall(rf"`uictest\.{name}\(([^`]*)\)`", PAGE)
    assert arguments == {each.partition("=")[0].strip(" *\n") for each in split(signature)} - {""}
    assert arguments - words(function.__doc__) == set()


def split(signature):
    """Return the arguments of a signature, at commas outside brackets."""
    return re.split(r",\s*(?![^()]*\))", signature)


@pytest.mark.parametrize(("name", "public"), CLASSES.items())
def test_every_member_is_on_the_page(name, public):
    members = {member for member in vars(public) if not member.startswith("_")} - {"read"}
    assert members - words(PAGE) == set(), name


def test_scripts_are_checked_in_strict_mode(tmp_path):
    sys.path.insert(0, str(REPOSITORY / "docs" / "tools"))
    try:
        from markup import blocks
    finally:
        sys.path.pop(0)
    scripts = {block.file_name: block.text for block in blocks(PAGE, "python")} | {"misuse.py": MISUSE}
    for name, text in scripts.items():
        (tmp_path / name).write_text(text)
    # The cache and the strict configuration of the repository, whose modules the scripts import.
    options = [f"--config-file={REPOSITORY / 'pyproject.toml'}", f"--cache-dir={REPOSITORY / '.mypy_cache'}"]
    mypy = [sys.executable, "-m", "mypy", "--no-error-summary", *options, *scripts]
    done = subprocess.run(mypy, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stderr == ""
    errors = [line for line in done.stdout.splitlines() if ": error:" in line]
    assert [line.split(":")[:2] for line in errors] == [["misuse.py", f"{number}"] for number in (3, 4, 5, 6)]

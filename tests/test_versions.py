"""The versions of packages that a release was tested with, and the ends of those that it allows."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import uictest

REPOSITORY = Path(__file__).parents[1]
CONSTRAINTS = Path(uictest.__file__).with_name("constraints.txt")
_LINE = re.compile(r"([a-z0-9-]+)==([0-9][0-9a-z.+!]*)")


def test_the_constraints_name_versions_and_nothing_else():
    """No path of a machine, no host of a registry."""
    lines = CONSTRAINTS.read_text("utf-8").splitlines()
    assert all(_LINE.fullmatch(line) for line in lines)
    names = [line.partition("==")[0] for line in lines]
    assert names == sorted(set(names))


def test_the_constraints_hold_a_version_of_every_package_that_is_allowed():
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    of_use = [each for name in extras if name not in ("dev", "docs") for each in extras[name]]
    tested = dict(line.split("==") for line in CONSTRAINTS.read_text("utf-8").splitlines())
    for text in (*project["dependencies"], *of_use):
        needed = Requirement(text)
        assert needed.specifier.contains(tested[canonicalize_name(needed.name)]), text


@pytest.mark.slow
@pytest.mark.parametrize("versions", ["oldest", "newest"])
def test_the_package_works_with_other_versions(versions):
    """Downloads every package; takes some ten minutes."""
    command = [sys.executable, REPOSITORY / "scripts" / "try_versions.py", versions]
    assert subprocess.run(command, check=False).returncode == 0

"""A version, stated in one place; the last release, named alike everywhere; what it was tested with."""

import re
import shutil
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

import uictest

REPOSITORY = Path(__file__).parents[1]
VERSION = uictest.__version__
_NAMED = re.compile(r"(?:uictest@v|rev: v|uictest-)(\d+\.\d+\.\d+)")


def read(name):
    return (REPOSITORY / name).read_text("utf-8")


_HEADINGS = re.findall(r"^## \[(\S+)\](?: - (\d{4}-\d{2}-\d{2}))?$", read("CHANGELOG.md"), re.MULTILINE)
RELEASED, DATE = next(each for each in _HEADINGS if each[0] != "Unreleased")


def test_the_installed_version_is_that_of_the_sources():
    assert metadata.version("uictest") == VERSION


def test_a_build_with_unreleased_changes_has_a_version_that_no_release_has():
    if _HEADINGS[0][0] == "Unreleased":
        assert Version(VERSION).is_devrelease
        assert Version(VERSION) > Version(RELEASED)
    else:
        assert VERSION == RELEASED


def test_the_known_errors_are_those_of_this_version_and_say_whether_it_is_a_release():
    page = read("docs/known-errors.md")
    assert re.findall(r"^## (\d\S*)$", page, re.MULTILINE)[0] == VERSION
    said = f"This build is not a release: it differs from {RELEASED} by"
    assert (said in page) == Version(VERSION).is_devrelease


def test_the_release_is_cited_with_its_date():
    citation = yaml.safe_load(read("CITATION.cff"))
    assert (citation["version"], str(citation["date-released"])) == (RELEASED, DATE)


@pytest.mark.parametrize("name", ["docs/ci.md", "docs/trust.md", "examples/ci/github.yml", "scripts/sbom.py"])
def test_what_users_copy_names_the_release(name):
    assert set(_NAMED.findall(read(name))) == {RELEASED}


@pytest.fixture(scope="session")
def distributions(tmp_path_factory):
    """A folder with the sdist and the wheel that is built from it."""
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run([sys.executable, "-m", "build", "--outdir", folder, REPOSITORY], check=True)
    return folder


@pytest.fixture(params=[f"python3.{minor}" for minor in range(11, 16)])
def python(request):
    """A Python of this machine that can run uictest."""
    found = shutil.which(request.param)
    # A shim of a version manager can be there without its version.
    if not found or subprocess.run([found, "-V"], capture_output=True, check=False).returncode != 0:
        pytest.skip(f"no {request.param}")
    return found


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".whl", ".tar.gz"])
def test_it_works_in_a_clean_environment(distributions, tmp_path, python, suffix):
    [package] = (each for each in distributions.iterdir() if each.name.endswith(suffix))
    subprocess.run([python, "-m", "venv", tmp_path / "env"], check=True)
    programs = tmp_path / "env" / "bin"
    subprocess.run([programs / "python", "-m", "pip", "install", "--quiet", package], check=True)
    work = tmp_path / "work"
    work.mkdir()
    for arguments in (["init"], ["check", "scenarios"], ["run", "scenarios"], ["selftest"]):
        subprocess.run([programs / "uictest", *arguments], cwd=work, check=True)
    page = (work / "reports" / "latest" / "index.html").read_text("utf-8")
    assert "var uPlot=" in page  # which comes with another package
    shown = subprocess.run([programs / "uictest", "--version"], capture_output=True, text=True, check=True)
    assert shown.stdout == f"uictest {VERSION}\n"


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

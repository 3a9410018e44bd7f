"""Versions of packages without `importlib.metadata`, and when that is loaded."""

import subprocess
import sys
from importlib import metadata

import pytest

from uictest.core.distributions import distribution_version

DEFERRED = """
import sys
from uictest.cli.start import defer_metadata
defer_metadata()
from importlib.metadata import entry_points
import importlib.metadata
import importlib.metadata as metadata
assert "email" not in sys.modules
assert not hasattr(metadata, "__wrapped__")
assert "email" not in sys.modules
USE
assert "email" in sys.modules
assert sys.modules["importlib.metadata"].version("numpy") == metadata.version("numpy")
from importlib.metadata import PackageNotFoundError, distribution
assert distribution("numpy").version == metadata.version("numpy")
"""


@pytest.mark.parametrize(
    "name", ["uictest", "numpy", "numba", "PyYAML", "typing-extensions", "typing_extensions"]
)
def test_a_version_is_that_of_the_metadata(name):
    assert distribution_version(name) == metadata.version(name)


def test_another_form_of_metadata_is_read_too(tmp_path, monkeypatch):
    (tmp_path / "acme.egg-info").write_text("Metadata-Version: 1.0\nName: acme\nVersion: 1.5\n", "utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    assert distribution_version.__wrapped__("acme") == "1.5"


def test_what_is_not_installed_has_no_version():
    with pytest.raises(metadata.PackageNotFoundError):
        distribution_version("uictest-of-nobody")


@pytest.mark.parametrize(
    "use",
    ["entry_points(group='none')", "importlib.metadata.version('numpy')", "metadata.distribution('numpy')"],
)
def test_metadata_are_loaded_when_they_are_used(use):
    program = DEFERRED.replace("USE", use)
    subprocess.run([sys.executable, "-c", program], check=True)

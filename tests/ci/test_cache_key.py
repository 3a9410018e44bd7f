"""The key of a CI cache changes with what compiled code depends on."""

import re
import runpy
from importlib import metadata
from types import SimpleNamespace

import pytest
from llvmlite import binding

from .conftest import REPOSITORY


@pytest.fixture
def key(capsys):
    """Return what the action adds to its outputs."""

    def printed():
        runpy.run_path(str(REPOSITORY / "scripts" / "cache_key.py"), run_name="__main__")
        return capsys.readouterr().out

    return printed


def test_the_key_names_version_files_and_processor(key, monkeypatch):
    first = key()
    assert re.fullmatch(rf"key=uictest-{metadata.version('uictest')}-[0-9a-f]{{12}}-[0-9a-f]{{12}}\n", first)
    assert key() == first
    monkeypatch.setattr(binding, "get_host_cpu_name", lambda: "another")
    other = key()
    assert other.rpartition("-")[0] == first.rpartition("-")[0]
    assert other != first
    installed = metadata.distribution

    def with_other_files(name):
        return SimpleNamespace(version=installed(name).version, read_text=lambda file: "other files")

    monkeypatch.setattr(metadata, "distribution", with_other_files)
    assert key().rpartition("-")[0] != first.rpartition("-")[0]

"""Controllers in Python files: how a file becomes a module."""

import hashlib
import json
import sys

import pytest

from uictest.controllers import ControllerError, ControllerProgram, open_controller

TEXT = """
from dataclasses import dataclass
from typing import ClassVar


@dataclass
class Wsp:
    config: object
    cycles: ClassVar[int] = 0

    def reset(self): ...
    def step(self, inputs): ...
"""


def program(path, name="Wsp"):
    path.write_text(TEXT, "utf-8")
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return ControllerProgram("python", str(path), digest, options={"class": name})


@pytest.fixture(autouse=True)
def _forgotten(tmp_path, monkeypatch):
    """Begin without a module called wsp, and leave no module of the test behind."""
    monkeypatch.delitem(sys.modules, "wsp", raising=False)
    monkeypatch.setattr(sys, "path", list(sys.path))
    yield
    for name, module in list(sys.modules.items()):
        if str(getattr(module, "__file__", "")).startswith(str(tmp_path)):
            del sys.modules[name]


def test_a_file_takes_the_place_of_no_other_module(tmp_path, config):
    (tmp_path / "other").mkdir()
    for path in (tmp_path / "json.py", tmp_path / "wsp.py", tmp_path / "other" / "wsp.py"):
        open_controller(program(path), config).close()
    assert sys.modules["json"] is json
    assert sys.modules["wsp"].__file__ == str(tmp_path / "wsp.py")


def test_a_class_that_is_not_there_is_named_with_those_that_are(tmp_path, config):
    with pytest.raises(ControllerError, match=r"^wsp\.py has no class 'Mine'; its classes: Wsp$"):
        open_controller(program(tmp_path / "wsp.py", "Mine"), config)

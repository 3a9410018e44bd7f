"""Which modules a process holds, while others import."""

import gc
import sys
from itertools import count
from types import ModuleType

import pytest

from uictest.controllers.adapters import python_class


@pytest.fixture
def importing_elsewhere():
    """Let modules be imported whenever the garbage collector runs, which is at nearly every object."""
    numbers, thresholds, before = count(), gc.get_threshold(), set(sys.modules)

    def import_another(phase, info):
        name = f"imported_meanwhile_{next(numbers)}"
        sys.modules[name] = ModuleType(name)

    gc.callbacks.append(import_another)
    gc.set_threshold(1)
    yield
    gc.set_threshold(*thresholds)
    gc.callbacks.remove(import_another)
    for name in set(sys.modules) - before:
        del sys.modules[name]


@pytest.mark.usefixtures("importing_elsewhere")
def test_an_import_of_another_thread_is_no_error_of_a_controller(tmp_path, monkeypatch):
    monkeypatch.setattr(python_class, "_FOLDERS", set())
    python_class.check_imports(tmp_path / "wsp.py")
    python_class.check_imports(tmp_path / "other" / "wsp.py")


def test_looking_for_modules_imports_none(tmp_path, monkeypatch):
    class Lazy(ModuleType):
        def __getattr__(self, name):
            raise ImportError(f"{name} needs an extra")

    monkeypatch.setitem(sys.modules, "lazy_module_of_a_test", Lazy("lazy_module_of_a_test"))
    monkeypatch.setattr(python_class, "_FOLDERS", {tmp_path})
    python_class.check_imports(tmp_path / "other" / "wsp.py")

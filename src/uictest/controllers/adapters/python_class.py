"""Controllers written in Python: a class in a file, or one that an installed package has registered."""

import sys
from collections.abc import Iterator
from functools import cache
from importlib.abc import SourceLoader
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from threading import Lock
from types import ModuleType
from typing import Any, Final

from uictest.controllers.adapters.instance import (
    CalledInstance,
    ControllerError,
    checked_contract,
    reason_of,
    reject_undeclared,
    unchanged_content,
)
from uictest.controllers.declared import ControllerProgram, installed, installed_names, package_of
from uictest.controllers.interface import Config, Inputs, Outputs


class PythonInstance(CalledInstance):
    """An object of the user's class."""

    def __init__(self, controller: Any, version: str, contract: int) -> None:
        super().__init__()
        self.contract = contract
        self._controller = controller
        self.version = version

    def reset(self) -> None:
        """Call the object's ``reset``."""
        try:
            self._controller.reset()
        except (Exception, SystemExit) as error:
            raise ControllerError(f"reset failed: {reason_of(error)}") from error

    def step(self, inputs: Inputs) -> Outputs:
        """Call the object's ``step``."""
        outputs: Outputs = self._controller.step(inputs)
        return outputs

    def close(self) -> None:
        """Let go of the object: a destructor that does not return is then one of the calls to it."""
        self._controller = None


def open_controller(program: ControllerProgram, config: Config) -> PythonInstance:
    """Load the class, once per process, and create an object of it. Raises ControllerError."""
    if program.kind == "registered":
        kind, version = _registered_class(program.location)
        reject_undeclared(program, None)
    else:
        kind, version = _class_in_file(program)
    name = kind.__name__
    for method in ("reset", "step"):
        if not callable(getattr(kind, method, None)):
            raise ControllerError(f"class {name} has no method {method!r}")
    contract = checked_contract(getattr(kind, "contract", 1), f"class {name} is of contract version")
    try:
        return PythonInstance(kind(config), version, contract)
    except (Exception, SystemExit) as error:
        raise ControllerError(f"{name}(config) failed: {reason_of(error)}") from error


@cache
def _registered_class(name: str) -> tuple[type, str]:
    """Return the object registered under a name, and name and version of its package."""
    entries = installed(name)
    if not entries:
        known = ", ".join(installed_names()) or "none"
        raise ControllerError(f"no installed package has registered {name!r}; registered: {known}")
    if len(entries) > 1:
        packages = " and ".join(map(package_of, entries))
        raise ControllerError(f"{name} is registered by {packages}: uninstall one of them")
    package = package_of(entries[0])
    try:
        registered = entries[0].load()
    except (Exception, SystemExit) as error:
        raise ControllerError(f"{name} of {package} cannot be imported: {reason_of(error)}") from error
    if not isinstance(registered, type):
        found = type(registered).__name__
        raise ControllerError(f"the entry point {name} of {package} is of type {found}; register a class")
    return registered, package


def _class_in_file(program: ControllerProgram) -> tuple[type, str]:
    with _loading:
        module = _loaded_module(program.location, program.sha256)
    name = program.options["class"]
    kind = getattr(module, name, None)
    if not isinstance(kind, type):
        classes = [name for name, value in vars(module).items() if isinstance(value, type)]
        own = [name for name in classes if getattr(module, name).__module__ == module.__name__]
        message = f"{Path(program.location).name} has no class {name!r}"
        raise ControllerError(f"{message}; its classes: {', '.join(own) or 'none'}")
    return kind, str(getattr(module, "__version__", ""))


_loading = Lock()
"""Two threads that need a file load it once."""


class _CheckedSource(SourceLoader):
    """Loads a module from the content that was checked, whatever stands in its file by then."""

    def __init__(self, location: str, content: bytes) -> None:
        self._location, self._content = location, content

    def get_filename(self, fullname: str) -> str:
        return self._location

    def get_data(self, path: Any) -> bytes:
        return self._content


@cache
def _loaded_module(location: str, sha256: str) -> ModuleType:
    path = Path(location)
    loader = _CheckedSource(location, unchanged_content(path, sha256))
    # dataclasses look a class's module up by its name; a file called json.py takes no other's place.
    name = location if path.stem in sys.modules else path.stem
    spec = spec_from_file_location(name, path, loader=loader)
    assert spec is not None
    check_imports(path)
    module = module_from_spec(spec)
    if str(path.parent) not in sys.path:
        sys.path.insert(0, str(path.parent))
    sys.modules[name] = module
    try:
        loader.exec_module(module)
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        raise ControllerError(f"{path.name} cannot be imported: {reason_of(error)}") from error
    return module


_FOLDERS: Final[set[Path]] = set()
"""Those of the files that this process has loaded."""


def check_imports(file: Path) -> None:
    """Raise ControllerError where a file would be given the modules of another one's folder for its own."""
    folder = file.parent
    for module in _imported_from(_FOLDERS - {folder}):
        if (folder / module.name).exists() and module.stem != file.stem:
            raise ControllerError(
                f"{file.name} may import {module.name}, and this process has imported the one beside another "
                "controller: leave out --in-process"
            )
    _FOLDERS.add(folder)


def _imported_from(folders: set[Path]) -> Iterator[Path]:
    # Other threads import meanwhile: a copy is made at once, while a walk over the items can be interrupted
    # by the garbage collector. Looking an attribute up would let lazy modules import.
    for name, module in sys.modules.copy().items():
        file = getattr(module, "__dict__", {}).get("__file__")
        if file and "." not in name:
            path = Path(file).parent if Path(file).stem == "__init__" else Path(file)
            if path.parent in folders:
                yield path

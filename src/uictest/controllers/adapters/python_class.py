"""Controllers written in Python: a class in a file."""

import importlib.util
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from threading import Lock
from types import ModuleType
from typing import Any, Final

from uictest.controllers.adapters.errors import ControllerError, unchanged_content
from uictest.controllers.adapters.instance import CalledInstance, checked_contract, reason_of
from uictest.controllers.declared import ControllerProgram
from uictest.controllers.interface import Config, Inputs, Outputs

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
    """Yield the modules and packages that lie in some folders."""
    # Other threads import meanwhile: a copy is made at once, while a walk over the items can be interrupted
    # by the garbage collector. Looking an attribute up would let lazy modules import.
    for name, module in sys.modules.copy().items():
        file = getattr(module, "__dict__", {}).get("__file__")
        if file and "." not in name:
            path = Path(file).parent if Path(file).stem == "__init__" else Path(file)
            if path.parent in folders:
                yield path


_loading = Lock()
"""Two threads that need a file load it once."""


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
    """Load the file, once per process, and create an object of the class. Raises ControllerError."""
    with _loading:
        module = _loaded(program.location, program.sha256)
    name = program.options["class"]
    kind = getattr(module, name, None)
    if not isinstance(kind, type):
        defined = [each for each, value in vars(module).items() if isinstance(value, type)]
        own = [each for each in defined if getattr(module, each).__module__ == module.__name__]
        message = f"{Path(str(module.__file__)).name} has no class {name!r}"
        raise ControllerError(f"{message}; its classes: {', '.join(own) or 'none'}")
    return object_of(kind, config, str(getattr(module, "__version__", "")))


def object_of(kind: type, config: Config, version: str) -> PythonInstance:
    """Return an object of a class. Raises ControllerError."""
    name: str = kind.__name__
    for method in ("reset", "step"):
        if not callable(getattr(kind, method, None)):
            raise ControllerError(f"class {name} has no method {method!r}")
    contract = checked_contract(getattr(kind, "contract", 1), f"class {name} is of contract version")
    try:
        return PythonInstance(kind(config), version, contract)
    except (Exception, SystemExit) as error:
        raise ControllerError(f"{name}(config) failed: {reason_of(error)}") from error


@cache
def _loaded(location: str, sha256: str) -> ModuleType:
    """Return the module of a file; its own folder is searched for what it imports."""
    path = Path(location)
    content = unchanged_content(path, sha256)
    # dataclasses look a class's module up by its name; a file called json.py takes no other's place.
    name = location if path.stem in sys.modules else path.stem
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise ControllerError(f"{path.name} is no Python file")
    check_imports(path)
    module = importlib.util.module_from_spec(spec)
    if str(path.parent) not in sys.path:
        sys.path.insert(0, str(path.parent))
    sys.modules[name] = module
    try:
        exec(compile(content, location, "exec"), vars(module))
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        raise ControllerError(f"{path.name} cannot be imported: {reason_of(error)}") from error
    return module

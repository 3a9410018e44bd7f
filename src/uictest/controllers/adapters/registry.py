"""The adapter of each kind of controller."""

from importlib import import_module
from typing import Final

from uictest.controllers.adapters.instance import ControllerInstance
from uictest.controllers.declared import ControllerProgram, Kind
from uictest.controllers.interface import Config

_MODULES: Final[dict[Kind, str]] = {
    "python": "python_class",
    "library": "c_library",
    "fmu": "fmu",
    "connect": "socket",
    "registered": "registered",
}
"""Kind -> module beside this one."""


def open_controller(program: ControllerProgram, config: Config) -> ControllerInstance:
    """Load a controller and create it for one stop. Raises ControllerError."""
    adapter = import_module(f"uictest.controllers.adapters.{_MODULES[program.kind]}")
    instance: ControllerInstance = adapter.open_controller(program, config)
    return instance

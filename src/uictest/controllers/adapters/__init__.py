"""Adapters: each makes controllers of one kind callable as a C function.

The rig knows one face: ``step(handle, inputs, outputs)`` at an address, with the memory of
:mod:`uictest.controllers.interface`. An adapter is one module with a function
``open_controller(program, config)`` that returns an :class:`~.instance.ControllerInstance`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from uictest.controllers.adapters.instance import ControllerInstance
    from uictest.controllers.declared import ControllerProgram, Kind
    from uictest.controllers.interface import Config

_MODULES: Final[dict[Kind, str]] = {
    "python": "python_class",
    "library": "c_library",
    "fmu": "fmu",
    "connect": "socket",
    "registered": "python_class",
}
"""Kind of controller -> its adapter."""


def open_controller(program: ControllerProgram, config: Config) -> ControllerInstance:
    """Load a controller and create it for one stop. Raises ControllerError."""
    adapter = import_module(f"{__name__}.{_MODULES[program.kind]}")
    instance: ControllerInstance = adapter.open_controller(program, config)
    return instance

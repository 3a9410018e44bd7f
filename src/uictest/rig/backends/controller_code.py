"""A built-in controller alone, in machine code, for a library that other programs load."""

from typing import Any, NamedTuple

from uictest.controllers import Controller, functions_of_addresses
from uictest.rig.backends.compiled import compile_inner
from uictest.rig.backends.machine_code import Entry, Target, Unit, object_code


class ControllerCode(NamedTuple):
    """An object file, and the name of its function: of the addresses of memory, inputs and outputs.

    The memory is that of :func:`uictest.controllers.memory_of`. Without inputs, the function begins a stop.
    """

    function: str
    content: bytes


def controller_code(controller: Controller, target: Target) -> ControllerCode:
    """Return a controller of this package as an object file for a target."""
    name = f"uictest_{controller.name.replace('-', '_')}"

    def functions() -> list[Any]:
        begin, decide = map(compile_inner, functions_of_addresses(controller, compile_inner))

        def begin_or_decide(memory: int, inputs: int, outputs: int) -> Any:
            return begin(memory) if inputs == 0 else decide(memory, inputs, outputs)

        return [compile_inner(begin_or_decide)]

    entry = Entry(name, f"the controller {controller.name}", (int, int, int))
    return ControllerCode(name, object_code(Unit(f"{name}_controller", (entry,), functions), entry, target))

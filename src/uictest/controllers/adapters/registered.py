"""Controllers of installed packages: a class as in a Python file."""

from functools import cache
from typing import Any

from uictest.controllers.adapters.errors import ControllerError
from uictest.controllers.adapters.instance import ControllerInstance, reason_of, reject_undeclared
from uictest.controllers.adapters.python_class import object_of
from uictest.controllers.declared import ControllerProgram, installed, installed_names, package_of
from uictest.controllers.interface import Config


def open_controller(program: ControllerProgram, config: Config) -> ControllerInstance:
    """Import what a package has registered, and create a controller for one stop. Raises ControllerError."""
    registered, package = _loaded(program.location)
    if not isinstance(registered, type):
        kind = type(registered).__name__
        raise ControllerError(
            f"the entry point {program.location} of {package} is of type {kind}; register a class"
        )
    reject_undeclared(program, None)
    return object_of(registered, config, package)


@cache
def _loaded(name: str) -> tuple[Any, str]:
    """Return what is registered under a name, and the package it comes from."""
    entries = installed(name)
    if not entries:
        known = ", ".join(installed_names()) or "none"
        raise ControllerError(f"no installed package has registered {name!r}; registered: {known}")
    if len(entries) > 1:
        packages = " and ".join(map(package_of, entries))
        raise ControllerError(f"{name} is registered by {packages}: uninstall one of them")
    package = package_of(entries[0])
    try:
        return entries[0].load(), package
    except (Exception, SystemExit) as error:
        raise ControllerError(f"{name} of {package} cannot be imported: {reason_of(error)}") from error

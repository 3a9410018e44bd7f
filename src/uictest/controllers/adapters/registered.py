"""Controllers of installed packages: a class as in a Python file, or functions in the built-in form."""

import json
from functools import cache
from typing import Any

from uictest.controllers.adapters.built_in_form import CompiledInstance, reject_undeclared
from uictest.controllers.adapters.instance import ControllerError, ControllerInstance, reason_of
from uictest.controllers.adapters.python_class import object_of
from uictest.controllers.contract import Controller
from uictest.controllers.declared import ControllerProgram
from uictest.controllers.installed import installed, installed_names, package_of
from uictest.controllers.interface import Config


def open_controller(program: ControllerProgram, config: Config) -> ControllerInstance:
    """Import what a package has registered, and create a controller for one stop. Raises ControllerError."""
    registered, package = _loaded(program.location)
    if isinstance(registered, Controller):
        return CompiledInstance(registered, json.loads(program.parameters), config, package)
    if isinstance(registered, type):
        reject_undeclared(program, None)
        return object_of(registered, config, package)
    kind = type(registered).__name__
    raise ControllerError(
        f"{program.location} of {package} is of type {kind}; register a class or a Controller"
    )


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

"""The controllers that there are."""

import pkgutil
from importlib import import_module

from uictest.controllers import built_in
from uictest.controllers.contract import Controller


def _built_in() -> dict[str, Controller]:
    """Return the controller of every module in :mod:`uictest.controllers.built_in` by its name."""
    modules = [
        import_module(f"{built_in.__name__}.{module.name}")
        for module in pkgutil.iter_modules(built_in.__path__)
    ]
    return {module.CONTROLLER.name: module.CONTROLLER for module in modules}


CONTROLLERS = _built_in()
"""Every controller by its name."""
DEFAULT = "threshold"
"""Name of the controller of a scenario that names none."""

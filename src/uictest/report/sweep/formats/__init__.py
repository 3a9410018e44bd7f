"""The formats that a sweep is reported in: one module each, called like the format and found by its name."""

import pkgutil
from functools import cache


@cache
def sweep_format_names() -> tuple[str, ...]:
    """Return the names of all formats of sweeps, in alphabetical order. Loads none of them."""
    return tuple(sorted(module.name for module in pkgutil.iter_modules(__path__)))

"""The formats of reports: one module each, called like the format and found by its name."""

import pkgutil
from functools import cache


@cache
def format_names() -> tuple[str, ...]:
    """Return the names of all formats, in alphabetical order. Loads none of them."""
    return tuple(sorted(module.name for module in pkgutil.iter_modules(__path__)))

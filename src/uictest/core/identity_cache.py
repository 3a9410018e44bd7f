"""What follows from an object alone, computed once for each object."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Final, TypeVar

Argument = TypeVar("Argument")
Result = TypeVar("Result")

_MOST: Final = 1_000
"""Results that are kept: the objects of many cases recur, those of drawn numbers do not."""


def once_per_object(function: Callable[[Argument], Result]) -> Callable[[Argument], Result]:
    """Return a function of a frozen object that is computed once for each object, not for each equal one."""
    # Holding the object keeps Python from giving its identity to another.
    results: dict[int, tuple[Argument, Result]] = {}

    @wraps(function)
    def computed_once(argument: Argument) -> Result:
        entry = results.get(id(argument))
        if entry is None:
            entry = argument, function(argument)
            if len(results) >= _MOST:
                results.clear()
            results[id(argument)] = entry
        return entry[1]

    return computed_once

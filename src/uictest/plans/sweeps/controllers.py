"""The controllers from outside that a sweep names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from uictest.plans.sweeps.column import ParameterValue
from uictest.plans.sweeps.plan import Group, ListedGroup, Plan

if TYPE_CHECKING:
    from uictest.controllers import ControllerProgram

CONTROLLER: Final = "controller"
"""Key of a scenario whose value is a controller."""


def programs_of(plan: Plan) -> Iterator[ControllerProgram]:
    """Yield the program of each controller from outside, with the parameters that are written beside it."""
    values = [value.content for group in plan.groups for value in _values(group, CONTROLLER)]
    for controller in values or [plan.base.scenario.controller]:
        if controller.program is not None:
            yield controller.program


def _values(group: Group, key: str) -> Sequence[ParameterValue]:
    """Return the values that a group lists for a key."""
    if key not in group.keys:
        return ()
    place = group.keys.index(key)
    return (
        [row[place] for row in group.rows] if isinstance(group, ListedGroup) else group.draws[place].choices
    )

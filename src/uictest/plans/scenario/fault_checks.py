"""Faults that do not fit the stop of a scenario: of parts that its car lacks, at speeds that it never has."""

from collections.abc import Iterator
from typing import Any, Final

from uictest.plans.faults import DYNAMIC_BRAKE, SANDER, TRACK_BRAKE, TRAIN_SPEED
from uictest.plans.scenario.parts.fault import SPEED
from uictest.plans.scenario.parts.wheelsets import wheelset_value
from uictest.plans.scenario.yaml import Inconsistency

_OPTIONAL: Final = {
    DYNAMIC_BRAKE: ("dynamic", "{force: 60 kN, power: 1.6 MW}"),
    TRACK_BRAKE: ("track", "{attraction: 100 kN, magnets: 4, off_below: 50 km/h}"),
}
"""Parts that a car need not have: their key below `brake` and an example."""


def impossible_faults(scenario: Any) -> Iterator[Inconsistency]:
    """Yield faults that do not fit the stop of a scenario."""
    for place, fault in enumerate(scenario.faults):
        if fault.at.unit == SPEED and fault.at > scenario.initial_speed:
            yield Inconsistency(
                ("faults", place, "at"),
                f"the train never runs at {fault.at.text}: it begins to brake at"
                f" {scenario.initial_speed.text}",
                "write a lower speed, or `at: 0 s` for a fault throughout the stop",
            )
        if fault.part in _OPTIONAL and getattr(scenario.brake, _OPTIONAL[fault.part][0]) is None:
            key, example = _OPTIONAL[fault.part]
            yield Inconsistency(
                ("faults", place, "part"),
                f"this car has no {fault.part.replace('-', ' ')}",
                f"give it one: brake.{key}: {example}",
            )
        if fault.part == SANDER and all(fault.wheelset != sander.wheelset for sander in scenario.sanders):
            yield Inconsistency(
                ("faults", place, "wheelset"),
                f"wheelset {fault.wheelset} has no sander",
                f"give it one: sanders: [{{wheelset: {fault.wheelset}, density: 7.5 g/m}}]",
            )
        if fault.part == TRAIN_SPEED and scenario.rig.sensors.train_speed is None:
            yield Inconsistency(
                ("faults", place, "part"),
                "this rig has no second source of speed",
                "give it one: rig.sensors.train_speed: {period: 100 ms, delay: 100 ms}",
            )
        if fault.wheelset is not None and fault.effects.lost_teeth > 0.0:
            yield from _without_teeth(scenario, place, fault)


def _without_teeth(scenario: Any, place: int, fault: Any) -> Iterator[Inconsistency]:
    """Yield a pole wheel that loses teeth though none are counted, or more teeth than it has."""
    method, teeth, missing = (
        wheelset_value(scenario, fault.wheelset, f"sensors.speed.{name}")
        for name in ("method", "teeth", "missing_teeth")
    )
    if method != "whole-teeth":
        yield Inconsistency(
            ("faults", place, "kind"),
            f"the speed sensor of wheelset {fault.wheelset} counts no teeth",
            "write `rig.sensors.speed.method: whole-teeth`",
        )
    elif missing + fault.effects.lost_teeth >= teeth:
        yield Inconsistency(
            ("faults", place, "value"),
            f"{fault.value.text} and {missing.text} of {teeth.text} teeth: at least one must be left",
        )

"""The tables of the faults of a stop, from its scenario."""

import math
from collections.abc import Iterator

from uictest.core.units import KINDS
from uictest.plans.faults import MOST_FAULTS, SPEED_SENSOR, Effects
from uictest.plans.scenario import Fault, Quantity, Scenario
from uictest.rig.derived_parameters import Assignment
from uictest.rig.model.parameters import Parameters

_CONVERTED = frozenset({"travel_time", "release_time"})
"""Effects whose tables hold something else: shares of a step, controller cycles."""
_TIME, _SPEED, _DISTANCE = (KINDS[name].canonical for name in ("time", "speed", "length"))


def _set_faults(p: Parameters, scenario: Scenario) -> None:
    faults, step = scenario.faults, float(scenario.simulation.time_step)
    p.fault_count = len(faults)
    p.has_leaks = float(any(fault.effects.tank_leak + fault.effects.line_leak > 0.0 for fault in faults))
    _set_windows(p, faults, step)
    _set_owners(p, faults)
    effects = [fault.effects for fault in faults] + [Effects()] * (MOST_FAULTS - len(faults))
    for name in Effects.__dataclass_fields__:
        if name not in _CONVERTED:
            setattr(p, f"fault_{name}", [float(getattr(each, name)) for each in effects])
    p.fault_travel_per_step = [min(step / max(each.travel_time, step), 1.0) for each in effects]
    cycle = float(scenario.controller.cycle_time)
    p.fault_release_cycles = [_cycles(each.release_time, cycle) for each in effects]


def _cycles(time: float, cycle: float) -> float:
    return math.ceil(time / cycle - 1e-9) if math.isfinite(time) else math.inf


def _set_windows(p: Parameters, faults: tuple[Fault, ...], step: float) -> None:
    begins = [tuple(_reached(fault.at, step)) for fault in faults]
    ends = [tuple(_reached(fault.until, step)) for fault in faults]
    never = [tuple(_reached(None, step))] * (MOST_FAULTS - len(faults))
    p.fault_begin_time, p.fault_begin_speed, p.fault_begin_distance = map(
        list, zip(*begins, *never, strict=True)
    )
    p.fault_end_time, p.fault_end_speed, p.fault_end_distance = map(list, zip(*ends, *never, strict=True))


def _reached(instant: Quantity | None, step: float) -> Iterator[float]:
    """Yield the time, speed and distance that are reached together at an instant; never without one.

    Times are half a step early: what they are compared with is a whole number of steps.
    """
    unit = "" if instant is None else instant.unit
    value = 0.0 if instant is None else float(instant)
    yield math.inf if instant is None else value - 0.5 * step if unit == _TIME else -math.inf
    yield value if unit == _SPEED else math.inf
    yield value if unit == _DISTANCE else -math.inf


def _set_owners(p: Parameters, faults: tuple[Fault, ...]) -> None:
    none = [0.0] * (MOST_FAULTS - len(faults))
    p.fault_wheelset = [*(float((fault.wheelset or 1) - 1) for fault in faults), *none]
    p.fault_of_wheelset = [*(float(fault.wheelset is not None) for fault in faults), *none]
    p.fault_of_speed_sensor = [*(float(fault.part == SPEED_SENSOR) for fault in faults), *none]


FAULTS: tuple[Assignment, ...] = (
    Assignment(_set_faults, ("faults", "simulation.time_step", "controller.cycle_time")),
)
"""What sets the tables of the faults."""

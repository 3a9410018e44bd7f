"""Whether a record agrees with the scenario that judges it: speed, deceleration, pressures, duration."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from uictest.core.recording import TIME
from uictest.core.units import as_written, in_unit, value_text
from uictest.judging.evaluation import Bounds, Status, Verdict
from uictest.plans.scenario import Case, brake_deceleration, check_id
from uictest.recorded.field_data.channel_map import of_wheelsets
from uictest.recorded.field_data.raw_channels import Array
from uictest.recorded.field_data.recorded_stop import RecordedStop
from uictest.recorded.field_data.trigger import first_lasting_fall

Finding = tuple[float | None, str]
"""The value of a check, SI, with the numbers that contradict each other; None with why it is not made."""

_RISING: Final = (
    *("demanded_pressure", "brake_line_pressure"),
    *of_wheelsets("cylinder_pressure"),
    *of_wheelsets("tank_pressure"),
)
"""Pressures that rise with the brake."""
_FROM, _TO = 0.9, 0.1
"""Shares of the initial speed between which the mean deceleration is taken; chosen. The brake is built up
below the first, no run-out counts above the second, and noise of 0.02 m/s is 0.2 % of a stop from 80 km/h."""
_LATE: Final = "the record begins after the brake command"
_NOT_DOWN: Final = f"the record does not go down to {100.0 * _TO:.0f} % of its speed"
_UNSTATED: Final = "nothing states which vehicle and brake it is"


def record_verdicts(case: Case, stop: RecordedStop) -> Iterator[Verdict]:
    """Yield the verdict of every check of a record, by the tolerances of the scenario."""
    tolerances = case.scenario.record.tolerances
    for name, (unit, find) in _CHECKS.items():
        tolerance = getattr(tolerances, name)
        number, words = find(case, stop)
        value = None if number is None else as_written(number, unit)
        bounds = Bounds(None, as_written(tolerance, unit))
        margin = None if value is None else bounds.margin(value)
        if value is not None:
            words = "" if bounds.hold(value) else f"{words}, tolerance {tolerance.text}"
        status: Status = "not_applicable" if value is None else "fail" if words else "pass"
        mark = "user" if name in tolerances.model_fields_set else "chosen"
        meaning = type(tolerances).model_fields[name].description or ""
        definition = {"clause": "none", "measure": meaning, "bound": f"<= {tolerance.text} ({mark})"}
        yield Verdict(
            check_id(name), "record", value, unit, None, bounds.upper, margin, status, words, definition
        )


def _compare_initial_speed(case: Case, stop: RecordedStop) -> Finding:
    recorded, stated = float(stop.recording["speed"][0]), case.scenario.initial_speed
    text = value_text(in_unit(recorded, "km/h"), "km/h")
    words = f"recorded {text}, scenario {case.scenario.name} says {stated.text}"
    return (None, _LATE) if stop.trigger.late else (abs(recorded - stated), words)


def _largest_brake_deceleration(case: Case) -> tuple[float, str]:
    """Return the largest deceleration by the brake, m/s2, and its text; 0 and a reason if unknown."""
    if not case.vehicle_stated or case.train is not None:
        return 0.0, _UNSTATED if case.train is None else f"{case.train.label}: its couplers slow it as well"
    most = brake_deceleration(case.scenario)
    return most, f"the brake gives {in_unit(most, 'g'):.3f} g at {case.scenario.brake.command_text}"


def _first_fall(stop: RecordedStop, share: float) -> tuple[float, float] | None:
    """Return the time, s, and speed, m/s, at which the speed has fallen to a share of the first one."""
    known = np.isfinite(stop.recording["speed"])
    time, speed = stop.recording[TIME][known], stop.recording["speed"][known]
    index = first_lasting_fall(time, speed, share * speed[0])
    return None if index is None else (float(time[index]), float(speed[index]))


def _compare_deceleration(case: Case, stop: RecordedStop) -> Finding:
    most, gives = _largest_brake_deceleration(case)
    begin, end = _first_fall(stop, _FROM), _first_fall(stop, _TO)
    if most <= 0.0 or begin is None or end is None or begin == end:
        return None, gives if most <= 0.0 else _NOT_DOWN
    mean = (begin[1] - end[1]) / (end[0] - begin[0])
    return mean / most, f"recorded {in_unit(mean, 'g'):.3f} g, {gives}"


def _build_up_time(case: Case) -> float:
    """Return the time from the brake command to full build-up of the last of its steps, s."""
    brake = case.scenario.brake
    ramps = ((at, brake.system.positions[position]) for at, _, position in brake.commands)
    return max(at + ramp.dead_time + ramp.fill_time for at, ramp in ramps)


def _compare_duration(case: Case, stop: RecordedStop) -> Finding:
    """Return the largest ratio of recorded time to time by the brake, down to either share of the speed."""
    most, gives = _largest_brake_deceleration(case)
    falls = {share: _first_fall(stop, share) for share in (_FROM, _TO)}
    taken = {share: fall[0] for share, fall in falls.items() if fall is not None}
    if most <= 0.0 or stop.trigger.late or not taken:
        return None, gives if most <= 0.0 else _LATE if stop.trigger.late else _NOT_DOWN
    needed = {s: _build_up_time(case) + (1.0 - s) * case.scenario.initial_speed / most for s in taken}
    share = max(taken, key=lambda share: taken[share] / needed[share])
    words = f"recorded {value_text(taken[share], 's')} down to {100.0 * share:.0f} % of the speed"
    return taken[share] / needed[share], f"{words}, the brake needs {value_text(needed[share], 's')}"


def _finite_pressures(stop: RecordedStop, *names: str) -> list[tuple[str, Array]]:
    recorded = ((name, stop.recording.channels[name]) for name in names if name in stop.recording.channels)
    finite = ((name, samples[np.isfinite(samples)]) for name, samples in recorded)
    return [(name, samples) for name, samples in finite if len(samples)]


def _in_bar(pressure: float) -> str:
    return value_text(in_unit(float(pressure), "bar"), "bar")


def _compare_vacuum(case: Case, stop: RecordedStop) -> Finding:
    recorded = _finite_pressures(stop, *_RISING, "reservoir_pressure")
    if not recorded:
        return None, "no pressure is recorded"
    lowest, name = min((float(samples.min()), name) for name, samples in recorded)
    return -lowest, f"{name} falls to {_in_bar(lowest)}"


def _compare_pressure_fall(case: Case, stop: RecordedStop) -> Finding:
    # A WSP vents what had risen: what rises at all has the right sign.
    tolerance = case.scenario.record.tolerances.pressure_fall
    falls = [
        (float(p[0] - (np.median(p) if p.max() <= p[0] + tolerance else p.max())), name, p)
        for name, p in _finite_pressures(stop, *_RISING)
    ]
    if stop.trigger.late or not falls:
        return None, _LATE if stop.trigger.late else "no pressure of the brake is recorded"
    fall, name, samples = max(falls, key=lambda fall: fall[0])
    levels = f"from {_in_bar(samples[0])} at the command to {_in_bar(np.median(samples))} (median)"
    return fall, f"{name} falls {levels} while the brake is applied"


def _compare_demanded_pressure(case: Case, stop: RecordedStop) -> Finding:
    demanded, brake = _finite_pressures(stop, "demanded_pressure"), case.scenario.brake
    if not demanded or not case.vehicle_stated:
        return None, _UNSTATED if demanded else "demanded_pressure is not recorded"
    if brake.dynamic is not None:
        return None, "a dynamic brake takes over from the friction brake"
    if stop.recording[TIME][-1] < _build_up_time(case):
        return None, "the record ends before the command is built up"
    largest, commanded = float(demanded[0][1].max()), case.scenario.highest_pressure
    words = (
        f"recorded at most {_in_bar(largest)} demanded, {brake.command_text} asks for {_in_bar(commanded)}"
    )
    return abs(largest / commanded - 1.0), words


_CHECKS: Final[dict[str, tuple[str, Callable[[Case, RecordedStop], Finding]]]] = {
    "initial_speed": ("km/h", _compare_initial_speed),
    "deceleration": ("1", _compare_deceleration),
    "vacuum": ("bar", _compare_vacuum),
    "pressure_fall": ("bar", _compare_pressure_fall),
    "demanded_pressure": ("%", _compare_demanded_pressure),
    "duration": ("1", _compare_duration),
}
"""Tolerance -> the unit of what it bounds, and what finds it."""

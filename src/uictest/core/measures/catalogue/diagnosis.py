"""What a controller reports of wheelsets that deviate or are faulty, and what its safety timers allow."""

from __future__ import annotations

import math
from collections.abc import Sequence

from uictest.core.measures.measure import (
    Measure,
    MeasureValue,
    RecordedData,
    ShownWhen,
    Wheelsets,
    one_value,
    unavailable,
)
from uictest.core.measures.records import StopMeasures

_FAULTS = RecordedData(("faults of the brake",), when="never")
_NO_DIAGNOSIS = "the controller has no diagnosis"
_NOT_OBSERVED = "a built-in controller is not watched in a stop without faults"
_RULE = ("monitored_speed", "monitored_share", "moving_speed")


def unreported_deviation(stop: StopMeasures, wheelsets: Wheelsets) -> MeasureValue:
    """Return for how long (s) each wheelset deviated at a stretch before it was reported."""
    if all(math.isnan(wheelset.longest_unfilled) for wheelset in wheelsets):
        return unavailable(_NOT_OBSERVED)
    longest = [float(wheelset.longest_deviation) for wheelset in wheelsets]
    if all(map(math.isnan, longest)):
        return unavailable("no wheelset deviates by more than A + B v from the train's speed v")
    return MeasureValue(tuple(0.0 if math.isnan(each) else each for each in longest))


def false_reports(stop: StopMeasures, wheelsets: Wheelsets) -> MeasureValue:
    """Return how many wheelsets were reported that had no fault, never locked and never deviated."""
    if not stop.has_diagnosis > 0.0:
        return unavailable(_NO_DIAGNOSIS)
    return one_value(sum(wheelset.falsely_reported for wheelset in wheelsets))


def report_time(stop: StopMeasures, wheelsets: Wheelsets) -> MeasureValue:
    """Return the longest time (s) from a fault of a wheelset to its report, whatever the kind of fault."""
    delays = [float(wheelset.report_delay) for wheelset in wheelsets]
    reported = [wheelset.fault_reported > 0.0 for wheelset in wheelsets]
    return _longest_delay(stop, delays, reported, "no wheelset had a fault while the train moved")


def required_report_time(stop: StopMeasures, wheelsets: Wheelsets) -> MeasureValue:
    """Return the longest time (s) from a fault that is to be reported to the report of its wheelset."""
    delays = [float(wheelset.required_delay) for wheelset in wheelsets]
    reported = [wheelset.required_reported > 0.0 for wheelset in wheelsets]
    return _longest_delay(stop, delays, reported, "no fault began that is to be reported whatever it causes")


def _longest_delay(
    stop: StopMeasures, delays: Sequence[float], reported: Sequence[bool], without: str
) -> MeasureValue:
    """Return the longest delay; where a report is missing it is at least that long."""
    known = [delay for delay in delays if not math.isnan(delay)]
    if not known:
        return unavailable(without)
    missing = [
        str(number)
        for number, (delay, done) in enumerate(zip(delays, reported, strict=True), start=1)
        if not (math.isnan(delay) or done)
    ]
    value = one_value(max(known))
    if not missing:
        return value
    why = "" if stop.has_diagnosis > 0.0 else f": {_NO_DIAGNOSIS}"
    return value._replace(open_reason=f"wheelset {', '.join(missing)} not reported{why}")


MEASURES = (
    Measure(
        name="required_report_time",
        kind="time",
        course="grows",
        better="smaller",
        meaning="longest time from a fault of a kind that is to be reported to the report of its wheelset",
        read=lambda stop, wheelsets, definition: required_report_time(stop, wheelsets),
        decided=ShownWhen(how="longest", plot="speed", field="required_delay"),
        observed_by=("moving_speed",),
        of_faults=True,
        recorded=_FAULTS,
    ),
    Measure(
        name="report_time",
        kind="time",
        course="grows",
        better="smaller",
        meaning="longest time from a fault of any kind to the report of its wheelset",
        read=lambda stop, wheelsets, definition: report_time(stop, wheelsets),
        decided=ShownWhen(how="longest", plot="speed", field="report_delay"),
        observed_by=("moving_speed",),
        of_faults=True,
        recorded=_FAULTS,
    ),
    Measure(
        name="false_reports",
        kind="number",
        course="grows",
        better="smaller",
        meaning="wheelsets reported that before had no fault, never locked and never deviated by more than"
        " A + B v",
        read=lambda stop, wheelsets, definition: false_reports(stop, wheelsets),
        decided=ShownWhen(how="outer", plot="valves", field="falsely_reported"),
        observed_by=(*_RULE, "locked_speed"),
        recorded=_FAULTS,
        approach="maximum_slide",
    ),
    Measure(
        name="unreported_deviation",
        kind="time",
        course="grows",
        better="smaller",
        meaning="longest time at a stretch that the speed shown of a wheelset differs by more than A + B v"
        " from the train's, v, and no report says so",
        read=lambda stop, wheelsets, definition: unreported_deviation(stop, wheelsets),
        decided=ShownWhen(how="longest", plot="speed", field="deviation"),
        of_wheelsets=True,
        observed_by=_RULE,
        recorded=RecordedData(("speed", "diagnosis", "wheel_speed_{n}")),
    ),
    Measure(
        name="longest_unfilled",
        kind="time",
        course="grows",
        better="smaller",
        meaning="longest time at a stretch that the WSP valve is not commanded to fill",
        absent=_NOT_OBSERVED,
        decided=ShownWhen(how="longest", plot="valves", field="unfilled"),
        of_wheelsets=True,
        observed_by=("moving_speed",),
        recorded=RecordedData(("speed", "valve_command_{n}")),
    ),
)

"""Measures of what a controller reports of a wheelset, and for how long it keeps the brake from it.

Scalar code, once per controller cycle after the train, only where a controller can report or a fault may be
to be reported.
"""

from uictest.core.measures.records import MeasureDefinition, StopMeasures, WheelsetMeasures
from uictest.core.physics import maximum

NAN = float("nan")
_REPORTS_OF_FIRST = 0x01010101


def reports_wheelset(diagnosis: int, i: int) -> float:
    """Return 1 where a diagnosis reports wheelset ``i`` (0 to 3): by bit i, 8 + i, 16 + i or 24 + i."""
    return 1.0 if (diagnosis >> i) & _REPORTS_OF_FIRST else 0.0


def begin_monitoring(measures: WheelsetMeasures) -> None:
    """Start what is kept of the reports on a wheelset."""
    measures.deviation = 0.0
    measures.deviation_reported = 0.0
    measures.longest_deviation = NAN
    measures.unfilled = 0.0
    measures.longest_unfilled = NAN
    measures.falsely_reported = 0.0
    measures.report_delay = NAN
    measures.fault_reported = 0.0
    measures.required_delay = NAN
    measures.required_reported = 0.0


def observe_monitoring(
    measures: WheelsetMeasures,
    train: StopMeasures,
    definition: MeasureDefinition,
    reported: float,
    faulty: float,
    report_required: float,
    shown_speed: float,
    fills: float,
) -> None:
    """Observe one wheelset in one cycle, after the train.

    Report, shown speed and command are of the train's last sample but one, from which the controller decided.
    The interval since then counts as unreported unless the report came at once.

    Args:
        measures: measures of the wheelset.
        train: measures of the stop; its last two samples give the interval.
        definition: how samples become measures.
        reported: 1 while the diagnosis reports the wheelset.
        faulty: 1 once one of its parts has had a fault.
        report_required: 1 once it has had one of a kind that is to be reported.
        shown_speed: of the wheelset as its sensor shows it, m/s; NaN, in a gap of a recording, deviates from
            nothing.
        fills: 1 while its valve is commanded to fill.
    """
    interval = train.end_time - train.previous_time
    speed = train.previous_speed
    if not speed > definition.moving_speed:
        measures.deviation = 0.0
        measures.unfilled = 0.0
        return
    allowed = definition.monitored_speed + definition.monitored_share * speed
    _observe_deviation(measures, abs(shown_speed - speed) > allowed, reported, interval)
    measures.unfilled = 0.0 if fills > 0.0 else measures.unfilled + interval
    measures.longest_unfilled = maximum(measures.longest_unfilled, measures.unfilled)
    stands_out = measures.longest_deviation >= 0.0 or measures.locked_time > 0.0
    if reported > 0.0 and faulty == 0.0 and not stands_out:
        measures.falsely_reported = 1.0
    if faulty > 0.0 and measures.fault_reported == 0.0:
        measures.fault_reported = reported
        measures.report_delay = _delayed(measures.report_delay, reported, interval)
    if report_required > 0.0 and measures.required_reported == 0.0:
        measures.required_reported = reported
        measures.required_delay = _delayed(measures.required_delay, reported, interval)


def _observe_deviation(measures: WheelsetMeasures, deviates: bool, reported: float, interval: float) -> None:
    """Count the time at a stretch for which a wheelset deviates and no report has said so."""
    if not deviates:
        measures.deviation = 0.0
        measures.deviation_reported = 0.0
        return
    measures.deviation_reported = maximum(measures.deviation_reported, reported)
    if measures.deviation_reported == 0.0:
        measures.deviation += interval
    # Before the first deviation this is NaN; the maximum then gives the other number.
    measures.longest_deviation = maximum(measures.longest_deviation, measures.deviation)


def _delayed(delay: float, reported: float, interval: float) -> float:
    """Return a delay, NaN before its beginning, after one more interval with or without the report."""
    return maximum(delay, 0.0) + (0.0 if reported > 0.0 else interval)

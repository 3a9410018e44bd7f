import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.judging.evaluation import (
    AppliedDefinition,
    CaseResult,
    Sensitivity,
    VerdictInterval,
    narrowest_margin,
)
from uictest.plans.scenario import PASS
from uictest.report.case_lines import turns_text
from uictest.report.page.margins import margin_share, margins_of
from uictest.report.page.marks import taken_at
from uictest.report.traces.trace import PlotTrace, trace_of

from ..builders import make_recording, make_verdict

_TRACE = PlotTrace(0.0, 30.0, 0.01, {})
_UPPER = {"lower": None, "upper": 10.0}


def _margins(*verdicts):
    return margins_of(verdicts, verdicts, _TRACE)


def test_failing_criteria_come_first_then_the_narrowest_margins_then_yes_or_no():
    changes = (
        {**_UPPER, "margin": 5.0},
        {"lower": 1.0, "upper": None, "value": 1.0, "margin": 0.0},
        {**_UPPER, "margin": 0.5},
        {**_UPPER, "margin": -1.0, "status": "fail"},
        {**_UPPER, "margin": -30.0, "status": "fail"},
        {"status": "inconclusive", "margin": None},
        {"status": "not_applicable", "margin": None},
    )
    margins = _margins(*(make_verdict(id=str(index), **each) for index, each in enumerate(changes)))
    assert [(each.verdict.id, each.share_text) for each in margins.judged] == [
        *(("4", "-300 %"), ("3", "-10 %"), ("5", ""), ("2", "+5 %"), ("0", "+50 %"), ("1", "met"))
    ]
    assert [each.verdict.id for each in margins.not_applicable] == ["6"]


@pytest.mark.parametrize(
    ("share", "bar"),
    [(-250.0, (0.0, 50.0)), (-40.0, (30.0, 20.0)), (60.0, (50.0, 30.0)), (3e4, (50.0, 50.0))],
)
def test_a_bar_begins_at_the_limit_and_ends_with_the_scale(share, bar):
    status = "pass" if share > 0 else "fail"
    (margin,) = _margins(make_verdict(lower=None, upper=2.0, margin=share / 50.0, status=status)).judged
    assert margin.bar == pytest.approx(bar)


def test_the_margin_of_a_limit_of_zero_is_no_share():
    assert margin_share(make_verdict(lower=None, upper=0.0, value=0.2, margin=-0.2, status="fail")) is None


@pytest.mark.parametrize(
    ("margin", "status", "spare", "words"),
    [
        (4.0, "pass", "turns", "would fail if d were 0.6 s instead of 0.2 s"),
        (-4.0, "fail", "-40 %", "would pass if d were 0.5 s instead of 0.7 s"),
        (0.0, "pass", "turns", "would fail if d were 0.6 s instead of 0.2 s"),
    ],
)
def test_a_verdict_that_turns_has_nothing_to_spare_as_where_cases_are_ranked(margin, status, spare, words):
    intervals = (VerdictInterval(0.0, 0.5, "pass"), VerdictInterval(0.6, 1.0, "fail"))
    stated = AppliedDefinition("d", 0.2 if status == "pass" else 0.7, "s", "chosen", 0.0, 1.0)
    turns = {"sensitivity": (Sensitivity("d", "s", 0.0, 1.0, intervals),), "definitions": (stated,)}
    verdict = make_verdict(**_UPPER, margin=margin, status=status, **turns)
    steady = make_verdict(**_UPPER, margin=0.1, status="pass", id="steady")
    shown = _margins(steady, verdict).judged[0]
    assert (shown.verdict.id, shown.share_text, turns_text(shown.verdict)) == (verdict.id, spare, words)
    assert shown.bar[1] == pytest.approx(abs(10.0 * margin) / 2)
    case = CaseResult("c", "s", {}, PASS, "pass", criteria=(steady, verdict))
    narrowest, criterion = narrowest_margin(case)
    assert criterion == verdict.id
    assert shown.to_spare == pytest.approx(100.0 * (narrowest or 0.0))


def _definitions(**values):
    return tuple(AppliedDefinition(name, value, "m/s", "chosen") for name, value in values.items())


def _with(recording, **channels):
    units = {**dict.fromkeys(channels, "1"), **recording.units}
    return Recording({**recording.channels, **channels}, units, recording.metadata)


@pytest.mark.parametrize(
    ("measure", "value", "interval", "wheelset"),
    [
        ("locked_time", 3.0, (10.0, 22.0), 2),
        ("longest_lock", 2.0, (20.0, 22.0), 2),
        ("longest_lock_of_sound_wheelsets", 0.5, (15.0, 15.5), 4),
    ],
)
def test_a_lock_is_that_of_the_wheelset_that_decides(measure, value, interval, wheelset):
    """Wheelset 2, which is faulty, is locked for 1 s and for 2 s, wheelset 4 for 0.5 s."""
    recording = make_recording()
    time, speed = recording["time"], recording["wheel_speed_1"]

    def locked(*spans):
        within = [(time > first + 1e-6) & (time < last + 1e-6) for first, last in spans]
        return np.where(np.logical_or.reduce(within), 0.0, speed)

    locks = {"wheel_speed_2": locked((10.0, 11.0), (20.0, 22.0)), "wheel_speed_4": locked((15.0, 15.5))}
    recording = _in_fault(recording, **locks)
    definitions = _definitions(locked_speed=0.1, moving_speed=1.0)
    verdict = make_verdict(measure=measure, value=value, definitions=definitions)
    taken = taken_at(verdict, trace_of(recording, [verdict]))
    assert (taken.start, taken.end) == pytest.approx(interval, abs=0.011)
    assert (taken.plot, taken.wheelset) == ("locked", wheelset)


def test_a_measure_of_the_train_is_taken_at_an_instant_of_its_own():
    recording = make_recording()
    time = recording["time"]
    lowest = _with(recording, reservoir_pressure=8e5 - 1e5 * np.exp(-((time - 12.0) ** 2)))
    verdict = make_verdict(measure="reservoir_minimum_pressure", value=7.0, unit="bar")
    taken = taken_at(verdict, trace_of(lowest, [verdict]))
    assert taken.start == taken.end == pytest.approx(12.0, abs=0.011)
    assert (taken.plot, taken.wheelset, taken.value) == ("pressure", None, pytest.approx(7.0, abs=1e-6))


def _in_fault(recording, **channels):
    active = np.where((recording["time"] > 5.0) & (recording["time"] < 9.0), 2.0, 0.0)
    faulty = _with(recording, active_faults=active, **channels)
    return Recording(
        faulty.channels, faulty.units, {**faulty.metadata, "faults": "brake-line-leak, speed-sensor-stuck-2"}
    )


def test_the_reference_is_furthest_off_after_the_first_fault():
    """It is 3 m/s too high at 2 s, before the fault, and 2 m/s at 12 s."""
    recording = make_recording()
    time, speed = recording["time"], recording["speed"]
    excess = 3.0 * np.exp(-((time - 2.0) ** 2)) + 2.0 * np.exp(-((time - 12.0) ** 2))
    faulty = _in_fault(recording, reference_speed=speed + excess)
    definitions = _definitions(moving_speed=1.0)
    verdict = make_verdict(measure="reference_excess", value=7.2, unit="km/h", definitions=definitions)
    taken = taken_at(verdict, trace_of(faulty, [verdict]))
    assert taken.start == pytest.approx(12.0, abs=0.011)
    assert taken.value == pytest.approx((120 / 3.6 - 12.0 + 2.0) * 3.6, abs=0.1)


@pytest.mark.parametrize(
    ("measure", "value"), [("contact_energy", 1.0), ("braking_distance", None), ("locked_time", 0.0)]
)
def test_what_has_no_place_in_the_plots_has_none(measure, value):
    assert taken_at(make_verdict(measure=measure, value=value), _TRACE) is None

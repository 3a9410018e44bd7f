from __future__ import annotations

from collections.abc import Callable

import pytest

from uictest.evaluation import CaseResult, Verdict
from uictest.recording import Recording
from uictest.report.page.marks import Mark, marks_of
from uictest.report.page.trace import trace_of
from uictest.scenario.parts.measure_catalogue import MEASURES

MakeResult = Callable[..., CaseResult]
MakeVerdict = Callable[..., Verdict]
MakeRecording = Callable[..., Recording]


@pytest.fixture
def marks(
    make_result: MakeResult, make_verdict: MakeVerdict, make_recording: MakeRecording
) -> Callable[..., list[Mark]]:
    """The marks of a stop whose wheelsets begin to slide after 5 s, judged by one criterion."""

    def make(measure: str, definition: dict[str, str] | None = None, **changes: object) -> list[Mark]:
        meaning = {"measure": MEASURES[measure].meaning, **(definition or {})}
        verdict = make_verdict(definition=meaning, **({"lower": None, "upper": None} | changes))
        return marks_of(make_result(criteria=(verdict,)), trace_of(make_recording(sliding_time="5.0")))

    return make


def test_the_first_phase_is_a_window_with_its_limit_and_what_was_found(
    marks: Callable[..., list[Mark]],
) -> None:
    definition = {"first_phase_duration": "3 s (chosen; range 2 s .. 5 s)"}
    found = marks("initial_adhesion", definition, unit="g", upper=0.08, value=0.06)
    shown = [(mark.plot, mark.kind, mark.x0, mark.x1, mark.y) for mark in found]
    assert shown == [
        ("speed", "window", 5.0, 8.0, None),
        ("deceleration", "window", 5.0, 8.0, None),
        ("deceleration", "limit", 5.0, 8.0, 0.08),
        ("deceleration", "found", 5.0, 8.0, 0.06),
    ]


def test_the_slide_limit_ends_where_slides_no_longer_count(marks: Callable[..., list[Mark]]) -> None:
    definition = {"low_speed_cutoff": "30 km/h (chosen; range 10 km/h .. 60 km/h)"}
    (mark,) = marks("maximum_slide_above_cutoff", definition, unit="%", lower=35.0)
    assert (mark.plot, mark.kind, mark.y, mark.x0) == ("slide", "limit", 35.0, None)
    # 120 km/h less 1 m/s2: 30 km/h after 25 s.
    assert mark.x1 == pytest.approx(25.0, abs=0.06)


def test_the_braking_distance_is_a_band_over_the_distance(marks: Callable[..., list[Mark]]) -> None:
    (mark,) = marks("braking_distance", lower=440.0, upper=490.0)
    assert (mark.plot, mark.kind, mark.x0, mark.x1) == ("over-distance", "band", 440.0, 490.0)
    assert mark.label == "braking-distance: 440 .. 490 m"


def test_a_deceleration_bound_is_drawn_in_g(marks: Callable[..., list[Mark]]) -> None:
    (mark,) = marks("minimum_deceleration", unit="m/s2", lower=0.5 * 9.80665)
    assert mark.y == pytest.approx(0.5)


def test_a_criterion_that_does_not_apply_is_not_drawn(marks: Callable[..., list[Mark]]) -> None:
    assert marks("braking_distance", lower=440.0, upper=490.0, verdict="not_applicable") == []


def test_a_definition_in_another_unit_is_not_guessed(marks: Callable[..., list[Mark]]) -> None:
    assert marks("initial_adhesion", {"first_phase_duration": "3 s/m"}, unit="g", upper=0.08) == []

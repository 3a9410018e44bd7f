"""Readings of a criterion stand beside its verdict, never decide it, and let it turn where they differ."""

import json
import math
from dataclasses import replace

import pytest

from uictest.judging.evaluation import (
    Coverage,
    MissingData,
    evaluate,
    judge,
    narrowest_margin,
    result_document,
    results_of,
)
from uictest.judging.evaluation.verdict import READINGS

from ..measures.catalogue.conftest import sliding_stop, slow_times, stop, wheelsets
from .conftest import case, criterion, evaluate_stops, scenario, shipped, verdict_of

KMH = 1 / 3.6
SHARE = criterion(
    "sliding_share",
    lower="35 %",
    definition={
        "sliding_below": {"value": "90 %", "range": ["90 %", "90 %"]},
        "end_speed": {"value": "60 km/h", "range": ["60 km/h", "60 km/h"]},
    },
)
NAMES = ["half-at-once", "each-wheelset", "depth"]


def minimum_slide(*records, **options):
    """Judge a stop by the shipped minimum slide."""
    resolved = scenario(shipped("uic-541-05-appendix-b"), condition="wet")
    verdicts = judge(resolved, *records, **options)
    return next(verdict for verdict in verdicts if verdict.id == "minimum-slide")


def over_readings(verdict):
    return next(each for each in verdict.sensitivity if each.definition == READINGS)


def test_three_readings_say_at_which_speeds_they_look_and_the_first_decides():
    verdict = minimum_slide(sliding_stop(share=0.5), wheelsets(0.6, 0.6, 0.05, 0.05))
    assert [each.id for each in verdict.readings] == NAMES
    assert [each.decides for each in verdict.readings] == [True, False, False]
    assert [each.value for each in verdict.readings] == pytest.approx([50.0, 75.0, 60.0])
    assert [each.mark for each in verdict.readings] == ["published", "chosen", "chosen"]
    assert "inferred" in verdict.readings[0].source
    assert verdict.value == verdict.readings[0].value
    assert not over_readings(verdict).flips
    assert verdict.steady
    for share in (0.1, 0.5):
        verdict = minimum_slide(sliding_stop(share=share), wheelsets(0.6, 0.6, 0.05, 0.05))
        at_once, each_wheelset, depth = (each.reason for each in verdict.readings)
        assert "from the brake command to 60 km/h" in at_once
        assert "from the brake command to 60 km/h" in each_wheelset
        assert "above 30 km/h" in depth


@pytest.mark.parametrize(
    ("share", "slides", "status", "statuses"),
    [
        (0.5, (0.6, 0.6, 0.0, 0.0), "pass", ["pass", "pass", "pass"]),
        (0.5, (0.2, 0.2, 0.2, 0.2), "pass", ["pass", "pass", "fail"]),
        (0.5, (0.6, 0.05, 0.05, 0.05), "pass", ["pass", "fail", "fail"]),
        (0.1, (0.6, 0.6, 0.6, 0.6), "fail", ["fail", "pass", "pass"]),
        (0.1, (0.0, 0.0, 0.0, 0.6), "fail", ["fail", "fail", "fail"]),
    ],
)
def test_the_verdict_turns_exactly_where_the_readings_disagree(share, slides, status, statuses):
    verdict = minimum_slide(sliding_stop(share=share), wheelsets(*slides))
    assert verdict.status == status
    assert [each.status for each in verdict.readings] == statuses
    assert over_readings(verdict).flips == (len(set(statuses)) > 1)
    assert verdict.steady == (len(set(statuses)) == 1)
    listed = ", ".join(f"{name} {each}" for name, each in zip(NAMES, statuses, strict=True))
    assert str(over_readings(verdict)) == f"readings: {listed}"


def test_a_reading_that_disagrees_leaves_no_margin_and_is_written_and_read_back():
    slip_test = case(scenario(shipped("uic-541-05-appendix-b"), condition="wet"))
    result = evaluate(slip_test, sliding_stop(), wheelsets(0.2, 0.2, 0.2, 0.2))
    assert result.outcome == "pass"
    assert narrowest_margin(result) == (0.0, "minimum-slide")
    result = replace(evaluate(slip_test, sliding_stop(), wheelsets(0.2, 0.2, 0.2, 0.2)), parts={})
    document = json.loads(json.dumps(result_document([result])))
    criteria = {each["id"]: each for each in document["cases"][0]["criteria"]}
    readings = criteria["minimum-slide"]["readings"]
    assert [(each["id"], each["verdict"]) for each in readings] == [
        ("half-at-once", "pass"),
        ("each-wheelset", "pass"),
        ("depth", "fail"),
    ]
    turning = [each for each in criteria["minimum-slide"]["sensitivity"] if each["flips"]]
    assert [each["definition"] for each in turning] == ["readings"]
    assert "readings" not in criteria["initial-adhesion"]
    (read,) = results_of(document)
    assert read.criteria == result.criteria


def test_definitions_of_every_reading_run_through_their_range():
    """Half at once slides below 90 and 95 % of the speed only."""
    table = slow_times(0.5)
    table[27] = 0.0
    records = wheelsets(0.6, 0.6, 0.6, 0.6)
    records.maximum_slide_above[:, 5:] = 0.2
    verdict = minimum_slide(sliding_stop(half_slow_time=table), records)
    of_verdict = {each.definition: each for each in verdict.sensitivity}
    assert [(each.status, each.first, each.last) for each in of_verdict["sliding_below"].intervals] == [
        ("fail", 85.0, 85.0),
        ("pass", 90.0, 95.0),
    ]
    assert not of_verdict["end_speed"].flips
    (of_depth,) = verdict.readings[2].sensitivity
    assert str(of_depth) == "low_speed_cutoff 10 .. 60 km/h: pass 10 .. 40, fail 50 .. 60"


@pytest.mark.parametrize("initial", [60.0, 45.0])
def test_a_stop_from_sixty_or_below_is_not_applicable(initial):
    """Also where the observation ends early: nothing that follows would give it a share."""
    for running in ({}, {"stopped": 0.0, "end_speed": 5.0}):
        records = stop(initial_speed=initial * KMH, **running), wheelsets(0.5, 0.5, 0.5, 0.5)
        assert verdict_of(SHARE, *records).status == "not_applicable"


def test_a_stop_that_never_came_down_to_sixty_is_inconclusive():
    """Whatever it showed until then; once it came down, the rest of the stop does not matter."""
    reached = stop().reached_time.copy()
    reached[:6] = math.nan
    running = {"stopped": 0.0, "end_speed": 18.0, "half_slow_time": slow_times(0.9)}
    records = wheelsets(0.9, 0.9, 0.9, 0.9)
    verdict = verdict_of(SHARE, stop(**running, reached_time=reached), records)
    assert verdict.status == "inconclusive"
    assert "60 km/h" in verdict.reason
    verdict = verdict_of(SHARE, stop(**running), records)
    assert (verdict.status, verdict.value) == ("pass", 90.0)


def test_a_recorded_stop_without_all_wheel_speeds_is_inconclusive_and_lists_its_readings():
    gap = MissingData("not recorded: wheel_speed_3", bounded=False)
    lacking = dict.fromkeys(("sliding_share", "maximum_slide_above_cutoff"), (gap,) * 4)
    lacking["sliding_share"] = (gap,)
    lacking["sliding_share_of_wheelsets"] = (None, None, gap, None)
    verdict = minimum_slide(sliding_stop(), wheelsets(0.6, 0.6, 0.6, 0.6), coverage=Coverage(lacking))
    assert verdict.status == "inconclusive"
    assert [each.status for each in verdict.readings] == ["inconclusive", "pass", "inconclusive"]
    assert verdict.sensitivity == ()


@pytest.mark.parametrize("nan", [math.nan, math.inf])
def test_no_reading_passes_on_what_is_no_number(nan):
    records = wheelsets(nan, nan, nan, nan, slow_time=nan)
    verdict = minimum_slide(sliding_stop(half_slow_time=nan), records)
    assert verdict.status != "pass"
    assert {each.status for each in verdict.readings}.isdisjoint({"pass"})


def test_repeated_stops_are_read_together():
    resolved = scenario(shipped("uic-541-05-appendix-b"), condition="wet")
    slid = wheelsets(0.2, 0.2, 0.2, 0.2)
    result = evaluate_stops(resolved, *((sliding_stop(share=share), slid) for share in (0.4, 0.5, 0.8)))
    verdict = next(each for each in result.criteria if each.id == "minimum-slide")
    assert [(each.status, each.value) for each in verdict.readings] == [
        ("pass", pytest.approx(50.0)),
        ("pass", pytest.approx(75.0)),
        ("fail", pytest.approx(20.0)),
    ]
    assert over_readings(verdict).flips
    assert verdict.reason.endswith("against > 35 % (from the brake command to 60 km/h)")

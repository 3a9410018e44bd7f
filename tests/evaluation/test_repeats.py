"""Medians, spread and shares over the stops of a repeated case, and their JSON form."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.judging.evaluation import (
    CaseResult,
    OverStops,
    RepeatedStop,
    Repeats,
    Verdict,
    column_medians,
    result_document,
    results_of,
    spread_of,
    to_json,
)
from uictest.plans.scenario import PASS, expectation_of

numbers = st.floats(-1e6, 1e6)


@given(values=st.lists(numbers, min_size=1, max_size=20))
def test_median_and_quartiles_are_those_of_numpy(values):
    spread = spread_of(values)
    own = [spread.lowest, spread.lower_quartile, spread.median, spread.upper_quartile, spread.highest]
    assert own == pytest.approx(list(np.percentile(values, [0, 25, 50, 75, 100])), rel=1e-9, abs=1e-6)
    assert spread.count == len(values)


@given(values=st.lists(numbers, min_size=1, max_size=9), data=st.data())
def test_neither_order_nor_missing_values_matter(values, data):
    shuffled = data.draw(st.permutations([*values, math.nan, math.nan]))
    assert spread_of(shuffled) == spread_of(values)


def test_without_any_number_there_is_no_spread_and_the_median_is_none():
    assert spread_of([math.nan, math.nan]) is None
    medians = column_medians(
        [{"a": 1.0, "b": math.nan}, {"a": 4.0, "b": math.nan}, {"a": 2.0, "b": math.nan}]
    )
    assert medians["a"] == 2.0
    assert math.isnan(medians["b"])
    assert column_medians([]) == {}


def stop(seed, outcome, distance=460.0):
    measures = dict.fromkeys(STOP_COLUMNS, 1.0) | {"braking_distance_m": distance}
    wheelsets = (dict.fromkeys(WHEELSET_COLUMNS, float(seed)),) * 4
    verdict = Verdict("distance", "validity", distance, "m", None, 490.0, 490.0 - distance, "pass", "")
    return RepeatedStop(seed, outcome, "", (verdict,), measures, wheelsets)


REPEATS = Repeats(
    "at_least", (stop(7, "pass"), stop(8, "fail", 470.0), RepeatedStop(9, "error", "made up")), 0.9
)


def test_shares_count_the_stops_a_verdict_that_turns_is_not_steady_and_the_first_stop_is_drawn():
    assert REPEATS.passed == 1
    assert REPEATS.share == pytest.approx(1 / 3)
    low, high = REPEATS.interval
    assert low < 1 / 3 < high
    assert REPEATS.turns
    assert REPEATS.seeds("fail") == [8]
    assert [REPEATS.as_expected(expectation_of(expect)) for expect in ("pass", "fail", "invalid")] == [
        1,
        1,
        0,
    ]
    assert REPEATS.values("braking_distance_m") == [460.0, 470.0]
    assert REPEATS.values("locked_time_s", wheelset=4) == [7.0, 8.0]
    (verdict,) = result(REPEATS).criteria
    assert not verdict.steady
    assert replace(verdict, over_stops=OverStops(passed=2, lowest=460.0, highest=470.0)).steady
    assert replace(verdict, over_stops=None).steady
    drawn = result(REPEATS).drawn_stop
    assert (drawn.outcome, drawn.repeats) == ("pass", None)
    (verdict,) = drawn.criteria
    assert (verdict.value, verdict.over_stops, verdict.definition) == (460.0, None, {"clause": "B"})
    assert result(None).drawn_stop == result(None)


def test_stops_none_of_which_was_judged_have_no_share():
    skipped = Repeats("all", (stop(1, "skipped"), stop(2, "skipped")))
    assert (skipped.passed, skipped.none_judged) == (0, True)
    assert all(map(math.isnan, (skipped.share, *skipped.interval)))
    before = result(skipped)
    text = to_json(result_document([before]))
    written = json.loads(text)["cases"][0]["repeats"]
    assert (written["share"], written["interval"]) == (None, [None, None])
    assert results_of(json.loads(text)) == [before]
    one_judged = Repeats("all", (stop(1, "skipped"), stop(2, "fail")))
    assert (one_judged.share, one_judged.none_judged) == (0.0, False)


def result(repeats):
    counts = OverStops(passed=1, failed=1, lowest=460.0, highest=470.0)
    verdict = Verdict(
        "distance", "validity", 465.0, "m", None, 490.0, 25.0, "pass", "", {"clause": "B"}, over_stops=counts
    )
    first = stop(7, "pass")
    own = ("case", "a.yaml", {}, PASS, "error", "made up", (verdict,), first.measures, first.wheelsets)
    return CaseResult(*own, repeats=repeats)


def test_a_case_with_one_stop_has_nothing_of_repeats_and_what_is_read_back_is_checked():
    single = replace(result(None), criteria=stop(0, "pass").criteria)
    text = to_json(result_document([single]))
    assert "repeats" not in text
    assert "over_stops" not in text
    assert results_of(json.loads(text)) == [single]
    document = result_document([result(REPEATS)])
    repeats = document["cases"][0]["repeats"]
    for broken in ({"rule": "most"}, {"stops": []}, {"stops": [{"seed": 1, "outcome": "pass"}]}, {"more": 1}):
        document["cases"][0]["repeats"] = {**repeats, **broken}
        with pytest.raises(ValueError, match="repeats"):
            results_of(document)
    before = result(REPEATS)
    text = to_json(result_document([before]))
    assert results_of(json.loads(text)) == [before]
    written = json.loads(text)["cases"][0]["repeats"]
    assert list(written) == ["rule", "required_share", "passed", "share", "interval", "stops"]
    assert written["passed"] == 1
    assert written["interval"] == list(REPEATS.interval)

"""Lines on cases and series: what is close or uncertain, the explanation of a case."""

from dataclasses import replace

import pytest

from uictest.core.series_measures import Estimate, SeriesValue
from uictest.judging.evaluation import AppliedDefinition, Sensitivity, VerdictInterval
from uictest.judging.series import SeriesVerdict
from uictest.report.case_lines import close_calls, definition_lines, explanation_lines, turns_text

from .builders import make_content, make_result, make_verdict
from .made_up_series import make_series
from .test_robustness import firmness, make_repeated
from .test_verdict_sentences import READ


def turning(now, *intervals, **changes):
    range_of = Sensitivity("sliding_below", "%", 85.0, 95.0, intervals)
    stated = AppliedDefinition("sliding_below", now / 100.0, "1", "stated", 0.85, 0.95)
    return make_verdict(id="minimum-slide", sensitivity=(range_of,), definitions=(stated,), **changes)


STEPS = VerdictInterval(85.0, 85.0, "fail"), VerdictInterval(90.0, 95.0, "pass")
CLOSELY = VerdictInterval(85.0, 87.1234561, "inconclusive"), VerdictInterval(87.1234562, 95.0, "pass")
BOTH = [VerdictInterval(at, at, "pass" if at == 90.0 else "fail") for at in (85.0, 90.0, 95.0)]
READINGS = VerdictInterval(1, 1, "pass", "half-at-once"), VerdictInterval(2, 2, "fail", "depth")
SLIDING = "sliding counted below {} instead of 90 % of the train's speed"


@pytest.mark.parametrize(
    ("verdict", "text"),
    [
        (turning(90.0, *STEPS), f"fails if {SLIDING.format('85 %')}"),
        (turning(90.0, *CLOSELY), f"is inconclusive if {SLIDING.format('87.12 %')}"),
        (turning(90.0, *BOTH), " or ".join(f"fails if {SLIDING.format(at)}" for at in ("85 %", "95 %"))),
        (make_verdict(sensitivity=(Sensitivity("readings", "", 1, 2, READINGS),)),
         "depends on the reading (half-at-once pass, depth fail)",),
        (make_repeated("ppf").criteria[0], "turns from stop to stop"),
        (make_verdict(), ""),
    ],
)  # fmt: skip
def test_a_verdict_that_turns_says_by_which_value_of_what_and_to_what(verdict, text):
    assert turns_text(verdict) == text


def test_what_turns_comes_before_narrow_margins_what_failed_is_not_close_():
    narrow, narrower = make_verdict(value=445.0, margin=5.0), make_verdict(value=441.0, margin=1.0)
    failed = make_verdict(id="missed", value=430.0, margin=-10.0, status="fail")
    results = [
        make_result(id="a", criteria=(narrow, replace(narrow, layer="rig"))),
        make_result(id="b", criteria=(narrower,)),
        make_result(id="c", criteria=(turning(90.0, *STEPS, margin=200.0),)),
        make_result(id="d", criteria=(failed, turning(90.0, *STEPS, status="fail")), outcome="fail"),
        make_result(id="wide", criteria=(make_verdict(margin=49.5),)),
    ]
    calls = close_calls(results)
    assert [(call.of, call.kind) for call in calls] == [("c", "turns"), ("b", "narrow"), ("a", "narrow")]
    assert str(calls[1]) == "b: braking-distance 441 m (440 to 490 m), 0.2 % to spare"
    not_firm = [
        make_result(firmness=firmness(), outcome=outcome, criteria=()) for outcome in ("pass", "fail")
    ]
    assert [[call.kind for call in close_calls([each])] for each in not_firm] == [["turns"], []]


INSIDE = "not certain, the 95 % interval 73.54 to 100 % holds the limit (12 stops)"


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({}, f"100 % (90 % needed): {INSIDE}; 36 stops, all passing, would settle it"),
        ({"lower": 100.0},
         f"100 % (100 % needed): {INSIDE}; no number of stops settles it",),
        ({"lower": None, "upper": 95.0}, f"100 % (limit 95 %): {INSIDE}"),
    ],
)  # fmt: skip
def test_an_uncertain_share_names_the_limit_inside_its_interval_and_the_stops_that_would_settle_it(
    changes, text
):
    share = Estimate(100.0, 73.54, 100.0, 0.95, "share", 12, 0.0, 1.0)
    verdict = make_verdict(
        **{"id": "passing-stops", "value": 100.0, "unit": "%", "lower": 90.0, "upper": None} | changes
    )
    (call,) = close_calls((), [make_series(criteria=(SeriesVerdict(verdict, share, confident=False),))])
    assert call.text == text


def test_a_series_that_passes_by_chance_or_worse_than_without_wsp_says_so():
    series = make_series()
    (k_wet,) = series.criteria
    bypassed = SeriesValue(replace(k_wet.estimate, value=k_wet.estimate.value + 0.05))
    doubtful = replace(series, criteria=(replace(k_wet, confident=False),), bypassed_k_wet=bypassed)
    first, second = close_calls((), [doubtful])
    assert (first.of, first.criterion, first.of_series) == ("acceptance", "", True)
    assert "K_wet is better with the WSP bypassed" in str(first)
    assert "locked" not in str(first)  # the results hold no stop with the WSP bypassed
    assert (second.criterion, second.of_series) == ("k-wet", True)
    assert "not certain, a limit lies inside the interval at another speed or rail" in second.text


TOO_LONG = {
    "id": "locked",
    "layer": "requirement",
    "value": 3.0,
    "unit": "s",
    "lower": None,
    "upper": 1.0,
    "margin": None,
}
LOCKED = make_verdict(**TOO_LONG, status="fail", reason="locked for 3 s")


def test_the_explanation_of_a_case_has_every_verdict_failing_ones_first():
    result = make_result(outcome="fail", criteria=(make_verdict(), LOCKED))
    assert list(explanation_lines(make_content(result), result)) == [
        "fail dry-120[command=90]",
        "locked (requirement) fail: locked for 3 s",
        "braking-distance (validity) pass: 465.2 m (440 to 490 m)",
    ]
    coloured = next(explanation_lines(make_content(result), result, coloured=True))
    assert coloured == "\x1b[1;31mfail\x1b[0m dry-120[command=90]"


def test_what_criteria_mean_is_said_once_for_all_cases():
    assert list(definition_lines([make_result(criteria=(make_verdict(definition={}),))])) == []
    results = [make_result(id=name) for name in ("a", "b")]
    assert list(definition_lines(results)) == ["definition braking-distance: low_speed_cutoff = 30 km/h"]
    others = [make_result(id=name, criteria=(make_verdict(definition={"bound": "< 1"}),)) for name in "cdefg"]
    assert list(definition_lines([*results, *others])) == [
        "definition braking-distance (in a, b): low_speed_cutoff = 30 km/h",
        "definition braking-distance (in c, d, e and 2 more): bound = < 1",
    ]
    assert list(definition_lines([make_result(criteria=(READ,))]))[1] == (
        "definition minimum-slide read as depth: chosen: ours alone, low_speed_cutoff = 30 km/h (chosen)"
    )

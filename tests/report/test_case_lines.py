"""Lines on cases and series: what is close or uncertain, the explanation of a case, lines for grep."""

from dataclasses import replace

import pytest

from uictest.core.series_measures import Estimate, SeriesValue
from uictest.judging.evaluation import AppliedDefinition, Sensitivity, VerdictInterval
from uictest.judging.series import SeriesVerdict
from uictest.report.case_lines import (
    MOST_CLOSE,
    case_line,
    close_calls,
    close_lines,
    criterion_lines,
    definition_lines,
    explanation_lines,
    missing_lines,
    series_line,
    series_lines,
    turns_text,
)
from uictest.report.difference import BaselineComparison, Difference

from .builders import HOSTILE, make_content, make_result, make_verdict
from .made_up_series import MISSED, make_series
from .test_robustness import make_repeated
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
        (turning(90.0, *STEPS), f"would fail if {SLIDING.format('85 %')}"),
        (turning(90.0, *CLOSELY), f"would be inconclusive if {SLIDING.format('87.123 %')}"),
        (turning(90.0, *BOTH), " or ".join(f"would fail if {SLIDING.format(at)}" for at in ("85 %", "95 %"))),
        (make_verdict(sensitivity=(Sensitivity("readings", "", 1, 2, READINGS),)),
         "turns with its reading (half-at-once pass, depth fail)",),
        (make_repeated("ppf").criteria[0], "turns from stop to stop"),
        (make_verdict(), ""),
    ],
)  # fmt: skip
def test_a_verdict_that_turns_says_by_which_value_of_what_and_to_what(verdict, text):
    assert turns_text(verdict) == text


def test_what_turns_comes_before_narrow_margins_what_failed_is_not_close_and_many_are_counted():
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
    assert str(calls[1]) == "b: braking-distance 441 m, 440 .. 490 m (+0.204 %)"
    lines = close_lines([make_result(id=f"case-{n}", criteria=(narrower,)) for n in range(MOST_CLOSE + 3)])
    assert len(lines.sentences) == MOST_CLOSE + 1
    assert lines.sentences[-1] == "3 more, in the tables of cases and series"


INSIDE = "lies inside the 95 % interval 73.54 .. 100 % (12 stops)"


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({}, f"100 %: not certain, the lower limit of 90 % {INSIDE}; 36 stops, all passing, would settle it"),
        ({"lower": 100.0},
         f"100 %: not certain, the lower limit of 100 % {INSIDE}; no number of stops settles it",),
        ({"lower": None, "upper": 95.0}, f"100 %: not certain, the upper limit of 95 % {INSIDE}"),
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


@pytest.mark.parametrize(
    ("every", "lines"),
    [
        (False, ["fail: locked 3 s, upper limit 1 s. Expected: pass",
         "test validity: valid; requirements: missed (locked)", "locked (requirement) fail: locked for 3 s",],
         ),
        (True, ["locked (requirement) fail: locked for 3 s",
         "braking-distance (validity) pass: 465.25 m, limits 440 .. 490 m, margin 24.75 m",]),
    ],
)  # fmt: skip
def test_the_explanation_names_expectation_and_deciding_criterion_or_every_one_when_asked(every, lines):
    result = make_result(outcome="fail", criteria=(make_verdict(), LOCKED))
    head, *shown = explanation_lines(make_content(result), result, every_criterion=every)
    assert (head, shown) == ("fail dry-120[command=90]", [f"  {line}" for line in lines])
    coloured = next(explanation_lines(make_content(result), result, coloured=True))
    assert coloured == "\x1b[1;31mfail\x1b[0m dry-120[command=90]"


FIGURES = (
    "braking_distance_m=465.25 corrected_distance_m=465.25 braking_time_s=27.5 mean_deceleration_mps2=1.195 "
    "reference_distance_m=- initial_adhesion_g=- slide_above=moving_speed maximum_slide=0.02/0.04/0.06/0.08 "
    "valve_actuations=1/2/3/4"
)
ID = "dry-120[command=90]"


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({}, f"pass {ID} outcome=pass expect=pass test_validity=valid requirements=not_judged {FIGURES}"),
        ({"outcome": "fail", "criteria": (LOCKED,)},
         (f"fail {ID} outcome=fail expect=pass test_validity=not_judged requirements=missed {FIGURES}"
         " reason=locked (requirement) fail: locked for 3 s")),
        ({"outcome": "fail", "expect": "fail", "criteria": (LOCKED,)},
         (f"expected-fail {ID} outcome=fail expect=fail test_validity=not_judged requirements=missed"
         f" {FIGURES} reason=locked (requirement) fail: locked for 3 s")),
        ({"outcome": "error", "reason": "ValueError: x", "measures": None, "wheelsets": (), "criteria": (),},
         f"error {ID} outcome=error expect=pass reason=ValueError: x",),
    ],
)  # fmt: skip
def test_the_line_of_a_case_says_its_word_its_figures_and_its_reason(changes, line):
    assert case_line(make_result(**changes)) == line


def test_a_line_says_how_many_stops_pass_and_stays_one_line():
    words = case_line(make_repeated("ppppppffff", outcome="fail")).split(" reason=")[0].split()
    assert {"stops=10", "passed=6", "share=0.6", "share_low=0.2624", "share_high=0.8784"} <= set(words)
    assert case_line(make_result(id=HOSTILE, outcome="error", reason=HOSTILE, criteria=())).isprintable()


def test_criterion_lines_can_be_found_by_the_case_and_missing_cases_by_their_word():
    steady = Sensitivity("low_speed_cutoff", "km/h", 10.0, 60.0, (VerdictInterval(10.0, 60.0, "pass"),))
    lines = list(criterion_lines(make_result(criteria=(make_verdict(sensitivity=(steady,)),))))
    assert lines == [
        f"criterion {ID} braking-distance (validity) pass: 465.25 m, limits 440 .. 490 m, margin 24.75 m",
        f"criterion {ID} braking-distance: {steady}",
    ]
    lost = Difference("lost", "outcome", "pass", "none", within=False)
    baseline = BaselineComparison("base", "00", differences={"lost": [lost]}, missing={"lost": "a.yaml"})
    assert list(missing_lines(baseline)) == ["differs lost reason=baseline: outcome was pass, is none"]


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


def test_lines_of_a_series_tell_its_measures_criteria_and_what_does_not_count():
    assert series_line(make_series()).startswith("pass acceptance outcome=pass expect=pass k_wet=0.86957 ")
    assert series_line(MISSED).endswith(f"reason={MISSED.reason}")
    criterion, counted, not_counted = series_lines(make_series())
    assert criterion.startswith(
        "criterion acceptance k-wet (requirement) pass: 0.86957 from 120 km/h, lower limit 0.8"
    )
    assert (
        counted == "stops acceptance Valid stops from 120 km/h: dry 2 of 2, wet 5 of 6 (83.33 %, 80 % needed)"
    )
    assert not_counted == "stops acceptance 1 stop invalid, not counted: energy-balance: 3 % misses < 0.1 %"

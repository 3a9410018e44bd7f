"""Series in sentences and tables: counts, how sure a value is, what does not count."""

from dataclasses import replace

import pytest

from uictest.core.series_measures import Estimate, SeriesValue
from uictest.judging.series import UncountedStop
from uictest.report.series_report import (
    comparison_table,
    criteria_of,
    estimate_words,
    is_uncertain,
    not_counted_sentences,
    series_criteria_table,
    series_explanation,
    series_lines_of_terminal,
    series_sections,
    series_tables,
    series_tally,
    series_verdict_sentence,
    stops_sentences,
    value_with_interval,
)

from .builders import HOSTILE, make_content
from .made_up_series import MISSED, make_series

RESULT = make_series()
(K_WET,) = RESULT.criteria
UNCERTAIN = replace(RESULT, criteria=(replace(K_WET, confident=False),))


@pytest.mark.parametrize(
    ("results", "text"),
    [
        ([RESULT], "1 series: 1 pass"),
        ([MISSED], "1 series: 1 fail; 1 not as expected"),
        ([RESULT, UNCERTAIN], "2 series: 2 pass; 1 of 2 criteria of series not certain"),
    ],
)
def test_series_are_counted_apart_and_so_are_verdicts_that_are_not_certain(results, text):
    assert series_tally(results) == make_content(series=results).tally == text
    assert is_uncertain(UNCERTAIN)


NAN = float("nan")


@pytest.mark.parametrize(
    ("estimate", "words", "value"),
    [
        (Estimate(0.87, 0.85, 0.89, 0.95, "mean", 5, 0.8, 0.9, dry_stops=2),
         "mean of 5 stops over 2 dry, 95 % interval 0.85 to 0.89", "0.87 (0.85 to 0.89)",
         ),
        (Estimate(1.0, 0.5, 1.5, 0.95, "median", 9, 0.0, 2.0),
         "median of 9 stops, 95 % interval 0.5 to 1.5", "1 (0.5 to 1.5)",),
        (Estimate(1.0, NAN, NAN, 0.95, "mean", 1, 1.0, 1.0),
         "mean of 1 stop, too few for a 95 % interval: 2 are needed", "1",),
        (Estimate(1.0, NAN, NAN, 0.95, "median", 3, 1.0, 1.0),
         "median of 3 stops, too few for a 95 % interval: 6 are needed", "1",),
        (Estimate(2.0, NAN, NAN, 0.95, "largest", 12, 1.0, 2.0, covered=0.7791),
         "largest of 12 stops; at least 77.91 % of such stops lie below it (95 % confidence)", "2"),
        (Estimate(12.34567, NAN, 12.34567, 0.95, "largest", 12, 1.0, 2.0, covered=0.5),
         "largest of 12 stops; at least 50 % of such stops lie below 12.35 (95 % confidence)", "12.35"),
    ],
)  # fmt: skip
def test_an_estimate_says_how_it_was_made_and_how_sure_it_is(estimate, words, value):
    assert (estimate_words(estimate), value_with_interval(estimate)) == (words, value)
    assert value_with_interval(None) == "-"


def test_a_verdict_has_value_limit_and_confidence_on_one_line():
    line = series_verdict_sentence(K_WET, 0.95)
    assert line.startswith("k-wet pass: 0.8696 (0.8 needed) from 120 km/h; mean of 5 stops over 2 dry, 95 %")
    uncertain = series_verdict_sentence(replace(K_WET, confident=False), 0.95)
    assert uncertain.startswith(f"{line}; not certain: ")
    absent = replace(K_WET, verdict=replace(K_WET.verdict, value=None, reason="no stop"), estimate=None)
    assert series_verdict_sentence(absent, 0.95) == "k-wet pass: no stop"
    shares = replace(K_WET, kept=4, stops=5)
    assert "; 4 of 5 stops keep it, 95 % interval of the share 28.36 % to 99.49 %" in series_verdict_sentence(
        shares, 0.95
    )


def test_stops_that_count_and_those_that_do_not_are_said_in_any_width_with_the_first_reasons():
    assert stops_sentences(RESULT) == [
        "Valid stops from 120 km/h: dry 2 of 2, wet 5 of 6 (83.33 %, 80 % needed)",
        "1 stop invalid, not counted: energy-balance: 3 % misses < 0.1 %",
    ]
    reasons = [UncountedStop("wet", "wet", seed, "invalid", f"reason {seed}") for seed in range(5)]
    assert list(not_counted_sentences(make_series(not_counted=reasons))) == [
        "5 stops invalid, not counted: reason 0; 4 more reasons"
    ]
    for width in (60, 100, 200):
        text = " ".join(" ".join(series_lines_of_terminal([RESULT], width)).split())
        for said in ("pass acceptance", "dry 2 of 2, wet 5 of 6", "1 stop invalid, not counted"):
            assert said in text
    # A summary without series has no section of them, and many lines are counted.
    assert series_sections([]) == []
    _, lines, _ = series_sections([RESULT] * 200)
    assert len(lines.sentences) == 301
    assert lines.sentences[-1] == "100 more lines in tables/series-stops.csv and results.json"


def test_tables_have_a_row_per_measure_criterion_and_stop():
    bypassed = replace(RESULT, bypassed_k_wet=SeriesValue(replace(K_WET.estimate, value=0.5)))
    measures, criteria, stops = ([*table.records] for table in series_tables([bypassed]))
    k_wet = next(row for row in measures if (row["measure"], row["speed_kmh"]) == ("k_wet", "120"))
    assert (k_wet["value"], k_wet["method"], k_wet["stops"], k_wet["dry_stops"]) == (
        *(pytest.approx(100 / 115), "mean", 5, 2),
    )
    assert [row["value"] for row in measures if row["measure"] == "bypassed_k_wet"] == [0.5]
    (criterion,) = criteria
    assert [criterion[key] for key in ("criterion", "verdict", "certain", "method", "requirements")] == [
        *("k-wet", "pass", True, "mean", "")
    ]
    ends = [[stop[key] for key in ("role", "seed", "counts", "braking_distance_m")] for stop in stops[::7]]
    assert ends == [["dry", 0, True, 459.99], ["wet", 5, False, 2000.0]]
    assert len(stops) == 8
    without = replace(K_WET, estimate=None, stops=3)
    (row,) = series_criteria_table([replace(RESULT, criteria=(without,))]).records
    assert (row["low"], row["stops"]) == (None, 3)


def test_people_see_a_verdict_that_is_not_certain_and_series_side_by_side():
    (judged,) = criteria_of(UNCERTAIN).rows
    assert (judged.verdict_text, judged.tone) == ("pass, not certain", "odd")
    (failing, passing) = criteria_of(replace(RESULT, criteria=(K_WET, *MISSED.criteria))).rows
    assert (failing.criterion.verdict.status, passing.criterion.verdict.status) == ("fail", "pass")
    table = comparison_table([RESULT, MISSED, UNCERTAIN, replace(RESULT, criteria=())])
    compared = {column.heading: texts for column, texts in table.for_people}
    assert compared["verdict"] == ["pass", "fail", "pass", "pass"]
    assert compared["wet stops"] == ["5 of 6"] * 4
    value = compared["k-wet"][0]
    assert value.startswith("0.8696 (0.8")
    assert compared["k-wet"][1:] == [f"{value} fail", f"{value}, not certain", "-"]


def test_hostile_texts_stay_one_line():
    not_counted = (UncountedStop(HOSTILE, "wet", 1, "invalid", HOSTILE),)
    result = make_series(id=HOSTILE, title=HOSTILE, not_counted=not_counted, outcome="error", reason=HOSTILE)
    assert all(line.isprintable() for line in series_lines_of_terminal([result], 80))


def test_criteria_without_a_value_for_the_same_reason_are_told_once():
    absent = replace(K_WET.verdict, value=None, status="inconclusive", reason="no dry stop counts")
    named = [replace(K_WET, verdict=replace(absent, id=name), estimate=None) for name in ("k-wet", "longest")]
    missed = make_series(criteria=(*named, *MISSED.criteria), outcome="fail")
    (outcome, sure) = series_explanation(missed)
    assert (
        outcome == "fail: k-wet 0.8696 (0.9 needed) from 120 km/h; k-wet, longest: no dry stop counts."
        " Expected: pass"
    )
    assert sure.startswith("k-wet: mean of 5 stops over 2 dry, 95 % interval")

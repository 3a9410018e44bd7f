"""How every report shows the stops of a repeated case."""

import csv
import io
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from uictest.judging.evaluation import OverStops, RepeatedStop, Repeats
from uictest.report import case_annotations, case_line, csv_text, junit_text, run_suites, verdict_table
from uictest.report.formats import csv as tables
from uictest.report.formats.md import markdown_summary
from uictest.report.page import page_html
from uictest.report.repeat_wording import band_text, drawn_sentence, repeat_sentences, stops_text
from uictest.report.traces.band import stop_extremes, with_band
from uictest.report.traces.trace import trace_of

from .builders import HOSTILE, make_content, make_recording, make_result, make_verdict

CONFIDENCE = "with 95 % confidence"


def make_repeated(letters, rule="all", share=None, **changes):
    """A case whose stops come out as these letters say: pass, fail (too long), error."""
    stops = []
    single = make_result()
    for seed, letter in enumerate(letters):
        if letter == "e":
            stops.append(RepeatedStop(seed, "error", "no wheel load"))
            continue
        outcome, reason, distance = (
            ("pass", "", 460.0 + seed) if letter == "p" else ("fail", "too long", 500.0)
        )
        verdict = make_verdict(value=distance, margin=490.0 - distance, status=outcome, reason="made up")
        measures = single.measures | {"braking_distance_m": distance}
        stops.append(RepeatedStop(seed, outcome, reason, (verdict,), measures, single.wheelsets))
    counts = OverStops(letters.count("p"), letters.count("f"), lowest=460.0, highest=500.0)
    criteria = (make_verdict(over_stops=counts, reason="some of the stops pass"),)
    repeats = Repeats(rule, tuple(stops), share)
    return make_result(**{"criteria": criteria, "repeats": repeats, **changes})


def test_the_share_of_stops_has_its_interval():
    (sentence,) = repeat_sentences(make_repeated("pppppppppf"))
    # 55.5 .. 99.7 % is the interval of Clopper and Pearson for 9 of 10.
    assert sentence == (
        "10 stops, seeds 0..9: 9 pass (seeds 0..8), 1 fail (seed 9);"
        " pass 90 % (55.5 .. 99.7 % with 95 % confidence); rule: all"
    )


@pytest.mark.parametrize(
    ("letters", "share", "said"),
    [
        ("p" * 10, 0.9, f"10 stops cannot show a share of 90 % {CONFIDENCE}: that takes 36, all as expected"),
        ("p" * 40 + "f", 0.9, "these stops do not show a share of 90 %: its 95 % interval begins below"),
        ("p" * 10, 1.0, "no number of stops shows a share of 100 %"),
        ("p" * 36, 0.9, None),
    ],
)
def test_whether_the_stops_can_show_a_share_at_all(letters, share, said):
    _, *more = repeat_sentences(make_repeated(letters, "at_least", share))
    assert more == ([said] if said else [])


def test_the_share_is_that_of_the_expected_outcome():
    result = make_repeated("fffp", expect="fail", outcome="pass")
    assert stops_text(result) == "fail 3/4"
    assert "; fail 75 % (" in next(iter(repeat_sentences(result)))


def test_stops_that_were_all_skipped_have_no_share():
    judged = make_repeated("pp")
    stops = tuple(replace(stop, outcome="skipped") for stop in judged.repeats.stops)
    result = replace(judged, outcome="skipped", repeats=replace(judged.repeats, stops=stops))
    assert stops_text(result) == "skipped 2"
    assert list(repeat_sentences(result)) == ["2 stops, seeds 0..1: all skipped; none was judged"]
    (row,) = rows(tables.summary_table([result]))
    assert (row["stops"], row["passed"], row["share"], row["share_low"]) == ("2", "0", "", "")


def test_a_case_with_one_stop_says_nothing_of_stops():
    single = make_result()
    assert (stops_text(single), list(repeat_sentences(single)), drawn_sentence(single)) == ("", [], "")
    assert "stops" not in tables.summary_table([single]).columns
    assert "stops" not in tables.criteria_table([single]).columns


def rows(table):
    return list(csv.DictReader(io.StringIO(csv_text(*table))))


def test_the_tables_have_shares_and_ranges():
    results = [make_repeated("ppf"), make_result(id="single")]
    repeated, single = rows(tables.summary_table(results))
    assert (repeated["stops"], repeated["passed"]) == ("3", "2")
    assert [float(repeated[name]) for name in ("share", "share_low", "share_high")] == pytest.approx(
        [2 / 3, 0.0943, 0.9916], abs=5e-5
    )
    ends = (repeated["braking_distance_m_lowest"], repeated["braking_distance_m_highest"])
    assert tuple(map(float, ends)) == (460.0, 500.0)
    assert single["stops"] == single["braking_distance_m_lowest"] == ""
    wheelset = rows(tables.wheelsets_table(results))[2]
    assert wheelset["maximum_slide_lowest"] == wheelset["maximum_slide"] == wheelset["maximum_slide_highest"]
    criterion = rows(tables.criteria_table(results))[0]
    assert [criterion[name] for name in ("stops", "passed", "failed", "lowest", "highest")] == [
        *("3", "2", "1", "460.0", "500.0")
    ]


def test_every_stop_has_a_row():
    result = make_repeated("pfe")
    written = rows(tables.repeats_table([result]))
    told = [" ".join((row["seed"], row["outcome"], row["reason"])) for row in written]
    assert told == ["0 pass ", "1 fail too long", "2 error no wheel load"]
    assert [row["braking_distance_m"] for row in written] == ["460.0", "500.0", ""]
    assert written[0]["maximum_slide_4"] == "0.08"


def test_lines_and_the_terminal_show_how_many_stops_pass():
    result = make_repeated("ppppppffff", outcome="fail")
    words = case_line(result).split(" reason=")[0].split()
    assert {"stops=10", "passed=6", "share=0.6", "share_low=0.2624", "share_high=0.8784"} <= set(words)
    table, _ = verdict_table([result, make_result(id="single")], lambda each: each.outcome, 200)
    column = next(each for each in table.columns if each.header == "stops")
    assert [str(cell) for cell in column.cells] == ["pass 6/10", "-"]
    single, _ = verdict_table([make_result()], lambda each: each.outcome, 200)
    assert all(each.header != "stops" for each in single.columns)


def test_markdown_has_a_column_of_stops():
    text = markdown_summary(make_content(make_repeated("ppf", outcome="fail")))
    head, rule, row = (line for line in text.splitlines() if line.startswith("|"))
    assert head.split(" | ")[2:6] == ["outcome", "test validity", "requirements", "stops"]
    assert row.split(" | ")[5] == "pass 2/3"
    assert head.count("|") == rule.count("|") == row.count("|")


def test_junit_has_one_testcase_and_says_which_stops():
    results = [make_repeated("ppf", "at_least", 0.6), make_repeated("pff", id="b", outcome="fail")]
    met, failed = ElementTree.fromstring(junit_text(run_suites(results))).iter("testcase")
    assert met.findtext("system-out").startswith("3 stops, seeds 0..2: 2 pass (seeds 0, 1), 1 fail")
    assert "3 stops, seeds 0..2: 1 pass (seed 0), 2 fail" in failed.findtext("failure")


def test_github_is_told_of_a_case_that_passes_in_some_stops_only():
    (notice,) = case_annotations(make_repeated("ppf", "at_least", 0.6))
    assert notice.startswith("::notice file=scenarios/dry/120.yaml,title=pass 2/3 dry-120")
    assert list(case_annotations(make_repeated("ppp"))) == []
    (error,) = case_annotations(make_repeated("pff", outcome="fail"))
    assert error.startswith("::error ")


def test_the_page_has_the_stops_of_each_case():
    result = make_repeated("ppf", "at_least", 0.6)
    spoiled = replace(result.repeats.stops[2], reason=HOSTILE)
    result = replace(result, repeats=replace(result.repeats, stops=(*result.repeats.stops[:2], spoiled)))
    trace = trace_of(make_recording(), result.drawn_stop.criteria)
    page = page_html(make_content(result, traces={result.id: trace}))
    assert page.count('<i class="seed outcome-fail" title="seed 2: fail">') == 2
    assert "the stop that is recorded and drawn is the first, of seed 0: pass" in page
    assert '<circle class="dot-fail"' in page
    assert "<title>seed 2: 500</title>" in page
    assert "sensitive to definitions or seed: braking-distance" in page
    assert "<script>" not in page.split("</h3>")[-1].split('<script type="application/json"')[0]


def test_the_key_says_what_the_band_behind_the_drawn_stop_spans():
    result = make_repeated("p" * 30)
    trace, stop = trace_of(make_recording()), stop_extremes(make_recording())
    said = "lowest and highest of the first 20 of 30 repeats, of those still running"
    page = page_html(make_content(result, traces={result.id: with_band(trace, [stop] * 20)}))
    assert page.count(f"{said}</label>") == 1
    assert page.count('<path class="band role-train role-band"') == 1
    assert '{"band":{' in page
    assert "The band takes the lowest and the highest sample of every 50 ms." in page
    assert band_text(result, 30) == "lowest and highest of 30 repeats, of those still running"
    for alone in (result, make_result()):
        page = page_html(make_content(alone, traces={alone.id: trace}))
        assert not any(words in page for words in ("lowest and highest of", 'class="band', '{"band":'))


def test_repeated_cases_without_a_recording_show_their_stops_as_well():
    page = page_html(make_content(make_repeated("ppf"), make_result(id="single")))
    section = page.split("Repeated cases that are not drawn")[1]
    assert "<title>seed 2: 500</title>" in section
    assert "Repeated cases that are not drawn" not in page_html(make_content(make_result()))


def test_a_page_lists_so_many_stops_and_says_how_many_more():
    result = make_repeated("p" * 130)
    trace = trace_of(make_recording(), result.drawn_stop.criteria)
    assert "30 more stops are in repeats.csv" in page_html(make_content(result, traces={result.id: trace}))

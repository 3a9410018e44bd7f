"""What is said of the stops of a repeated case, and which numbers turn a verdict."""

from dataclasses import replace

import pytest

from uictest.judging.evaluation import (
    Firmness,
    NumberEffect,
    OverStops,
    RepeatedStop,
    Repeats,
    Turn,
    VerdictFirmness,
)
from uictest.report import BaselineComparison, Difference
from uictest.report.ci_server import case_annotations, run_suites
from uictest.report.robustness import (
    band_text,
    drawn_sentence,
    firmness_property,
    firmness_sentences,
    firmness_table,
    repeat_sentences,
    share_cells,
    stop_rows,
    stops_text,
    strongest_numbers_table,
    wheelset_cells,
)
from uictest.report.run_publication import cases_table, criteria_table, wheelsets_table
from uictest.report.run_text import run_lines

from .builders import make_content, make_result, make_verdict

CONFIDENCE = "with 95 % confidence"


def make_repeated(letters, rule="all", share=None, **changes):
    """A case whose stops come out as these letters say: pass, fail (too long), error."""
    stops = []
    single = make_result()
    for seed, letter in enumerate(letters):
        if letter == "e":
            stops.append(RepeatedStop(seed, "error", "no wheel load"))
            continue
        passed = letter == "p"
        outcome, reason, distance = ("pass", "", 460.0 + seed) if passed else ("fail", "too long", 500.0)
        verdict = make_verdict(value=distance, margin=490.0 - distance, status=outcome, reason="made up")
        measures = single.measures | {"braking_distance_m": distance}
        stops.append(RepeatedStop(seed, outcome, reason, (verdict,), measures, single.wheelsets))
    counts = OverStops(letters.count("p"), letters.count("f"), lowest=460.0, highest=500.0)
    criteria = (make_verdict(over_stops=counts, reason="some of the stops pass"),)
    repeats = Repeats(rule, tuple(stops), share)
    return make_result(**{"criteria": criteria, "repeats": repeats, **changes})


def skipped(result):
    stops = tuple(replace(stop, outcome="skipped") for stop in result.repeats.stops)
    return replace(result, outcome="skipped", repeats=replace(result.repeats, stops=stops))


@pytest.mark.parametrize(
    ("result", "text", "sentence"),
    [
        # 55.5 .. 99.7 % is the interval of Clopper and Pearson for 9 of 10.
        (make_repeated("pppppppppf"), "pass 9/10",
         ("10 stops, seeds 0..9: 9 pass (seeds 0..8), 1 fail (seed 9);"
         " pass 90 % (55.5 .. 99.7 % with 95 % confidence); rule: all")),
        # The share is that of the expected outcome.
        (make_repeated("fffp", "at_least", 0.5, expect="fail", outcome="pass"), "fail 3/4",
         ("4 stops, seeds 0..3: 1 pass (seed 3), 3 fail (seeds 0..2);"
         " fail 75 % (19.4 .. 99.4 % with 95 % confidence); rule: at least 50 %")),
        (make_repeated("ee"), "pass 0/2",
         "2 stops, seeds 0..1: all error; pass 0 % (0 .. 84.2 % with 95 % confidence); rule: all",),
        (skipped(make_repeated("pp")), "skipped 2", "2 stops, seeds 0..1: all skipped; none was judged"),
    ],
)  # fmt: skip
def test_a_repeated_case_says_how_its_stops_came_out(result, text, sentence):
    assert (stops_text(result), next(repeat_sentences(result))) == (text, sentence)


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


def test_a_case_with_one_stop_says_nothing_of_stops():
    single = make_result()
    assert (stops_text(single), list(repeat_sentences(single)), drawn_sentence(single)) == ("", [], "")
    assert (share_cells(single), band_text(single, 5), list(stop_rows([single]))) == ({}, "", [])
    for table in (cases_table(make_content(single)), criteria_table([single]), wheelsets_table([single])):
        keys = {column.key for column in table.for_programs}
        assert not any(key in ("stops", "share") or key.endswith("_lowest") for key in keys)


def test_which_stop_is_drawn_and_what_the_band_behind_it_spans():
    result = make_repeated("p" * 30)
    assert drawn_sentence(result) == "the stop that is recorded and drawn is the first, of seed 0: pass"
    assert band_text(result, 20) == "lowest and highest of the first 20 of 30 repeats, of those still running"
    assert band_text(result, 30) == "lowest and highest of 30 repeats, of those still running"
    assert band_text(result, 0) == ""


def test_tables_have_shares_and_ranges():
    results = [make_repeated("ppf"), make_result(id="single")]
    table = cases_table(make_content(*results))
    repeated, single = table.records
    assert (repeated["stops"], repeated["passed"]) == (3, 2)
    shares = [repeated[name] for name in ("share", "share_low", "share_high")]
    assert shares == pytest.approx([2 / 3, 0.0943, 0.9916], abs=5e-5)
    assert (repeated["braking_distance_m_lowest"], repeated["braking_distance_m_highest"]) == (460.0, 500.0)
    assert single["stops"] is single["braking_distance_m_lowest"] is None
    assert {column.heading: texts for column, texts in table.for_people}["stops"] == ["pass 2/3", "-"]
    wheelset = list(wheelsets_table(results).records)[2]
    assert wheelset["maximum_slide_lowest"] == wheelset["maximum_slide"] == wheelset["maximum_slide_highest"]
    criterion = next(criteria_table(results).records)
    counts = [criterion[name] for name in ("stops", "passed", "failed", "share", "lowest", "highest")]
    assert counts == [3, 2, 1, pytest.approx(2 / 3), 460.0, 500.0]
    (none,) = cases_table(make_content(skipped(make_repeated("pp")))).records
    assert [none[name] for name in ("stops", "passed", "share", "share_low")] == [2, 0, None, None]


def test_every_stop_has_a_row():
    rows = list(stop_rows([make_repeated("pfe"), make_result()]))
    told = [" ".join((str(row["seed"]), row["outcome"], row["reason"])) for row in rows]
    assert told == ["0 pass ", "1 fail too long", "2 error no wheel load"]
    assert [row.get("braking_distance_m") for row in rows] == [460.0, 500.0, None]
    assert [row["test_validity"] for row in rows] == ["valid", "not_valid", "not_judged"]
    assert rows[0]["maximum_slide_4"] == 0.08
    assert wheelset_cells([{"a": 1.0}, {"a": 2.0}]) == {"a_1": 1.0, "a_2": 2.0}


def test_a_ci_server_is_told_which_stops():
    results = [make_repeated("ppf", "at_least", 0.6), make_repeated("pff", id="b", outcome="fail")]
    content = make_content(*results)
    (suite,) = run_suites(content)
    failed, met = suite.testcases
    assert met.lines[0].startswith("3 stops, seeds 0..2: 2 pass (seeds 0, 1), 1 fail")
    assert any(line.startswith("3 stops, seeds 0..2: 1 pass (seed 0), 2 fail") for line in failed.lines)
    (notice,) = case_annotations(content, results[0])
    assert notice.startswith("::notice file=scenarios/dry/120.yaml,title=pass 2/3 dry-120")
    assert list(case_annotations(content, make_repeated("ppp"))) == []
    (error,) = case_annotations(content, results[1])
    assert error.startswith("::error ")


ABOVE = Turn("a.b", "above", "k-wet", "fail", "6.1 kJ/m", "6.0 kJ/m", "6.3 kJ/m", "9 kJ/m")
IN_PLACES = Turn("c", "below", "k-wet", "fail", "", "0.1", "", "0.05")
WEAK, STRONG, FLAT = (
    NumberEffect(key, "1", "0", "2", "chosen", "ours", {"k-wet": margins}, "uniform")
    for key, margins in (("weak", (0.1, 0.11)), ("a.b", (0.1, -0.2)), ("flat", (0.1, 0.1)))
)


def firmness(status="turns", turned=2, turned_by=(ABOVE,), **changes):
    """How firm a case is, one of whose criteria 100 draws of three numbers turned so often."""
    own = {"nominal": "pass", "status": status, "counted": 100, "turned": turned, "share": 1 - turned / 100}
    own |= {"share_at_least": None if turned else 0.9704, "lowest_block": 0.96, "highest_block": 1.0}
    own |= {"margin": 0.1, "turned_by": turned_by}
    whole = {"numbers": (WEAK, STRONG, FLAT), "draws": 120, "infeasible": 5, "outcomes": {}, "seeds": 3}
    criteria = (VerdictFirmness(criterion="k-wet", **own),)
    return Firmness(**own | {"criteria": criteria, "on_four_calipers": False} | whole | changes)


WITHIN = "of 100 draws of 3 numbers within their ranges"
IN_98 = f"not firm: it stands in 98 % {WITHIN} (96 % to 100 % in blocks)"
LEFT_OUT = "of 120 draws 15 are no test, 5 do not fit together: they do not count"
RANGE = "it stands to 6.0 kJ/m; range to 9 kJ/m"
TURNS = (
    f"k-wet pass is {IN_98}; turned by a.b above 6.1 kJ/m (fail, under every seed above 6.3 kJ/m; {RANGE})"
)
SEEDS = "turned by c in places or under some seeds between 0.1 and 0.05 (fail)"
OTHERWISE = "the stops that were varied come to fail, of which the following is said"
ALL = {"infeasible": 0, "draws": 100}


@pytest.mark.parametrize(
    ("varied", "sentences", "named"),
    [
        (None, [], {}),
        (firmness(), [f"pass is {IN_98}", TURNS, LEFT_OUT], "turns: a.b above 6.1 kJ/m"),
        (firmness(turned_by=(ABOVE, IN_PLACES)), [f"pass is {IN_98}", f"{TURNS}; {SEEDS}", LEFT_OUT],
         "turns: a.b above 6.1 kJ/m, c below 0.1"),
        (firmness("firm", 0, (), **ALL), [f"pass is firm: it stands in all {WITHIN}, a share above 97.04 %"],
         "firm"),
        (firmness("not_shown", 0, (), counted=0),
         ["pass is not shown to be firm: none of 120 draws is a test", LEFT_OUT.replace("15", "115")],
         "not_shown"),
        (firmness("firm", 0, (), numbers=(), without_range=("rail.friction",), **ALL),
         ["pass is firm: no number states a plausible range",
          "not varied, as no range is stated: rail.friction"], "firm"),
        (firmness(nominal="fail"),
         [f"pass is not shown to be firm: {OTHERWISE}", f"fail is {IN_98}", TURNS, LEFT_OUT], "not_shown"),
    ],
)  # fmt: skip
def test_how_firm_a_case_is_and_which_numbers_turn_it(varied, sentences, named):
    result = make_result(firmness=varied)
    assert list(firmness_sentences(result)) == sentences
    assert firmness_property(result) == (named and {"firmness": named})


@pytest.mark.parametrize("quiet", [False, True])
def test_how_firm_a_case_is_stands_among_the_close_or_else_above_them(quiet):
    cases = [make_result(id=f"case-{k}", firmness=firmness()) for k in range(10)]
    differs = {case.id: [Difference(case.id, "stops", "1", "2", within=False)] for case in cases}
    content = make_content(*cases, baseline=BaselineComparison("kept", "00", differences=differs))
    lines = [line.strip() for line in run_lines(content, 10_000, quiet=quiet)]
    assert all(lines.count(f"{case.id}: pass is {IN_98}") == 1 for case in cases)


def test_numbers_are_listed_by_what_they_do_to_a_verdict():
    table = strongest_numbers_table(firmness(), "car 2")
    assert table.title == "What the numbers do to the margins of car 2"
    shown = {column.title: texts for column, texts in table.for_people}
    assert shown["number"] == ["a.b", "weak", "flat"]
    assert shown["turns"] == ["yes", "", ""]
    assert (shown["margin\n%"], shown["at highest\n%"]) == (["10"] * 3, ["-20", "11", "10"])
    rows = list(firmness_table([make_result(firmness=firmness()), make_result()]).records)
    assert [(row["key"], row["turns"], row["margin_at_highest"]) for row in rows] == [
        *(("weak", False, 0.11), ("a.b", True, -0.2), ("flat", False, 0.1))
    ]
    assert {row["id"] for row in rows} == {make_result().id}

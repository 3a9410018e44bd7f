"""The series of two runs: what is compared of them, and which of their stops pair."""

import dataclasses
from xml.etree import ElementTree

from uictest.analysis.comparison import (
    Baseline,
    Scope,
    Tolerances,
    accepted_document,
    compare_variants,
    comparison_document,
)
from uictest.analysis.comparison.runs import compare_runs
from uictest.core.series_measures import SeriesValue, mean_of
from uictest.judging import series
from uictest.judging.evaluation import Verdict
from uictest.plans.scenario import PASS
from uictest.report import RunContent, document_lines, junit_text
from uictest.report.ci_server import missing_annotations, run_suites
from uictest.report.run_folder import baseline_form, read_baseline_comparison

from .conftest import make_repeated


def make_series(
    wet, status="pass", name="acceptance", parameters=None, not_counted=(), keys=("00000007", "00000009")
):
    """A series of one dry and several wet stops from 120 km/h, the wet ones under two frictions."""
    cases = [series.SeriesCase("dry", 120.0, make_repeated({1: 460.0}, f"{name}.dry"))]
    for key, friction in zip(keys, ("0.07", "0.09"), strict=True):
        case_id = f"{name}.wet[friction={friction}]"
        case = make_repeated(dict(enumerate(wet, 1)), case_id, key, parameters={"rail.friction": friction})
        cases.append(series.SeriesCase("wet", 120.0, case))
    extension = SeriesValue(mean_of([each - 460.0 for each in wet], 0.95))
    measures = {"deceleration_distance_extension": extension, "k_wet": SeriesValue(None, "no wet stop")}
    verdict = Verdict("k-wet", "requirement", 0.87, "1", 0.8, None, 0.07, status, "")
    counts = series.StopCounts(1, 1), series.StopCounts(2 * len(wet), 2 * len(wet) - len(not_counted))
    return series.SeriesResult(
        *(name, "acceptance.series.yaml", "", parameters or {}, PASS, "pass", "", 0.95, 0.8, 3.0),
        criteria=(series.SeriesVerdict(verdict),),
        measures=measures,
        speeds=(series.SpeedResult(120.0, *counts, measures),),
        not_counted=not_counted,
        cases=tuple(cases),
    )


def _compared(first, second):
    runs = RunContent("one", [], series=first), RunContent("other", [], series=second)
    return compare_runs(*runs, Tolerances())


LEFT_OUT = (series.UncountedStop("acceptance.wet[friction=0.09]", "wet", 2, "invalid", "no test"),)


def test_a_series_and_itself_agree_and_verdicts_counts_and_measures_are_compared():
    before = [make_series([500.0, 510.0])]
    found = _compared(before, [make_series([500.0, 510.0])])
    assert found.agrees
    # The outcome, a criterion, the dry and the wet stops that count, two measures.
    assert found.compared == 6
    assert found.answer.standing == "no difference shown"
    (missing,) = _compared(before, []).beyond
    assert (missing.case, missing.first, missing.second) == ("acceptance", "pass", "missing")
    found = _compared(before, [make_series([500.0, 530.0], "fail", not_counted=LEFT_OUT)])
    shown = [(each.case, each.quantity, each.first, each.second, each.unit) for each in found.beyond]
    assert shown == [
        ("acceptance", "criterion k-wet", "pass", "fail", ""),
        ("acceptance", "wet stops from 120 km/h", "4 of 4", "3 of 4", ""),
        ("acceptance", "deceleration_distance_extension", 45.0, 55.0, "%"),
    ]


def test_the_wet_stops_that_count_on_both_sides_pair():
    before = make_series([500.0, 510.0])
    (group,) = _compared([before], [make_series([501.0, 513.0])]).paired.groups
    assert (group.name, group.pairs) == ("acceptance, wet stops from 120 km/h", 4)
    assert (group.draws, group.seeds) == (4, (1, 2))
    distance = next(each for each in group.differences if each.quantity == "braking_distance_m")
    assert (distance.mean.value, distance.mean.smallest, distance.mean.largest) == (2.0, 1.0, 3.0)
    (group,) = _compared([before], [make_series([501.0, 513.0], not_counted=LEFT_OUT)]).paired.groups
    assert (group.pairs, group.unpaired) == (3, (1, 0))
    # Of a case without repeats the list of stops that do not count has no seed.
    single = (dataclasses.replace(LEFT_OUT[0], seed=None),)
    (group,) = _compared([before], [dataclasses.replace(before, not_counted=single)]).paired.groups
    assert (group.pairs, group.unpaired) == (2, (2, 0))


def test_stops_of_a_series_that_met_the_same_noise_are_told_apart():
    """As those on a rail that sliding cleans and on one that it does not: their friction is the same."""
    keys = ("00000007", "00000007")
    found = _compared([make_series([500.0, 510.0], keys=keys)], [make_series([501.0, 513.0], keys=keys)])
    (group,) = found.paired.groups
    assert (group.pairs, group.draws) == (4, 2)
    lines = document_lines(comparison_document(found, every=True), None)
    (line,) = (each for each in lines if each.startswith("acceptance, wet stops from 120 km/h: 4 pairs"))
    assert "only 2 draws of noise, so that the intervals are too narrow" in line


def test_series_of_one_run_pair_over_the_keys_that_make_them():
    variants = [
        make_series([500.0, 510.0], name="wsp[controller=a]", parameters={"controller": "a"}),
        make_series([490.0, 500.0], name="wsp[wsp=bypassed]", parameters={"rig.wsp": "bypassed"}),
    ]
    (found,) = compare_variants(_run(*variants), ["controller", "rig.wsp"], Tolerances())
    assert (found.first, found.second) == ("controller=a", "rig.wsp=bypassed")
    (group,) = found.paired.groups
    assert (group.name, group.pairs) == ("wsp, wet stops from 120 km/h", 4)
    distance = next(each for each in group.differences if each.quantity == "braking_distance_m")
    assert distance.mean.value == -10.0


def _run(*planned, **changes):
    return RunContent("run", [], series=planned, **changes)


def make_baseline(accepted, selected=(), searched=()):
    """A baseline of series, and which of them a later run selects."""
    scope = Scope(frozenset(selected), searched)
    document = {"cases": [], "manifest": {}, "series": series.series_document(accepted)}
    return Baseline("kept", "", _run(*accepted), {}, document, scope, Tolerances())


def _shown(differences):
    return [(each.case, each.quantity, each.first, each.second) for each in differences]


def test_a_baseline_compares_verdicts_and_measures_of_series():
    before = make_series([500.0, 510.0])
    baseline = make_baseline([before], ["acceptance"])
    same = baseline.compare(_run(before))
    assert (same.agrees, same.compared, same.within, dict(same.series)) == (True, 6, 0, {})
    found = baseline.compare(_run(make_series([500.0, 530.0], "fail")))
    assert _shown(found.all_differences) == [("acceptance", "criterion k-wet", "pass", "fail")]
    # No criterion judges it.
    assert _shown(found.informing) == [("acceptance", "deceleration_distance_extension", 45.0, 55.0)]
    assert found.series == {"acceptance": "acceptance.series.yaml"}
    # One that is new, or that its file no longer has, differs.
    new, old = make_series([500.0], name="new"), make_series([500.0], name="old")
    found = make_baseline([old], ["new"], ["acceptance.series.yaml"]).compare(_run(new))
    shown = [("new", "series", "missing", "pass"), ("old", "series", "pass", "missing")]
    assert _shown(found.all_differences) == shown
    assert (sorted(found.series), found.series_not_compared, found.compared) == (["new", "old"], [], 2)


def test_a_series_that_was_not_selected_is_not_compared_and_stays_accepted():
    old, new = make_series([500.0], name="old"), make_series([500.0], name="new")
    baseline = make_baseline([old], ["new"])
    found = baseline.compare(_run())
    assert (found.agrees, found.series_not_compared) == (True, ["old"])
    run = {"cases": [], "manifest": {}, "series": series.series_document([new])}
    kept = accepted_document(run, baseline)
    stops = [
        [(each.id, stop.case.id) for each in results for stop in each.cases]
        for results in (series.series_results_of(kept["series"]), (old, new))
    ]
    assert stops[0] == stops[1]
    assert kept["manifest"]["cases"] == len(old.cases) + len(new.cases)
    dropping = make_baseline([old], ["new"], ["acceptance.series.yaml"])
    assert [each["id"] for each in accepted_document(run, dropping)["series"]["series"]] == ["new"]


def test_a_series_that_differs_is_in_every_report_for_machines():
    after = make_series([500.0], "fail")
    found = make_baseline([make_series([500.0])]).compare(_run(after))
    sentence = "baseline: criterion k-wet was pass, is fail"
    content = _run(after, baseline=found)
    suites = ElementTree.fromstring(junit_text(run_suites(content)))
    failure = suites.find(".//testcase[@name='acceptance']/failure")
    assert (failure.get("type"), failure.text) == ("baseline", sentence)
    assert list(missing_annotations(found)) == [
        f"::error file=acceptance.series.yaml,title=differs acceptance::{sentence}"
    ]
    assert content.tally.endswith("; 1 series different from the baseline")
    assert read_baseline_comparison({"baseline": baseline_form(found)}) == found

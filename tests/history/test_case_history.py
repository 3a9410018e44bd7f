from dataclasses import replace

from uictest.judging import evaluation
from uictest.runs.history.case_history import case_histories, runs_with_cases
from uictest.runs.history.listing import CASES_READ, list_runs

from .conftest import case, part


def histories(reports):
    return {each.id: each for each in case_histories(runs_with_cases(list_runs(reports).runs))}


def test_a_case_is_followed_by_its_id_from_run_to_run(publish, reports):
    publish(case("a", distance=470.0))
    publish(case("b"))
    publish(case("a", "fail", distance=475.5))
    found = histories(reports)["a"]
    assert [entry.word if entry else None for entry in found.entries] == ["pass", None, "fail"]
    assert (found.change, found.turned, found.newest.word) == (5.5, True, "fail")


def test_one_run_alone_and_a_stop_without_a_distance_have_no_change(publish, reports):
    publish(case("a"))
    assert histories(reports)["a"].change is None
    publish(case("a", "error", float("nan")))
    assert histories(reports)["a"].change is None


def test_parts_and_versions_that_changed_or_are_gone_are_named(publish, reports):
    publish(case("a"))
    publish(case("a"))
    other = {"vehicle": part("vehicle", "coach"), "controller": part("controller", "slip-band")}
    publish(case("a", parts=other))
    publish(case("a", parts=other), versions={"uictest": "0.2.0", "numpy": "2.0.0"})
    publish(case("a", parts={"vehicle": part("vehicle", "coach")}))
    versions = [["uictest 0.1.0 → 0.2.0"], ["controller", "uictest 0.2.0 → 0.1.0"]]
    changes = {1: [], 2: ["controller"], 3: versions[0], 4: versions[1]}
    assert histories(reports)["a"].changes() == changes


def test_another_expectation_of_the_same_outcome_is_a_change(publish, reports):
    publish(case("a", "fail", expect="fail"))
    publish(case("a", "fail"))
    publish(case("a", "invalid"))
    publish(case("a", expect="fail"))
    assert histories(reports)["a"].changes() == {1: ["expect"], 2: [], 3: ["expect"]}


def test_more_stops_of_a_case_or_another_rule_for_them_are_a_change(publish, reports):
    def repeated(count, rule):
        stops = tuple(evaluation.RepeatedStop(seed, "pass") for seed in range(count))
        return replace(case("a"), repeats=evaluation.Repeats(rule, stops))

    publish(case("a"))
    for count, rule in ((3, "all"), (3, "all"), (5, "all"), (5, "median")):
        publish(repeated(count, rule))
    assert histories(reports)["a"].changes() == {1: ["repeat"], 2: [], 3: ["repeat"], 4: ["repeat"]}


def test_another_recording_of_the_same_name_is_a_change(publish, reports):
    stop = replace(case("a"), scenario="a.mf4", parts={"conditions": part("conditions", "")})
    for digest in ("00", "00", "11"):
        publish(stop, command=("evaluate", "a.mf4"), inputs={"a.mf4": digest})
    assert histories(reports)["a"].changes() == {1: [], 2: ["recording"]}


def test_where_parts_are_not_known_no_change_is_claimed_or_denied(publish, reports):
    publish(case("a"))
    publish(case("a", parts={}))
    assert histories(reports)["a"].changes() == {1: None}


def test_the_most_urgent_cases_come_first(publish, reports):
    publish(case("calm"), case("moved"), case("turned", "fail"), case("failing"))
    publish(case("calm"), case("moved", distance=480.0), case("turned"), case("failing", "fail"))
    assert list(histories(reports)) == ["failing", "turned", "moved", "calm"]


def test_as_many_runs_as_are_shown_are_read_with_their_cases(publish, reports):
    for _ in range(CASES_READ + 2):
        publish(case("a"), formats=())
    listed = list_runs(reports).runs
    assert [bool(run.cases) for run in listed] == [True] * CASES_READ + [False] * 2
    assert all(run.counts == {"pass": 1} for run in listed)

"""`uictest run` on cases that repeat their stop, and the commands to which repeats mean nothing."""

import json
from pathlib import Path

import pytest

WET = "rail: {condition: wet, friction: 0.05}\ncriteria: uictest-stop\n"


def results():
    document = json.loads(Path("reports/latest/results.json").read_text("utf-8"))
    return document["cases"]


def test_the_option_repeats_every_stop(call, scenario):
    path = scenario("stop", f"{WET}seed: 3\nrepeat: 2\n")
    answer = call("run", path, "--repeat", "3", code=0)
    assert answer.out.startswith(
        "pass stop outcome=pass expect=pass test_validity=not_judged requirements=met"
        " stops=3 passed=3 share=1 share_low=0.2924"
    )
    (case,) = results()
    assert [stop["seed"] for stop in case["repeats"]["stops"]] == [3, 4, 5]
    assert len(Path("reports/latest/repeats.csv").read_text("utf-8").splitlines()) == 4
    call("run", path, "--repeat", "1")
    assert "repeats" not in results()[0]
    assert not Path("reports/latest/repeats.csv").exists()


def test_reports_are_written_again_from_the_results(call, scenario):
    call("run", scenario("stop", WET), "--repeat", "2", "--record", "all")
    run = Path("reports/latest").resolve()
    names = ("summary.csv", "criteria.csv", "repeats.csv", "index.html")
    before = {name: (run / name).read_bytes() for name in names}
    assert call("report", run, "--format", "csv,html,md", "-o", "again").code == 0
    for name in ("summary.csv", "criteria.csv", "repeats.csv"):
        assert Path("again", name).read_bytes() == before[name]
    assert "2 stops, seeds 0..1: all pass" in Path("again/index.html").read_text("utf-8").lower()


def test_an_expectation_is_met_by_all_stops_or_not(call, scenario):
    path = scenario("stop", f"{WET}expect: fail\n")
    answer = call("run", path, "--repeat", "2", code=1)
    assert answer.out.startswith("unexpected-pass stop outcome=pass expect=fail ")
    assert " stops=2 passed=2 " in answer.out
    assert "fail 0 % (0 .. 84.2 % with 95 % confidence); rule: all" in answer.out
    assert call("run", path, "--repeat", "2", "--lf").code == 1


def test_a_baseline_compares_medians_shares_and_the_number_of_stops(call, scenario):
    path = scenario("stop", WET)
    call("run", path, "--repeat", "2", "--baseline", "accepted", "--accept")
    assert call("run", path, "--repeat", "2", "--baseline", "accepted").code == 0
    answer = call("run", path, "--repeat", "3", "--baseline", "accepted", "--tolerance", "100%", code=1)
    assert "baseline: stops was 2, rule all, is 3, rule all" in answer.out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("run", "--repeat", "0"), "--repeat"),
        (("run", "--repeat", "1001"), "--repeat"),
        (("run", "--real-time"), "stop repeats its stop 2 times; run one stop: --repeat 1"),
    ],
)
def test_what_cannot_be_repeated_is_said(call, scenario, arguments, message):
    scenario("stop", "repeat: 2\n")
    call(*arguments, code=4, says=message)


def test_a_recording_is_one_stop(call, scenario):
    path = scenario("stop", f"{WET}repeat: 2\n")
    call("run", path, "--record", "all")
    answer = call("evaluate", Path("reports/latest/recordings/stop.parquet"), "--scenario", path, code=0)
    assert "note: stop: `repeat` plays no part: a recording is one stop" in answer.err
    assert "stops=" not in answer.out


@pytest.mark.parametrize(
    ("repeat", "lists", "said"),
    [
        (2, "seed: [0, 1]", ["repeat: the scenario repeats its stop 2 times", "list or sample `seed`"]),
        (
            1,
            "repeat: [1, 2], outcome_of_repeats: [all, median]",
            [
                f"vary.matrix.{key}: '{key}' cannot vary: a sweep runs one stop per case"
                for key in ("repeat", "outcome_of_repeats")
            ],
        ),
    ],
)
def test_a_sweep_runs_one_stop_per_case(call, scenario, repeat, lists, said):
    scenario("stop", f"{WET}repeat: {repeat}\n")
    sweep = Path("scenarios/study.sweep.yaml")
    sweep.write_text(
        f"schema: uictest/scenario/1\nname: study\nextends: stop.yaml\nvary: {{matrix: {{{lists}}}}}\n",
        "utf-8",
    )
    answer = call("sweep", sweep, "--dry-run", code=4)
    for each in said:
        assert each in answer.err
    assert (call("sweep", sweep, "--dry-run", "--set", "repeat=1").code == 0) is (repeat == 2)

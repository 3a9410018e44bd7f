"""`uictest run`: what it selects, shows, writes and ends with; of stops that are made up where that does."""

import json
import re
from pathlib import Path

import pytest

from uictest import report
from uictest.running import campaign

from ..conftest import manifest_of, results_of, verdicts_in

WET = "rail: {condition: wet, friction: 0.05}\ncriteria: uictest-stop\n"
IN_EVERY_RUN = {
    *("SHA256SUMS", "criteria.csv", "index-entry.json", "index.html", "junit.xml", "manifest.json"),
    *("results.json", "summary.csv", "wheelsets.csv"),
}


def latest(name):
    return Path("reports/latest", name)


def files():
    return {path.name for path in latest("").iterdir()} if Path("reports").exists() else set()


@pytest.mark.parametrize(
    ("option", "names"),
    [
        ((), IN_EVERY_RUN),
        (("--report", "xlsx,md"), {*IN_EVERY_RUN, "report.xlsx", "summary.md"} - {"index.html"}),
    ],
)
def test_met_cases_exit_0_with_one_row_each_and_reports_on_disk(call, scenario, made_up, option, names):
    scenario("a")
    scenario("b")
    answer = call("run", *option, code=0)
    assert verdicts_in(answer.out) == {"a": "pass", "b": "pass"}
    *_, passed, place = answer.out.splitlines()
    assert passed.startswith("PASSED: 2 cases: 2 pass; took ")
    assert place.startswith("page: reports/" if "index.html" in names else "reports: reports/")
    assert answer.err == ""
    assert files() == names


def test_a_missed_case_exits_1_and_an_error_3(call, scenario, made_up):
    scenario("a", "tags: [fail]\nexpect: fail\n")
    call("run", code=0)
    scenario("a", "tags: [fail]\n")
    call("run", code=1)
    scenario("b", "tags: [error]\n")
    shown = call("run", code=3).out
    assert verdicts_in(shown) == {"a": "fail", "b": "error"}
    # Errors come first; each says how it is run again.
    of_error, of_failure = (shown.index(text) for text in ("b could not be run", "a misses requirements"))
    assert of_error < of_failure < shown.index("FAILED: 1 of 2 cases could not be run")
    assert "\n  ZeroDivisionError: no wheel load\n  uictest run scenarios/b.yaml -k b\n" in shown
    assert shown.count("uictest run ") == 2


@pytest.mark.parametrize(
    ("arguments", "ids"),
    [
        (["-k", "a or c"], ["a", "c"]),
        (["-m", "wet"], ["b", "c"]),
        (["-k", "not a", "-m", "wet and not long"], ["b"]),
        (["scenarios/b.yaml", "scenarios/a.yaml"], ["b", "a"]),
    ],
)
def test_selection(call, scenario, made_up, arguments, ids):
    scenario("a")
    scenario("b", "tags: [wet]\n")
    scenario("c", "tags: [wet, long]\n")
    call("run", *arguments, code=0)
    assert sorted(made_up) == sorted(ids)


def test_dry_run_lists_and_set_sweeps_and_durations_name_the_slowest(call, scenario, made_up):
    scenario("a", "matrix:\n  brake.command: [80 %, 90 %]\n")
    assert call("run", "--dry-run", code=0).out == "a[command=80]\na[command=90]\n"
    assert (made_up, files()) == ([], set())
    scenario("a")
    call("run", "--set", "brake.command=80 %,90 %", code=0)
    header, *rows = latest("summary.csv").read_text().splitlines()
    assert ("parameters.brake.command" in header, len(rows)) == (True, 2)
    scenario("b")
    call("run", "--durations", "1", says="the slowest 1 of 2 cases")
    call("run", "--durations", "0", says="the slowest 2 of 2 cases")


def test_json_is_the_document_alone_and_the_manifest_holds_command_seed_and_inputs(call, scenario, made_up):
    scenario("a")
    answer = call("run", "--format", "json")
    assert answer.out == latest("results.json").read_text()
    assert (results_of()["schema"], results_of()["complete"]) == ("uictest/result/2", True)
    call("run", scenario("a").absolute(), "--seed", "7")
    manifest = manifest_of()
    assert manifest["command"] == ["uictest", "run", "scenarios/a.yaml", "--seed", "7"]
    assert manifest["seed"] == 7
    assert "scenarios/a.yaml" in manifest["inputs"]
    assert str(Path.cwd()) not in json.dumps(manifest)


def test_github_annotates_what_is_not_met_and_quiet_shows_nothing_else(call, scenario, made_up):
    scenario("a")
    scenario("b", "tags: [fail]\n")
    text = call("run", "--format", "github").out
    assert verdicts_in(text) == {"a": "pass", "b": "fail"}
    (error,) = [line for line in text.splitlines() if line.startswith("::")]
    assert error.startswith("::error file=scenarios/b.yaml,title=fail b::")
    answer = call("run", "-q")
    assert verdicts_in(answer.out) == {"b": "fail"}
    assert answer.err == ""


@pytest.mark.parametrize("option", [["-x"], ["--maxfail", "1"]])
def test_the_first_missed_case_ends_the_run(call, scenario, made_up, option):
    for name in "abc":
        scenario(name, "tags: [fail]\n")
    answer = call("run", *option, code=1)
    assert verdicts_in(answer.out) == {"a": "fail"}
    assert "FAILED: 1 of 1 case failed: a; 2 not run; took " in answer.out
    assert results_of()["complete"] is False


def test_colour_is_off_unless_wanted(call, scenario, made_up, monkeypatch):
    scenario("a")
    assert "\x1b" not in call("run").out
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert "\x1b[32mpass" in call("run").out
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b" not in call("run").out


def test_the_summary_of_a_job_is_appended(call, scenario, made_up, monkeypatch):
    scenario("a")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "step.md")
    call("run", code=0)
    assert "## uictest: 1 case: 1 pass" in Path("step.md").read_text()
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "no/such/folder")
    call("run", code=0, says="GITHUB_STEP_SUMMARY cannot be written")


def raising(error):
    def fail(*_, **__):
        raise error

    return fail


def test_an_internal_error_shows_where_it_arose_and_ends_with_its_reason(call, scenario, monkeypatch):
    scenario("a")
    monkeypatch.setattr(report, "run_manifest", raising(RuntimeError("a \x1b[31mbug")))
    lines = call("run", code=3).err.splitlines()
    assert lines[0].startswith("Traceback")
    assert lines[-1] == r"uictest: internal error: RuntimeError: a \x1b[31mbug"


@pytest.mark.parametrize(
    ("place", "name", "what"),
    [
        (campaign, "run_cases", lambda *_, **__: campaign.BatchResult([], interrupted=True)),
        (report, "publish", raising(KeyboardInterrupt())),
    ],
)
def test_an_interrupt_before_anything_is_published_exits_2_and_writes_nothing(
    call, scenario, made_up, monkeypatch, place, name, what
):
    scenario("a")
    monkeypatch.setattr(place, name, what)
    assert call("run", "--format", "json", code=2, says="interrupted").out == ""
    assert not any(Path("reports").iterdir() if Path("reports").exists() else ())


HEAVY = "vehicle.body.mass: warning: axle load 40.7 t, plausible 4 to 25 t"


def test_an_implausible_train_is_warned_of_in_every_report_and_a_usual_one_has_its_figures(
    call, scenario, made_up
):
    path = scenario("a", "vehicle: {extends: intercity-180, body: {mass: 150 t}}\n")
    call("run", path, "--strict", code=4, says=HEAVY.replace("warning: ", ""))
    answer = call("run", path, "-v", says=HEAVY)
    assert "part car: car mass 162.6 t, axle load 40.66 t, braked weight percentage" in answer.out
    (case,) = results_of()["cases"]
    assert case["car"]["mass_t"] == pytest.approx(150.0 + 2 * 2.615 + 4 * 1.85)
    (found,) = case["car"]["implausible"]
    likely = "the mass of several cars?"
    assert (found["name"], found["span"], found["likely"]) == ("axle-load", [4.0, 25.0], likely)
    for name in ("index.html", "junit.xml"):
        assert "implausible: axle load 40.7 t, plausible 4 to 25 t" in latest(name).read_text()
    call("run", "dry-120", "--set", "vehicle.body.mass=150 t", code=0, says=f"dry-120:1:1: {HEAVY}")
    assert [found["name"] for found in results_of()["cases"][0]["car"]["implausible"]] == ["axle-load"]
    assert "warning" not in call("run", scenario("a")).err
    assert results_of()["cases"][0]["car"] == {
        "mass_t": pytest.approx(45.0),
        "axle_load_t": pytest.approx(11.25),
        "braked_weight_percentage": pytest.approx(149.6, abs=0.1),
    }


def test_a_met_case_is_recorded_when_asked_and_a_missed_one_always(call, scenario):
    path = scenario("stop", "matrix:\n  brake.command: [80 %, 90 %]\n")
    call("run", path, "--record", "all", "--record-rate", "50", code=0)
    ids = ["stop[command=80]", "stop[command=90]"]
    assert sorted(path.stem for path in latest("recordings").iterdir()) == ids
    scenario("stop")
    assert verdicts_in(call("run", code=0).out) == {"stop": "pass"}
    assert not latest("recordings").exists()
    call("run", "--set", "expect=invalid", code=1)
    assert latest("recordings/stop.parquet").is_file()


def test_results_are_the_same_bits_with_and_without_recording_and_on_any_number_of_threads(call, scenario):
    scenario("stop", "matrix:\n  rail.friction: [0.05, 0.1]\n  rail.condition: [wet]\n")
    results = []
    for options in (["-n1"], ["-n2"], ["-n", "auto"], ["--record", "all", "--record-rate", "200"]):
        call("run", *options)
        results.append(results_of()["cases"])
    assert results == [results[0]] * 4


def test_the_option_repeats_every_stop_and_reports_are_written_again_from_the_results(call, scenario):
    path = scenario("stop", f"{WET}seed: 3\nrepeat: 2\n")
    answer = call("run", path, "--repeat", "3", "--record", "all", code=0)
    assert re.search("^stop +pass .* pass 3/3 ", answer.out, re.MULTILINE), answer.out
    assert [stop["seed"] for stop in results_of()["cases"][0]["repeats"]["stops"]] == [3, 4, 5]
    assert len(latest("tables/repeats.csv").read_text("utf-8").splitlines()) == 4
    call("report", "reports/latest", "--format", "csv,html,md", "-o", "again", code=0)
    for name in ("summary.csv", "criteria.csv", "tables/repeats.csv"):
        assert Path("again", name).read_bytes() == latest(name).read_bytes()
    assert "3 stops, seeds 3..5: all pass" in Path("again/index.html").read_text("utf-8").lower()
    call("run", path, "--repeat", "1")
    assert "repeats" not in results_of()["cases"][0]
    assert not latest("tables").exists()


def test_an_expectation_is_met_by_all_stops_and_a_baseline_compares_their_medians_and_number(call, scenario):
    path = scenario("stop", f"{WET}expect: fail\n")
    answer = call("run", path, "--repeat", "2", code=1)
    assert verdicts_in(answer.out) == {"stop": "unexpected pass"}
    assert "stop should not have passed\n  pass, expected: fail" in answer.out
    call("run", path, "--repeat", "2", "--lf", code=1)
    path = scenario("stop", WET)
    call("run", path, "--repeat", "2", "--baseline", "accepted", "--accept")
    call("run", path, "--repeat", "2", "--baseline", "accepted", code=0)
    answer = call("run", path, "--repeat", "3", "--baseline", "accepted", "--tolerance", "100%", code=1)
    assert "baseline: stops was 2, rule all, is 3, rule all" in answer.out


def test_a_recording_is_one_stop(call, scenario):
    path = scenario("stop", f"{WET}repeat: 2\n")
    call("run", path, "--record", "all")
    note = "note: stop: `repeat` plays no part: a recording is one stop"
    answer = call("evaluate", latest("recordings/stop.parquet"), "--scenario", path, code=0, says=note)
    assert "stops" not in answer.out

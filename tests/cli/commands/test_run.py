import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from uictest import report
from uictest.running import campaign

pytestmark = pytest.mark.usefixtures("made_up")


def _reports():
    return sorted(path.name for path in Path("reports").iterdir()) if Path("reports").exists() else []


def test_met_cases_exit_0_with_one_line_each_and_reports_on_disk(call, scenario):
    scenario("a")
    scenario("b")
    answer = call("run", code=0)
    assert [line.split()[:2] for line in answer.out.splitlines()] == [["pass", "a"], ["pass", "b"]]
    assert "2 cases: 2 pass" in answer.err
    files = sorted(path.name for path in Path("reports/latest/").iterdir())
    assert files == [
        "SHA256SUMS",
        "criteria.csv",
        "index-entry.json",
        "index.html",
        "junit.xml",
        "manifest.json",
        "results.json",
        "summary.csv",
        "wheelsets.csv",
    ]


def test_a_missed_case_exits_1_and_an_error_3(call, scenario):
    scenario("a", "tags: [fail]\nexpect: fail\n")
    assert call("run").code == 0
    scenario("a", "tags: [fail]\n")
    assert call("run").code == 1
    scenario("b", "tags: [error]\n")
    answer = call("run", code=3)
    assert "error b outcome=error expect=pass reason=ZeroDivisionError: no wheel load" in answer.out


def test_nothing_selected_exits_5_and_writes_nothing(call, scenario):
    scenario("a", "tags: [wet]\n")
    answer = call("run", "-k", "snow")
    assert (answer.code, answer.out) == (5, "")
    assert "among 1 case; their tags: wet" in answer.err
    assert _reports() == []


@pytest.mark.parametrize(
    "arguments",
    [
        ["--no-such-option"],
        ["-k", "a and"],
        ["-m", "(wet"],
        ["-n", "0"],
        ["-n", "many"],
        ["--maxfail", "0"],
        ["--seed", "-1"],
        ["--seed", "4294967296"],
        ["--format", "xml"],
        ["--record", "some"],
        ["--record-rate", "0"],
        ["--record-rate", "nan"],
        ["--durations", "-1"],
        ["--set", "no-equals-sign"],
        ["--set", "rail.frictoin=0.1"],
        ["missing.yaml"],
    ],
)
def test_a_usage_error_exits_4_with_one_message_and_nothing_written(call, scenario, arguments):
    scenario("a")
    answer = call("run", *arguments)
    assert (answer.code, answer.out) == (4, "")
    assert answer.err
    assert "Traceback" not in answer.err
    assert _reports() == []


def test_without_a_folder_of_scenarios_the_way_to_one_is_shown(call):
    call("run", code=4, says="uictest init")


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
    assert call("run", *arguments).code == 0
    assert sorted(made_up) == sorted(ids)


def test_dry_run_lists_and_does_nothing(call, scenario, made_up):
    scenario("a", "matrix:\n  brake.command: [80 %, 90 %]\n")
    answer = call("run", "--dry-run")
    assert (answer.code, answer.out) == (0, "a[command=80]\na[command=90]\n")
    assert made_up == _reports() == []


def test_set_sweeps_and_durations_name_the_slowest(call, scenario):
    scenario("a")
    assert call("run", "--set", "brake.command=80 %,90 %").code == 0
    header, *rows = Path("reports/latest/summary.csv").read_text().splitlines()
    assert "parameters.brake.command" in header
    assert len(rows) == 2
    scenario("b")
    assert "the slowest 1 of 2 cases" in call("run", "--durations", "1").err
    assert "the slowest 2 of 2 cases" in call("run", "--durations", "0").err


def test_json_is_the_document_and_nothing_else(call, scenario):
    scenario("a")
    answer = call("run", "--format", "json")
    assert answer.out == Path("reports/latest/results.json").read_text()
    document = json.loads(answer.out)
    assert (document["schema"], document["complete"]) == ("uictest/result/2", True)


def test_github_annotates_what_is_not_met_and_quiet_shows_nothing_else(call, scenario):
    scenario("a")
    scenario("b", "tags: [fail]\n")
    lines = call("run", "--format", "github").out.splitlines()
    assert [line.split()[0] for line in lines] == ["pass", "fail", "::error"]
    assert lines[2].startswith("::error file=scenarios/b.yaml,title=fail b::")
    answer = call("run", "-q")
    assert [line.split()[0] for line in answer.out.splitlines()] == ["fail"]
    assert answer.err == ""


@pytest.mark.parametrize("file", ["no/junit.xml", "."])
def test_junit_with_no_place_is_refused_before_the_first_case(call, scenario, made_up, file):
    scenario()
    call("run", "--junitxml", file, code=3, says=f"cannot write {file}: ")
    assert not made_up


@pytest.mark.parametrize("file", ["junit.xml", "out/junit.xml", "out/latest/other.xml"])
def test_junit_is_written_where_it_is_wanted_and_in_the_reports(call, scenario, file):
    scenario("a", "tags: [fail]\n")
    call("run", "--junitxml", file, "-o", "out")
    root = ElementTree.parse(file).getroot()
    assert root.find("testsuite/testcase/failure") is not None
    assert Path("out/latest/junit.xml").read_text() == Path(file).read_text()


@pytest.mark.parametrize("option", [["-x"], ["--maxfail", "1"]])
def test_the_first_missed_case_ends_the_run(call, scenario, option):
    for name in "abc":
        scenario(name, "tags: [fail]\n")
    answer = call("run", *option, code=1)
    assert answer.out.count("outcome=fail expect=pass") == 1
    assert "2 not run" in answer.err
    assert json.loads(Path("reports/latest/results.json").read_text())["complete"] is False


def test_colour_is_off_unless_wanted(call, scenario, monkeypatch):
    scenario("a")
    assert "\x1b" not in call("run").out
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert "\x1b[32mpass\x1b[0m a" in call("run").out
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b" not in call("run").out


def test_the_manifest_holds_command_seed_and_inputs(call, scenario):
    path = scenario("a")
    call("run", path.absolute(), "--seed", "7")
    manifest = json.loads(Path("reports/latest/manifest.json").read_text())
    assert manifest["command"] == ["uictest", "run", "scenarios/a.yaml", "--seed", "7"]
    assert manifest["seed"] == 7
    assert "scenarios/a.yaml" in manifest["inputs"]
    assert str(Path.cwd()) not in json.dumps(manifest)


def test_an_internal_error_shows_where_it_arose_and_ends_with_its_reason(call, scenario, monkeypatch):
    def broken(*_):
        raise RuntimeError("a \x1b[31mbug")

    scenario("a")
    monkeypatch.setattr(report, "run_manifest", broken)
    lines = call("run", code=3).err.splitlines()
    assert lines[0].startswith("Traceback")
    assert lines[-1] == r"uictest: internal error: RuntimeError: a \x1b[31mbug"


def test_an_interrupt_before_the_first_case_is_finished_exits_2_and_writes_nothing(
    call, scenario, monkeypatch
):
    scenario("a")
    monkeypatch.setattr(campaign, "run_cases", lambda *_, **__: campaign.BatchResult([], interrupted=True))
    answer = call("run", "--format", "json")
    assert (answer.code, answer.out) == (2, "")
    assert "interrupted" in answer.err
    assert _reports() == []


def test_an_interrupt_outside_the_simulation_exits_2(call, scenario, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    scenario("a")
    monkeypatch.setattr(report, "write_reports", interrupted)
    assert call("run").code == 2
    assert _reports() == []


def test_an_implausible_train_is_warned_of_and_stands_in_every_report(call, scenario, workplace):
    path = scenario("a", "vehicle: {extends: intercity-180, body: {mass: 150 t}}\n")
    call("run", path, "--strict", code=4, says="vehicle.body.mass: axle load 40.7 t, plausible 4 to 25 t")
    answer = call("run", path, "-v", "--report", "csv,html,junit")
    assert "vehicle.body.mass: warning: axle load 40.7 t" in answer.err
    assert "part car: car mass 162.6 t, axle load 40.66 t, braked weight percentage" in answer.out
    folder = workplace / "reports" / "latest"
    (case,) = json.loads((folder / "results.json").read_text())["cases"]
    assert case["car"]["mass_t"] == pytest.approx(150.0 + 2 * 2.615 + 4 * 1.85)
    (found,) = case["car"]["implausible"]
    assert (found["name"], found["span"], found["likely"]) == (
        "axle-load",
        [4.0, 25.0],
        "the mass of several cars?",
    )
    for name in ("index.html", "junit.xml"):
        assert "implausible: axle load 40.7 t, plausible 4 to 25 t" in (folder / name).read_text()


def test_a_shipped_scenario_that_options_make_implausible_is_warned_of_and_run(call, workplace):
    answer = call("run", "dry-120", "--set", "vehicle.body.mass=150 t", code=0)
    assert "dry-120:1:1: vehicle.body.mass: warning: axle load 40.7 t, plausible 4 to 25 t" in answer.err
    (case,) = json.loads((workplace / "reports" / "latest" / "results.json").read_text())["cases"]
    assert [found["name"] for found in case["car"]["implausible"]] == ["axle-load"]


def test_a_usual_train_has_its_figures_and_no_warning(call, scenario, workplace):
    answer = call("run", scenario("a"))
    assert "warning" not in answer.err
    (case,) = json.loads((workplace / "reports" / "latest" / "results.json").read_text())["cases"]
    assert case["car"] == {
        "mass_t": pytest.approx(45.0),
        "axle_load_t": pytest.approx(11.25),
        "braked_weight_percentage": pytest.approx(149.6, abs=0.1),
    }

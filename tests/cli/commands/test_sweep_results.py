"""What a sweep leaves for people and for CI services, and what it says of controllers from outside."""

import csv
import html
import re
import shlex
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from ..conftest import manifest_of, results_of

FOLDER = Path("reports/pads")
TEXT = """\
schema: uictest/scenario/1
name: pads
extends: scenarios/stop.yaml
vary:
  matrix:
    brake.system.disc.pad_friction: [0.30, 0.45]
    brake.command: [80 %, 100 %]
"""
HEADLINE = "## uictest sweep: 4 cases: 4 pass; 4 not as expected\n"
CONTROLLER = """\
from uictest.controllers import Config, Inputs, Outputs


class Share:
    def __init__(self, config: Config) -> None:
        self.share = config.parameters.get("share", 0.0)

    def reset(self) -> None:
        pass

    def step(self, inputs: Inputs) -> Outputs:
        if self.share < 0:
            raise ValueError("a share below zero")
        holds = inputs.cycle % 10 < 10 * self.share
        return Outputs([holds] * 4, [0] * 4)


PARAMETERS = {"share": {"default": 0.0, "unit": "1"}}
"""
"""Holds in a share of all cycles: the more, the longer the stop."""


@pytest.fixture
def pads(scenario):
    """Write a sweep of four stops that are expected to fail and do not, or of other values."""
    scenario("stop", "expect: fail\n")

    def write(vary=""):
        head, own = TEXT.split("  matrix")
        Path("pads.sweep.yaml").write_text(f"{head}  {vary or 'matrix' + own}\n")
        return "pads.sweep.yaml"

    return write


def rows(name="summary.csv"):
    with (FOLDER / name).open() as file:
        return list(csv.DictReader(file))


def test_reports_are_written_in_the_formats_asked_for_and_in_others_later(call, pads, monkeypatch):
    Path("summary").write_text("# Before\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "summary")
    call("sweep", pads(), "--report", "md", code=1)
    assert (FOLDER / "summary.md").read_text().startswith(HEADLINE)
    assert Path("summary").read_text().startswith(f"# Before\n{HEADLINE}")
    answer = call("report", FOLDER, "--format", "csv,xlsx,md", "-o", "elsewhere", code=0)
    names = {path.relative_to("elsewhere").as_posix() for path in Path("elsewhere").rglob("*.*")}
    assert names == {Path(line).relative_to("elsewhere").as_posix() for line in answer.out.splitlines()}
    tables = {"summary.csv", "tables/rates.csv", "tables/map-met.csv"}
    assert {*tables, "report.xlsx", "summary.md"} <= names
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "no/folder")
    call("sweep", pads(), "--report", "md", code=1, says="GITHUB_STEP_SUMMARY cannot be written")
    assert (FOLDER / "summary.md").exists()


@pytest.mark.parametrize("name", ["results.json", "summary.parquet"])
def test_a_damaged_sweep_is_rejected(call, pads, name):
    call("sweep", pads(), "--report", "csv")
    (FOLDER / name).write_text("{}")
    answer = call("report", FOLDER, "--format", "xlsx", code=4, says="cannot be read as a sweep")
    assert answer.out == ""


def test_github_gets_annotations_below_the_findings_and_alone_with_q(call, pads):
    lines = call("sweep", pads(), "--format", "github").out.splitlines()
    errors = [line for line in lines if line.startswith("::error ")]
    [error] = errors  # one for all that is missed alike
    assert "file=pads.sweep.yaml,title=4 cases should not have passed::worst pads[" in error
    notice = "::notice file=pads.sweep.yaml,title=uictest sweep pads::4 cases: 4 pass; 4 not as expected"
    assert lines[-1] == notice
    assert any("Cases met" in line for line in lines)
    assert call("sweep", pads(), "--format", "github", "-q").out.splitlines() == [*errors, notice]


def test_the_page_draws_the_worst_cases_and_is_made_again_and_nothing_of_an_earlier_result_stays(call, pads):
    call("sweep", pads())
    page = FOLDER / "index.html"
    first = page.read_bytes()
    assert first.count(b'<details class="stop"') == 4
    assert len(list((FOLDER / "recordings").iterdir())) == 4
    page.unlink()
    call("report", FOLDER, "--format", "html", code=0)
    assert page.read_bytes() == first
    file = pads()
    call("sweep", file, "--report", "html", "--measure", "braking_time_s")
    (FOLDER / "notes.csv").write_text("mine")
    call("sweep", file, "--report", "csv")
    names = {path.relative_to(FOLDER).as_posix() for path in FOLDER.rglob("*")}
    assert {"tables/map-braking_distance_m.csv", "notes.csv", "results.json"} <= names
    assert names.isdisjoint({"tables/map-braking_time_s.csv", "index.html"})


def test_the_command_for_one_stop_works_as_printed_beside_the_sweep(call, pads):
    call("sweep", pads(), "--seed", "7", "--set", "brake.command=80 %,90 %", "--report", "html,csv")
    written = re.search(r"<code>([^<]* -k [^<]*CASE[^<]*)</code>", (FOLDER / "index.html").read_text("utf-8"))
    for command in ("80", "90"):
        case = f"pads[command={command},pad_friction=0.30]"
        words = shlex.split(html.unescape(written[1]).replace("CASE", case))
        assert words[0] == "uictest"
        call(*words[1:], code=1)
        (row,) = (Path("alone", case, "pads/summary.csv").read_text().splitlines())[1:]
        assert row in (FOLDER / "summary.csv").read_text().splitlines()


def test_a_case_in_error_is_3_and_a_row_and_not_drawn(call, pads):
    steps = "matrix: {simulation.time_step: [0.5 ms, 0.4 ms], controller.cycle_time: [10 ms, 5 ms]}"
    call("sweep", pads(steps), code=3)
    assert results_of(FOLDER)["outcomes"]["error"] == 1
    assert any("does not divide" in case["reason"] for case in results_of(FOLDER)["missed"])
    page = (FOLDER / "index.html").read_text()
    assert 'class="word word-odd"' in page
    assert page.count('<details class="stop"') == 3


@pytest.mark.parametrize("options", [(), ("--report", "csv")])
def test_so_many_cases_are_written_as_csv_only_when_asked(call, pads, monkeypatch, options):
    monkeypatch.setattr("uictest.report.sweep.LARGEST_CSV", 95)
    monkeypatch.setattr("uictest.report.LARGEST_CSV", 95, raising=False)
    sample = "sample: {size: 96, parameters: {brake.command: {uniform: [60 %, 100 %]}}}"
    answer = call("sweep", pads(sample), "--set", "initial_speed=5 km/h", *options)
    assert (FOLDER / "summary.csv").exists() == bool(options)
    assert (FOLDER / "summary.parquet").exists()
    assert ("note: every case is a row of summary.parquet" in answer.out) != bool(options)
    assert "all of them: summary.parquet" in answer.out


def test_cases_that_no_criterion_applies_to_are_counted(call, pads):
    file = pads("matrix: {brake.command: [80 %, 100 %], rail.friction: [0.08, 0.12]}")
    stated = ("criteria=[uic-541-05-appendix-b]", "expect=pass", "rail.condition=wet")
    options = tuple(f"--set={each}" for each in stated)
    # The stops are from 30 km/h; with the WSP bypassed they are of no kind that the profile is for.
    call("sweep", file, *options, code=1, says="4 cases: 4 inconclusive; 4 not as expected")
    skipped = (*options, "--set", "rig.wsp=bypassed", "--restart")
    done = call("sweep", file, *skipped, code=1, says="4 cases: 4 skipped; 4 not as expected")
    assert re.search(r"0\.12 +2 +0 +0 +2 ", done.out)
    assert "note: 4 cases not judged, since no criterion applies" in done.out


def test_the_frontier_is_written_and_shown(call, pads):
    file = pads("matrix: {rail.friction: [0.02, 0.2], brake.command: [100 %]}")
    stop = ("initial_speed=40 km/h", "rig.wsp=bypassed", "expect=pass", "rail.condition=wet")
    options = ("--frontier", "rail.friction", "--tolerance", "0.02")
    answer = call("sweep", file, *(f"--set={each}" for each in stop), *options)
    assert "Frontier along rail.friction" in answer.out
    (flip,) = rows("tables/frontier.csv")
    assert list(flip) == ["brake.command", "from", "to", "met_at_from", "flips", "note"]
    assert 0.0 < float(flip["to"]) - float(flip["from"]) <= 0.02


def test_a_survey_says_what_it_repeated_and_what_its_step_does(call, pads):
    file = pads()
    result = call("sweep", file, "--set", "simulation.time_step=survey", "--report", "html,md")
    survey = results_of(FOLDER)["survey"]
    bias = next(each for each in survey["biases"] if each["measure"] == "uncorrected_braking_distance")
    assert (survey["time_step"], survey["regular_step"]) == ("1 ms", "0.5 ms")
    assert survey["repeated"] == 0
    begin = "survey in steps of 1 ms, which settled all of 4 cases"
    assert f"note: {begin}" in result.out
    assert "note: bias of the survey step: uncorrected_braking_distance at most" in result.out
    assert bias["case"] in "".join(result.out.split())
    for name in ("summary.md", "index.html"):
        assert begin in html.unescape((FOLDER / name).read_text()), name
    table = pq.read_table(FOLDER / "summary.parquet").to_pylist()
    distance = {row["id"]: row["braking_distance_m"] for row in table}
    for case in results_of(FOLDER)["worst"]:
        assert case["measures"]["braking_distance_m"] == distance[case["id"]]
    # The chunks of a survey are no others.
    call("sweep", file, code=4, says="time step: survey before, none now")


@pytest.fixture
def share(pads, scenario):
    """Write a sweep of stops with that controller, for which these values are listed."""
    controller = "controller: {python: ../share.py, class: Share}\n"
    scenario("stop", f"{controller}measures: {{extends: standard}}\ncriteria: [uictest-stop]\n")
    Path("share.py").write_text(CONTROLLER)
    return lambda *values, key="controller.parameters.share": pads(f"matrix: {{{key}: {list(values)}}}")


def test_a_controller_that_fails_is_an_error_and_the_sweep_goes_on(call, share):
    call("sweep", share(0, -1, 0.3), code=3)
    first, failed, last = rows()
    assert [row["outcome"] == "error" for row in (first, failed, last)] == [False, True, False]
    assert failed["reason"].startswith("controller: step failed: ValueError: a share below zero")
    assert failed["reason"].endswith("(cycle 0)")
    assert float(first["braking_distance_m"]) < float(last["braking_distance_m"])


def test_another_content_of_the_controller_is_another_sweep(call, share):
    file = share(0, 0.3)
    assert call("sweep", file).code in (0, 1)
    first = rows()
    assert len(manifest_of(FOLDER)["inputs"]["share.py"]) == 64
    Path("share.py").write_text(CONTROLLER + "\n")
    answer = call("sweep", file, code=4, says="holds chunks of this sweep with other inputs")
    assert "inputs: share.py" in answer.err
    assert call("sweep", file, "--restart").code in (0, 1)
    assert rows() == first


def test_an_axis_of_controllers_names_them_and_the_frontier_of_a_parameter_is_found(call, share):
    part = "schema: uictest/controller/1\npython: share.py\nclass: Share\nparameters: {share: 0.5}\n"
    Path("own.yaml").write_text(part)
    file = share("threshold", {"python": "share.py", "class": "Share"}, "own.yaml", key="controller")
    assert call("sweep", file).code in (0, 1)
    names = ("threshold", "share", "own")
    assert [row["id"] for row in rows()] == [f"pads[controller={name}]" for name in names]
    assert {"share.py", "own.yaml"} <= manifest_of(FOLDER)["inputs"].keys()
    options = ("--frontier", "controller.parameters.share", "--tolerance", "0.1", "--restart")
    answer = call("sweep", share(0.0, 1.0), *options, "--set", "simulation.maximum_duration=15 s", code=1)
    assert "Frontier along controller.parameters.share" in answer.out
    (flip,) = rows("tables/frontier.csv")
    assert 0.0 < float(flip["from"]) < float(flip["to"]) <= 1.0
    assert float(flip["to"]) - float(flip["from"]) <= 0.1

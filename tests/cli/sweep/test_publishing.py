"""`uictest sweep` and `uictest report`: what a sweep leaves for people and for GitHub."""

import html
import json
import re
import shlex
from pathlib import Path

import pytest

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


@pytest.fixture
def pads(scenario):
    """A sweep of four stops that are expected to fail and do not."""
    scenario("stop", "expect: fail\n")
    Path("pads.sweep.yaml").write_text(TEXT)
    return Path("pads.sweep.yaml")


HEADLINE = "## uictest sweep: 4 cases: 4 pass; 4 not as expected\n"


def test_reports_are_written_in_the_formats_asked_for_and_in_others_later(call, pads, monkeypatch):
    Path("summary").write_text("# Before\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "summary")
    assert call("sweep", pads, "--report", "md").code == 1
    assert (FOLDER / "summary.md").read_text().startswith(HEADLINE)
    assert Path("summary").read_text().startswith(f"# Before\n{HEADLINE}")
    answer = call("report", FOLDER, "--format", "csv,xlsx,md", "-o", "elsewhere", code=0)
    written = {Path(line).name for line in answer.out.splitlines()}
    assert {"summary.csv", "rates.csv", "map-met.csv", "report.xlsx", "summary.md"} <= written
    assert written == {path.name for path in Path("elsewhere").iterdir()}
    assert Path("elsewhere/report.xlsx").read_bytes().startswith(b"PK")


def test_a_format_there_is_not_is_rejected_and_a_summary_that_cannot_be_written_undoes_nothing(
    call, pads, monkeypatch
):
    answer = call("sweep", pads, "--report", "pdf")
    assert (answer.code, answer.out, FOLDER.exists()) == (4, "", False)
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(Path("no/folder")))
    call("sweep", pads, "--report", "md", code=1, says="GITHUB_STEP_SUMMARY cannot be written")
    assert (FOLDER / "summary.md").exists()


def test_nothing_of_an_earlier_result_stays_beside_another(call, pads):
    call("sweep", pads, "--report", "html", "--measure", "braking_time_s")
    (FOLDER / "notes.csv").write_text("mine")
    call("sweep", pads, "--report", "csv")
    names = {path.name for path in FOLDER.iterdir()}
    assert {"map-braking_distance_m.csv", "notes.csv", "sweep.json"} <= names
    assert names.isdisjoint({"map-braking_time_s.csv", "index.html"})
    call("sweep", pads, "--report", "html")
    call("sweep", pads, "--report", "csv")
    assert (FOLDER / "index.html").exists()


@pytest.mark.parametrize("name", ["sweep.json", "summary.parquet"])
def test_a_damaged_sweep_is_rejected(call, pads, name):
    call("sweep", pads, "--report", "csv")
    (FOLDER / name).write_text("{}")
    answer = call("report", FOLDER, "--format", "xlsx")
    assert (answer.code, answer.out) == (4, "")
    assert "cannot be read as a sweep" in answer.err


def test_github_gets_annotations_below_the_findings_and_alone_with_q(call, pads):
    lines = call("sweep", pads, "--format", "github").out.splitlines()
    errors = [line for line in lines if line.startswith("::error ")]
    assert len(errors) == 4
    assert "file=pads.sweep.yaml,title=unexpected pass pads[" in errors[0]
    notice = "::notice file=pads.sweep.yaml,title=uictest sweep pads::4 cases: 4 pass; 4 not as expected"
    assert lines[-1] == notice
    assert any("Cases met" in line for line in lines)
    assert call("sweep", pads, "--format", "github", "-q").out.splitlines() == [*errors, notice]


def test_the_page_draws_the_worst_cases_and_can_be_made_again(call, pads):
    call("sweep", pads)
    page = FOLDER / "index.html"
    first = page.read_bytes()
    assert first.count(b'<details class="stop"') == 4
    assert len(list((FOLDER / "recordings").iterdir())) == 4
    page.unlink()
    assert call("report", FOLDER, "--format", "html").code == 0
    assert page.read_bytes() == first


def test_the_command_for_one_stop_works_as_printed_beside_the_sweep(call, pads):
    call("sweep", pads, "--seed", "7", "--set", "brake.command=80 %,90 %", "--report", "html,csv")
    written = re.search(r"<code>([^<]* -k [^<]*)</code>", (FOLDER / "index.html").read_text("utf-8"))
    for command in ("80", "90"):
        case = f"pads[command={command},pad_friction=0.30]"
        words = shlex.split(html.unescape(written[1]).replace("CASE", case))
        assert words[0] == "uictest"
        assert call(*words[1:]).code == 1
        (row,) = (Path("alone", case, "pads/summary.csv").read_text().splitlines())[1:]
        of_sweep = (FOLDER / "summary.csv").read_text().splitlines()
        assert row in of_sweep


def test_a_case_in_error_is_3_and_a_row_and_not_drawn(call, pads):
    steps = "  matrix: {simulation.time_step: [0.5 ms, 0.4 ms], controller.cycle_time: [10 ms, 5 ms]}\n"
    pads.write_text(TEXT.split("  matrix")[0] + steps)
    assert call("sweep", pads).code == 3
    document = json.loads((FOLDER / "sweep.json").read_text())
    assert document["outcomes"]["error"] == 1
    assert any("does not divide" in case["reason"] for case in document["missed"])
    page = (FOLDER / "index.html").read_text()
    assert 'class="word word-odd"' in page
    assert page.count('<details class="stop"') == 3

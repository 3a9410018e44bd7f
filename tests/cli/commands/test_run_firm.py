"""`uictest run --firm`: what every report says of it, on a short stop with few draws."""

import csv
from pathlib import Path

import pytest

from uictest.analysis.firmness import Effort
from uictest.cli import run_display
from uictest.runs import firmness

from ..conftest import manifest_of, results_of, verdicts_in

STOP = "rail: {condition: wet, friction: 0.1}\ncriteria: uictest-stop\n"
TURNED = """\
rail: {condition: dry}
criteria:
  name: own
  criteria:
    - {id: short, layer: requirement, measure: braking_distance, upper: 36 m}
brake:
  system:
    extends: ep-disc
    disc: {pad_friction: {value: 0.38, range: [0.30, 0.42]}}
"""


@pytest.fixture(autouse=True)
def _few(monkeypatch):
    monkeypatch.setattr(firmness, "EFFORT", Effort(blocks=2, block=4, seeds=2, seeds_at_ends=1))


def run(call, path, *arguments, code=0, report="csv,md"):
    answer = call("run", path, "--report", report, *arguments, code=code)
    document = results_of()
    return answer, document["cases"]


def rows(folder):
    with Path(folder, "tables/firmness.csv").open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def test_a_scenario_asks_for_it_and_every_report_says_how_firm_a_case_is(call, scenario):
    answer, [case] = run(call, scenario("stop", f"{STOP}firm: true\n"), report="csv,html,md")
    found = case["firmness"]
    assert "calibrated" not in found
    assert found["status"] == "not_shown"  # nothing turns it, in eight draws
    assert (found["draws"], found["seeds"], found["on_four_calipers"]) == (8, 2, True)
    sentence = "pass is not shown to be firm: it stands in all of 8 draws"
    assert f"stop: {sentence}" in answer.out
    assert "stop: not varied, as no range is stated: rail.friction" in answer.out
    folder = Path("reports/latest")
    for name in ("summary.md", "index.html"):
        assert sentence in (folder / name).read_text("utf-8"), name
    page = (folder / "index.html").read_text("utf-8")
    assert "why this range and prior" in page and ">log-uniform<" in page
    assert '<property name="firmness" value="not_shown"' in (folder / "junit.xml").read_text("utf-8")
    priors = {number["key"]: number["prior"] for number in found["numbers"]}
    assert priors == {row["key"]: row["prior"] for row in rows(folder)}
    assert all(row["reason"] for row in rows(folder))
    assert priors["rail.condition.friction_ratio"] == "uniform"
    assert priors["rail.condition.friction_decay"] == "log-uniform"
    reasons = {number["key"]: number["reason"] for number in found["numbers"]}
    assert all(prior in reasons[key].lower() for key, prior in priors.items())
    call("report", folder, "--format", "csv,html", "-o", "again", code=0)
    assert rows("again") == rows(folder)
    assert "not shown to be firm" in Path("again/index.html").read_text("utf-8")


def test_a_number_that_turns_a_verdict_is_named_with_its_value_and_misses_strict(call, scenario):
    path = scenario("stop", TURNED)
    answer, [case] = run(call, path, "--firm", "--strict", code=1)
    turns = {each["key"]: each for each in case["firmness"]["turned_by"]}
    turn = turns["brake.system.disc.pad_friction"]
    assert (turn["side"], turn["criterion"], turn["to"]) == ("below", "short", "fail")
    assert 0.30 < float(turn["turned_from"]) <= float(turn["value"]) <= float(turn["stands_to"]) < 0.38
    key = "brake.system.disc.pad_friction"
    for value, code in ((turn["end"], 1), (turn["stands_to"], 0)):
        assert call("run", path, "--set", f"{key}={value}", "--set", "rig.topology=four-caliper").code == code
    assert f"turned by brake.system.disc.pad_friction below {turn['value']}" in " ".join(answer.out.split())
    assert run(call, path, "--strict")[0].code == 0
    assert verdicts_in(answer.out) == {"stop": "unsettled"}
    assert "  uictest run scenarios/stop.yaml --firm --strict -k stop\n" in answer.out
    assert "stop has a verdict that is not settled\n  pass, unsettled. Expected: pass" in answer.out


def test_an_outcome_that_is_not_shown_is_not_said_to_be_firm_and_seeds_go_on_from_0(call, scenario):
    # A rig with one caliper stops within 33.463 m, one with four within 33.491 m.
    path = scenario("stop", TURNED.replace("36 m", "33.47 m"))
    answer, [case] = run(call, path, "--firm", "--strict", code=1)
    assert (case["outcome"], case["firmness"]["nominal"]) == ("pass", "fail")
    sentence = "pass is not shown to be firm: the stops that were varied come to fail"
    assert sentence in " ".join(answer.out.split())
    _, [case] = run(call, scenario("stop", STOP), "--firm", "--seed", 2**32 - 1)
    assert case["firmness"]["status"] == "not_shown"  # the stops under further seeds can be run


def test_nothing_is_said_where_it_was_not_asked_and_an_interrupt_leaves_an_incomplete_run(
    call, scenario, monkeypatch
):
    answer, [case] = run(call, scenario("stop", STOP))
    assert "firmness" not in case
    assert "firm" not in answer.out
    assert not Path("reports/latest/tables").exists()

    def interrupt(own, case):
        raise KeyboardInterrupt

    monkeypatch.setattr(firmness.FirmnessRun, "of_case", interrupt)
    _, [case] = run(call, scenario("stop", STOP), "--firm", code=2)
    assert "firmness" not in case
    assert results_of()["complete"] is False
    assert "Incomplete" in Path("reports/latest/summary.md").read_text("utf-8")


def test_of_the_cases_of_a_series_it_is_not_asked(call, scenario, monkeypatch):
    monkeypatch.delattr(firmness.FirmnessRun, "of_case")
    text = "rail: {condition: dry}\ncriteria: uictest-stop\nfirm: true\n"
    scenario("dry", text)
    scenario("wet", STOP)
    series = Path("scenarios/small.series.yaml")
    series.write_text(
        "schema: uictest/series/1\nname: small\nrepeat: 1\ndry: dry.yaml\nwet: wet.yaml\n"
        "criteria: uictest-wsp\n"
    )
    answer = call("run", series)
    assert answer.code in (0, 1)
    assert "firm" not in answer.out


def test_a_terminal_tells_once_what_a_strict_case_lacks(call, scenario, monkeypatch):
    monkeypatch.setattr(run_display, "interactive", lambda stream: True)
    monkeypatch.setenv("COLUMNS", "500")
    answer, _ = run(call, scenario("stop", TURNED), "--firm", "--strict", code=1)
    assert answer.out.count("run with a caliper in every module") == 1


def test_calibrating_stops_choose_among_the_draws_and_one_that_is_missed_is_refused(call, scenario):
    stop, missed = scenario("stop", TURNED), scenario("missed", TURNED.replace("36 m", "5 m"))
    says = "missed is not pass at the nominal values"
    call("run", stop, "--firm", "--calibrated-by", missed, code=4, says=says)
    stop = scenario("stop", TURNED)
    # The pads that stop within 34 m are those of the upper half of the range; all stop within 50 m.
    of_half, of_all = (
        scenario(name, TURNED.replace("36 m", limit)) for name, limit in (("half", "34 m"), ("all", "50 m"))
    )
    answer, [case] = run(call, stop, "--firm", "--calibrated-by", of_half)
    assert case["firmness"]["calibrated_by"] == ["half"]
    assert 0 < case["firmness"]["calibrated"]["counted"] < 8
    assert case["firmness"]["calibrated"]["share"] == 1.0
    assert "of them in which half comes to what it expects" in answer.out
    manifest = manifest_of()
    assert any(name.endswith("half.yaml") for name in manifest["inputs"])
    _, [case] = run(call, stop, "--firm", "--calibrated-by", of_all)
    assert case["firmness"]["calibrated"] == {"counted": 8, "share": case["firmness"]["share"]}


def test_a_sweep_says_how_firm_its_nominal_case_is_in_every_report(call, scenario):
    path = scenario("stop", f"{TURNED}vary:\n  matrix: {{brake.command: [90 %, 100 %]}}\n")
    answer = call("sweep", path, "--firm", "--report", "csv,html,md")
    folder = Path("reports/stop")
    [nominal] = results_of(folder)["nominal"]
    assert "brake.system.disc.pad_friction" in {each["key"] for each in nominal["firmness"]["turned_by"]}
    sentence = "pass is not firm: it stands in"
    for text in (answer.out, *((folder / name).read_text("utf-8") for name in ("summary.md", "index.html"))):
        assert sentence in text
    assert {row["id"] for row in rows(folder)} == {"stop"}
    call("sweep", path)
    assert not (folder / "tables/firmness.csv").exists()
    assert results_of(folder)["nominal"] == []

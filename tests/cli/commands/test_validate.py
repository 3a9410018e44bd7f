"""`uictest validate` and `uictest run --validated`: hand-made recordings with a known bias."""

import csv
import json
import shutil
from html import unescape
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from uictest.analysis.validation import read_validation
from uictest.running.campaign import train_blocks

from ..conftest import FIGURES

SIMULATED = FIGURES["braking_distance_m"]
"""What every simulation comes to here, m."""


def record(name, distance, speed_kmh=30.0):
    """Write the record of a train that stops within a distance (m) at a constant deceleration."""
    speed = speed_kmh / 3.6
    deceleration = speed**2 / (2.0 * distance)
    time = np.arange(-1.0, speed / deceleration + 1.0, 0.05)
    speeds = np.clip(speed - deceleration * time, 0.0, speed)
    lines = ["time [s],speed [m/s]", *(f"{t:.2f},{v!r}" for t, v in zip(time, speeds.tolist(), strict=True))]
    Path(name).write_text("\n".join(lines) + "\n", "utf-8")
    return name


@pytest.fixture
def validate(call, scenario, made_up):
    """Validate records, whose simulation is made up, against a stop from 30 km/h."""
    scenario("stop", "rail: {condition: wet, friction: 0.1}\n")
    Path("map.yaml").write_text(
        "schema: uictest/channel-map/1\nname: m\nextends: uictest\npreparation: {trigger_time: 0 s}\n"
    )

    def run(*entries, options=(), text=""):
        stops = "".join(f"  - {{scenario: scenarios/stop.yaml, map: map.yaml, {each}}}\n" for each in entries)
        head = "schema: uictest/validation/1\nname: my-train\n"
        Path("my.validation.yaml").write_text(f"{head}{text}stops:\n{stops}", "utf-8")
        return call("validate", "my.validation.yaml", *options)

    return run


def newest():
    return max(Path("reports").glob("validation-*"), key=lambda folder: folder.stat().st_mtime_ns)


def rows(name):
    with (newest() / name).open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def distance(table="figures.csv"):
    """The row of the braking distance."""
    [row] = [row for row in rows(table) if row["figure"] == "braking_distance_m"]
    return row


def run_results():
    return json.loads(Path("reports/latest/results.json").read_text("utf-8"))


def test_a_known_bias_of_the_distance_is_found(validate):
    """Simulated stops are 5, 10 and 15 m longer than these records: bias 10 m, deviation 5 m."""
    files = [record(f"r{error}.csv", SIMULATED - error) for error in (5, 10, 15)]
    answer = validate(f"recordings: [{', '.join(files)}]")
    assert answer.code == 0
    figure = distance()
    assert figure["stops"] == "3"
    assert float(figure["bias"]) == pytest.approx(10.0, abs=1e-3)
    assert float(figure["deviation"]) == pytest.approx(5.0, abs=1e-3)
    # Student's t with two degrees of freedom: 4.3027.
    assert float(figure["bias_high"]) == pytest.approx(10.0 + 4.30265 * 5.0 / 3**0.5, abs=1e-3)
    assert float(figure["limits_low"]) == pytest.approx(10.0 - 4.30265 * 5.0 * (4 / 3) ** 0.5, abs=1e-3)
    expected = np.mean([error / (SIMULATED - error) for error in (5, 10, 15)])
    assert float(figure["relative_bias"]) == pytest.approx(expected, rel=1e-4)
    assert "3 of 3 recorded stops counted" in answer.err
    lines = answer.out.splitlines()
    assert any(line.startswith("braking_distance_m") and "+10" in line for line in lines)


def test_every_stop_is_in_the_table_one_claims_no_spread_and_json_is_the_document(validate):
    validate(f"recordings: [{record('a.csv', SIMULATED - 5.0)}]")
    row = distance("stops.csv")
    assert (row["stop"], row["recording"], row["counted"]) == ("my-train.stop.a", "a.csv", "true")
    assert float(row["simulated"]) == SIMULATED
    assert float(row["difference"]) == pytest.approx(5.0, abs=1e-3)
    answer = validate(f"recordings: [{record('a.csv', SIMULATED)}]")
    assert "not compared, as no counted stop has both: " in answer.out
    assert "maximum_disc_temperature_degc_1" not in answer.out
    assert "one stop: it shows a difference, and nothing of bias or spread" in answer.out
    figure = distance()
    assert (figure["deviation"], figure["bias_low"], figure["limits_high"]) == ("", "", "")
    answer = validate(f"recordings: [{record('a.csv', SIMULATED)}]", options=("--format", "json"))
    assert answer.out == (newest() / "validation.json").read_text("utf-8")
    document = json.loads(answer.out)
    assert (document["schema"], document["kind"]) == ("uictest/result/2", "validation")
    assert {"my.validation.yaml", "scenarios/stop.yaml", "map.yaml", "a.csv"} <= set(document["inputs"])


def test_a_stop_that_the_numbers_come_from_is_listed_and_not_counted(validate):
    used, other = record("used.csv", SIMULATED - 100.0), record("other.csv", SIMULATED - 5.0)
    answer = validate(f"recordings: [{used}], tuned: true", f"recordings: [{other}]")
    assert answer.code == 0
    assert "not counted: numbers of its scenario were found with it" in answer.out
    figure = distance()
    assert (figure["stops"], float(figure["bias"])) == ("1", pytest.approx(5.0, abs=1e-3))
    assert "1 of 2 recorded stops counted" in answer.err


def test_every_recorded_stop_has_a_draw_of_its_own_whatever_the_others_are(validate, monkeypatch):
    """One draw for all stops of a speed would make the interval of the bias too narrow."""
    simulated = {}
    run_stop = train_blocks.run_stop

    def noted(stop, *rest):
        simulated[stop.case.id.rpartition(".")[2]] = stop.case.scenario.seed
        return run_stop(stop, *rest)

    monkeypatch.setattr(train_blocks, "run_stop", noted)
    files = [record(f"r{error}.csv", SIMULATED - error) for error in (5, 10, 15)]
    answer = validate(f"recordings: [{', '.join(files)}]")
    seeds = dict(simulated)
    assert len(set(seeds.values())) == 3
    assert "simulated draws: one seed per stop, from the seed of its scenario" in answer.out
    assert "one seed per stop" in (newest() / "validation.md").read_text("utf-8")
    page = (newest() / "index.html").read_text("utf-8")
    assert "3 of 3 recorded stops counted" in page
    assert "braking_distance_m: +" in page[page.index("limits of agreement") :]  # drawn, with its bias
    assert {row["draws"] for row in rows("figures.csv")} == {"one seed per stop"}
    shown = {row["stop"].rpartition(".")[2]: row["seed"] for row in rows("stops.csv")}
    assert {name: int(seed) for name, seed in shown.items()} == seeds
    document = json.loads((newest() / "validation.json").read_text("utf-8"))
    assert [stop["seed"] for stop in document["stops"]] == list(seeds.values())
    simulated.clear()
    validate(f"recordings: [{files[2]}, {files[0]}]")
    assert simulated == {"r15": seeds["r15"], "r5": seeds["r5"]}


def test_two_files_of_one_name_are_not_compared_with_one_simulation(validate):
    for folder in ("monday", "tuesday"):
        Path(folder).mkdir()
        record(f"{folder}/run.csv", SIMULATED)
    answer = validate("recordings: [monday/run.csv]", "recordings: [tuesday/run.csv], repeat: 1")
    assert answer.code == 4
    assert "a second recorded stop 'my-train.stop.run', of tuesday/run.csv and monday/run.csv" in answer.err
    assert list(Path("reports").glob("*")) == []


def test_a_copy_of_a_record_is_no_second_stop(validate):
    copy = Path(shutil.copy(record("a.csv", SIMULATED - 5.0), "b.csv"))
    answer = validate(f"recordings: [a.csv, {copy}]")
    assert answer.code == 1
    assert "stop my-train.stop.b from 30 km/h" in answer.out
    assert "not counted: a copy of a.csv" in answer.out
    assert (distance()["stops"], distance()["deviation"]) == ("1", "")
    answer = validate(f"recordings: [{copy}]", "recordings: [a.csv], tuned: true")
    assert answer.code == 1
    assert "not counted: a copy of a.csv" in answer.out
    assert "0 of 2 recorded stops counted" in answer.err


def test_a_stop_from_another_speed_than_its_scenario_is_not_counted(validate):
    near, far = record("near.csv", SIMULATED, 32.0), record("far.csv", SIMULATED, 34.0)
    slow, copy = record("slow.csv", SIMULATED, 26.0), shutil.copy("far.csv", "copy.csv")
    answer = validate(f"recordings: [{near}, {far}, {slow}, {copy}]")
    assert answer.code == 1
    why = "not counted: its scenario begins at 30 km/h, more than 3 km/h away"
    for name, speed in (("far", 34), ("slow", 26), ("copy", 34)):
        assert f"stop my-train.stop.{name} from {speed} km/h: {why}" in answer.out
    validation = read_validation(newest() / "validation.json").validation
    assert [stop.id for stop in validation.counted] == ["my-train.stop.near"]


def test_a_record_without_an_end_is_named_and_the_others_count(validate):
    Path("bad.csv").write_text("time [s],speed [m/s]\n0,8\n1,nan\n")
    answer = validate(f"recordings: [bad.csv, {record('good.csv', SIMULATED)}]")
    assert answer.code == 1
    assert (
        "stop my-train.stop.bad from 28.8 km/h: not counted: the record has no braking distance" in answer.out
    )
    validation = read_validation(newest() / "validation.json").validation
    assert [domain.stops for domain in validation.domains] == [1]


def test_a_simulation_that_fails_is_an_error_and_never_a_figure(validate, scenario):
    scenario("stop", "tags: [error]\n")
    answer = validate(f"recordings: [{record('a.csv', SIMULATED)}]")
    assert answer.code == 3
    assert "not counted: simulation: ZeroDivisionError: no wheel load" in answer.out
    assert rows("figures.csv") == []


def test_a_series_without_recordings_says_what_to_write(call, scenario):
    scenario("dry", "rail: {condition: dry}\n")
    scenario("wet", "rail: {condition: wet}\n")
    text = "schema: uictest/series/1\nname: s\ndry: scenarios/dry.yaml\nwet: scenarios/wet.yaml\n"
    Path("s.series.yaml").write_text(text)
    call("validate", "s.series.yaml", code=4, says="no stop names a recording: list them under `recordings`")


@pytest.fixture
def validated(validate, made_once):
    """The document of a validation from 29 to 31 km/h."""

    def make():
        files = [record(f"r{speed}.csv", SIMULATED, float(speed)) for speed in (29, 31)]
        assert validate(f"recordings: [{', '.join(files)}]").code == 0

    made_once(make)
    return newest() / "validation.json"


def test_cases_outside_of_what_was_validated_are_flagged(call, validated):
    changes = ("--set", "initial_speed=30 km/h,40 km/h")
    answer = call("run", "scenarios/stop.yaml", *changes, "--validated", validated, "--report", "html")
    assert answer.code == 0
    flags = [line for line in answer.out.splitlines() if line.startswith("outside")]
    why = "initial_speed 40 km/h > 31 km/h"
    assert flags == [f"outside stop[initial_speed=40kmh] of what my-train validated: {why}"]
    count = "1 of 2 cases outside of what my-train validated"
    flag = f"outside of what my-train validated: {why}"
    assert count in answer.err
    inside, outside = (case["domain_of_validity"] for case in run_results()["cases"])
    assert (inside["validation"], inside["outside"]) == ("my-train", [])
    assert [each["key"] for each in outside["outside"]] == ["initial_speed"]
    folder = Path("reports/latest")
    manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
    assert inside["sha256"] in manifest["inputs"].values()
    page = unescape((folder / "index.html").read_text("utf-8"))
    assert count in page
    assert page.count(flag) == 1
    said = [each.text or "" for each in ElementTree.parse(folder / "junit.xml").iter("system-out")]
    assert sum(flag in text for text in said) == 1


def test_without_the_option_nothing_is_said_and_results_with_a_domain_are_read_back(call, validated):
    answer = call("run", "scenarios/stop.yaml", "--set", "initial_speed=90 km/h")
    assert "outside" not in answer.out + answer.err
    assert "domain_of_validity" not in Path("reports/latest/results.json").read_text("utf-8")
    call("run", "scenarios/stop.yaml", "--set", "vehicle=crh380a", "--validated", validated)
    before = Path("reports/latest/results.json").read_text("utf-8")
    call("report", "reports/latest", "--format", "md", code=0)
    assert "outside of what my-train validated" in Path("reports/latest/summary.md").read_text("utf-8")
    assert Path("reports/latest/results.json").read_text("utf-8") == before


@pytest.mark.parametrize("named", ["option", "scenario"])
@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"schema": "uictest/result/1"}, "not the result of a validation"),
        ({"domains": []}, "none of its stops is counted"),
        ({"domains": [{"stops": "two"}]}, "other.json: domains.0."),
        ({"verdict": "pass"}, "other.json: verdict: "),
        (None, "other.json"),
    ],
)
def test_a_document_that_is_none_is_refused(call, validated, scenario, change, message, named):
    if change is not None:
        document = json.loads(validated.read_text("utf-8")) | change
        Path("scenarios/other.json").write_text(json.dumps(document), "utf-8")
    if named == "scenario":
        scenario("stop", "validated: other.json\n")
    options = ("--validated", "scenarios/other.json") if named == "option" else ()
    call("run", "scenarios/stop.yaml", *options, code=4, says=message if named == "option" else "other.json")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"confidence": "high"}, "confidence: Input should be a valid number"),
        ({"stops": [{"id": 3}]}, "stops.0."),
    ],
)
def test_check_refuses_a_validation_that_run_refuses(call, validated, scenario, change, message):
    """With the place in the scenario; both name the file and the key in it."""
    document = json.loads(validated.read_text("utf-8")) | change
    Path("scenarios/other.json").write_text(json.dumps(document), "utf-8")
    scenario("stop", "validated: other.json\n")
    run, check = (call(command, "scenarios/stop.yaml") for command in ("run", "check"))
    assert run.code == check.code == 4
    assert f"uictest: scenarios/other.json: {message}" in run.err
    assert f"scenarios/stop.yaml:4:12: validated: scenarios/other.json: {message}" in check.out + check.err


def test_a_scenario_names_the_validation_that_its_cases_are_held_against(call, validated, scenario):
    shutil.copy(validated, "scenarios/train.json")
    friction = "rail: {condition: wet, friction: 0.1}\n"
    scenario("fast", f"{friction}validated: train.json\n")
    scenario("other", friction)
    answer = call("run", "scenarios", "--set", "initial_speed=40 km/h", code=0)
    results = run_results()
    asked = {case["id"]: "domain_of_validity" in case for case in results["cases"]}
    assert asked == {"fast": True, "other": False, "stop": False}
    assert "outside fast of what my-train validated: initial_speed 40 km/h > 31 km/h" in answer.out
    assert "1 of 1 case outside of what my-train validated" in answer.err
    manifest = json.loads(Path("reports/latest/manifest.json").read_text("utf-8"))
    assert "scenarios/train.json" in manifest["inputs"]


def test_the_option_takes_the_place_of_what_a_scenario_names(call, validated, scenario):
    document = json.loads(validated.read_text("utf-8")) | {"name": "another-train"}
    Path("scenarios/another.json").write_text(json.dumps(document), "utf-8")
    scenario("stop", "rail: {condition: wet, friction: 0.1}\nvalidated: another.json\n")
    for options, name in (((), "another-train"), (("--validated", validated), "my-train")):
        call("run", "scenarios/stop.yaml", *options)
        results = run_results()
        assert results["cases"][0]["domain_of_validity"]["validation"] == name


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("none.json", "no such file: 'none.json'"),
        ("stop.yaml", "'stop.yaml' is not the result of a validation"),
        ("list.json", "'list.json' is not the result of a validation"),
        ("old.json", "'old.json' is written by uictest 0.2 or older: run it again"),
        ("/etc/hostname", "is an absolute path"),
        ("../../elsewhere.json", "leads out of"),
        ("[a.json]", "expected a text, found a list"),
    ],
)
@pytest.mark.parametrize("command", ["check", "run"])
def test_what_a_scenario_names_is_checked_on_loading(call, scenario, command, text, message):
    scenario("stop", f"validated: {text}\n")
    Path("scenarios/list.json").write_text("[]")
    Path("scenarios/old.json").write_text('{"schema": "uictest/validation-result/1"}')
    answer = call(command, "scenarios/stop.yaml", code=4)
    shown = answer.out + answer.err
    assert "scenarios/stop.yaml:4:12: validated: " in shown
    assert message in shown


@pytest.fixture
def study(validated):
    """A sweep of four stops, of which three are outside of the validation."""
    path = Path("study.sweep.yaml")
    head = "schema: uictest/scenario/1\nname: study\nextends: scenarios/stop.yaml\n"
    path.write_text(
        f"{head}vary: {{matrix: {{initial_speed: [30 km/h, 32 km/h], brake.command: [100 %, 90 %]}}}}\n"
    )
    return path


NOTE = (
    "3 of 4 cases outside of what my-train validated: initial_speed 32 km/h > 31 km/h in 2;"
    " brake.command 0.9 < 1 in 2"
)


def test_a_sweep_counts_and_names_the_cases_outside(call, validated, study):
    answer = call("sweep", study, "--validated", validated, "--report", "csv,html")
    assert answer.code in (0, 1)
    assert f"note: {NOTE}" in answer.out
    folder = Path("reports/study")
    with (folder / "summary.csv").open(encoding="utf-8") as file:
        outside = {row["id"]: set(row["outside"].split()) for row in csv.DictReader(file)}
    speed, command = "initial_speed", "brake.command"
    assert list(outside.values()) == [set(), {command}, {speed}, {speed, command}]
    found = json.loads((folder / "sweep.json").read_text("utf-8"))["domain_of_validity"]
    assert (found["validation"], found["outside"]) == ("my-train", 3)
    counts = [(each["deviation"]["key"], each["cases"]) for each in found["conditions"]]
    assert counts == [(speed, 2), (command, 2)]
    assert NOTE in unescape((folder / "index.html").read_text("utf-8"))


def test_another_validation_simulates_nothing_again(call, validated, study):
    call("sweep", study)
    before = json.loads(Path("reports/study/sweep.json").read_text("utf-8"))
    assert before["domain_of_validity"] is None
    assert "outside" not in Path("reports/study/summary.csv").read_text("utf-8").splitlines()[0]
    answer = call("sweep", study, "--validated", validated)
    assert "4 of 4 cases are already finished" in answer.err
    after = json.loads(Path("reports/study/sweep.json").read_text("utf-8"))
    assert after["domain_of_validity"]["outside"] == 3
    assert after["outcomes"] == before["outcomes"]


def test_a_swept_scenario_names_its_validation(call, validated, study, scenario):
    shutil.copy(validated, "scenarios/train.json")
    scenario("stop", "rail: {condition: wet, friction: 0.1}\nvalidated: train.json\n")
    answer = call("sweep", study, "--format", "json")
    assert json.loads(answer.out)["domain_of_validity"]["outside"] == 3

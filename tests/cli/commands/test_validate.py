"""`uictest validate` and `uictest run --validated`: hand-made recordings with a known bias."""

import csv
import json
import shutil
from html import unescape
from pathlib import Path

import numpy as np
import pytest

from uictest.running.campaign import stop as stop_module

from ..conftest import FIGURES, manifest_of, results_of

SIMULATED = FIGURES["braking_distance_m"]
"""What every simulation comes to here, m."""
FROM_OTHER_SPEED = "its scenario begins at 30 km/h, more than 3 km/h away"


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

    def run(*entries, options=(), **expected):
        stops = "".join(f"  - {{scenario: scenarios/stop.yaml, map: map.yaml, {each}}}\n" for each in entries)
        head = "schema: uictest/validation/1\nname: my-train\n"
        Path("my.validation.yaml").write_text(f"{head}stops:\n{stops}", "utf-8")
        return call("validate", "my.validation.yaml", *options, **expected)

    return run


def newest():
    return max(Path("reports").glob("validation-*"), key=lambda folder: folder.stat().st_mtime_ns)


def rows(name):
    with (newest() / "tables" / name).open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def distance(table="figures.csv"):
    """The row of the braking distance."""
    [row] = [row for row in rows(table) if row["figure"] == "braking_distance_m"]
    return row


def test_a_known_bias_of_the_distance_is_found(validate):
    """Simulated stops are 5, 10 and 15 m longer than these records: bias 10 m, deviation 5 m."""
    files = [record(f"r{error}.csv", SIMULATED - error) for error in (5, 10, 15)]
    answer = validate(f"recordings: [{', '.join(files)}]", code=0, says="3 of 3 recorded stops counted")
    figure = distance()
    assert figure["stops"] == "3"
    assert float(figure["bias"]) == pytest.approx(10.0, abs=1e-3)
    assert float(figure["deviation"]) == pytest.approx(5.0, abs=1e-3)
    # Student's t with two degrees of freedom: 4.3027.
    assert float(figure["bias_high"]) == pytest.approx(10.0 + 4.30265 * 5.0 / 3**0.5, abs=1e-3)
    assert float(figure["limits_low"]) == pytest.approx(10.0 - 4.30265 * 5.0 * (4 / 3) ** 0.5, abs=1e-3)
    expected = np.mean([error / (SIMULATED - error) for error in (5, 10, 15)])
    assert float(figure["relative_bias"]) == pytest.approx(expected, rel=1e-4)
    lines = answer.out.splitlines()
    bias, low, high = (
        100.0 * float(figure[f"relative_{name}"]) for name in ("bias", "bias_low", "bias_high")
    )
    said = (
        "no difference is shown by 3 stops"
        if low < 0.0 < high
        else f"simulated stops are {bias:.2g} % longer"
    )
    assert lines[0].startswith(said)
    assert any(line.startswith("braking_distance_m") and "+10" in line for line in lines)
    assert [line.split()[0] for line in lines if line.startswith("my-train.stop.")] == [
        f"my-train.stop.r{error}" for error in (15, 10, 5)
    ]


def test_the_page_lays_a_record_over_its_simulation_under_the_answer(call, scenario):
    path = scenario("stop", "rail: {condition: wet, friction: 0.1}\n")
    call("run", path, "--record", "all", "--report", "csv", "--set", "rail.friction=0.11")
    head = "schema: uictest/validation/1\nname: my-train\n"
    stops = "stops: [{scenario: scenarios/stop.yaml, recordings: [reports/latest/recordings/stop.parquet]}]\n"
    Path("my.validation.yaml").write_text(head + stops, "utf-8")
    answer = call("validate", "my.validation.yaml", code=0)
    said = answer.out.splitlines()[0]
    assert said.startswith("simulated stops are ")
    assert said.endswith(" longer than recorded: 1 stop shows no interval")
    page = unescape((newest() / "index.html").read_text("utf-8"))
    assert f"<h1>S{said[1:]}</h1>" in page
    assert page.count('class="plots laid-over"') == 1
    assert "A <code>recorded</code>" in page
    for channel in ("speed", "slide_1", "tank_pressure_1"):
        assert f'data-channel="{channel}"' in page


def test_one_stop_claims_no_spread_and_json_is_the_document(validate):
    files = f"recordings: [{record('a.csv', SIMULATED - 5.0)}]"
    answer = validate(files)
    row = distance("stops.csv")
    assert (row["stop"], row["recording"], row["counted"]) == ("my-train.stop.a", "a.csv", "true")
    assert float(row["simulated"]) == SIMULATED
    assert float(row["difference"]) == pytest.approx(5.0, abs=1e-3)
    assert "not compared, as no counted stop has both: " in answer.out
    assert "maximum_disc_temperature_degc_1" not in answer.out
    assert "one stop: it shows a difference, and nothing of bias or spread" in answer.out
    figure = distance()
    assert (figure["deviation"], figure["bias_low"], figure["limits_high"]) == ("", "", "")
    answer = validate(files, options=("--format", "json"))
    assert answer.out == (newest() / "validation.json").read_text("utf-8")
    document = json.loads(answer.out)
    assert (document["schema"], document["kind"]) == ("uictest/result/2", "validation")
    assert {"my.validation.yaml", "scenarios/stop.yaml", "map.yaml", "a.csv"} <= set(document["inputs"])


def test_every_recorded_stop_has_a_draw_of_its_own_whatever_the_others_are(validate, monkeypatch):
    """One draw for all stops of a speed would make the interval of the bias too narrow."""
    simulated = {}
    run_stop = stop_module.run_stop

    def noted(stop, *rest):
        simulated[stop.case.id.rpartition(".")[2]] = stop.case.scenario.seed
        return run_stop(stop, *rest)

    monkeypatch.setattr(stop_module, "run_stop", noted)
    files = [record(f"r{error}.csv", SIMULATED - error) for error in (5, 10, 15)]
    answer = validate(f"recordings: [{', '.join(files)}]")
    seeds = dict(simulated)
    assert len(set(seeds.values())) == 3
    assert "simulated draws: one seed per stop, from the seed of its scenario" in answer.out
    assert "one seed per stop" in (newest() / "summary.md").read_text("utf-8")
    page = (newest() / "index.html").read_text("utf-8")
    assert "3 of 3 recorded stops counted" in page
    assert "braking_distance_m: +" in page[page.index("limits of agreement") :]  # drawn, with its bias
    assert {row["draws"] for row in rows("figures.csv")} == {"one seed per stop"}
    shown = {row["stop"].rpartition(".")[2]: row["seed"] for row in rows("stops.csv")}
    assert {name: int(seed) for name, seed in shown.items()} == seeds
    simulated.clear()
    validate(f"recordings: [{files[2]}, {files[0]}]")
    assert simulated == {"r15": seeds["r15"], "r5": seeds["r5"]}


def test_two_files_of_one_name_are_not_compared_with_one_simulation(validate):
    for folder in ("monday", "tuesday"):
        Path(folder).mkdir()
        record(f"{folder}/run.csv", SIMULATED)
    says = "a second recorded stop 'my-train.stop.run', of tuesday/run.csv and monday/run.csv"
    other = "recordings: [tuesday/run.csv], repeat: 1"
    validate("recordings: [monday/run.csv]", other, code=4, says=says)
    assert list(Path("reports").glob("*")) == []


@pytest.mark.parametrize(
    ("entries", "code", "counted", "not_counted"),
    [
        (
            ["a.csv], tuned: true", "b.csv]"],
            *(0, ["b"], {"a from 30 km/h": "numbers of its scenario were found with it"}),
        ),
        (["a.csv, copy.csv]"], 1, ["a"], {"copy from 30 km/h": "a copy of a.csv"}),
        (["copy.csv]", "a.csv], tuned: true"], 1, [], {"copy from 30 km/h": "a copy of a.csv"}),
        (
            ["near.csv, far.csv, slow.csv]"],
            *(1, ["near"], {"far from 34 km/h": FROM_OTHER_SPEED, "slow from 26 km/h": FROM_OTHER_SPEED}),
        ),
        (["bad.csv, a.csv]"], 1, ["a"], {"bad from 28.8 km/h": "the record has no braking distance"}),
    ],
)
def test_a_stop_that_is_not_counted_says_why_and_is_in_no_figure(
    validate, entries, code, counted, not_counted
):
    Path("bad.csv").write_text("time [s],speed [m/s]\n0,8\n1,nan\n")
    record("a.csv", SIMULATED - 100.0)
    record("b.csv", SIMULATED - 5.0)
    shutil.copy("a.csv", "copy.csv")
    for name, speed in (("near", 32.0), ("far", 34.0), ("slow", 26.0)):
        record(f"{name}.csv", SIMULATED, speed)
    stops = sum(each.count(".csv") for each in entries)
    says = f"{len(counted)} of {stops} recorded stops counted"
    answer = validate(*(f"recordings: [{each}" for each in entries), code=code, says=says)
    for stop, why in not_counted.items():
        said = " ".join(answer.out.split())
        file = f"{stop.partition(' ')[0]}.csv"
        assert f"not counted: my-train.stop.{stop} ({file}): {why}" in said
    document = json.loads((newest() / "validation.json").read_text("utf-8"))
    assert [stop["id"] for stop in document["stops"] if not stop["not_counted"] and not stop["tuned"]] == [
        f"my-train.stop.{name}" for name in counted
    ]
    assert not counted or distance()["stops"] == str(len(counted))


def test_a_simulation_that_fails_is_an_error_and_never_a_figure(validate, scenario):
    scenario("stop", "tags: [error]\n")
    answer = validate(f"recordings: [{record('a.csv', SIMULATED)}]", code=3)
    assert "not counted: my-train.stop.a from 30 km/h (a.csv): simulation: ZeroDivisionError" in answer.out
    assert rows("figures.csv") == []


@pytest.fixture
def validated(validate, made_once):
    """The document of a validation from 29 to 31 km/h."""

    def make():
        files = [record(f"r{speed}.csv", SIMULATED, float(speed)) for speed in (29, 31)]
        validate(f"recordings: [{', '.join(files)}]", code=0)

    made_once(make)
    return newest() / "validation.json"


def test_cases_outside_of_what_was_validated_are_flagged(call, validated):
    changes = ("--set", "initial_speed=30 km/h,40 km/h", "--report", "html,md")
    count = "1 of 2 cases outside of what my-train validated"
    answer = call("run", "scenarios/stop.yaml", *changes, "--validated", validated, code=0, says=count)
    flags = [line for line in answer.out.splitlines() if "]: outside" in line]
    why = "initial_speed 40 km/h > 31 km/h"
    assert flags == [f"stop[initial_speed=40kmh]: outside of what my-train validated: {why}"]
    inside, outside = (case["domain_of_validity"] for case in results_of()["cases"])
    assert (inside["validation"], inside["outside"]) == ("my-train", [])
    assert [each["key"] for each in outside["outside"]] == ["initial_speed"]
    folder = Path("reports/latest")
    manifest = manifest_of(folder)
    assert inside["sha256"] in manifest["inputs"].values()
    for name in ("index.html", "junit.xml"):
        assert f"outside of what my-train validated: {why}" in unescape((folder / name).read_text("utf-8"))
    assert count in unescape((folder / "index.html").read_text("utf-8"))
    # Results with a domain are read back, without a simulation.
    summary = (folder / "summary.md").read_text("utf-8")
    assert count in summary
    call("report", folder, "--format", "md", "-o", "again", code=0)
    assert Path("again/summary.md").read_text("utf-8") == summary


def test_without_the_option_nothing_is_said_and_with_it_nothing_is_simulated_again(call, validated, study):
    answer = call("run", "scenarios/stop.yaml", "--set", "initial_speed=90 km/h")
    assert "outside" not in answer.out + answer.err
    assert "domain_of_validity" not in Path("reports/latest/results.json").read_text("utf-8")
    call("sweep", study)
    before = results_of("reports/study")
    assert before["domain_of_validity"] is None
    assert "outside" not in Path("reports/study/summary.csv").read_text("utf-8").splitlines()[0]
    answer = call("sweep", study, "--validated", validated)
    assert "4 of 4 cases are already finished" in answer.err
    after = results_of("reports/study")
    assert after["domain_of_validity"]["outside"] == 3
    assert after["outcomes"] == before["outcomes"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"schema": "uictest/result/1"}, "not the result of a validation"),
        ({"domains": []}, "none of its stops is counted"),
        ({"domains": [{"stops": "two"}]}, "other.json: domains.0."),
        ({"verdict": "pass"}, "other.json: verdict: "),
        ({"confidence": "high"}, "confidence: Input should be a valid number"),
        ({"stops": [{"id": 3}]}, "stops.0."),
        (None, "other.json"),
    ],
)
def test_a_document_that_is_none_is_refused_by_run_and_by_check(call, validated, scenario, change, message):
    """Named in the scenario, with the place there; both name the file and the key in it."""
    if change is not None:
        document = json.loads(validated.read_text("utf-8")) | change
        Path("scenarios/other.json").write_text(json.dumps(document), "utf-8")
    call("run", "scenarios/stop.yaml", "--validated", "scenarios/other.json", code=4, says=message)
    scenario("stop", "validated: other.json\n")
    call("run", "scenarios/stop.yaml", code=4, says="other.json")
    answer = call("check", "scenarios/stop.yaml", code=4, says="scenarios/stop.yaml:4:12: validated: ")
    assert change is None or {"schema", "domains"} & change.keys() or message in answer.err


def test_a_scenario_names_the_validation_that_its_cases_are_held_against(call, validated, scenario):
    """The option takes the place of it."""
    document = json.loads(validated.read_text("utf-8")) | {"name": "another-train"}
    Path("scenarios/train.json").write_text(json.dumps(document), "utf-8")
    friction = "rail: {condition: wet, friction: 0.1}\n"
    scenario("fast", f"{friction}validated: train.json\n")
    scenario("other", friction)
    says = "1 of 1 case outside of what another-train validated"
    answer = call("run", "scenarios", "--set", "initial_speed=40 km/h", code=0, says=says)
    asked = {case["id"]: "domain_of_validity" in case for case in results_of()["cases"]}
    assert asked == {"fast": True, "other": False, "stop": False}
    assert "fast: outside of what another-train validated: initial_speed 40 km/h > 31 km/h" in answer.out
    manifest = manifest_of()
    assert "scenarios/train.json" in manifest["inputs"]
    call("run", "scenarios/fast.yaml", "--validated", validated)
    assert results_of()["cases"][0]["domain_of_validity"]["validation"] == "my-train"


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


def test_a_sweep_counts_and_names_the_cases_outside_also_of_the_validation_that_a_scenario_names(
    call, validated, study, scenario
):
    answer = call("sweep", study, "--validated", validated, "--report", "csv,html")
    assert answer.code in (0, 1)
    assert f"note: {NOTE}" in " ".join(answer.out.split())
    folder = Path("reports/study")
    with (folder / "summary.csv").open(encoding="utf-8") as file:
        outside = {row["id"]: set(row["outside"].split()) for row in csv.DictReader(file)}
    speed, command = "initial_speed", "brake.command"
    assert list(outside.values()) == [set(), {command}, {speed}, {speed, command}]
    found = results_of(folder)["domain_of_validity"]
    assert (found["validation"], found["outside"]) == ("my-train", 3)
    counts = [(each["deviation"]["key"], each["cases"]) for each in found["conditions"]]
    assert counts == [(speed, 2), (command, 2)]
    assert NOTE in unescape((folder / "index.html").read_text("utf-8"))
    shutil.copy(validated, "scenarios/train.json")
    scenario("stop", "rail: {condition: wet, friction: 0.1}\nvalidated: train.json\n")
    answer = call("sweep", study, "--format", "json", "-o", "again")
    assert json.loads(answer.out)["domain_of_validity"]["outside"] == 3

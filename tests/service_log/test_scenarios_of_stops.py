"""Scenarios made of the stops of a log: they simulate what was recorded, or it is said that they do not."""

import json
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import yaml
from pyarrow import parquet

from tests.service_log import logs
from uictest.cli.entry import execute
from uictest.core.recording import Recording
from uictest.plans.scenario import load
from uictest.recorded import field_data
from uictest.recorded.service_log import command_course
from uictest.runs.made_scenario import assumptions

SHIPPED = Path(__file__).parents[2] / "scenarios"
COURSE = [
    {"at": "0 s", "value": "60 %"},
    {"at": "4 s", "value": "100 %", "position": "emergency"},
    {"at": "9 s", "value": "0 %"},
    {"at": "11 s", "value": "80 %"},
]


def suite(folder, stops, conditions=logs.CONDITIONS, *arguments, without=()):
    """Make scenarios of simulated stops, and return their folder."""
    path = logs.write_log(stops, folder / "night.parquet")
    parquet.write_table(parquet.read_table(path).drop_columns(list(without)), path)
    (folder / "night.yaml").write_text(conditions, "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        options = ["--scenario", "night.yaml", "--scenarios", "suite", "-q", *arguments]
        assert execute(["log", "night.parquet", *options]) in (0, 1)
    return folder / "suite"


def compared(made):
    """Return the differences of distance and time in % by stop, as README.md has them."""
    rows = re.findall(
        r"\| `(stop-\d+)\.yaml` .*?\(([-+.\d]+) %\).*?\(([-+.\d]+) %\)", (made / "README.md").read_text()
    )
    return {name: (float(distance), float(time)) for name, distance, time in rows}


@pytest.fixture(name="made", scope="module")
def _made(tmp_path_factory):
    """A dry stop, two slippery ones, and one with a course of commands on a rail where nothing slides."""
    stops = [
        logs.simulated(logs.DRY, 80.0, 1),
        logs.simulated(logs.wet(0.03), 60.0, 2),
        logs.simulated(logs.wet(0.09), 80.0, 3),
        logs.simulated(logs.wet(0.4), 80.0, 4, {"brake.command": [COURSE]}),
    ]
    return suite(tmp_path_factory.mktemp("made"), stops)


def test_every_scenario_lies_over_its_record(made):
    differences = compared(made)
    assert len(differences) == 4
    assert all(abs(each) <= 2.0 for pair in differences.values() for each in pair)


def test_the_suite_runs_and_holds_each_stop_to_its_record(made, monkeypatch):
    monkeypatch.chdir(made.parent)
    assert execute(["run", "suite", "-q", "-o", "runs"]) == 0
    assert execute(["run", "suite", "-q", "-o", "runs", "--set", "brake.command=60 %"]) == 1


def test_the_worst_stop_is_first_and_says_why(made):
    (first, *_) = re.findall(
        r"^\| `(.*?)` \| (.*?) \|", (made / "README.md").read_text("utf-8"), re.MULTILINE
    )
    assert first[0] == "stop-0002.yaml"
    assert first[1].startswith("fail: ")
    assert yaml.safe_load((made / first[0]).read_text("utf-8"))["expect"] == "fail"


def test_a_scenario_states_the_commands_of_its_record(made):
    course = yaml.safe_load((made / "stop-0004.yaml").read_text("utf-8"))["brake"]["command"]
    assert [step["value"] for step in course] == [step["value"] for step in COURSE]
    assert course[1]["position"] == "emergency"
    for step, truth in zip(course, COURSE, strict=True):
        assert float(step["at"].split()[0]) == pytest.approx(float(truth["at"].split()[0]), abs=0.2)


def test_a_scenario_says_where_it_is_from_and_what_is_assumed(made):
    text = (made / "stop-0001.yaml").read_text("utf-8")
    assert re.search(r"night\.parquet, sample \d+, [\d.]+ s", text)
    assert re.search(r"SHA-256 of the log: [0-9a-f]{64}", text)
    assert "rail: not seen" in text
    assert "rail: not seen" not in (made / "stop-0003.yaml").read_text("utf-8")
    assert "controller: a record does not hold it; threshold" in text


def test_a_speed_that_is_kept_and_a_slippery_stretch_are_found(tmp_path):
    drag = {"speed": "60 km/h", "duration": "12 s"}
    points = [{"position": f"{at} m", "friction": mu} for at, mu in ((0, 0.3), (90, 0.07), (170, 0.3))]
    stretch = {"condition": "wet", "friction": {"interpolation": "steps", "points": points}}
    stops = [
        logs.simulated(logs.wet(0.3), 80.0, 1, {"brake.command": "40 %", "drag": drag}),
        logs.simulated(stretch, 80.0, 2),
    ]
    made = suite(tmp_path, stops)
    assert all(abs(each) <= 1.0 for pair in compared(made).values() for each in pair)
    held = yaml.safe_load((made / "stop-0001.yaml").read_text("utf-8"))["drag"]
    assert float(held["duration"].split()[0]) == pytest.approx(12.0, abs=1.0)
    rail = yaml.safe_load((made / "stop-0002.yaml").read_text("utf-8"))["rail"]["friction"]["points"]
    (_, begin, end) = [float(point["position"].split()[0]) for point in rail]
    assert (begin, end) == (pytest.approx(90.0, abs=4.0), pytest.approx(170.0, abs=4.0))


@pytest.mark.parametrize(
    ("without", "told"),
    [
        (["wheel_speed_3"], r"No scenario of:\n\n- stop-0001.*not recorded: wheel_speed_3"),
        (["brake_line_pressure"], r"brake command: not recorded; 100 % as stated"),
    ],
)
def test_what_a_record_lacks_is_said(tmp_path, without, told):
    made = suite(tmp_path, [logs.simulated(logs.wet(0.08), 60.0, 2)], without=without)
    assert re.search(told, (made / "README.md").read_text("utf-8"))


def test_of_many_stops_the_worst_are_taken_and_what_was_changed_stays(tmp_path, capsys):
    stops = [logs.simulated(logs.DRY, 40.0, 1), logs.simulated(logs.wet(0.03), 50.0, 2)]
    made = suite(tmp_path, stops, logs.CONDITIONS, "--worst", "1")
    assert [path.name for path in made.glob("*.yaml")] == ["stop-0002.yaml"]
    (made / "stop-0002.yaml").write_text("mine", "utf-8")
    with pytest.raises(AssertionError):
        suite(tmp_path, stops)
    assert "suite: stop-0002.yaml: uictest did not write it, or it has changed" in capsys.readouterr().err
    assert (made / "stop-0002.yaml").read_text("utf-8") == "mine"


def test_scenarios_need_a_vehicle(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    logs.write_log([logs.simulated(logs.DRY, 40.0, 1)], tmp_path / "night.parquet")
    assert execute(["log", "night.parquet", "--scenarios", "suite"]) == 4
    assert "state them with --scenario" in capsys.readouterr().err


@pytest.mark.parametrize(("factor", "told"), [(1.0, False), (1.9, True)])
def test_more_pressure_than_the_stated_brake_gives_is_said(factor, told):
    [case] = load([SHIPPED / "slip-120.yaml"], [])
    system = case.scenario.brake.system
    most = max(float(each.maximum_pressure) for each in system.positions.values())
    time = np.arange(0.0, 20.0, 0.01)
    pressure = factor * most * np.minimum(time / 2.0, 1.0)
    recording = Recording(
        {"time": time, "brake_line_pressure": pressure}, {"time": "s", "brake_line_pressure": "Pa"}
    )
    course = command_course(recording, case.scenario, 0.0)
    assert course.beyond == pytest.approx(factor, rel=1e-3)
    said = list(assumptions(case.scenario, SimpleNamespace(friction=()), course))
    assert any(f"{factor:.2f} times" in each for each in said) is told


def test_logs_of_one_name_are_told_apart_by_their_folder_and_their_digest(tmp_path, monkeypatch):
    """Two nights, both `a<line feed>b.parquet`: one dry stop, one on a slippery rail."""
    monkeypatch.chdir(tmp_path)
    rails = {"mon": logs.DRY, "tue": logs.wet(0.09)}
    for number, (night, rail) in enumerate(rails.items()):
        Path(night).mkdir()
        stop = logs.simulated(rail, 40.0, number)
        logs.write_log([stop], Path(night, "a\nb.parquet"), begin=1000.0 * number)
    Path("night.yaml").write_text(logs.CONDITIONS, "utf-8")
    options = ["--scenario", "night.yaml", "--scenarios", "suite", "-q", "--dry", "mon/a"]
    assert execute(["log", *(f"{night}/a\nb.parquet" for night in rails), *options]) in (0, 1)
    made = {path.stem: yaml.safe_load(path.read_text()) for path in Path("suite").glob("stop-*.yaml")}
    assert len(made) == 2
    assert {each["title"].partition(" at ")[0] for each in made.values()} == {
        rf"Recorded stop: {night}/a\nb.parquet" for night in rails
    }
    digests = {field_data.digest_of(Path(night, "a\nb.parquet"))[:6] for night in rails}
    assert {each["name"] for each in made.values()} == {
        f"a-b-{digest}-{stop}"
        for digest in digests
        for stop in made
        if digest in Path("suite", f"{stop}.yaml").read_text()
    }
    assert execute(["run", "suite", "-q"]) in (0, 1)
    results = json.loads(Path("reports/latest/results.json").read_text("utf-8"))
    (log,) = [path for path in Path("reports").glob("2*") if (path / "stops.csv").is_file()]
    subjects = json.loads((log / "results.json").read_text("utf-8"))["subjects"]
    assert [each["settings"]["rail"] for each in subjects.values()] == ["dry", "wet"]
    assert len(results["cases"]) == 2

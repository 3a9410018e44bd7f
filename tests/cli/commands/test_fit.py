import json
from pathlib import Path

import pytest

from uictest.core.recording import parquet_bytes
from uictest.plans.scenario import load
from uictest.rig import simulate

WET = "rail: {condition: wet, friction: 0.07}\ncriteria: [uictest-stop]\n"


def simulated(scenario, recording):
    """Simulate a scenario and write its recording."""
    [case] = load([scenario])
    Path(recording).write_bytes(parquet_bytes(simulate(case, record_every=0.01).recording))


@pytest.fixture
def recorded(scenario):
    simulated(scenario("real", WET), "stop.parquet")
    return scenario("guess", WET.replace("0.07", "0.12"))


def test_a_fit_leaves_a_scenario_that_runs(call, recorded):
    answer = call("fit", "stop.parquet", "--scenario", recorded, code=0)
    assert answer.out.startswith("friction everywhere: 0.07")
    [folder] = Path("reports").iterdir()
    assert sorted(path.name for path in folder.iterdir()) == [
        "SHA256SUMS",
        "fit.json",
        "guess-fitted.yaml",
        "overlay.csv",
        "overlay.svg",
    ]
    [fitted] = load([folder / "guess-fitted.yaml"])
    assert fitted.scenario.rail.friction == pytest.approx(0.07, rel=0.03)
    document = json.loads((folder / "fit.json").read_text())
    assert document["determined"] is True
    assert document["agreement"]["simulated_distance"] == pytest.approx(
        document["agreement"]["recorded_distance"], rel=0.1
    )


def test_steps_and_pads_and_settings_are_kept(call, recorded):
    arguments = ("--break", "10 m", "--pads", "--set", "brake.command=95 %")
    assert call("fit", "stop.parquet", "--scenario", recorded, *arguments).code == 0
    [fitted] = load(list(Path("reports").glob("*/guess-fitted.yaml")))
    assert [float(point.position) for point in fitted.scenario.rail.friction.points] == [0.0, 10.0]
    assert float(fitted.scenario.brake.command) == pytest.approx(0.95)


def test_a_record_that_cannot_tell_exits_1(call, scenario):
    path = scenario("dry", "rail: {condition: dry}\n")
    simulated(path, "stop.parquet")
    answer = call("fit", "stop.parquet", "--scenario", path, code=1)
    assert "at least" in answer.out

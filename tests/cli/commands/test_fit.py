from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from uictest.recording import write_parquet
from uictest.rig import simulate
from uictest.scenario import load

Call = Callable[..., Any]
WET = "rail: {condition: wet, friction: 0.07}\ncriteria: [uictest-stop]\n"


@pytest.fixture
def recorded(scenario: Callable[..., Path]) -> Path:
    [case] = load([scenario("real", WET)])
    recording = simulate(case, record_every=0.01).recording
    assert recording is not None
    write_parquet(recording, Path("stop.parquet"))
    return scenario("guess", WET.replace("0.07", "0.12"))


def test_a_fit_leaves_a_scenario_that_runs(call: Call, recorded: Path) -> None:
    answer = call("fit", "stop.parquet", "--scenario", recorded)
    assert answer.code == 0
    assert answer.out.startswith("friction everywhere: 0.07")
    [folder] = Path("reports").iterdir()
    assert sorted(path.name for path in folder.iterdir()) == [
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


def test_steps_and_pads_and_settings_are_kept(call: Call, recorded: Path) -> None:
    arguments = ("--break", "10 m", "--pads", "--set", "brake.command=95 %")
    assert call("fit", "stop.parquet", "--scenario", recorded, *arguments).code == 0
    [fitted] = load(list(Path("reports").glob("*/guess-fitted.yaml")))
    assert [float(point.position) for point in fitted.scenario.rail.friction.points] == [0.0, 10.0]  # type: ignore[union-attr]
    assert float(fitted.scenario.brake.command) == pytest.approx(0.95)


def test_a_record_that_cannot_tell_exits_1(call: Call, scenario: Callable[..., Path]) -> None:
    path = scenario("dry", "rail: {condition: dry}\n")
    [case] = load([path])
    recording = simulate(case, record_every=0.01).recording
    assert recording is not None
    write_parquet(recording, Path("stop.parquet"))
    answer = call("fit", "stop.parquet", "--scenario", path)
    assert answer.code == 1
    assert "at least" in answer.out


@pytest.mark.parametrize(
    "arguments", [["--break", "10"], ["--break", "20 m", "--break", "10 m"], ["--set", "rail.friction=x"]]
)
def test_usage_errors_exit_4(call: Call, recorded: Path, arguments: list[str]) -> None:
    assert call("fit", "stop.parquet", "--scenario", recorded, *arguments).code == 4
    assert not Path("reports").exists()

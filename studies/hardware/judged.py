"""What the second module is identified and judged on: inputs from the rig's own bench and stops."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import yaml

from studies.replay import maximum_pressure, replayed
from studies.stop_runner import StopRunner, seeded
from uictest import Case, Recording
from uictest.rig import bench

_CONDITIONS: Final = Path(__file__).parents[1] / "conditions"
_BRAKE: Final = _CONDITIONS / "brake-of-another-caliper.yaml"
BENCHES: Final = {"hysteresis": "six-inch-hysteresis", "pressure": "six-inch-cylinder"}
"""Record -> bench test of the library whose inputs are applied, as for the compensation that ships."""
INPUTS: Final = ("time", "brake_line_pressure", "valve_command_1")


@dataclass(frozen=True, slots=True)
class Conditions:
    """Every combination of a friction, a speed, a command and a controller is judged."""

    frictions: Sequence[float]
    speeds: Sequence[str]
    commands: Sequence[str]
    controllers: Sequence[str]
    wheelset: int
    seed: int


def conditions() -> Conditions:
    """Return the declared conditions."""
    return Conditions(**yaml.safe_load((_CONDITIONS / "another-caliper.yaml").read_text("utf-8")))


def owners_case() -> Case:
    """Return the rig of the second module as its owner knows it, for the identification of the air."""
    path = bench.recipe_path(BENCHES["pressure"])
    return bench.load_bench(path, [f"brake.system={os.path.relpath(_BRAKE)}"], trusted=[_CONDITIONS]).case


def bench_records(changes: Sequence[str] = ()) -> dict[str, Recording]:
    """Return the records of the bench tests on the library's rig, changed as by `--set`."""
    return {
        subject: bench.run_test(bench.load_bench(bench.recipe_path(name), changes))
        for subject, name in BENCHES.items()
    }


def only_inputs(record: Recording) -> Recording:
    """Return a record that holds what drives a module and nothing of what the library's rig did."""
    channels = {name: record[name] for name in INPUTS}
    return Recording(channels, {name: record.units[name] for name in INPUTS}, {})


def judged_cases(stop_runner: StopRunner, changes: Mapping[str, Any] | None = None) -> list[Case]:
    """Return the judged stops, on the rig with four calipers of the library."""
    judged = conditions()
    varied = {
        "rail.friction": judged.frictions,
        "initial_speed": judged.speeds,
        "brake.command": judged.commands,
        "controller": judged.controllers,
    }
    cases = stop_runner.cases("slide-80-four-caliper", {**varied, **(changes or {})})
    return [seeded(case, judged.seed) for case in cases]


def judged_replay(case: Case) -> tuple[Recording, float]:
    """Return the bench record of a judged stop on its own rig, and the pressure of its position, Pa."""
    (stop,) = StopRunner(1).recordings([case])
    return replayed(case, stop, conditions().wheelset), maximum_pressure(case)

"""Cases judged in a block have, to the last byte, the rows that they have when each is judged alone."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from uictest import rig
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.judging.evaluation import ResultColumns, error_result, evaluate_simulated, result_columns
from uictest.plans.sweeps import Plan
from uictest.running.chunked import ChunkRunner, chunk_runner
from uictest.running.chunked.case_blocks import CaseBlock
from uictest.running.chunked.chunk import parquet_bytes
from uictest.running.chunked.table import rows

from ..conftest import Load
from .test_case_blocks import written_out

MakeRunner = Callable[[Plan], ChunkRunner]
OUTCOMES = ("pass", "fail", "invalid", "skipped", "inconclusive", "error")
SIDES = """\
schema: uictest/criteria/1
name: sides
criteria:
  - {id: far, layer: validity, measure: braking_distance, lower: 100 m, upper: 500 m}
  - {id: brief, layer: requirement, measure: braking_time, upper: 20 s, strict: true}
  - {id: mean, layer: requirement, measure: mean_deceleration, lower: 0.5 m/s2}
  - {id: developed, layer: requirement, measure: developed_deceleration, lower: 0.6 m/s2}
  - {id: least, layer: requirement, measure: minimum_deceleration, lower: 0.4 m/s2,
     applies: {brake_position: [R], command: {value: 90 %, tolerance: 5 %}}}
  - {id: balance, layer: validity, measure: energy_residual, upper: 0 %}
  - {id: standstill, layer: requirement, measure: standstill, lower: 1}
  - {id: tied, layer: requirement, measure: braking_time, upper: 20 s}
"""
WHEELS = """\
schema: uictest/criteria/1
name: wheels
criteria:
  - {id: every, layer: requirement, measure: longest_lock, upper: 1 s, wheelsets: all}
  - {id: some, layer: validity, measure: valve_actuations, lower: 2, upper: 8, wheelsets: any}
  - {id: half, layer: validity, measure: maximum_slide_above_cutoff, lower: 35 %, strict: true,
     wheelsets: {at_least: half}, applies: {wsp: [active]},
     definition: {low_speed_cutoff: {value: 30 km/h, range: [10 km/h, 60 km/h]}}}
  - {id: share, layer: validity, measure: sliding_share, lower: 35 %, strict: true, reading: at-once,
     definition: {sliding_below: {value: 90 %, range: [85 %, 95 %]},
                  end_speed: {value: 60 km/h, range: [40 km/h, 80 km/h]}},
     readings: [{id: deep, measure: maximum_slide_above_cutoff, wheelsets: {at_least: half},
                 definition: {low_speed_cutoff: {value: 30 km/h, range: [10 km/h, 60 km/h]}}}]}
  - {id: each, layer: validity, measure: sliding_share_of_wheelsets, lower: 35 %, wheelsets: {at_least: 3},
     definition: {sliding_below: {value: 95 %, range: [85 %, 95 %]},
                  end_speed: {value: 40 km/h, range: [40 km/h, 80 km/h]}}}
  - {id: three, layer: requirement, measure: air_vented, upper: 10 NL, wheelsets: {at_least: 3}}
  - {id: discs, layer: requirement, measure: maximum_disc_temperature, upper: 300 degC, wheelsets: all}
  - {id: adhesion, layer: validity, measure: initial_adhesion, upper: 0.08 g, strict: true,
     applies: {initial_speed: {value: 80 km/h, tolerance: 40 km/h}},
     definition: {first_phase_duration: {value: 2.5 s, range: [2 s, 5 s]}}}
"""
NEVER = """\
schema: uictest/criteria/1
name: never
criteria:
  - {id: gentle, layer: requirement, measure: maximum_deceleration, upper: 1 m/s2,
     applies: {gradient: {value: -1 permille, tolerance: 4 permille}}}
"""
SWEEP = """\
grid:
  criteria: [sides.yaml, [wheels.yaml, sides.yaml], never.yaml]
  brake.position: [R, P]
  rig.wsp: [active, bypassed]
  measures.moving_speed: [3 km/h, 50 km/h]
  expect: [pass, invalid]
sample:
  method: random
  size: 210
  parameters:
    brake.command: {uniform: [80 %, 100 %]}
    rail.gradient: {uniform: [-10 permille, 10 permille]}
    rail.friction: {uniform: [0.02, 0.2]}
    initial_speed: {uniform: [10 km/h, 200 km/h]}
"""
# Values at bounds, between them and beyond, so that margins are zero and tied.
VALUES: dict[str, tuple[float, ...]] = {
    "braking_distance": (100.0, 99.0, 300.0, 500.0, 700.0),
    "end_distance": (0.0, 250.0, 900.0),
    "braking_time": (10.0, 19.0, 20.0, 21.0),
    "end_time": (5.0, 30.0),
    "minimum_deceleration": (0.4, 0.3, 0.9, np.nan),
    "maximum_deceleration": (0.9, 1.0, 1.1, np.nan),
    "sliding_time": (1.0, np.nan, np.inf),
    "energy_residual": (0.0, 0.0, 1e-6, -1e-9),
    "longest_lock": (0.0, 0.5, 1.0, 1.5),
    "valve_actuations": (0.0, 2.0, 5.0, 8.0, 9.0),
    "air_vented": (0.0, 0.01, 0.011, 0.02),
    "air_residual": (0.0,),
    "air_energy_residual": (1e-12,),
    "loadcell_saturation": (0.0,),
    "pressure_saturation": (0.0,),
    "line_saturation": (0.0,),
    "saturation_time": (0.3,),
    "compensation_misfit": (0.0, 0.9, 1.0),
    "maximum_disc_temperature": (np.nan, np.nan, 500.0, 573.15, 600.0),
}
RARE: dict[str, tuple[float, ...]] = {
    "stopped": (0.0,),
    "end_speed": (np.nan, np.inf),
    "air_residual": (np.nan,),
    "air_energy_residual": (1e-8,),
    "loadcell_saturation": (1.5,),
    "pressure_saturation": (0.25,),
    "line_saturation": (1e-3,),
    "compensation_misfit": (1.1, np.nan),
    "locked_time": (np.inf,),
    "braking_distance": (np.nan, 0.0, np.inf),
    "braking_time": (np.nan,),
    "build_up_time": (np.nan,),
    "build_up_distance": (100.0,),  # no distance left, or less than none
}


def hand_made(
    parameters: NDArray[Any],
    wheelset_parameters: NDArray[Any],
    rail: NDArray[np.float64],
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Measures that no rig makes: every number by lot, all that can go wrong, in all combinations."""
    lot = np.random.default_rng(int(parameters["noise_key"].sum()))
    measures = np.zeros(parameters.size, STOP_MEASURES)
    wheelsets = np.zeros((parameters.size, 4), WHEELSET_MEASURES)
    for records in (measures, wheelsets):
        for name in records.dtype.names or ():
            field = records[name]
            field[...] = lot.choice(VALUES[name], field.shape) if name in VALUES else lot.random(field.shape)
    measures["stopped"], measures["initial_speed"] = 1.0, parameters["initial_speed"]
    measures["reached_time"] = np.where(measures["reached_time"] < 0.05, np.nan, measures["reached_time"])
    measures["speed_after_sliding"] = 20.0 - lot.random((parameters.size, 1)) * np.arange(11.0)
    measures["speed_after_sliding"][lot.random(parameters.size) < 0.1, 2:] = np.nan
    wheelsets["maximum_slide_above"][lot.random(parameters.size) < 0.1] = np.nan
    for name, values in RARE.items():
        records = measures if name in (measures.dtype.names or ()) else wheelsets
        field = records[name].copy()
        rare = lot.random(field.shape) < 0.01
        field[rare] = lot.choice(values, int(rare.sum()))
        records[name] = field
    return measures, wheelsets


def judged_alone(runner: ChunkRunner, block: CaseBlock) -> ResultColumns:
    """Judge the cases of a block one by one."""
    columns = result_columns(len(block.ids))
    simulated = [place for place, reason in enumerate(block.rejections) if not reason]
    measures, wheelsets = runner.simulate(
        block.parameters[simulated],
        block.wheelset_parameters[simulated],
        block.rail[simulated],
    )
    for place, reason in enumerate(block.rejections):
        case = runner.assembler.case(block, place)
        if reason:
            columns.put(place, error_result(case, reason))
            continue
        stop = simulated.index(place)
        records = measures[stop].view(np.recarray), wheelsets[stop].view(np.recarray)
        columns.put(place, evaluate_simulated(case, *records, explain=False))
    return columns


@pytest.fixture
def profiles(tmp_path: Path) -> None:
    """Profiles of criteria beside the sweep: all kinds of bounds, all ways to count wheelsets."""
    for name, text in {"sides": SIDES, "wheels": WHEELS, "never": NEVER}.items():
        (tmp_path / f"{name}.yaml").write_text(text)


@pytest.mark.usefixtures("profiles")
@pytest.mark.parametrize(("cases", "of_each"), [(3000, 3), pytest.param(10_000, 21, marks=pytest.mark.slow)])
def test_hand_made_cases_are_judged_as_each_alone(
    load: Load, made_up: MakeRunner, cases: int, of_each: int
) -> None:
    """Among them some of each outcome."""
    plan = load(SWEEP)
    runner = replace(made_up(plan), simulate=hand_made)
    outcomes: Counter[str] = Counter()
    chosen = np.random.default_rng(1).permutation(plan.size)[:cases]
    for indices in np.array_split(chosen, 8):
        block = runner.assembler.block(indices)
        together, alone = runner.results(block), judged_alone(runner, block)
        assert parquet_bytes(rows(plan, block, together)) == parquet_bytes(rows(plan, block, alone))
        outcomes.update(together.outcomes)
    assert sum(outcomes.values()) == cases
    assert min(outcomes[each] for each in OUTCOMES) >= of_each


@pytest.mark.usefixtures("profiles")
def test_a_case_of_a_block_is_judged_as_its_scenario_written_out(load: Load, made_up: MakeRunner) -> None:
    plan = load(SWEEP)
    runner = replace(made_up(plan), simulate=hand_made)
    for index in (0, 211, 5039, 9999):
        block = runner.assembler.block(np.array([index]))
        row = runner.results(block)
        if not block.rejections[0]:
            measures, wheelsets = hand_made(block.parameters, block.wheelset_parameters, block.rail)
            result = evaluate_simulated(written_out(plan, index), measures[0], wheelsets[0], explain=False)
            assert (row.outcomes[0], row.reasons[0], row.met[0]) == (
                result.outcome,
                result.reason,
                result.met,
            )


def test_a_simulated_sweep_is_judged_as_its_cases_alone(load: Load) -> None:
    plan = load(
        "grid: {criteria: [[uictest-stop, uic-541-05-appendix-b]]}\n"
        "sample: {size: 12, parameters: {rail.friction: {uniform: [0.04, 0.15]}}}\n"
    )
    runner = chunk_runner(plan, rig.run_block)
    block = runner.assembler.block(np.arange(plan.size))
    together, alone = runner.results(block), judged_alone(runner, block)
    assert parquet_bytes(rows(plan, block, together)) == parquet_bytes(rows(plan, block, alone))


@pytest.mark.parametrize(("entry", "key"), [("{}", "criteria.criteria.0"), ("[{}]", "criteria.0.criteria.0")])
def test_a_case_is_judged_by_its_own_bound(load: Load, made_up: MakeRunner, entry: str, key: str) -> None:
    own = "{name: own, criteria: [{id: d, layer: requirement, measure: braking_distance, upper: 1 m}]}"
    stop = Path("stop.yaml")
    plan = load()
    stop.write_text(f"{stop.read_text()}criteria: {entry.format(own)}\n")
    plan = load(
        f"grid: {{{key}.upper: [1 m, 1 km], rail.friction: [0.08, 0.12], brake.command: [80 %, 90 %]}}\n"
    )
    runner = made_up(plan)
    block = runner.assembler.block(np.arange(plan.size))
    assert list(runner.results(block).outcomes) == ["fail"] * 4 + ["pass"] * 4

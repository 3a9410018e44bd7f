"""A case of a sweep is judged as its scenario written out is, and one that cannot be judged is a row."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uictest.judging.evaluation import evaluate_simulated

from ..conftest import formula
from .test_case_blocks import written_out

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
matrix:
  criteria: [sides.yaml, [wheels.yaml, sides.yaml], never.yaml]
  brake.position: [R, P]
  rig.wsp: [active, bypassed]
  measures.moving_speed: [3 km/h, 50 km/h]
  expect: [pass, invalid]
sample:
  method: random
  size: 40
  parameters:
    brake.command: {uniform: [80 %, 100 %]}
    rail.gradient: {uniform: [-10 permille, 10 permille]}
    rail.friction: {uniform: [0.02, 0.2]}
    initial_speed: {uniform: [10 km/h, 200 km/h]}
"""


@pytest.fixture
def profiles(tmp_path):
    """Profiles of criteria beside the sweep: all kinds of bounds, all ways to count wheelsets."""
    for name, text in {"sides": SIDES, "wheels": WHEELS, "never": NEVER}.items():
        (tmp_path / f"{name}.yaml").write_text(text)


def slid(parameters, own, rail):
    """Stops of the formula whose wheelsets slide, some of them above a cut-off only."""
    measures, wheelsets = formula(parameters, own, rail)
    measures["sliding_time"], measures["reached_time"], measures["maximum_deceleration"] = 1.0, 10.0, 0.9
    measures["speed_after_sliding"] = 20.0 - 0.7 * np.arange(11.0)
    wheelsets["maximum_slide_above"] = np.linspace(0.9, 0.0, 21) * np.arange(1.0, 5.0)[:, None] / 4.0
    return measures, wheelsets


@pytest.mark.usefixtures("profiles")
def test_a_case_is_judged_as_its_scenario_written_out(load, made_up):
    plan = load(SWEEP)
    runner = replace(made_up(plan), simulate=slid)
    indices = np.random.default_rng(1).permutation(plan.size)[:60]
    block = runner.assembler.block(indices)
    results, _ = runner.results(block)
    measures, wheelsets = slid(block.parameters, block.wheelset_parameters, block.rail)
    outcomes = set()
    for place, index in enumerate(indices.tolist()):
        if block.rejections[place]:
            continue
        alone = evaluate_simulated(
            written_out(plan, index), measures[place], wheelsets[place], detail="status"
        )
        # As texts, in which NaN is equal to NaN.
        assert repr(replace(results[place], parameters=alone.parameters)) == repr(alone)
        outcomes.add(alone.outcome)
    assert outcomes >= {"pass", "fail", "invalid", "skipped"}


def test_a_case_that_cannot_be_judged_is_an_error_and_its_neighbours_are_judged(load, made_up):
    def without_a_number(parameters, own, rail):
        measures, wheelsets = formula(parameters, own, rail)
        measures["energy_residual"][2] = np.nan
        return measures, wheelsets

    plan = load()
    runner = replace(made_up(plan), simulate=without_a_number)
    results, _ = runner.results(runner.assembler.block(np.arange(plan.size)))
    assert [place for place, each in enumerate(results) if each.outcome == "error"] == [2]
    assert results[2].reason.startswith("the simulation gives no finite energy_residual")


@pytest.mark.parametrize(("entry", "key"), [("{}", "criteria.criteria.0"), ("[{}]", "criteria.0.criteria.0")])
def test_a_case_is_judged_by_its_own_bound(load, made_up, entry, key):
    own = "{name: own, criteria: [{id: d, layer: requirement, measure: braking_distance, upper: 1 m}]}"
    stop = Path("stop.yaml")
    plan = load()
    stop.write_text(f"{stop.read_text()}criteria: {entry.format(own)}\n")
    plan = load(
        f"matrix: {{{key}.upper: [1 m, 1 km], rail.friction: [0.08, 0.12], brake.command: [80 %, 90 %]}}\n"
    )
    runner = made_up(plan)
    block = runner.assembler.block(np.arange(plan.size))
    results, _ = runner.results(block)
    assert [each.outcome for each in results] == ["fail"] * 4 + ["pass"] * 4

"""A case of a sweep has the bits of its scenario written out, and is judged as that is."""

from dataclasses import replace

import numpy as np
import pytest

from uictest.judging.evaluation import evaluate_simulated
from uictest.rig import assemble

from ..conftest import MATRIX, SCENARIO, formula, formula_of, made_up, written_out

SWEEPS = {
    "grid": MATRIX + "  initial_speed: [20 km/h, 8 m/s]\n",
    "parts": """\
matrix:
  vehicle: [intercity-180, crh380a]
  vehicle.wheelset.radius: [0.43 m, 0.45 m]
  controller: [threshold, slip-band]
  rail.friction: [null, 0.2]
  rail.condition: [dry, wet]
""",
    "laws": """\
matrix:
  rail.friction:
    - {points: [{position: 0 m, friction: 0.1}, {position: 5 m, friction: 0.3}], interpolation: steps}
    - 0.07
  rail.friction_over_time: [{points: [{time: 0 s, factor: 1}, {time: 3 s, factor: 0.5}]}, null]
zip: {simulation.time_step: [0.5 ms, 0.25 ms], controller.cycle_time: [10 ms, 5 ms], seed: [3, 4]}
""",
    "pads": """\
matrix:
  brake.pad: [constant, disc-pad, composite-block]
  brake.disc_temperature: [null, modelled, constant]
  brake.initial_disc_temperature: [null, 300 degC]
  brake.system.disc.thermal.thickness: [15 mm, 25 mm]
""",
    "faults": """\
matrix:
  faults:
    - []
    - [{at: 3 s, wheelset: 2, part: speed-sensor, kind: stuck}]
    - - {at: 3 s, wheelset: 1, part: tank, kind: leak, value: 1e-8 m3/(s Pa)}
      - {at: 2 m, part: controller, kind: silent}
  simulation.time_step: [0.5 ms, 0.25 ms]
""",
    "sand": """\
matrix:
  sanders:
    - []
    - [{wheelset: 2, density: 7.5 g/m}]
    - [{wheelset: 2, rate: 2 kg/min, when: always}, {wheelset: 4, density: 5 g/m, delay: 1 s}]
  rail.sand.kept: [0.7, 0.9]
  initial_speed: [40 km/h, 80 km/h]
  vehicle: [intercity-180, crh380a]
""",
    "sample": """\
matrix: {rig.compensation: [none, full]}
sample:
  method: sobol
  size: 16
  parameters:
    rail.friction: {uniform: [0.05, 0.15]}
    brake.command: {triangular: [80 %, 90 %, 100 %]}
    brake.system.wsp_valve.vent_conductance: {log-uniform: [1e-8 m3/(s Pa), 2e-8 m3/(s Pa)]}
    brake.system.air.temperature: {normal: {mean: 15 degC, deviation: 8 degC, lower: -5 degC, upper: 35 degC}}
    rig.topology: {choice: [one-caliper, four-caliper]}
""",
    "numbers": """\
matrix: {controller: [threshold, slip-band]}
sample:
  method: random
  size: 16
  parameters:
    rail.friction: {uniform: [0.08, 0.16]}
    initial_speed: {uniform: [25 km/h, 85 km/h]}
    brake.command: {uniform: [80 %, 100 %]}
    rail.gradient: {uniform: [-5 permille, 5 permille]}
    vehicle.body.mass: {uniform: [30 t, 36 t]}
    vehicle.bogie.pitch_inertia: {uniform: [1500 kg m2, 2500 kg m2]}
    vehicle.wheelset.radius: {uniform: [0.42 m, 0.46 m]}
    brake.system.air.temperature: {uniform: [-10 degC, 30 degC]}
    brake.system.tank.volume: {uniform: [10 L, 12 L]}
    brake.system.wsp_valve.vent_conductance: {uniform: [1.0e-8 m3/(s Pa), 1.2e-8 m3/(s Pa)]}
    brake.system.wsp_valve.switching_delay: {uniform: [1 ms, 30 ms]}
    brake.system.critical_pressure_ratio: {uniform: [0.3, 0.4]}
    rail.condition.friction_ratio: {uniform: [0.3, 0.9]}
    rig.caliper.contact_stiffness: {uniform: [2e7 N/m, 3e7 N/m]}
    vehicle.bogie.half_wheelbase: {uniform: [1.2 m, 1.3 m]}
""",
    "wheelsets": """
sample:
  method: sobol
  size: 16
  parameters:
    vehicle.wheelsets.2.wheel_radius: {uniform: [0.41 m, 0.44 m]}
    vehicle.wheelsets.3.wsp_valve.travel_time: {uniform: [10 ms, 30 ms]}
    vehicle.wheelsets.4.brake_force: {choice: [80 %, 100 %, 120 %]}
    vehicle.wheelset.radius: {uniform: [0.42 m, 0.43 m]}
    brake.system.wsp_valve.switching_delay: {uniform: [1 ms, 30 ms]}
    rig.sensors.pressure.offset: {uniform: [-0.01 bar, 0.01 bar]}
""",
    "keys in a fault": (
        "matrix:\n  faults.0.at: [3 s, 20 m]\n  faults.0.wheelset: [1, 4]\n",
        "faults=[{at: 3 s, wheelset: 2, part: speed-sensor, kind: stuck}]",
    ),
    # Where its spread is nothing, its other numbers change nothing.
    "variation of the rail": (
        """\
matrix:
  rail.variation.spread: [0 %, 10 %]
sample:
  method: sobol
  size: 8
  parameters:
    rail.variation.correlation_length: {log-uniform: [5 m, 100 m]}
    rail.variation.left_right_correlation: {uniform: [0, 1]}
""",
        "rail.variation={spread: 20 %, correlation_length: 10 m, left_right_correlation: 0.5}",
    ),
}
"""What varies, in some with an override of the scenario."""


@pytest.mark.parametrize("name", SWEEPS)
def test_records_are_those_of_the_scenario_written_out(load, name):
    text, *overrides = [SWEEPS[name]] if isinstance(SWEEPS[name], str) else SWEEPS[name]
    plan = load(text, *overrides)
    simulated = []

    def noted(parameters, wheelsets, rail):
        simulated.extend(zip(parameters, wheelsets, rail, strict=True))
        return formula(parameters, wheelsets, rail)

    made_up(plan, noted).run(np.arange(plan.size))
    assert len(simulated) == plan.size
    for index, (parameters, wheelsets, rail) in enumerate(simulated):
        record, own, laws, *_ = assemble(written_out(plan, index, *overrides))
        assert record.tobytes() == parameters.tobytes()
        assert own.tobytes() == wheelsets.tobytes()
        assert np.array_equal(laws, rail[:, : laws.shape[1]])


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
def test_a_case_is_judged_as_its_scenario_written_out(load):
    plan = load(SWEEP)
    indices = np.random.default_rng(1).permutation(plan.size)[:60]
    results, _ = made_up(plan, slid).results(indices, plan.settings(indices))
    outcomes = set()
    for index, result in zip(indices.tolist(), results, strict=True):
        if result.outcome == "error":
            continue
        case = written_out(plan, index)
        alone = evaluate_simulated(case, *formula_of(case, slid), detail="status")
        # As texts, in which NaN is equal to NaN.
        assert repr(replace(result, parameters=alone.parameters)) == repr(alone)
        outcomes.add(alone.outcome)
    assert outcomes >= {"pass", "fail", "invalid", "skipped"}


def test_a_case_that_cannot_be_judged_is_an_error_and_its_neighbours_are_judged(load):
    def without_a_number(parameters, own, rail):
        measures, wheelsets = formula(parameters, own, rail)
        measures["energy_residual"][2] = np.nan
        return measures, wheelsets

    plan = load()
    results, _ = made_up(plan, without_a_number).results(np.arange(6), plan.settings(np.arange(6)))
    assert [k for k, result in enumerate(results) if result.outcome == "error"] == [2]
    assert results[2].reason.startswith("the simulation gives no finite energy_residual")


@pytest.mark.parametrize(("entry", "key"), [("{}", "criteria.criteria.0"), ("[{}]", "criteria.0.criteria.0")])
def test_a_case_is_judged_by_its_own_bound(load, entry, key):
    own = "{name: own, criteria: [{id: d, layer: requirement, measure: braking_distance, upper: 1 m}]}"
    text = f"{{{key}.upper: [1 m, 1 km], rail.friction: [0.08, 0.12], brake.command: [80 %, 90 %]}}"
    plan = load(f"matrix: {text}\n", stop=f"{SCENARIO}criteria: {entry.format(own)}\n")
    results, _ = made_up(plan).results(np.arange(8), plan.settings(np.arange(8)))
    assert [each.outcome for each in results] == ["fail"] * 4 + ["pass"] * 4

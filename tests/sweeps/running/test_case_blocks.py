"""A case of a sweep has the numbers that the scenario with its values has, to the last bit."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uictest.judging.evaluation import JUDGED_KEYS
from uictest.plans.scenario import load as load_scenarios
from uictest.plans.scenario.yaml.model import Model
from uictest.rig import ASSIGNMENTS, FRICTION_KEYS, WHEELSET_ASSIGNMENTS, assemble, assigned, friction_laws
from uictest.running.chunked.case_blocks import BlockAssembler
from uictest.running.chunked.scenario_function import ScenarioVariants

from ..conftest import MATRIX

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
}


def written_out(plan, index, *overrides):
    """The case as `uictest run --set ...` would load it, with the id that it has in the sweep."""
    settings = plan.settings(np.array([index]))
    # A part first, then what lies inside it: an override of a part would take the inside with it.
    keys = sorted(settings, key=lambda key: key.count("."))
    texts = [f"{key}={settings[key][0].text}" for key in keys]
    case = load_scenarios([Path("stop.yaml")], [*overrides, *texts])[0]
    return replace(case, id=plan.ids(np.array([index]))[0], path=plan.base.path)


@pytest.mark.parametrize("name", SWEEPS)
def test_records_are_those_of_the_scenario_written_out(load, name):
    plan = load(SWEEPS[name])
    block = BlockAssembler(plan).block(np.arange(plan.size))
    assert block.rejections == [""] * plan.size
    for place in range(plan.size):
        record, own, rail, *_ = assemble(written_out(plan, place))
        assert record.tobytes() == block.parameters[place].tobytes()
        assert own.tobytes() == block.wheelset_parameters[place].tobytes()
        assert np.array_equal(rail, block.rail[place][:, : rail.shape[1]])


def test_keys_inside_a_fault_of_the_base_vary(load):
    fault = "faults=[{at: 3 s, wheelset: 2, part: speed-sensor, kind: stuck}]"
    plan = load("matrix:\n  faults.0.at: [3 s, 20 m]\n  faults.0.wheelset: [1, 4]\n", fault)
    block = BlockAssembler(plan).block(np.arange(plan.size))
    assert block.rejections == [""] * plan.size
    for place in range(plan.size):
        written = assemble(written_out(plan, place, fault)).parameters
        assert written.tobytes() == block.parameters[place].tobytes()


def test_the_variation_of_the_rail_varies(load):
    """Where its spread is nothing, its other numbers change nothing."""
    varied = "rail.variation={spread: 20 %, correlation_length: 10 m, left_right_correlation: 0.5}"
    plan = load(
        "matrix:\n  rail.variation.spread: [0 %, 10 %]\n"
        "sample:\n  method: sobol\n  size: 8\n  parameters:\n"
        "    rail.variation.correlation_length: {log-uniform: [5 m, 100 m]}\n"
        "    rail.variation.left_right_correlation: {uniform: [0, 1]}\n",
        varied,
    )
    block = BlockAssembler(plan).block(np.arange(plan.size))
    assert block.rejections == [""] * plan.size
    assert sorted(block.parameters["varies_friction"]) == [0.0] * 8 + [1.0] * 8
    for place in range(plan.size):
        written = assemble(written_out(plan, place, varied)).parameters
        assert written.tobytes() == block.parameters[place].tobytes()


def test_cases_that_differ_in_numbers_are_assembled_together(load, monkeypatch):
    plan = load(SWEEPS["numbers"])
    assembler = BlockAssembler(plan)
    assembler.block(np.array([0, plan.size - 1]))  # what listed values give is kept

    def at(variants, place):
        raise AssertionError(tuple(variants.settings))

    monkeypatch.setattr(ScenarioVariants, "at", at)
    assert assembler.block(np.arange(plan.size)).rejections == [""] * plan.size


def test_a_case_does_not_depend_on_its_neighbours(load):
    plan = load(SWEEPS["sample"])
    whole = BlockAssembler(plan).block(np.arange(plan.size))
    assembler = BlockAssembler(plan)
    for place in (31, 3, 17):
        alone = assembler.block(np.array([place]))
        assert alone.parameters.tobytes() == whole.parameters[[place]].tobytes()


def test_impossible_combinations_are_rejected_case_by_case(load):
    plan = load(
        "matrix:\n  simulation.time_step: [0.5 ms, 0.4 ms, 0.25 ms]\n  controller.cycle_time: [10 ms, 5 ms]\n"
    )
    rejections = BlockAssembler(plan).block(np.arange(6)).rejections
    assert [bool(reason) for reason in rejections] == [False, False, False, True, False, False]
    assert rejections[3] == "simulation.time_step: 0.4 ms does not divide the controller cycle of 5 ms"


class Watched:
    """A scenario that notes which keys are read."""

    def __init__(self, model, above, read):
        self.__dict__.update(_model=model, _above=above, _read=read)

    def __getattr__(self, name):
        declared = getattr(type(self._model), name, None)
        if isinstance(declared, property) and declared.fget is not None:
            return declared.fget(self)
        value = getattr(self._model, name)
        if name not in type(self._model).model_fields:
            self._read.add(self._above.rstrip("."))  # a method may read anything of its model
            return value
        key = f"{self._above}{name}"
        if key == "vehicle.wheelsets":
            return {number: Watched(own, f"{key}.{number}.", self._read) for number, own in value.items()}
        if isinstance(value, Model):
            return Watched(value, f"{key}.", self._read)
        self._read.add(key)
        return value

    def __iter__(self):
        self._read.add(self._above.rstrip("."))
        return iter(self._model)


def keys_read(function, scenario):
    read = set()
    function(Watched(scenario, "", read))
    return read


SHIPPED = load_scenarios([Path(__file__).parents[3] / "scenarios"])


@pytest.mark.parametrize("case", SHIPPED, ids=lambda case: case.id)
def test_what_sets_parameters_reads_nothing_but_what_they_say(case):
    """What sets parameters, and what they are set to apart from all others."""
    assignments = [*ASSIGNMENTS, *(each for wheelset in WHEELSET_ASSIGNMENTS for each in wheelset)]
    setters = [(lambda scenario, each=each: assigned([each], scenario), each.keys) for each in assignments]
    for setter, keys in (*setters, (friction_laws, FRICTION_KEYS)):
        for read in keys_read(setter, case.scenario):
            assert any(read == key or read.startswith(f"{key}.") for key in keys), (keys, read)


@pytest.mark.parametrize("case", SHIPPED[:3], ids=lambda case: case.id)
def test_judging_reads_nothing_but_what_it_says(case):
    from uictest.judging.evaluation import evaluate

    from ..conftest import formula

    record, own, rail, *_ = assemble(case)
    measures, wheelsets = formula(np.array([record]), own[None], rail[None])
    read = set()
    watched = Watched(case.scenario, "", read)
    for stopped in (1.0, 0.0):
        measures["stopped"] = stopped
        evaluate(replace(case, scenario=watched), measures[0], wheelsets[0], detail="status")
    for key in read:
        assert any(key == judged or key.startswith(f"{judged}.") for judged in JUDGED_KEYS), key

"""The air of the caliper's module, identified from records of the simulated one."""

from dataclasses import replace

import numpy as np
import pytest

from uictest.plans.scenario.yaml import parse_quantity
from uictest.rig.bench import identify_air, load_bench, run_test
from uictest.rig.identification import UnsuitableRecordError

RECIPE = """schema: uictest/bench/1
name: cycling
stop:
  simulation: {time_step: 1 ms}
  rig:
    sensors:
      extends: standard
      pressure: {noise: 1e-6 bar, offset: 0 bar, gain_error: 0 %, resolution: 1e-5 bar}
inputs:
  - {kind: triangular, peaks: [1 bar, 1 bar], floor: 0 bar, ramp: 2 s}
  - {kind: wsp, pressure: 4 bar, lead: 3 s, cycles: 8, vent: [0.2 s, 2 s], hold: [0.05 s, 0.4 s],
     fill: [0.1 s, 1 s], seed: 4}
  - {kind: rest, duration: 3 s}
"""


@pytest.fixture(name="test", scope="module")
def _test(tmp_path_factory):
    recipe = tmp_path_factory.mktemp("bench") / "cycling.yaml"
    recipe.write_text(RECIPE, "utf-8")
    return load_bench(recipe)


@pytest.fixture(name="record", scope="module")
def _record(test):
    return run_test(test)


def changed(case, part, **fields):
    """The case with other values in a part of its scenario."""

    def copied(model, names):
        update = {names[0]: copied(getattr(model, names[0]), names[1:])} if names else fields
        return model.model_copy(update=update)

    return replace(case, scenario=copied(case.scenario, part.split(".")))


def channels(record):
    names = {
        "time": "time",
        "tank": "measured_pressure_2",
        "cylinder": "cylinder_pressure_1",
        "line": "brake_line_pressure",
        "command": "valve_command_1",
    }
    return {role: np.array(record[name]) for role, name in names.items()}


@pytest.fixture(name="result", scope="module")
def _result(test, record):
    return identify_air(channels(record), test.case)


def test_the_air_that_made_a_record_is_found_in_it(test, result):
    """Surfaces times film coefficients, the volume of the stroke, the pressures of spring and friction."""
    system, caliper = test.case.scenario.brake.system, test.case.scenario.rig.caliper
    tank = system.tank.surface * system.tank.film_coefficient
    balls = system.caliper_tank.ball_surface * system.caliper_tank.film_coefficient
    assert result.tank_heat_conductance == pytest.approx(tank, rel=0.15)
    assert result.caliper_heat_conductance == pytest.approx(tank + balls, rel=0.15)
    assert result.swept_volume == pytest.approx(caliper.piston_area * caliper.clearance, rel=0.15)
    closing = (caliper.preload + caliper.coulomb_friction) / caliper.piston_area
    opening = (caliper.preload - caliper.coulomb_friction) / caliper.piston_area
    assert result.closing_pressure == pytest.approx(closing, rel=0.1)
    assert result.opening_pressure == pytest.approx(opening, rel=0.1)
    assert result.largest_before > 0.03
    assert result.largest_after < 0.02


@pytest.mark.parametrize("volume", ["1 L", "4 L"])
def test_a_record_of_a_tank_of_another_volume_contradicts_the_rig(test, record, volume):
    """Heat conductances fitted to it would be wrong by a factor, with small errors."""
    other = changed(test.case, "brake.system.tank", volume=parse_quantity(volume, "volume"))
    with pytest.raises(UnsuitableRecordError, match=rf"as one of .* L would, .* has {volume}"):
        identify_air(channels(record), other)


def test_the_numbers_do_not_depend_on_those_of_the_compensation(test, record, result):
    air = {"tank_heat_conductance": 0.0, "swept_volume": 1e-6}
    other = changed(test.case, "rig.compensation_model.air", **air)
    assert identify_air(channels(record), other) == result


def test_sensors_with_noise_change_little(tmp_path):
    recipe = tmp_path / "noisy.yaml"
    recipe.write_text(RECIPE[: RECIPE.index("  rig:")] + RECIPE[RECIPE.index("inputs:") :], "utf-8")
    noisy = load_bench(recipe)
    result = identify_air(channels(run_test(noisy)), noisy.case)
    assert result.caliper_heat_conductance == pytest.approx(11.8, rel=0.2)
    assert result.largest_after < 0.02


def test_the_fit_of_the_largest_error_has_a_smaller_one_and_a_greater_mean(test, record, result):
    least = identify_air(channels(record), test.case, starts_near=result, largest=True)
    assert least.largest_after < result.largest_after
    assert least.rms_after > result.rms_after


@pytest.mark.parametrize(
    ("spoil", "reason"),
    [
        ({"cylinder": lambda record: record["tank"]}, "the same, sample by sample"),
        ({"tank": lambda record: np.full_like(record["tank"], 2e5)}, "no excitation"),
        ({"line": lambda record: np.full_like(record["line"], np.nan)}, "not numbers"),
        ({"tank": lambda record: np.minimum(record["tank"], record["tank"] - 8e4)}, "is it gauge pressure"),
        ({"line": lambda record: record["line"] + 2e5}, "begin with released brakes, but the line pressure"),
    ],
)
def test_a_record_that_cannot_support_it_is_refused(test, record, spoil, reason):
    spoiled = channels(record)
    spoiled |= {name: change(spoiled) for name, change in spoil.items()}
    with pytest.raises(UnsuitableRecordError, match=reason):
        identify_air(spoiled, test.case)

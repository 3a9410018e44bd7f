"""A range for sensitivities says where the scenario's own value lies."""

from pathlib import Path

import numpy as np
import pytest

from uictest.plans.sweeps import drawn_ranges, load_sweep
from uictest.plans.sweeps.plan import saltelli_sample

SHIPPED = sorted((Path(__file__).parents[3] / "scenarios").glob("*.sweep.yaml"))
TEXT = """\
sample:
  method: saltelli
  size: 8
  parameters:
    rail.friction: {uniform: [0.11, 0.15]}
    brake.command: {triangular: [80 %, 100 %, 100 %]}
    initial_speed: {normal: {mean: 30 km/h, deviation: 1 km/h, lower: 28 km/h, upper: 32 km/h}}
    rig.topology: {choice: [one-caliper, four-caliper]}
    vehicle.wheelsets.2.brake_force: {uniform: [90 %, 95 %]}
"""


def test_the_ends_are_those_of_the_draws(load):
    plan = load(TEXT)
    sample = saltelli_sample(plan)
    for each in drawn_ranges(plan):
        draw = sample.draws[sample.keys.index(each.key)]
        first, last = draw.values(np.array([0.0, 1.0]))
        assert (each.low, each.high) == (first.content, last.content)


def test_only_samples_for_sensitivities_have_ranges_that_lie_around_the_nominal_or_beside(load):
    inside = {each.key: each.contains_nominal for each in drawn_ranges(load(TEXT))}
    # A wheelset without a brake force of its own has the regular one.
    assert inside == {
        "rail.friction": False,
        "brake.command": True,
        "initial_speed": True,
        "vehicle.wheelsets.2.brake_force": False,
    }
    sentences = list(map(str, drawn_ranges(load(TEXT))))
    assert sentences[0] == "rail.friction: the scenario's own 0.1 lies OUTSIDE the range 0.11 .. 0.15"
    assert list(drawn_ranges(load(TEXT.replace("saltelli", "random")))) == []
    assert list(drawn_ranges(load())) == []


@pytest.mark.parametrize("path", SHIPPED, ids=[path.stem for path in SHIPPED])
def test_the_shipped_sensitivities_are_those_of_the_shipped_scenario(path):
    assert [str(each) for each in drawn_ranges(load_sweep(path)) if not each.contains_nominal] == []

"""What the shipped controllers make of a speed sensor that fails: over frictions, instants and wheelsets."""

from itertools import product

import numpy as np
import pytest

from uictest import rig as simulation

INSTANTS = ("at: 2 s", "at: 40 km/h")
FRICTIONS = ("0.06", "0.09", "0.12")
WHEELSETS = (1, 2, 3, 4)
SEEDS = (0, 1)
KINDS = {"lost": "kind: lost", "zero": "kind: factor, value: 0 %", "stuck": "kind: stuck"}


def stops(rig, controller, kind, instants=INSTANTS, frictions=FRICTIONS):
    """Measures of the stop and of its wheelsets, for every instant, friction, wheelset and seed."""
    inputs = []
    for at, friction, wheelset in product(instants, frictions, WHEELSETS):
        fault = f"faults=[{{{at}, wheelset: {wheelset}, part: speed-sensor, {KINDS[kind]}}}]"
        case = rig.inputs(
            *(f"controller={controller}", "rig.topology=four-caliper", "rail.condition=wet"),
            *(f"rail.friction={friction}", fault),
        )
        for seed in SEEDS:
            parameters = case.parameters.copy()
            parameters["seed"] = seed
            inputs.append(case._replace(parameters=parameters))
    parameters = np.array([each.parameters for each in inputs], inputs[0].parameters.dtype)
    wheelsets, rail = (np.array([each[k] for each in inputs]) for k in (1, 2))
    batch = simulation.run_in_lanes(parameters, wheelsets, rail)
    yield from zip(batch.measures.view(np.recarray), batch.wheelset_measures.view(np.recarray), strict=True)


@pytest.mark.parametrize("kind", KINDS)
def test_a_lost_sensor_locks_no_sound_wheelset(rig, kind):
    """Nor does it capture the estimate of the train's speed, or keep its own brake released."""
    for measures, wheelsets in stops(rig, "threshold", kind):
        sound = wheelsets[wheelsets.faulty == 0.0]
        assert len(sound) == 3
        assert measures.stopped == 1.0
        assert sound.longest_lock.max() < 1.0
        assert measures.reference_excess < 1.0
        assert np.nanmax(wheelsets.longest_release) < 6.0
        assert abs(measures.air_residual) < 1e-9
        assert abs(measures.energy_residual) < 1e-6


def test_the_simplest_controller_follows_a_stuck_sensor(rig):
    """It takes what it reads for the speed of the train, unless that wheelset slides deep when it sticks."""
    found = list(stops(rig, "slip-band", "stuck", ["at: 30 km/h"], ["0.12"]))
    assert max(measures.reference_excess for measures, _ in found) > 3.0

"""Once per controller cycle: friction under each wheelset, sensor noise and the delay of the valves."""

import numpy as np
import pytest

from uictest.core.physics.air import FILL, HOLD, VENT
from uictest.rig.model.cycle import command_valves, read_sensors, start_cycle
from uictest.rig.model.records import needs_of

from ..plain_numbers import step


def scripted(commands):
    """The cycle with a controller that gives every wheelset the next of these commands, then fills."""
    script = iter(commands)

    def cycle(car, wheelsets, p, rail):
        start_cycle(car, wheelsets, p, rail)
        command = next(script, FILL)
        for wheelset in wheelsets:
            wheelset.valve_command = command

    return cycle


def openings(bench, rail, commands, cycles):
    """Openings of the first valve after each step."""
    cycle = scripted(commands)
    vent, fill = [], []
    for _ in range(cycles):
        cycle(bench.car, bench.wheelsets, bench.p, rail)
        command_valves(bench.car, bench.wheelsets, bench.p)
        for _ in range(bench.p.steps_per_cycle):
            step(bench.car, bench.bogies, bench.wheelsets, bench.p)
            vent.append(bench.wheelsets[0].vent_opening)
            fill.append(bench.wheelsets[0].fill_opening)
    return {"vent": np.array(vent), "fill": np.array(fill)}


@pytest.mark.parametrize("steps", [1, 19, 20, 21, 127, 128, 240])
def test_valve_moves_a_whole_delay_after_the_command(rig, bench, steps):
    """Exact to the step, whatever part of a controller cycle the delay ends in."""
    delay = f"brake.system.wsp_valve.switching_delay={steps * 0.5} ms"
    parameters, rail = rig.parameters(delay, "brake.system.wsp_valve.travel_time=0.5 ms")
    commanded, until = 3, 9
    seen = openings(bench(parameters), rail, [FILL] * commanded + [VENT] * (until - commanded), 30)
    expected = np.zeros(600)
    expected[commanded * 20 + steps : until * 20 + steps] = 1.0
    np.testing.assert_array_equal(seen["vent"], expected)
    np.testing.assert_array_equal(seen["fill"], 1.0 - expected)


def test_valve_travels_for_its_travel_time_and_bypassed_ones_always_fill(rig, bench):
    parameters, rail = rig.parameters("brake.system.wsp_valve.travel_time=20 ms")
    seen = openings(bench(parameters), rail, [FILL] + [HOLD] * 20, 20)
    moving = (seen["fill"] > 0.0) & (seen["fill"] < 1.0)
    assert moving.sum() + 1 == pytest.approx(40, abs=1)
    assert not seen["vent"].any()
    parameters, rail = rig.parameters("rig.wsp=bypassed")
    seen = openings(bench(parameters), rail, [VENT] * 20, 20)
    assert np.all(seen["fill"] == 1.0)
    assert not seen["vent"].any()


def test_friction_is_looked_up_at_each_wheelsets_own_place_and_time(rig, bench):
    """The second wheelset of a bogie is a wheelbase behind, the second bogie the pivots' distance."""
    parameters, _ = rig.parameters(friction_points=3, friction_times=2)
    rail = np.array([[0.0, 50.0, 60.0], [0.3, 0.3, 0.05], [0.0, 10.0, 0.0], [1.0, 0.5, 0.0]])
    wheelbase, pivots = 2.0 * parameters.half_wheelbase, 2.0 * parameters.half_pivot_distance
    behind = np.array([0.0, wheelbase, pivots, pivots + wheelbase])
    standing = bench(parameters)
    undecided = scripted([])
    for place, time in ((0.0, 0.0), (51.0, 2.0), (58.5, 5.0), (70.0, 20.0), (90.0, 9.0)):
        standing.car.position, standing.car.time = place, time
        undecided(standing.car, standing.wheelsets, standing.p, rail)
        along = np.interp(place - behind, rail[0], rail[1])
        factor = np.interp(time, [0.0, 10.0], [1.0, 0.5])
        found = [wheelset.friction for wheelset in standing.wheelsets]
        np.testing.assert_allclose(found, along * factor, rtol=1e-12)


def test_a_step_of_friction_is_met_by_one_wheelset_after_the_other(rig):
    friction = (
        "rail.friction={interpolation: steps, points: [{position: 0 m, friction: 0.3}, "
        "{position: 40 m, friction: 0.2}]}"
    )
    trace = rig.columns("rail.condition=wet", friction, every=20)
    p = rig.parameters()[0]
    met = trace["distance"][np.argmax(trace["friction"] < 0.25, axis=0)] - 40.0
    wheelbase, pivots = 2.0 * p.half_wheelbase, 2.0 * p.half_pivot_distance
    one_cycle = 80.0 / 3.6 * 0.01
    np.testing.assert_allclose(met, [0.0, wheelbase, pivots, pivots + wheelbase], atol=2.0 * one_cycle)


def test_every_sensor_has_noise_of_its_own(rig, bench):
    parameters, rail = rig.parameters()
    rolling = bench(parameters)
    undecided = scripted([])
    noise, all_sensors = [], needs_of(rolling.p)._replace(calipers=True, line_pressure=True)
    for _ in range(400):
        read_sensors(rolling.car, rolling.wheelsets, rolling.p, all_sensors)
        undecided(rolling.car, rolling.wheelsets, rolling.p, rail)
        command_valves(rolling.car, rolling.wheelsets, rolling.p)
        modules = [(w.measured_speed, w.pressure_error, w.loadcell_error) for w in rolling.wheelsets]
        noise.append([*np.ravel(modules), rolling.car.line_pressure_error])
    channels = np.array(noise)
    np.testing.assert_allclose(np.corrcoef(channels.T), np.eye(13), atol=5.0 / np.sqrt(400))
    pressures, loadcells = channels[:, [1, 4, 7, 10, 12]], channels[:, [2, 5, 8, 11]]
    np.testing.assert_allclose(pressures.std(axis=0), parameters.pressure_noise, rtol=0.15)
    np.testing.assert_allclose(loadcells.std(axis=0), parameters.loadcell_noise, rtol=0.15)

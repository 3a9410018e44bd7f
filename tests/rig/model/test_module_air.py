"""The air that a caliper's module would hold, followed beside a tank, against a module that has a caliper."""

from copy import deepcopy
from typing import NamedTuple

import numpy as np
import pytest

from uictest.rig.model.friction_brake import follow_tanks, read_line_pressure, step_clamping
from uictest.rig.model.pneumatics import step_air
from uictest.rig.train_stop import compiled_rig, run_to_end

EXACT = {f"pressure_{error}": 0.0 for error in ("gain_error", "offset", "noise")} | {
    # A converter so fine that it does not show.
    "pressure_resolution": 2.0**-30,
    "pressure_steps": 2.0**30,
}
LIKE_THE_TANK = {"modelled_swept_share": 1e-12}
"""No piston to speak of; :func:`followed` gives the module the heat of the tank as well."""
FILL, HOLD, VENT = (1.0, 0.0), (0.0, 0.0), (0.0, 1.0)


class Followed(NamedTuple):
    """Absolute pressures over time: of a module with a caliper, of a tank, and modelled beside the tank."""

    caliper: np.ndarray
    tank: np.ndarray
    modelled: np.ndarray


def commands(seed, seconds):
    """Fill for two seconds, then fill, hold and vent for 40 to 200 ms at random; (fill, vent) per step."""
    random = np.random.default_rng(seed)
    history = [FILL] * 4000
    while len(history) < seconds / 5e-4:
        history += [(FILL, HOLD, VENT)[random.integers(3)]] * int(random.integers(80, 400))
    return iter(history[: round(seconds / 5e-4)])


def followed(bench, history):
    """Step air and clamping of modules 1, with a caliper, and 2, a tank, under the same valve commands."""
    p, rows = bench.p, []
    caliper, tank = bench.wheelsets[:2]
    for fill, vent in history:
        for wheelset in bench.wheelsets:
            wheelset.fill_before = wheelset.fill_after = fill
            wheelset.vent_before = wheelset.vent_after = vent
        follow_tanks(bench.wheelsets, read_line_pressure(bench.car, p), p)
        step_air(bench.car, bench.wheelsets, p)
        step_clamping(caliper, p)
        step_clamping(tank, p)
        bench.car.steps += 1.0
        bench.car.time = bench.car.steps * p.step
        modelled = tank.compensated_pressure + p.atmospheric_pressure
        rows.append((caliper.pressure, tank.pressure, modelled))
    return Followed(*np.array(rows).T)


@pytest.fixture(name="thermal", scope="module")
def _thermal(rig, bench):
    """A rig with the modelled air, whose walls, piston and pressures are those of the rig itself."""

    def thermal(*overrides, **changes):
        overrides = ("rig.compensation=thermal", *overrides)
        p = rig.parameters(*overrides, **(EXACT | changes))[0]
        per_exchange = (p.heat_capacity_ratio - 1.0) * p.air_temperature / p.tank_volume
        own = {
            "modelled_tank_exchange": per_exchange * p.tank_exchange,
            "modelled_exchange": per_exchange * p.caliper_tank_exchange,
            "modelled_swept_share": p.piston_area * p.clearance / p.tank_volume,
            "modelled_closing_pressure": p.atmospheric_pressure
            + (p.preload + p.coulomb_friction) / p.piston_area,
            "modelled_opening_pressure": p.atmospheric_pressure
            + (p.preload - p.coulomb_friction) / p.piston_area,
        }
        return bench(rig.parameters(*overrides, **(EXACT | own | changes))[0])

    return thermal


@pytest.fixture(name="moved", scope="module")
def _moved(thermal):
    """A rig after four seconds of such commands, and the pressures meanwhile."""
    bench = thermal()
    return bench, followed(bench, commands(0, 4.0))


def test_modelled_pressure_is_that_of_the_caliper_within_a_per_cent(moved):
    """Of the commanded pressure: friction of the piston and heat of the line are not modelled."""
    bench, (caliper, tank, modelled) = moved
    acting = slice(4000, None)
    tanks_own = np.abs(tank - caliper)[acting].max() / bench.p.commanded_pressure
    assert tanks_own > 0.04
    assert np.abs(modelled - caliper)[acting].max() < 0.01 * bench.p.commanded_pressure


def test_heat_alone_is_followed_within_two_per_mille(thermal):
    """A piston that never moves and a line as warm as its wall: only the balls make a difference."""
    still = {"preload": 1e6, "caliper_tank_volume": thermal().p.tank_volume, "line_exchange": 1e9}
    bench = thermal(**still, **LIKE_THE_TANK)
    caliper, tank, modelled = followed(bench, commands(1, 4.0))
    assert np.abs(tank - caliper).max() > 0.03 * bench.p.commanded_pressure
    assert np.abs(modelled - caliper).max() < 0.002 * bench.p.commanded_pressure


def test_the_piston_alone_is_followed_within_two_per_mille(thermal):
    """No heat and a quick piston before a rigid disc: only the volume that it sweeps makes a difference."""
    caliper = ("viscous_friction=20 N s/m", "contact_friction=0 N s/m", "contact_stiffness=1e10 N/m")
    walls = {"tank_exchange": 0.0, "caliper_tank_exchange": 0.0, "line_exchange": 1e9}
    bench = thermal("simulation.time_step=0.125 ms", *(f"rig.caliper.{key}" for key in caliper), **walls)
    caliper, tank, modelled = followed(bench, commands(2, 4.0))
    assert np.abs(tank - caliper).max() > 0.01 * bench.p.commanded_pressure
    assert np.abs(modelled - caliper).max() < 0.002 * bench.p.commanded_pressure


def test_a_module_like_the_tank_has_the_tanks_pressure_at_every_step(thermal):
    exchange = thermal().p.modelled_tank_exchange
    bench = thermal(modelled_exchange=exchange, **LIKE_THE_TANK)
    _, tank, modelled = followed(bench, commands(1, 4.0))
    # The reading is a step old when the model takes it, and the ratio of both pressures is what it gives.
    np.testing.assert_allclose(modelled, tank, rtol=1e-8)


def test_air_at_rest_stays_at_rest(thermal):
    """Until the dead time of the command is over."""
    bench = thermal()
    _, _, modelled = followed(bench, iter([FILL] * int(bench.p.dead_time / bench.p.step)))
    np.testing.assert_allclose(modelled, bench.p.atmospheric_pressure, rtol=1e-14)


@pytest.mark.parametrize(
    ("errors", "accuracy"),
    [({}, 1e-4), ({"pressure_offset": 2e3, "pressure_gain_error": 0.005}, 1e-3)],
    ids=["exact sensors", "offset and gain"],
)
def test_the_ratio_of_pressures_comes_to_one_while_the_valve_fills(thermal, moved, errors, accuracy):
    """Whatever went before there is no drift; what sensors err in shifts tank, line and module alike."""
    bench = thermal(**errors) if errors else deepcopy(moved[0])
    if errors:
        followed(bench, commands(0, 4.0))
    tank = bench.wheelsets[1]
    assert abs(tank.pressure_ratio - 1.0) > 1e-3
    followed(bench, iter([FILL] * 6000))
    assert tank.pressure_ratio == pytest.approx(1.0, abs=accuracy)
    assert tank.modelled_travel == 1.0


def test_the_piston_closes_the_clearance_once_and_opens_it_when_the_tank_is_empty(thermal):
    bench = thermal()
    tank = bench.wheelsets[1]
    followed(bench, iter([FILL] * 2000))
    assert (tank.modelled_travel, tank.modelled_volume) == (1.0, 1.0)
    followed(bench, iter([VENT] * 4000))
    assert tank.modelled_travel == 0.0
    assert tank.modelled_volume == pytest.approx(1.0 - bench.p.modelled_swept_share)


def test_what_is_modelled_beside_calipers_is_read_by_nothing(rig):
    """Where every module has a caliper no stop depends on it; it is then not followed."""

    def measures(topology, exchange):
        overrides = ("rig.compensation=thermal", f"rig.topology={topology}", "initial_speed=20 km/h")
        inputs = rig.inputs(*overrides, modelled_exchange=exchange, noise_key=1)
        outcome = run_to_end(compiled_rig(), inputs)
        return outcome.measures.tobytes() + outcome.wheelset_measures.tobytes()

    assert measures("four-caliper", 1.0) == measures("four-caliper", 1e-3)
    assert measures("one-caliper", 1.0) != measures("one-caliper", 1e-3)

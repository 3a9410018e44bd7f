"""The longest step is where pressures begin to swing from step to step, and no shipped part comes near it."""

import numpy as np
import pytest

from uictest.plans.scenario import ScenarioErrors
from uictest.plans.scenario.feasibility import limit_of_air, limit_of_vehicle
from uictest.rig import simulate

STEP = 0.5e-3


@pytest.fixture
def head(head):
    return f"{head}rail: {{condition: dry}}\n".replace("120 km/h", "20 km/h")


def air_limit(case):
    system = case.scenario.brake.system
    smallest = min(float(system.tank.volume), case.scenario.tank_volume_with_caliper)
    valve = system.wsp_valve.fill_conductance, system.wsp_valve.vent_conductance
    return limit_of_air(system, case.scenario.rig.caliper, smallest, [valve] * 4)


def swing(case, channel):
    """Share of a channel's travel that is made back and forth between neighbouring steps."""
    recording = simulate(case, record_every=float(case.scenario.simulation.time_step)).recording
    assert recording is not None
    changes = np.diff(recording[channel])
    back = changes[1:] * changes[:-1] < 0.0
    return float(np.abs(changes[1:][back]).sum() / np.abs(changes).sum())


@pytest.mark.parametrize("brake", ["ep-disc", "distributor"])
@pytest.mark.parametrize("vehicle", ["intercity-180", "crh380a", "manchester-benchmark"])
def test_the_library_leaves_room_for_a_step_of_one_millisecond(case, brake, vehicle):
    stop = case(f"brake.system={brake}", f"vehicle={vehicle}", "simulation.time_step=1 ms")
    assert air_limit(stop).longest > 1e-3
    assert limit_of_vehicle(stop.scenario.vehicle).longest > 1e-3


@pytest.mark.parametrize(
    ("changed", "channel"),
    [
        ("brake.system.relay_valve.proportional_band=0.04 bar", "brake_line_pressure"),
        ("brake.system.brake_line.volume=2 L", "brake_line_pressure"),
        ("rig.caliper.viscous_friction=70 N s/m", "tank_pressure_1"),
    ],
)
def test_no_pressure_swings_just_inside_the_limit(case, changed, channel):
    stop = case(changed)
    assert STEP <= air_limit(stop).longest < 1.2 * STEP
    assert swing(stop, channel) < 1e-3


@pytest.mark.parametrize(
    ("changed", "of"),
    [
        ("brake.system.relay_valve.proportional_band=0.005 bar", "the air in the brake line"),
        ("brake.system.brake_line.volume=0.1 L", "the air in the brake line"),
        ("brake.system.wsp_valve.fill_conductance=1e-5 m3/(s Pa)", "the air in"),
        ("vehicle.wheelsets.3.wsp_valve.fill_conductance=2e-6 m3/(s Pa)", "the air in a tank"),
        ("brake.system.reservoir.volume=0.2 L", "the air in the reservoir"),
        ("rig.caliper.viscous_friction=0 N s/m", "the free piston of the caliper"),
    ],
)
def test_air_that_a_step_cannot_follow_is_rejected(case, changed, of):
    with pytest.raises(ScenarioErrors, match=f"too long for {of}"):
        case(changed)


def test_a_step_within_the_stated_limit_is_accepted_and_a_piston_that_nothing_holds_rejected(case):
    tight = "brake.system.relay_valve.proportional_band=0.02 bar"
    with pytest.raises(ScenarioErrors, match=r"time_step must be at most 0\.2") as rejected:
        case(tight)
    assert "relay_valve" in str(rejected.value)
    assert air_limit(case(tight, "simulation.time_step=0.25 ms")).longest > 0.25e-3
    with pytest.raises(ScenarioErrors, match="without spring rate and viscous friction"):
        case("rig.caliper.viscous_friction=0 N s/m", "rig.caliper.spring_rate=0 N/m")

"""Wheelsets that differ: each value moves what it should, and nothing else."""

import numpy as np
import pytest

from uictest.core.physics.air import VENT
from uictest.core.record import fields_of
from uictest.plans.scenario import WHEELSET_NUMBERS, wheelset_value
from uictest.plans.scenario.parts.vehicle import REGULAR
from uictest.rig.assembly import assemble
from uictest.rig.model.cycle import command_valves
from uictest.rig.model.parameters import WHEELSET_PARAMETERS, WheelsetParameters

from .plain_numbers import step

DRY = ("rail.condition=dry", "vehicle=intercity-180")
WET = ("rail.condition=wet", "rail.friction=0.09", "initial_speed=60 km/h")
FOUR_CALIPERS = "rig.topology=four-caliper"
"""So that each wheelset may have a caliper of its own."""
SILENT = {"speed_noise": 0.0, "timer_resolution": 1e-12}


def own(number, name, value):
    return f"vehicle.wheelsets.{number}.{name}={value}"


def differing(rig, *overrides):
    """The fields in which each wheelset's parameters differ from those of the regular one."""
    regular, changed = (
        assemble(rig.case(FOUR_CALIPERS, *each)).wheelset_parameters for each in ((), overrides)
    )
    return {
        number: {name for name in WHEELSET_PARAMETERS.names if one[name] != other[name]}
        for number, one, other in zip(WHEELSET_NUMBERS, regular, changed, strict=True)
    }


FIELDS_SET = {
    "wheel_radius=0.42 m": {"wheel_radius", "slip_response", "slip_stiffness"},
    "configured_radius=0.42 m": {"configured_radius", "tooth_pitch"},
    "rotational_inertia=200 kg m2": {
        *("rotational_inertia", "inertia_response", "inertia_stiffness"),
        *("slip_response", "slip_stiffness"),
    },
    "brake_force=90 %": {"brake_force"},
    "pad_friction=0.3": {"reference_pad_friction"},
    "caliper.coulomb_friction=99 N": {"coulomb_friction"},
    "caliper.load_friction=9.9 %": {
        *("squeezing_stiffness", "squeezing_compliance"),
        *("releasing_stiffness", "releasing_compliance"),
    },
    "wsp_valve.switching_delay=47.5 ms": {"valve_delay_cycles", "valve_delay_steps"},
    "wsp_valve.travel_time=33 ms": {"valve_travel_per_step"},
    "wsp_valve.fill_conductance=5e-8 m3/(s Pa)": {"fill_conductance"},
    "wsp_valve.vent_conductance=5e-8 m3/(s Pa)": {"vent_conductance"},
    "sensors.speed.teeth=60": {"tooth_pitch", "teeth"},
    "sensors.speed.noise=1 %": {"speed_noise"},
    "sensors.pressure.offset=0.1 bar": {"pressure_offset"},
    "sensors.loadcell.noise=50 N": {"loadcell_noise"},
}


@pytest.mark.parametrize("setting", FIELDS_SET)
def test_a_value_sets_its_fields_of_its_wheelset(rig, setting):
    for number in WHEELSET_NUMBERS:
        changed = differing(rig, f"vehicle.wheelsets.{number}.{setting}")
        assert changed.pop(number) == FIELDS_SET[setting]
        assert not any(changed.values())


def test_parameters_of_the_car_do_not_depend_on_single_wheelsets(rig):
    """Neither does the sensor of the brake line err as that of a tank does. The noise is that of a train."""
    settings = [f"vehicle.wheelsets.{number}.{setting}" for number in (1, 3) for setting in FIELDS_SET]
    regular, own = (assemble(rig.case(FOUR_CALIPERS, *each)).parameters for each in ((), settings))
    names = [name for name in regular.dtype.names if name != "noise_key"]
    assert [own[name].tolist() for name in names] == [regular[name].tolist() for name in names]


def test_the_state_of_a_wheelset_holds_its_parameters(rig, bench):
    started = bench(rig.parameters()[0])
    for wheelset in started.wheelsets:
        for name in fields_of(WheelsetParameters):
            assert getattr(wheelset, name) == getattr(started.p, name), name


def test_wheelsets_that_all_have_the_regular_values_change_no_bit(rig):
    four = (FOUR_CALIPERS, *WET)
    scenario = rig.case(*four).scenario
    values = [
        own(number, name, getattr(value := wheelset_value(scenario, number, name), "text", value))
        for number in WHEELSET_NUMBERS
        for name in (*REGULAR, "brake_force")
    ]
    inputs, regular = assemble(rig.case(*four, *values)), assemble(rig.case(*four))
    assert inputs.wheelset_parameters.tobytes() == regular.wheelset_parameters.tobytes()
    assert rig.stop(*four, *values).measures.tobytes() == rig.stop(*four).measures.tobytes()


def test_a_smaller_wheel_that_rolls_reads_fast(rig):
    """Its circumference is smaller, so it turns faster, and the WSP knows only the regular radius."""
    radius = float(rig.case().scenario.vehicle.wheelset.radius)
    smaller = own(2, "wheel_radius", f"{0.98 * radius} m")
    trace = rig.columns(*DRY, "rig.wsp=bypassed", smaller, **SILENT)
    rolling = (trace["time"] < 0.1) & (trace["time"] > 0.0)
    ratio = (trace["measured_speed"] / trace["speed"][:, None])[rolling]
    np.testing.assert_allclose(ratio, np.broadcast_to([1.0, 1.0 / 0.98, 1.0, 1.0], ratio.shape), rtol=1e-4)
    np.testing.assert_allclose(
        trace["wheel_speed"][rolling], trace["speed"][rolling, None] * np.ones(4), rtol=1e-4
    )
    told = rig.columns(
        *DRY, "rig.wsp=bypassed", smaller, own(2, "configured_radius", f"{0.98 * radius} m"), **SILENT
    )
    np.testing.assert_allclose((told["measured_speed"] / told["speed"][:, None])[rolling], 1.0, rtol=1e-4)


def test_a_radius_that_the_wsp_was_told_wrongly_moves_nothing_but_readings(rig):
    """With bypassed valves the vehicle does not know what the sensors read."""
    overrides = (*WET, "rig.wsp=bypassed")
    regular = rig.stop(*overrides)
    wrong = rig.stop(*overrides, own(3, "configured_radius", "0.40 m"))
    assert wrong.measures.tobytes() == regular.measures.tobytes()
    changed = [
        name
        for name in wrong.wheelsets.dtype.names
        if not np.array_equal(wrong.wheelsets[name], regular.wheelsets[name], equal_nan=True)
    ]
    assert {"configured_radius", "tooth_pitch"} <= set(changed)
    assert not {"speed", "rotation", "torque", "brake_heat", "wheel_load"} & set(changed)


@pytest.mark.parametrize("name", ["brake_force", "pad_friction"])
def test_a_weak_brake_has_less_torque_in_a_dry_stop(rig, name):
    regular_friction = float(rig.case().scenario.brake.system.disc.pad_friction)
    value = "90 %" if name == "brake_force" else f"{0.9 * regular_friction}"
    overrides = (*DRY, "rig.wsp=bypassed")
    trace = rig.columns(*overrides, own(3, name, value))
    force, torque = trace["clamping_force"][300:600], trace["brake_torque"][300:600]
    per_force = torque.mean(axis=0) / force.mean(axis=0)
    np.testing.assert_allclose(per_force / per_force[0], [1.0, 1.0, 0.9, 1.0], rtol=1e-9)


def test_a_slow_valve_vents_later_than_the_others(rig, bench):
    """By its own delay, in whole steps."""
    one = bench(rig.parameters("brake.system.wsp_valve.switching_delay=3 ms")[0])
    one.wheelsets[2].valve_delay_cycles, one.wheelsets[2].valve_delay_steps = 1, 4.0
    for wheelset in one.wheelsets:
        wheelset.valve_command, wheelset.friction = VENT, 0.3
    opened = np.zeros(4)
    for n in range(60):
        if n % one.p.steps_per_cycle == 0:
            command_valves(one.car, one.wheelsets, one.p)
        step(one.car, one.bogies, one.wheelsets, one.p)
        opened += [wheelset.vent_opening == 0.0 for wheelset in one.wheelsets]
    assert list(opened) == [6, 6, one.p.steps_per_cycle + 4, 6]

"""Friction of the rail and of the pads under a recorded stop, and the samples for it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.rail import contact_stiffness, creep_force
from uictest.core.recording import TIME, Recording
from uictest.plans.scenario import load, load_part
from uictest.recorded.field_data import WHEELSETS, Preparation, RawChannel, prepare, stated_case
from uictest.recorded.fitting import FitError, fit_stop
from uictest.recorded.fitting.balances import (
    Balances,
    samples_of,
    wheel_loads,
    wheelset_creep_force,
    windows_of,
)
from uictest.recorded.fitting.fit import Estimate, Fit, in_a_row, stretch_names, stretch_of
from uictest.recorded.fitting.outputs import fitted_yaml, friction_of
from uictest.rig import simulate

NOISE = {"speed": 0.05, "wheel_speed": 0.03, "clamping_force": 50.0}
"""Standard deviations, m/s and N; wheel speeds are read by the rig's toothed wheels besides."""
LOADCELL_GAIN = 0.005
"""Standard deviation of the gain errors of loadcells, share."""


def _with_sensor_noise(recording, dice):
    time = np.asarray(recording[TIME])

    def noise(kind):
        return dice.normal(0.0, NOISE[kind], len(time))

    samples = {"speed": recording["speed"] + noise("speed")}
    for n in (1, 2, 3, 4):
        samples[f"wheel_speed_{n}"] = recording[f"measured_speed_{n}"] + noise("wheel_speed")
        gain = 1.0 + dice.normal(0.0, LOADCELL_GAIN)
        samples[f"clamping_force_{n}"] = gain * recording[f"clamping_force_{n}"] + noise("clamping_force")
    return {name: RawChannel(name, name, time, np.asarray(values)) for name, values in samples.items()}


def recorded_stop(speed, friction, seed=0, without=(), every=0.01, **facts):
    """Simulate a stop from a speed in km/h on a friction, and record it with the sensor noise of a seed.

    A sample `every` so many seconds.
    """
    wsp = facts.get("wsp", "active")
    case = stated_case(
        "stop",
        speed / 3.6,
        ["rail.condition=wet", f"rail.friction={friction}", f"rig.wsp={wsp}", *facts.get("settings", ())],
    )
    recording = simulate(case, record_every=every).recording
    channels = _with_sensor_noise(recording, np.random.default_rng(seed))
    kept = {name: c for name, c in channels.items() if not name.startswith(without or ("-",))}
    return case, prepare(kept, recording.metadata, Preparation())


CONSTANT = [(80.0, 0.05), (80.0, 0.07), (80.0, 0.09), (80.0, 0.10), (100.0, 0.06), (100.0, 0.08)]
STEPS = [(80.0, 0.10, 0.06), (80.0, 0.06, 0.09), (100.0, 0.09, 0.06), (100.0, 0.06, 0.10)]


def _text(*levels, place=100.0):
    points = ", ".join(
        f"{{position: {p} m, friction: {mu}}}" for p, mu in zip((0, place), levels, strict=True)
    )
    return f"{{points: [{points}], interpolation: steps}}"


@pytest.mark.parametrize(("speed", "friction"), CONSTANT)
def test_constant_friction_within_3_percent(speed, friction):
    case, stop = recorded_stop(speed, str(friction), seed=int(1000 * friction))
    fit = fit_stop(stop, case.scenario)
    assert fit.determined
    assert fit.friction[0].value == pytest.approx(friction, rel=0.03)
    assert 0.0 < fit.friction[0].half_width < 0.03 * friction


@pytest.mark.parametrize(("speed", "before", "after"), STEPS)
def test_two_steps_within_5_percent(speed, before, after):
    case, stop = recorded_stop(speed, _text(before, after), seed=7)
    fit = fit_stop(stop, case.scenario, [100.0])
    assert [estimate.value for estimate in fit.friction] == pytest.approx([before, after], rel=0.05)


def test_without_sliding_or_beyond_the_stop_there_is_no_value():
    case, stop = recorded_stop(60.0, "0.5")
    [estimate] = fit_stop(stop, case.scenario).friction
    assert estimate.standing == "at least"
    assert 0.02 < estimate.value < 0.5
    assert "so it may be higher" in str(estimate)
    case, stop = recorded_stop(60.0, "0.07")
    fit = fit_stop(stop, case.scenario, [5000.0])
    assert [estimate.standing for estimate in fit.friction] == ["found", "not reached"]
    assert fit.determined
    case, stop = recorded_stop(60.0, "0.07", without=("wheel_speed_2",))
    with pytest.raises(FitError, match="not recorded: wheel_speed_2"):
        fit_stop(stop, case.scenario)


def test_a_stop_of_a_few_samples_is_too_short():
    case, stop = recorded_stop(10.3, "0.07", settings=("measures.moving_speed=10 km/h",))
    with pytest.raises(FitError, match="the stop is too short for a fit"):
        fit_stop(stop, case.scenario)


LAW = "recovered_friction: 0.22, reach: 0.5 m, carry_over: 0.5"
CURVES = "friction_ratio: 0.74, friction_decay: 0.18 s/m, reduction_adhesion: 0.87, reduction_slip: 0.45"


@pytest.mark.parametrize(
    "more",
    [
        "energy: 8000 J/m",
        f"energy: 8000 J/m, clean_curve: {{{CURVES}}}",
        "energy: 8000 J/m, spent: 2 kJ/m",
        "energy: 4000 J/m, loss: contact",
    ],
    ids=["one curve", "whole curves", "a worn layer", "loss of one contact"],
)
def test_stated_cleaning_is_not_counted_twice(more):
    """The friction is that of the rail as found."""
    case, recorded = recorded_stop(80.0, "0.07", 1, settings=(f"rail.cleaning={{{LAW}, {more}}}",))
    plain = stated_case("plain", 80.0 / 3.6, ["rail.condition=wet"]).scenario
    assert fit_stop(recorded, case.scenario).friction[0].value == pytest.approx(0.07, rel=0.04)
    assert fit_stop(recorded, plain).friction[0].value > 0.09


def test_what_wheelsets_have_of_their_own_is_accounted_for():
    """A weak brake, a small wheel, other pads: the balances of that wheelset hold with its own numbers."""
    small = "wheel_radius: 0.41 m, configured_radius: 0.41 m"
    own = f"{{1: {{brake_force: 80 %}}, 2: {{{small}}}, 4: {{pad_friction: 0.45}}}}"
    case, stop = recorded_stop(80.0, "0.07", seed=3, settings=[f"vehicle.wheelsets={own}"])
    fit = fit_stop(stop, case.scenario)
    assert fit.friction[0].value == pytest.approx(0.07, rel=0.03)
    alike, _ = recorded_stop(80.0, "0.07", seed=3)
    other = fit_stop(stop, alike.scenario)
    assert fit.residual < other.residual
    assert fit.friction[0].half_width < 0.2 * other.friction[0].half_width


def test_one_factor_does_not_stand_for_pads_of_single_wheelsets():
    case, stop = recorded_stop(80.0, "0.07", settings=["vehicle.wheelsets.2.pad_friction=0.36"])
    with pytest.raises(FitError, match="single wheelsets"):
        fit_stop(stop, case.scenario, with_pads=True)


def test_pad_friction_beside_friction():
    case, stop = recorded_stop(80.0, "0.08")
    pads = case.scenario.brake.system.disc.pad_friction
    system = case.scenario.brake.system
    weaker = system.disc.model_copy(update={"pad_friction": type(pads)(0.9 * pads, "", "1")})
    brake = case.scenario.brake.model_copy(update={"system": system.model_copy(update={"disc": weaker})})
    fit = fit_stop(stop, case.scenario.model_copy(update={"brake": brake}), with_pads=True)
    assert fit.pad_factor.value == pytest.approx(1.0 / 0.9, rel=0.03)
    assert fit.friction[0].value == pytest.approx(0.08, rel=0.03)


def test_without_forces_the_train_alone_tells_where_all_wheelsets_slide():
    case, stop = recorded_stop(80.0, "0.06", without=("clamping_force",))
    assert fit_stop(stop, case.scenario).friction[0].value == pytest.approx(0.06, rel=0.05)
    with pytest.raises(FitError, match="clamping forces"):
        fit_stop(stop, case.scenario, with_pads=True)


def test_forces_do_not_say_the_torque_of_pads_that_vary():
    """The recorded torque does, and whether pads are weaker than the scenario's cannot be asked."""
    case, stop = recorded_stop(80.0, "0.08")
    varying = case.scenario.brake.model_copy(update={"pad": load_part("pads/disc-pad")})
    scenario = case.scenario.model_copy(update={"brake": varying})
    [known], [unknown] = (fit_stop(stop, each).friction for each in (case.scenario, scenario))
    assert unknown.half_width > 5.0 * known.half_width
    assert abs(unknown.value - known.value) < unknown.half_width
    with pytest.raises(FitError, match="pad: constant"):
        fit_stop(stop, scenario, with_pads=True)


def test_the_creep_law_over_arrays_is_the_rigs_own():
    rail = stated_case("rail", 20.0, ["rail.condition=wet"]).scenario.rail.condition
    slips = np.array([0.0, 0.01, 0.5, 3.0, 15.0])
    full = np.full(5, 1.0)
    forces = wheelset_creep_force(slips, 20.0 * full, 5.5e4 * full, 0.1 * full, rail)
    contact = rail.contact
    area = np.pi * contact.semi_axis_longitudinal * contact.semi_axis_lateral
    reference = 0.25 * contact.shear_modulus * area * contact.kalker_coefficient
    for slip, force in zip(slips, forces, strict=True):
        stiffness = contact_stiffness(float(reference), 5.5e4 / float(contact.reference_wheel_load))
        rest = (rail.friction_ratio, rail.friction_decay, rail.reduction_adhesion, rail.reduction_slip)
        single, _ = creep_force(float(slip), 20.0, 5.5e4, stiffness, 0.1, *map(float, rest))
        assert force == pytest.approx(2.0 * single, rel=1e-9)


def test_braking_loads_the_leading_wheelsets_and_keeps_the_weight():
    vehicle = stated_case("car", 20.0, []).scenario.vehicle
    rest, braking = wheel_loads(vehicle, np.array([0.0, 1.0])).T
    assert braking.sum() == pytest.approx(rest.sum())
    assert braking[1] < braking[0]
    assert braking[3] < braking[2]


def test_stretches():
    np.testing.assert_array_equal(
        stretch_of(np.array([-5.0, 49.9, 50.0, 200.0]), [50.0, 120.0]), [0, 0, 1, 2]
    )
    assert stretch_names([50.0, 120.0]) == ["up to 50 m", "from 50 m to 120 m", "from 120 m on"]
    assert stretch_names([]) == ["everywhere"]


@pytest.mark.parametrize("delay", [-0.03, 0.02, 0.04])
def test_wheel_speeds_that_are_recorded_late_do_not_change_the_friction(delay):
    case, stop = recorded_stop(80.0, "0.08", seed=5)
    channels = dict(stop.recording.channels)
    for n in (1, 2, 3, 4):
        name = f"wheel_speed_{n}"
        channels[name] = np.interp(channels["time"] - delay, channels["time"], channels[name])
    late = replace(stop, recording=Recording(channels, stop.recording.units))
    before, after = (fit_stop(each, case.scenario) for each in (stop, late))
    assert after.delay.value - before.delay.value == pytest.approx(delay, abs=0.002)
    assert after.friction[0].value == pytest.approx(0.08, rel=0.005)


def test_recorded_wheel_loads_take_the_place_of_those_of_the_vehicle():
    """The same forces on half the weight are twice the friction."""
    case, stop = recorded_stop(80.0, "0.08")
    samples = samples_of(stop, case.scenario)
    loads = {f"wheel_load_{n + 1}": np.full(len(stop.recording["time"]), 0.5) for n in range(4)}
    for n in range(4):
        loads[f"wheel_load_{n + 1}"] *= float(samples.load[n].mean())
    units = {**stop.recording.units, **dict.fromkeys(loads, "N")}
    light = replace(stop, recording=Recording({**stop.recording.channels, **loads}, units))
    assert fit_stop(light, case.scenario).friction[0].value == pytest.approx(0.16, rel=0.03)


def test_loads_of_the_vehicle_are_those_of_the_simulated_train():
    case = stated_case("stop", 80.0 / 3.6, ["rail.condition=dry"])
    recording = simulate(case, record_every=0.01).recording
    steady = (recording["time"] > 5.0) & (recording["speed"] > 5.0)
    deceleration = -np.gradient(recording["speed"], recording["time"])[steady].mean()
    expected = wheel_loads(case.scenario.vehicle, np.array([deceleration]))[:, 0]
    for n in range(4):
        assert recording[f"wheel_load_{n + 1}"][steady].mean() == pytest.approx(expected[n], rel=0.002)


def test_the_train_alone_says_nothing_where_a_wheelset_rolls():
    case, stop = recorded_stop(80.0, "0.07", without=("clamping_force",))
    rolling = {"wheel_speed_4": np.array(stop.recording["speed"])}
    recording = Recording({**stop.recording.channels, **rolling}, stop.recording.units)
    [estimate] = fit_stop(replace(stop, recording=recording), case.scenario).friction
    assert estimate.standing == "at least"


@given(st.lists(st.floats(-1.0, 1.0), min_size=2, max_size=200))
def test_the_variance_of_a_mean_is_that_of_all_rows(residuals):
    """By the rows themselves, also those that reach beyond the ends."""
    rest = np.array(residuals) - np.mean(residuals)
    row, variance = in_a_row(np.array(residuals))
    means = np.convolve(rest, np.full(row, 1.0 / row))
    floor = np.sum(rest**2) / len(rest) / row**2
    assert variance == pytest.approx(max(np.sum(means**2) / len(rest), floor), rel=1e-9, abs=1e-15)


def test_noise_at_the_ends_of_windows_hardly_stays_in_a_mean():
    ends = np.random.default_rng(1).normal(size=401)
    noise = np.diff(ends)
    row, variance = in_a_row(noise)
    assert variance < 0.3 * np.var(noise) / row


def test_the_noise_of_a_record_and_what_it_leaves_are_those_of_its_sensor():
    """At the friction of the rail nothing but the noise is left: conftest's 0.05 m/s on the train speed."""
    shares = []
    for seed in (1, 2, 3, 4):
        case, stop = recorded_stop(100.0, "0.05", seed=seed, without=("clamping_force",))
        samples = samples_of(stop, case.scenario)
        assert samples.noise == pytest.approx(0.05 / 11**0.5, rel=0.1)
        balances = Balances(samples, windows_of(samples), case.scenario)
        _, of_train = balances.residuals(np.full_like(samples.slip, 0.05), None, 1.0)
        row, variance = in_a_row(of_train)
        shares.append(balances.noise_variance(row) / variance)
    assert np.mean(shares) == pytest.approx(1.0, abs=0.3)


def test_forces_say_the_torque_of_pads_that_do_not_vary():
    """By calipers, pads, radius and friction, each wheelset with its own: the rig records both."""
    own = "{1: {brake_force: 80 %}, 4: {pad_friction: 0.45}}"
    settings = ["rail.condition=wet", "rail.friction=0.07", f"vehicle.wheelsets={own}"]
    case = stated_case("stop", 80.0 / 3.6, settings)
    recording = simulate(case, record_every=0.01).recording
    time = np.asarray(recording[TIME])
    names = [f"{kind}_{n}" for n in WHEELSETS for kind in ("wheel_speed", "clamping_force", "brake_torque")]
    channels = {
        name: RawChannel(name, name, time, np.array(recording[name], dtype=float))
        for name in ("speed", *names)
    }
    torques = []
    for without in ("brake_torque", "clamping_force"):
        kept = {name: each for name, each in channels.items() if not name.startswith(without)}
        samples = samples_of(prepare(kept, recording.metadata, Preparation()), case.scenario)
        assert samples.torque is not None
        torques.append(np.where(samples.standing, 0.0, samples.torque))
    by_forces, recorded = torques
    assert recorded.max() > 1e3
    rolling = np.abs(by_forces - recorded) < 1e-3 * recorded.max()
    assert rolling.mean() > 0.98


def test_a_stop_that_a_track_brake_slowed_as_well_is_no_stop_for_a_fit():
    case, stop = recorded_stop(60, 0.06, settings=["brake.track={attraction: 100 kN, when: always}"])
    with pytest.raises(FitError, match="a track brake slowed the train"):
        samples_of(stop, case.scenario)


NAN = float("nan")
HEAD = "schema: uictest/scenario/1\nname: {name}\ninitial_speed: 80 km/h\n"


def fit(*estimates, breaks=()):
    """Return a fit with these standings and values, one for each stretch."""
    found = [Estimate("friction", standing, value, NAN, 1) for standing, value in estimates]
    return Fit(breaks, tuple(found), None, 0.001)


@pytest.fixture
def case():
    """A stop on a rail of friction 0.3, as far as its scenario knows."""
    return stated_case("guess", 80.0 / 3.6, ["rail.condition=wet", "rail.friction=0.3"])


@pytest.mark.parametrize(
    ("estimate", "friction"),
    [
        (("found", 0.0712345678), 0.07123),
        (("at least", 0.2), 0.3),
        (("at least", 0.4), 0.4),
        (("found", 1.2), 1.0),
    ],
)
def test_friction_is_what_was_found_or_the_scenarios_own_unless_it_is_higher(case, estimate, friction):
    """A scenario takes no friction above 1."""
    assert friction_of(fit(estimate), case.scenario) == friction


def test_a_stretch_that_no_wheelset_reached_takes_its_neighbours_friction(case):
    fitted = fit(("found", 0.07), ("not reached", NAN), ("found", 0.1), breaks=(50.0, 120.0))
    assert friction_of(fitted, case.scenario) == {
        "points": [
            {"position": "0 m", "friction": 0.07},
            {"position": "50 m", "friction": 0.07},
            {"position": "120 m", "friction": 0.1},
        ],
        "interpolation": "steps",
    }


def test_a_stretch_that_begins_behind_the_brake_command_has_one_before_it(case):
    points = friction_of(fit(("found", 0.07), ("found", 0.1), breaks=(-20.0,)), case.scenario)
    assert [each["position"] for each in points["points"]] == ["-21 m", "-20 m"]


def test_a_fitted_rail_varies_no_more_at_random(tmp_path):
    """What it was is in the friction that was found."""
    path = tmp_path / "own.yaml"
    path.write_text(HEAD.format(name="own") + "rail: {condition: wet-varied}\n", "utf-8")
    [case] = load([path])
    fitted = tmp_path / "fitted.yaml"
    fitted.write_text(fitted_yaml(case, {}, fit(("found", 0.07)), path, tmp_path), "utf-8")
    [read] = load([fitted])
    assert case.scenario.rail.variation_in_force is not None
    assert read.scenario.rail.variation_in_force is None
    assert friction_of(fit(("at least", 0.2)), case.scenario) == 0.3


@pytest.mark.parametrize("length", [5, 100])
def test_a_fitted_scenario_has_a_name_that_scenarios_can_have(tmp_path, length):
    name = "s" * length
    path = tmp_path / "own.yaml"
    path.write_text(HEAD.format(name=name) + "rail: {condition: wet}\n", "utf-8")
    [case] = load([path])
    fitted = tmp_path / "fitted.yaml"
    fitted.write_text(fitted_yaml(case, {}, fit(("found", 0.07)), path, tmp_path), "utf-8")
    [read] = load([fitted])
    assert read.scenario.name == f"{name[:90]}-fitted"
    assert read.scenario.rail.friction == 0.07

"""A record must agree with the scenario that judges it: what contradicts it is named with both numbers."""

import math
from dataclasses import replace

import numpy as np
import pytest

import uictest
from uictest import rig
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans import library
from uictest.plans.scenario import ScenarioErrors, brake_deceleration, load
from uictest.plans.series import load_series
from uictest.recorded.field_data import MapError, Preparation, RawChannel, prepare

from .conftest import channels_of, judge_stop, kept

BAR = 1e5
PRESSURES = ("demanded_pressure", "brake_line_pressure", "cylinder_pressure", "tank_pressure")


def _shipped(name, overrides=()):
    return load([library.scenarios()[name]], overrides)[0]


@pytest.fixture(scope="module", name="dry")
def _dry():
    """The dry stop from 120 km/h in position R, and its recording."""
    case = _shipped("dry-120")
    return case, uictest.simulate(case)


def _checks(case, channels, facts, **choices):
    """Return the verdicts on a record by their id, without `record-`, and the result."""
    result = judge_stop(case, prepare(channels, facts, Preparation.model_validate(choices)))
    checks = {each.id.removeprefix("record-"): each for each in result.criteria if each.layer == "record"}
    return checks, result


def _failed(checks):
    return {name for name, each in checks.items() if each.status == "fail"}


def _changed(recording, names, change):
    channels = channels_of(recording)
    for name in list(channels):
        if name.startswith(names):
            channels[name] = replace(channels[name], samples=change(channels[name].samples))
    return channels


def _retimed(recording, factor):
    return {
        name: replace(channel, time=factor * channel.time) for name, channel in channels_of(recording).items()
    }


def test_the_brake_of_the_shipped_car_gives_what_its_numbers_give(dry):
    """By hand: cylinder, lever, 12 pads on 4 wheelsets, running resistance, inertia of the wheelsets."""
    case, recording = dry
    scenario = case.scenario
    caliper, disc, wheelset = scenario.rig.caliper, scenario.brake.system.disc, scenario.vehicle.wheelset
    lost = caliper.preload + caliper.spring_rate * caliper.clearance + caliper.coulomb_friction
    clamping = caliper.lever_ratio * (3.78e5 * caliper.piston_area - lost) / (1.0 + caliper.load_friction)
    faces = disc.calipers_per_wheelset * disc.pads_per_caliper
    force = 4.0 * faces * disc.pad_friction * clamping * disc.mean_radius / wheelset.radius
    drag, speed = scenario.vehicle.running_resistance, 120.0 / 3.6
    force += drag.constant + drag.linear * speed + drag.quadratic * speed**2
    mass = scenario.vehicle.total_mass + 4.0 * wheelset.rotational_inertia / wheelset.radius**2
    assert brake_deceleration(scenario) == pytest.approx(force / mass, rel=1e-9)
    assert 0.125 < brake_deceleration(scenario) / STANDARD_GRAVITY < 0.133
    checks, _ = _checks(case, channels_of(recording), recording.metadata)
    assert checks["deceleration"].value == pytest.approx(1.0, abs=0.015)  # built up, on a rail that holds


def test_uphill_and_a_track_brake_give_more_and_half_the_command_gives_half():
    level, uphill, half = (
        brake_deceleration(_shipped("dry-120", each).scenario)
        for each in ((), ("rail.gradient=30 permille",), ("brake.command=50 %",))
    )
    mass = _shipped("dry-120").scenario.vehicle.total_mass
    rotating = mass / (mass + 2661.0)
    assert uphill - level == pytest.approx(0.030 * STANDARD_GRAVITY * rotating, rel=1e-4)
    assert 0.4 < half / level < 0.55
    track = _shipped("track-brake-120").scenario
    without = track.model_copy(update={"brake": track.brake.model_copy(update={"track": None})})
    more = (brake_deceleration(track) - brake_deceleration(without)) * (mass + 2661.0)
    assert more == pytest.approx(track.brake.track.largest_force, rel=1e-3)


def _scaled(names, factor):
    return lambda recording: _changed(recording, names, lambda samples: factor * samples)


SPEEDS = ("speed", "wheel_speed")
FASTER = _scaled(SPEEDS, 124.0 / 120.0)
MISTAKES = {
    # m/s taken for km/h, and the other way round: GoldenCheetah issues 127 and 1826
    "m/s as km/h": (_scaled(SPEEDS, 1.0 / 3.6), {"initial-speed": ""}),
    "km/h as m/s": (
        _scaled(SPEEDS, 3.6),
        {"initial-speed": "", "deceleration": "the brake gives 0.126 g at 100 %, tolerance 1.2"},
    ),
    "124 of 120 km/h": (
        FASTER,
        {"initial-speed": "recorded 124 km/h, scenario dry-120 says 120 km/h, tolerance 3 km/h"},
    ),
    "seconds as minutes": (lambda r: _retimed(r, 60.0), {"duration": ""}),
    "half seconds": (lambda r: _retimed(r, 0.5), {"deceleration": ""}),
    # a differential pressure of the other sign: rosflight_firmware issue 101
    "sign of every pressure": (
        _scaled(PRESSURES, -1.0),
        {"vacuum": "falls to -3.798 bar, tolerance 1.013 bar", "pressure-fall": "", "demanded-pressure": ""},
    ),
    "sign of one pressure, above vacuum": (
        lambda r: _changed(r, "cylinder_pressure_3", lambda p: 5e5 - 0.2 * p),
        {"pressure-fall": ""},
    ),
    # absolute pressure taken for gauge, as in AMO-Tools-Desktop issue 2188
    "absolute as gauge": (
        lambda r: _changed(r, PRESSURES, lambda p: p + 101325.0),
        {"demanded-pressure": ""},
    ),
    # mbar taken for kPa: zephyr pull request 116092
    "ten times the pressure": (_scaled(PRESSURES, 10.0), {"demanded-pressure": ""}),
    "80 % for 100 %": (
        _scaled("demanded_pressure", 0.8),
        {"demanded-pressure": "recorded at most 3.024 bar demanded, 100 % asks for 3.78 bar, tolerance 15 %"},
    ),
}
"""How a record is damaged; the checks that must fail, and what their reasons say."""
AT_ZERO = {"brake_command_time": "0 s"}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_in_a_record_is_named_and_makes_the_stop_invalid(dry, mistake):
    case, recording = dry
    damage, expected = MISTAKES[mistake]
    checks, result = _checks(case, damage(recording), AT_ZERO)
    assert _failed(checks) == expected.keys()
    assert result.outcome == "invalid"
    for name, reason in expected.items():
        assert f"record-{name}: " in result.reason
        assert reason in checks[name].reason
    value = {"124 of 120 km/h": ("initial-speed", 4.0), "80 % for 100 %": ("demanded-pressure", 20.0)}
    if mistake in value:
        name, shown = value[mistake]
        assert checks[name].value == pytest.approx(shown)


def test_another_unit_of_time_is_no_stop_of_a_train_and_a_command_too_late_another_initial_speed(dry):
    case, recording = dry
    for factor in (1000.0, 1e-3):
        with pytest.raises(MapError, match="check the units of time and speed"):
            _checks(case, _retimed(recording, factor), AT_ZERO)
    checks, result = _checks(case, channels_of(recording), {}, trigger_time="5 s")
    assert _failed(checks) == {"initial-speed"}
    assert "scenario dry-120 says 120 km/h, tolerance 3 km/h" in result.reason


@pytest.mark.parametrize(("coasting", "failed"), [(1.0, set()), (60.0, {"duration"})])
def test_a_brake_command_long_before_the_brake_is_named(dry, coasting, failed):
    """A trigger far too early: the train runs on at its speed, and the stop would be judged as a long one."""
    case, recording = dry
    even = np.arange(0.0, recording["time"][-1] + coasting, 0.01)
    raw = {
        name: RawChannel(name, name, even, np.interp(even, each.time + coasting, each.samples))
        for name, each in channels_of(recording).items()
    }
    checks, _ = _checks(case, raw, AT_ZERO)
    assert _failed(checks) == failed
    if failed:
        assert "down to 90 % of the speed, the brake needs" in checks["duration"].reason


def test_three_kilometres_per_hour_are_the_tolerance_unless_the_scenario_states_its_own(dry):
    case, recording = dry
    for speed, status in ((122.9, "pass"), (117.1, "pass"), (123.1, "fail")):
        checks, _ = _checks(case, _scaled(SPEEDS, speed / 120.0)(recording), AT_ZERO)
        assert checks["initial-speed"].status == status
    wide = _shipped("dry-120", ("record.tolerances.initial_speed=5 km/h",))
    checks, _ = _checks(wide, FASTER(recording), AT_ZERO)
    assert (checks["initial-speed"].status, checks["initial-speed"].upper) == ("pass", 5.0)
    strict = _shipped("dry-120", ("record.tolerances.deceleration=1", "initial_speed=124 km/h"))
    assert _failed(_checks(strict, FASTER(recording), AT_ZERO)[0]) == {"deceleration"}


@pytest.mark.parametrize(
    ("statement", "says"),
    [
        ("record.tolerances.initial_speed=3", "3 km/h"),
        ("record.tolerances.initial_speed=3 bar", "km/h"),
        ("record.tolerances.deceleration=0.5", "at least 1"),
        ("record.tolerances.inital_speed=3 km/h", "initial_speed"),
        ("record.friction=0.1", "friction"),
    ],
)
def test_a_tolerance_that_is_none_is_refused(statement, says):
    with pytest.raises(ScenarioErrors, match=says):
        _shipped("dry-120", (statement,))


def test_what_is_not_recorded_or_known_is_not_checked_and_says_why(dry, recording, case):
    dry_case, stop = dry
    bare = {name: each for name, each in channels_of(stop).items() if "pressure" not in name}
    checks, result = _checks(dry_case, bare, AT_ZERO)
    reasons = {name: each.reason for name, each in checks.items() if each.status == "not_applicable"}
    assert reasons == {
        "vacuum": "no pressure is recorded",
        "pressure-fall": "no pressure of the brake is recorded",
        "demanded-pressure": "demanded_pressure is not recorded",
    }
    assert result.outcome == "pass"
    late = kept(channels_of(stop), channels_of(stop)["speed"].time > 5.0)
    checks, _ = _checks(dry_case, late, AT_ZERO)
    unchecked = {name for name, each in checks.items() if each.status == "not_applicable"}
    assert {"initial-speed", "pressure-fall", "duration"} <= unchecked
    checks, _ = _checks(case, channels_of(recording), recording.metadata)
    unknown = {name for name, each in checks.items() if "which vehicle" in each.reason}
    assert unknown == {"deceleration", "demanded-pressure", "duration"}
    assert {checks[name].status for name in unknown} == {"not_applicable"}


def test_a_command_that_is_never_built_up_and_a_blended_brake_demand_less():
    slow = _shipped("dry-120", ("brake.position=G", "initial_speed=30 km/h"))
    short = uictest.simulate(slow)
    checks, _ = _checks(slow, channels_of(short), short.metadata)
    assert checks["demanded-pressure"].reason == "the record ends before the command is built up"
    assert not _failed(checks)
    blended = _shipped("dry-120", ("brake.dynamic={force: 60 kN, power: 1000 kW}",))
    stop = uictest.simulate(blended)
    checks, _ = _checks(blended, channels_of(stop), stop.metadata)
    assert checks["demanded-pressure"].status == "not_applicable"
    assert checks["deceleration"].status == "pass"


def test_the_record_outranks_a_missed_requirement_and_no_simulated_stop_has_its_checks():
    bypassed = _shipped("wsp-bypassed-80")
    stop = rig.simulate(bypassed, record_every=0.01)
    simulated = uictest.judging.evaluation.evaluate_simulated(bypassed, stop.measures, stop.wheelset_measures)
    assert simulated.outcome == "fail"
    assert "record" not in {each.layer for each in simulated.criteria}
    other = _shipped("wsp-bypassed-80", ("initial_speed=120 km/h",))
    checks, result = _checks(other, channels_of(stop.recording), stop.recording.metadata)
    assert result.outcome == "invalid"
    assert _failed(checks) == {"initial-speed"}
    assert "locked-wheels" in {each.id for each in result.criteria if each.status == "fail"}
    assert "locked-wheels" not in result.reason


def test_what_slows_a_car_of_a_train_is_not_its_brake_alone():
    case = _shipped("train-120")
    recording = uictest.simulate(case)
    checks, _ = _checks(case, channels_of(recording), recording.metadata)
    for name in ("deceleration", "duration"):
        assert checks[name].status == "not_applicable"
        assert checks[name].reason == "car 1 of 4: its couplers slow it as well"
    assert checks["demanded-pressure"].status == "pass"


def test_a_criterion_of_ones_own_cannot_be_called_as_a_check_is(tmp_path):
    (tmp_path / "own.yaml").write_text(
        "schema: uictest/criteria/1\nname: own\ncriteria:\n"
        "  - {id: record-duration, layer: requirement, measure: braking_time, upper: 60 s}\n"
    )
    path = tmp_path / "a.yaml"
    path.write_text("schema: uictest/scenario/1\nname: a\ninitial_speed: 80 km/h\ncriteria: own.yaml\n")
    with pytest.raises(ScenarioErrors, match=r"'record-duration'.*checks of a record"):
        uictest.load(path)


@pytest.mark.parametrize("longer", [0.0, 0.01, 0.05])
def test_a_distance_that_is_not_that_of_the_speed_is_told_and_decides_nothing(dry, longer):
    """Where the speed is that of wheels that slide, it is shorter than the way."""
    case, recording = dry
    channels = _changed(recording, "distance", lambda s: (1.0 + longer) * s)
    stop = prepare(channels, recording.metadata, Preparation())
    told = [str(each) for each in stop.defects if each.kind == "contradiction"]
    assert len(told) == (longer > 0.02)
    result = judge_stop(case, stop)
    assert "invalid by" not in result.reason
    assert math.isfinite(result.measures["braking_distance_m"])
    assert not _failed({each.id: each for each in result.criteria if each.layer == "record"})


def _shipped_cases():
    for path in library.scenarios().values():
        if path.name.endswith(".series.yaml"):
            yield from (stop.case for each in load_series(path) for stop in each.stops)
        elif not path.name.endswith((".sweep.yaml", ".programme.yaml")):
            yield from uictest.load(path)


def _noisy(recording, seed):
    """At 50 Hz, with the noise that is usual on trains: 0.02 m/s, and 15 mbar."""
    random = np.random.default_rng(seed)
    thinned = kept(channels_of(recording), slice(None, None, 2))
    noise = {"speed": 0.02, "wheel_speed": 0.02, "pressure": 0.015 * BAR}

    def of(name, samples):
        size = next((size for kind, size in noise.items() if kind in name), 0.0)
        return samples + random.normal(0.0, size, len(samples)) if size else samples

    return {name: RawChannel(name, name, each.time, of(name, each.samples)) for name, each in thinned.items()}


def _false_alarms(case):
    recording = uictest.simulate(case)
    for channels in (channels_of(recording), _noisy(recording, 1), _noisy(recording, 2)):
        checks, _ = _checks(case, channels, recording.metadata)
        yield from (f"{case.id}: {name}: {checks[name].reason}" for name in sorted(_failed(checks)))


@pytest.mark.parametrize("name", ["dry-120", "slip-120", "low-adhesion-80", "track-brake-120", "train-120"])
def test_no_check_alarms_falsely_on_a_shipped_stop(name):
    assert list(_false_alarms(_shipped(name))) == []


@pytest.mark.slow
def test_no_check_alarms_falsely_on_any_of_the_44_shipped_recordings():
    cases = list(_shipped_cases())
    assert len(cases) == 44
    assert [alarm for case in cases for alarm in _false_alarms(case)] == []


def test_a_brake_that_held_before_and_is_vented_by_the_wsp_has_not_fallen():
    """A holding brake of 1 bar, then full braking on a rail on which the WSP keeps the modules below it."""
    case = _shipped("low-adhesion-80")
    channels = channels_of(uictest.simulate(case))
    for name, each in channels.items():
        if name.startswith(("brake_line_pressure", "cylinder_pressure", "tank_pressure")):
            held = np.where(each.time < 0.6, np.maximum(each.samples, 1.0 * BAR), each.samples)
            channels[name] = replace(each, samples=held)
    assert np.median(channels["tank_pressure_3"].samples) < 1.0 * BAR
    checks, _ = _checks(case, channels, AT_ZERO)
    assert checks["pressure-fall"].status == "pass"

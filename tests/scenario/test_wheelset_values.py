"""What single wheelsets have of their own: what is accepted, and what holds where."""

from operator import attrgetter

import pytest

from uictest.plans.scenario import ScenarioErrors, wheelset_value
from uictest.plans.scenario.parts.vehicle import REGULAR

FOUR_CALIPERS = "rig.topology=four-caliper"


@pytest.fixture
def head(head):
    return f"{head}vehicle: {{extends: intercity-180, wheelsets: {{2: {{wheel_radius: 0.42 m}}}}}}\n"


def test_a_wheelset_has_its_own_value_where_it_says_one(case):
    scenario = case("vehicle.wheelsets.4.caliper.load_friction=7 %", FOUR_CALIPERS).scenario
    radii = [wheelset_value(scenario, number, "wheel_radius") for number in (1, 2, 3, 4)]
    regular = scenario.vehicle.wheelset.radius
    assert radii == [regular, 0.42, regular, regular]
    assert scenario.vehicle.wheel_radii == tuple(radii)
    assert wheelset_value(scenario, 2, "configured_radius") == regular
    shares = [wheelset_value(scenario, number, "caliper.load_friction") for number in (3, 4)]
    assert shares == [scenario.rig.caliper.load_friction, 0.07]
    assert wheelset_value(scenario, 1, "brake_force") == 1.0


@pytest.mark.parametrize("name", ["load_friction=9 %", "coulomb_friction=60 N"])
def test_a_wheelset_whose_module_is_a_tank_has_no_caliper_of_its_own(case, name):
    """Nothing would read the value."""
    with pytest.raises(ScenarioErrors, match=r"vehicle\.wheelsets\.2\.caliper.*wheelset 2 has no caliper"):
        case(f"vehicle.wheelsets.2.caliper.{name}")
    assert case(f"vehicle.wheelsets.1.caliper.{name}")


@pytest.mark.parametrize("name", REGULAR)
def test_every_own_value_replaces_one_of_the_same_kind(case, name):
    """What the scenario says for all is accepted for one, and read from there."""
    scenario = case().scenario
    regular = wheelset_value(scenario, 3, name)
    own = f"vehicle.wheelsets.3.{name}={getattr(regular, 'text', regular)}"
    other = case(own, FOUR_CALIPERS).scenario
    assert wheelset_value(other, 3, name) == regular
    assert attrgetter(name)(other.vehicle.wheelsets["3"]) == regular
    assert attrgetter(name)(other.vehicle.wheelsets["1"]) is None


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("vehicle.wheelsets.5.wheel_radius=0.42 m", "no wheelset '5'.*accepted: 1, 2, 3, 4"),
        ("vehicle.wheelsets.0.brake_force=90 %", "no wheelset '0'"),
        ("vehicle.wheelsets.2.wheel_radus=0.42 m", "did you mean 'wheel_radius'"),
        ("vehicle.wheelsets.2.caliper.preload=1 kN", "unknown key 'preload'"),
        ("vehicle.wheelsets.2.wheel_radius=0.42", "has no unit"),
        ("vehicle.wheelsets.2.wheel_radius=42 bar", "wheel_radius"),
        ("vehicle.wheelsets.2.brake_force=0.9", "write `90 %`"),
        ("vehicle.wheelsets.3.wheel_radius=1.5 m", "out of range"),
        ("vehicle.wheelsets.3.wsp_valve.switching_delay=900 ms", "wsp_valve.switching_delay: .*too long"),
        ("vehicle.wheelsets.2.wheel_radius={value: 0.42 m, source: scales}", "unknown source 'scales'"),
    ],
)
def test_what_is_wrong_is_named_with_what_is_accepted(case, override, message):
    with pytest.raises(ScenarioErrors, match=f"(?s){message}"):
        case(override)


def test_wheels_fit_between_the_axles_and_have_their_inertia(case):
    short = "vehicle.bogie.half_wheelbase=0.5 m"
    assert case(short).scenario.vehicle.bogie.half_wheelbase == 0.5
    with pytest.raises(ScenarioErrors, match=r"wheelsets\.4\.wheel_radius: the wheels of a bogie overlap"):
        case(short, "vehicle.wheelsets.4.wheel_radius=0.55 m")
    with pytest.raises(ScenarioErrors, match=r"wheelsets\.1\.wheel_radius: no wheelset of this mass"):
        case("vehicle.wheelsets.1.wheel_radius=0.2 m")


def test_a_brake_may_be_too_strong_by_its_lever_its_pads_or_on_single_wheelsets(case):
    strong = [f"vehicle.wheelsets.{number}.brake_force=300 %" for number in (1, 2, 3, 4)]
    assert case(strong[0])
    with pytest.raises(ScenarioErrors, match="the brake would slow this car"):
        case("rig.caliper.lever_ratio=20", "rig.topology=four-caliper")
    with pytest.raises(ScenarioErrors, match="the brake would slow this car"):
        case(*strong, *(f"vehicle.wheelsets.{number}.pad_friction=1" for number in (1, 2, 3, 4)))
    points = "{points: [{speed: 0 km/h, factor: 5}, {speed: 100 km/h, factor: 1}]}"
    force = "{numerator: 1000 kN, denominator: 10 kN, reference: 14 kN}"
    with pytest.raises(ScenarioErrors, match="the brake would slow this car"):
        case(f"brake.pad={{speed: {points}, force: {force}}}")
    assert case("brake.pad=composite-block").scenario.brake.pad.largest_factor < 3.0


@pytest.mark.parametrize(
    ("sensors", "key", "value", "message"),
    [
        ("pole-wheel", "vehicle.wheelsets.3.sensors.speed.method", "momentary", "wheelset 3 has 1 missing"),
        ("pole-wheel", "vehicle.wheelsets.2.sensors.speed.teeth", "1", "1 of 1 teeth"),
        ("pole-wheel", "rig.sensors.speed.minimum_speed", "0 km/h", "0 km/h is out of range"),
        ("standard", "rig.sensors.speed.missing_teeth", "2", "a momentary speed counts no teeth"),
        ("standard", "vehicle.wheelsets.2.sensors.speed.missing_teeth", "1", "counts no teeth"),
    ],
)
def test_pole_wheels_that_cannot_be_are_rejected(case, sensors, key, value, message):
    with pytest.raises(ScenarioErrors, match=f"{key}: .*{message}"):
        case(f"rig.sensors={sensors}", f"{key}={value}")

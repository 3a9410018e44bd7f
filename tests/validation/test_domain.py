"""Where a validation holds: the conditions of its stops, and what lies outside of them."""

import pytest

from uictest.analysis.validation import conditions_of, deviations, domains_of
from uictest.judging.evaluation import Deviation
from uictest.plans.scenario import load
from uictest.running.campaign import parts_of_cases

STOP = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 100 km/h\n"


@pytest.fixture
def under(tmp_path):
    """Return the conditions of a stop, changed by `key=value` texts and by a text appended to its file."""
    path = tmp_path / "stop.yaml"

    def conditions(*changes, text=""):
        path.write_text(STOP + text, "utf-8")
        [case] = load([path], changes)
        return conditions_of(parts_of_cases([case])[case.id])

    return conditions


def test_a_validated_stop_lies_inside_of_its_domain(under):
    domains = domains_of([[under()], [under("initial_speed=120 km/h", "rail.friction=0.2")]])
    assert [domain.stops for domain in domains] == [2]
    assert deviations(domains, under()) == ()
    assert deviations(domains, under("initial_speed=110 km/h", "rail.friction=0.25")) == ()


@pytest.mark.parametrize(
    ("change", "key", "found"),
    [
        ("initial_speed=160 km/h", "initial_speed", 160 / 3.6),
        ("initial_speed=80 km/h", "initial_speed", 80 / 3.6),
        ("brake.command=70 %", "brake.command", 0.7),
        ("rail.friction=0.05", "rail.friction", 0.05),
        ("rail.gradient=-5 permille", "rail.gradient", -0.005),
        ("vehicle.body.mass=40 t", "vehicle.body.mass", 40e3),
        ("controller.slip_threshold=0.6 m/s", "controller.slip_threshold", 0.6),
    ],
)
def test_a_number_beyond_those_of_the_stops_is_outside(under, change, key, found):
    domains = domains_of([[under()], [under("initial_speed=120 km/h")]])
    [deviation] = deviations(domains, under(change))
    assert deviation.key == key
    assert deviation.found == pytest.approx((found, found))


@pytest.mark.parametrize(
    ("change", "deviation"),
    [
        ("vehicle=crh380a", Deviation("vehicle", "crh380a", "intercity-180")),
        ("controller=slip-band", Deviation("controller", "slip-band", "threshold")),
        ("rail.condition=wet", Deviation("rail.condition", "wet", "dry")),
        ("brake.position=P", Deviation("brake.position", "P", "R")),
        ("rig.wsp=bypassed", Deviation("rig.wsp", "bypassed", "active")),
    ],
)
def test_another_part_or_setting_is_outside_and_named_once(under, change, deviation):
    condition = "rail.friction=0.3"
    assert deviations(domains_of([[under(condition)]]), under(condition, change)) == (deviation,)


def test_seed_criteria_texts_and_the_last_bit_of_a_conversion_say_nothing_of_the_conditions(under):
    changed = under("seed=7", "criteria=uic-541-05-appendix-b", text="title: Another\ntags: [dry]\n")
    assert deviations(domains_of([[under()]]), changed) == ()
    with_another_last_bit = domains_of([[under("initial_speed=33.3333333333 m/s")]])
    assert deviations(with_another_last_bit, under("initial_speed=120 km/h")) == ()


def test_stops_with_different_settings_are_different_domains(under):
    """Dry from 160 km/h and wet from 80 km/h do not validate wet from 160 km/h."""
    friction = "rail.friction=0.1"
    dry = under("initial_speed=160 km/h", friction)
    wet = under("initial_speed=80 km/h", friction, "rail.condition=wet")
    domains = domains_of([[dry], [wet]])
    assert [domain.stops for domain in domains] == [1, 1]
    both = under("initial_speed=160 km/h", friction, "rail.condition=wet")
    [deviation] = deviations(domains, both)
    assert deviation.key in ("initial_speed", "rail.condition")


def test_friction_along_the_track_and_over_time_counts_by_its_ends(under):
    course = """
rail:
  friction: {interpolation: steps, points: [{position: 0 m, friction: 0.2}, {position: 99 m, friction: 0.1}]}
  friction_over_time: {points: [{time: 0 s, factor: 1}, {time: 5 s, factor: 0.5}]}
"""
    conditions = under(text=course)
    assert conditions.ranges["rail.friction"].lowest == pytest.approx(0.05)
    assert conditions.ranges["rail.friction"].highest == pytest.approx(0.2)
    domains = domains_of([[conditions]])
    assert deviations(domains, under("rail.friction=0.12")) == ()
    assert [each.key for each in deviations(domains, under("rail.friction=0.04"))] == ["rail.friction"]


def test_what_only_one_side_has_is_outside(under):
    fault = "faults: [{at: 3 s, wheelset: 2, part: speed-sensor, kind: stuck}]\n"
    with_fault, without = under(text=fault), under()
    for validated, stop in ((without, with_fault), (with_fault, without)):
        found = deviations(domains_of([[validated]]), stop)
        assert any(each.key.startswith("faults") for each in found)

"""The stops that assumptions lead to: dry ones follow from mechanics, without sliding."""

from dataclasses import replace

import pytest

from studies.field.assumptions import DRY, Assumptions
from studies.field.field_rig import field_stop
from uictest import rig

SPEED = 80.0 / 3.6
DRY_STOP = Assumptions("constant", DRY, 0.0, "ep-disc", 0.8)
SLIDING = Assumptions("dry first", 0.15, 95.0, "ep-disc", 0.8)


@pytest.fixture
def run(field_rig):
    """Return time and distance of the dry stop with some assumptions changed."""

    def changed(**changes):
        figures = field_rig.stops([replace(DRY_STOP, **changes)])[0].figures
        return figures["braking_time"], figures["braking_distance"]

    return changed


def test_the_library_brake_on_a_constant_rail_is_the_slide_test_of_the_studies(field_rig, stop_runner):
    slide_test = stop_runner.cases("slide-80")[0]
    assumed = replace(DRY_STOP, friction=0.1651)
    assert field_rig.stops([assumed]) == [field_stop(rig.simulate(slide_test), {})]


def test_nothing_slides_on_dry_track_and_stops_behind_it_do(field_rig):
    dry, sliding = field_rig.stops([DRY_STOP, SLIDING])
    assert dry.actuations == (0, 0, 0, 0)
    assert min(sliding.actuations) > 5


def test_a_lead_within_the_dead_time_only_moves_the_clock(run):
    """Nothing but the running resistance acts before the pressure rises."""
    (time, distance), (early, shorter) = (run(lead=lead) for lead in (0.0, 0.08))
    assert time - early == pytest.approx(0.08, abs=0.002)
    assert distance - shorter == pytest.approx(0.08 * SPEED, abs=0.05)


def test_after_a_long_lead_only_braking_at_full_force_is_left(run):
    """Of an even deceleration, distance is half of speed times time."""
    time, distance = run(lead=3.0)
    assert distance == pytest.approx(0.5 * SPEED * time, rel=0.01)


def test_a_slower_build_up_costs_half_its_time_on_dry_track(run):
    """The force rises linearly: the stop is as long as if half of the build-up were dead time."""
    (time, distance), (later, longer) = (run(fill_time=fill) for fill in (0.8, 4.0))
    assert later - time == pytest.approx(1.6, rel=0.1)
    assert longer - distance == pytest.approx(1.6 * SPEED, rel=0.1)


def test_the_least_deceleration_is_not_that_of_the_build_up(field_rig):
    fast, slow = field_rig.stops([DRY_STOP, replace(DRY_STOP, fill_time=4.0)])
    assert slow.figures["minimum_deceleration"] > fast.figures["minimum_deceleration"]
    for stop in (fast, slow):
        assert stop.figures["minimum_deceleration"] > 0.9 * stop.figures["maximum_deceleration"]


def test_stronger_pads_brake_harder_in_proportion(field_rig):
    normal, strong = field_rig.stops([DRY_STOP, replace(DRY_STOP, pad_factor=1.2)])
    ratio = strong.figures["maximum_deceleration"] / normal.figures["maximum_deceleration"]
    assert ratio == pytest.approx(1.2, rel=0.03)


def test_cleaning_shortens_the_stop_and_spares_the_valves(field_rig):
    cleaned = replace(SLIDING, friction=0.10, cleaning_energy=5300.0, carry_over=0.5)
    without, with_cleaning = field_rig.stops([replace(cleaned, cleaning_energy=None), cleaned])
    assert with_cleaning.figures["braking_distance"] < without.figures["braking_distance"] - 5.0
    assert sum(with_cleaning.actuations) < sum(without.actuations)


def test_the_distributor_has_the_longer_dead_time(run):
    ep_disc, distributor = (run(brake=brake) for brake in ("ep-disc", "distributor"))
    assert distributor[0] - ep_disc[0] == pytest.approx(0.3, abs=0.02)


def test_stops_in_lanes_have_the_bits_of_stops_alone(field_rig, stop_runner):
    """Rails with one point and with several, side by side."""
    step = "{interpolation: steps, points: [{position: 0 m, friction: 0.3}, {position: 90 m, friction: 0.1}]}"
    cases = [
        case
        for rails in ([0.14, 0.17], step)
        for case in stop_runner.cases("slide-80", {"rail.friction": rails})
    ]
    assert field_rig.in_lanes([]) == []
    for case, stop in zip(cases, field_rig.in_lanes(cases), strict=True):
        alone = rig.simulate(case)
        assert stop.measures.tobytes() == alone.measures.tobytes()
        assert stop.wheelset_measures.tobytes() == alone.wheelset_measures.tobytes()

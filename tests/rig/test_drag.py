"""Drag braking: traction holds a speed while the brake acts, then the stop goes on."""

import numpy as np
import pytest

DRAG = "drag={speed: 60 km/h, duration: 10 s}"
GENTLE = ("brake.command=20 %", "initial_speed=65 km/h")
HELD = 60.0 / 3.6


def test_a_speed_is_held_for_the_duration_also_from_the_first_command_on_and_the_train_then_stops(rig):
    stop = rig.columns(DRAG, *GENTLE)
    held = np.flatnonzero(np.abs(stop["speed"] - HELD) < 1e-9)
    assert np.all(np.diff(held) == 1)
    assert stop["time"][held[-1]] - stop["time"][held[0]] == pytest.approx(10.0, abs=0.021)
    assert stop["speed"][: held[0]].min() > HELD - 0.005  # it begins with the next controller cycle
    measures = rig.stop(DRAG, *GENTLE).measures
    alone = rig.stop(*GENTLE).measures
    assert measures.stopped == 1.0
    assert measures.end_time - alone.end_time == pytest.approx(10.0, rel=0.01)
    assert measures.end_distance - alone.end_distance == pytest.approx(10.0 * HELD, rel=0.01)
    stop = rig.columns("drag={speed: 80 km/h, duration: 5 s}", "brake.command=20 %")
    held = stop["time"] < 4.99
    assert np.abs(stop["speed"][held] - 80.0 / 3.6).max() < 1e-9


def test_traction_works_against_the_brakes_and_the_energy_closes(rig):
    """At a held speed the brakes turn P = F v into heat; the discs of a drag warm by it."""
    inputs = ("rail.gradient=-5 permille", "brake.disc_temperature=modelled")
    measures = rig.stop(DRAG, *GENTLE, *inputs).measures
    assert abs(measures.energy_residual) < 1e-9
    warm, cool = (
        rig.stop(*drag, *GENTLE, *inputs).wheelset_measures.maximum_disc_temperature.max()
        for drag in ((DRAG,), ())
    )
    assert warm > cool + 1.0


def test_traction_never_brakes(rig):
    """Down a steep gradient under a weak brake the train gains speed, whatever is to be held."""
    stop = rig.columns(
        *("drag={speed: 80 km/h, duration: 5 s}", "brake.command=1 %", "rail.gradient=-30 permille"),
        cycles=800,
    )
    assert stop["speed"].max() > 80.0 / 3.6 + 0.5


def test_a_held_train_on_a_slippery_rail_slides_and_is_held_all_the_same(rig):
    wet = ("rail.condition=wet", "rail.friction=0.05", "initial_speed=65 km/h")
    stop = rig.columns(DRAG, *wet)
    held = np.abs(stop["speed"] - HELD) < 1e-9
    assert stop["slide"][held].max() > 0.1
    assert abs(rig.stop(DRAG, *wet).measures.energy_residual) < 1e-9


def test_criteria_of_a_standstill_do_not_apply(rig):
    _, verdicts = rig.judged(DRAG, *GENTLE, "criteria=uictest-stop")
    assert verdicts["standstill"].reason == "drag braking: traction holds 60 km/h for 10 s"
    assert verdicts["standstill"].status == "not_applicable"


def test_what_traction_holds_proves_no_slippery_rail(rig):
    """While it holds, the train does not slow: that is no low adhesion."""
    result, verdicts = rig.judged(
        *("initial_speed=120 km/h", "drag={speed: 120 km/h, duration: 10 s}", "rail.condition=wet"),
        *("rail.friction=0.13", "criteria=uic-541-05-appendix-b"),
    )
    assert verdicts["initial-adhesion"].status == verdicts["minimum-slide"].status == "inconclusive"
    assert result.outcome == "inconclusive"
    for name in ("braking_distance_m", "mean_deceleration_mps2", "minimum_deceleration_mps2"):
        assert np.isnan(result.measures[name])


def test_a_speed_that_is_not_held_is_said(rig):
    """Down a gradient under a weak brake: nothing is shown of a drag."""
    result, verdicts = rig.judged(
        *("drag={speed: 80 km/h, duration: 5 s}", "rail.gradient=-30 permille", "criteria=uictest-stop"),
        "brake.command=[{at: 0 s, value: 1 %}, {at: 12 s, value: 100 %}]",
    )
    assert result.outcome == "inconclusive"
    assert any("traction held 80 km/h for" in each.reason for each in verdicts.values())

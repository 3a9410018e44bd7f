"""Measures of whole stops that say what a WSP made of the rail, against balances and closed forms."""

import math

import numpy as np
import pytest

WET = ("rail.condition=wet", "rail.friction=0.09")
LOCKING = ("rail.condition=wet", "rail.friction=0.05", "rig.wsp=bypassed")
EVEN = ("rail.condition.friction_ratio=1",)
"""A friction that does not fall with the slip."""
KMH = 1 / 3.6


@pytest.mark.parametrize("overrides", [(), WET, LOCKING, ("brake.position=G",)])
def test_both_bogies_and_the_running_resistance_give_the_mean_deceleration(rig, overrides):
    stop = rig.stop(*overrides)
    measures, (p, _) = stop.measures, rig.parameters(*overrides)
    mean = measures.initial_speed**2 / (2.0 * measures.braking_distance)
    resistance = stop.car.resistance_loss / (p.total_mass * measures.braking_distance)
    given = measures.deceleration_bogie_1 + measures.deceleration_bogie_2
    assert given + resistance == pytest.approx(mean, rel=2e-3)


@pytest.mark.parametrize("overrides", [WET, LOCKING])
def test_work_of_the_rail_is_that_of_the_recorded_creep_forces(rig, overrides):
    trace, stop = rig.columns(*overrides, every=1), rig.stop(*overrides, every=1)
    force = 2.0 * trace["wheel_load"] * trace["adhesion"]
    work = (force * np.diff(trace["distance"], prepend=0.0)[:, None]).sum(axis=0)
    np.testing.assert_allclose(stop.wheelset_measures.rail_work, work, rtol=2e-3)


def test_locked_wheelsets_use_what_the_creep_law_leaves_them(rig):
    """On a rail whose friction does not fall: F / (Q mu0) = (2/pi)(kA e/(1 + (kA e)^2) + arctan(kS e))."""
    overrides = (*LOCKING, *EVEN)
    stop = rig.stop(*overrides)
    p, _ = rig.parameters(*overrides)
    assert min(stop.wheelset_measures.locked_time) > 20.0
    e = p.creep_stiffness * (p.static_wheel_load * p.load_scale) ** (2 / 3) / (p.static_wheel_load * 0.05)
    ka, ks = p.reduction_adhesion, p.reduction_slip
    expected = 2 / math.pi * (ka * e / (1 + (ka * e) ** 2) + math.atan(ks * e))
    assert stop.measures.adhesion_utilisation == pytest.approx(expected, abs=5e-3)


def test_locking_on_a_rail_whose_friction_falls_wastes_most_of_it_and_a_dry_stop_uses_none(rig):
    """At these slip speeds the friction is near A = 0.4 of what it is at the beginning."""
    assert 0.4 < rig.stop(*LOCKING).measures.adhesion_utilisation < 0.65
    measures = rig.stop().measures
    assert np.isnan(measures.adhesion_utilisation)
    assert measures.available_work == 0.0


def test_line_builds_up_in_dead_time_and_half_of_the_fill_time_whether_wheelsets_slide_or_not(rig):
    dry, wet = (rig.stop(*overrides).measures for overrides in ((), WET))
    assert wet.build_up_time == pytest.approx(dry.build_up_time, abs=0.005)
    assert rig.stop("brake.position=G").measures.build_up_time > 5.0 * dry.build_up_time
    # The relay valve follows the demand within its proportional band.
    p, _ = rig.parameters("brake.position=G")
    expected = p.dead_time + 0.5 / p.filling_rate
    assert rig.stop("brake.position=G").measures.build_up_time == pytest.approx(expected, rel=0.05)


def test_figures_are_those_of_the_recorded_channels(rig):
    trace, stop = rig.columns(*WET), rig.stop(*WET, every=20)
    speed, time = trace["speed"][:, None], trace["time"]
    slip = speed - trace["wheel_speed"]
    slides = (speed > 10 * KMH) & (slip > 0.05 * speed) & (slip > 0.3)
    run = np.diff(trace["distance"], prepend=0.0)[:, None]
    power = 2.0 * trace["wheel_load"] * trace["adhesion"] * slip
    own = stop.wheelset_measures
    np.testing.assert_allclose(own.slid_distance, (run * slides).sum(axis=0), rtol=2e-3)
    np.testing.assert_allclose(own.sliding_duration, slides.sum(axis=0) * (time[1] - time[0]), atol=0.011)
    np.testing.assert_allclose(own.contact_energy, (power * slides * 0.01).sum(axis=0), rtol=2e-2)
    margin = (trace["reservoir_pressure"] - trace["cylinder_pressure"].max(axis=1)).min()
    assert stop.measures.reservoir_margin == pytest.approx(margin, abs=100.0)

"""Stops on a rail whose friction varies at random."""

import numpy as np
import pytest

from uictest.rig.backends.lanes import run_in_lanes

SLIPPERY = ("initial_speed=120 km/h", "rail.condition=wet", "rail.friction=0.08")
COARSE = "simulation.time_step=1 ms"


def variation(spread=20.0, length=10.0, left_right=0.5):
    return (
        f"rail.variation={{spread: {spread} %, correlation_length: {length} m,"
        f" left_right_correlation: {left_right}}}"
    )


def bits(stop):
    return bytes(stop.measures.tobytes() + stop.wheelset_measures.tobytes())


def test_no_spread_gives_the_bits_of_a_rail_that_does_not_vary(rig):
    without = bits(rig.stop(*SLIPPERY))
    assert bits(rig.stop(*SLIPPERY, variation(spread=0.0))) == without
    assert bits(rig.stop(*SLIPPERY, variation(), variation_log_spread=0.0)) == without
    assert bits(rig.stop(*SLIPPERY, variation())) != without


def test_energy_closes(rig):
    assert abs(rig.stop(*SLIPPERY, variation(spread=40.0)).measures.energy_residual) < 1e-9


def met_along_the_track(rig, *overrides):
    """Places of the first and the last wheelset where a cycle begins, and the friction held during it."""
    changed = (*SLIPPERY, variation(spread=30.0), *overrides)
    columns, behind = rig.columns(*changed, every=20), rig.stop(*changed, every=20).wheelsets.behind
    return [(columns["distance"][:-1] - behind[i], columns["friction"][1:, i]) for i in (0, 3)]


@pytest.mark.parametrize(
    "other",
    [
        ("controller=slip-band",),
        ("rig.wsp=bypassed",),
        ("brake.command=60 %",),
        ("initial_speed=60 km/h",),
        ("vehicle.wheelset.mass=1500 kg",),
        ("rig.sensors=pole-wheel",),
    ],
)
def test_whatever_stops_meets_the_same_rail(rig, other):
    """Friction is linear within the whole metres between which it is drawn; there the two must agree."""
    (places, frictions), *_ = met_along_the_track(rig)
    for own_places, own in met_along_the_track(rig, *other):
        after = np.searchsorted(places[1:-1], own_places) + 1
        metres = np.floor([places[after - 1], own_places, places[after]])
        expected = np.interp(own_places, places, frictions, np.nan, np.nan)
        within = (metres == metres[0]).all(axis=0) & np.isfinite(expected)
        assert within.sum() > 400
        np.testing.assert_allclose(own[within], expected[within], rtol=1e-9)


def test_the_seed_draws_the_rail(rig):
    (_, rail), (_, another) = (met_along_the_track(rig, f"seed={seed}")[0] for seed in (0, 1))
    assert abs(rail[0] - another[0]) > 0.01 * 0.08


def test_seeds_stop_at_other_distances_around_that_of_the_mean(rig):
    mean = rig.stop(*SLIPPERY).measures.end_distance
    noise, both = (in_lanes(rig, np.arange(12), *SLIPPERY, *rail) for rail in ((), (variation(length=50.0),)))
    assert both.std() > 3.0 * noise.std()
    assert abs(both.mean() / mean - 1.0) < 0.1


def in_lanes(rig, seeds, *overrides):
    inputs = rig.inputs(*overrides)
    parameters = np.repeat(inputs.parameters, len(seeds))
    parameters["seed"] = seeds
    same = (np.repeat(each[None], len(seeds), axis=0) for each in (inputs.wheelset_parameters, inputs.rail))
    return run_in_lanes(parameters, *same).measures["end_distance"]


@pytest.mark.parametrize("length", [5.0, 25.0])
def test_where_friction_alone_decides_distances_vary_as_its_mean_along_them(rig, length):
    """Locked wheels, friction that does not fall: the formula times the sensitivity of the distance."""
    locked = ("rig.wsp=bypassed", "rail.condition={extends: wet, friction_ratio: 1}", COARSE)
    still, better = (rig.stop(*locked, f"rail.friction={mu}").measures.end_distance for mu in (0.06, 0.0606))
    sensitivity = np.log(still / better) / np.log(0.0606 / 0.06)
    share = length / still
    of_mean = 0.2 * np.sqrt(2.0 * share * (1.0 - share * (1.0 - np.exp(-1.0 / share))))
    varied = variation(length=length, left_right=1.0)
    distances = in_lanes(rig, np.arange(192), *locked, "rail.friction=0.06", varied)
    deviation = 1.0 / np.sqrt(2.0 * 191.0)
    assert distances.std(ddof=1) / distances.mean() == pytest.approx(
        sensitivity * of_mean, rel=3.0 * deviation
    )


def test_friction_over_time_and_cleaning_act_on_the_friction_of_the_place(rig):
    fading = "rail.friction_over_time={points: [{time: 0 s, factor: 0.5}]}"
    (_, whole), _ = met_along_the_track(rig)
    (_, half), _ = met_along_the_track(rig, fading)
    assert half[0] == pytest.approx(0.5 * whole[0])
    (_, cleaned), _ = met_along_the_track(rig, "rail.condition=wet-cleaning")
    assert cleaned[0] == whole[0]


def test_a_scenario_replaces_the_variation_of_its_rail(rig):
    slippery = ("initial_speed=120 km/h", "rail.condition=wet-varied", "rail.friction=0.08")
    assert bits(rig.stop(*slippery)) == bits(rig.stop(*SLIPPERY, variation()))
    assert bits(rig.stop(*slippery, variation(spread=0.0))) == bits(rig.stop(*SLIPPERY))

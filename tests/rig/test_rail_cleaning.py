"""Stops on a rail that sliding cleans: limits, directions and an oracle beside the rig."""

import numpy as np
import pytest
from numpy.typing import NDArray

Array = NDArray[np.float64]
SLIPPERY = ("initial_speed=120 km/h", "rail.condition=wet", "rail.friction=0.08")
LOCKED = (*SLIPPERY, "rig.wsp=bypassed")
"""No valve acts: the wheelsets slide or stand, and nothing amplifies a difference."""


def cleaning(energy=5300.0, reach=0.5, carry_over=0.5):
    return (
        f"rail.cleaning={{energy: {energy} J/m, recovered_friction: 0.28, reach: {reach} m,"
        f" carry_over: {carry_over}}}"
    )


def bits(stop):
    return bytes(stop.measures.tobytes() + stop.wheelset_measures.tobytes())


@pytest.mark.parametrize("rail", [SLIPPERY, LOCKED, ("rail.condition=wet", "rail.friction=0.1627")])
def test_a_rail_that_no_energy_cleans_gives_the_bits_of_one_that_is_not_cleaned(rig, rail):
    without = rig.stop(*rail)
    assert bits(rig.stop(*rail, cleaning(), cleaning_response=0.0)) == bits(without)
    assert bits(rig.stop(*rail, cleaning(), recovered_friction=0.01)) == bits(without)


def test_a_dry_rail_keeps_its_bits(rig):
    """Its friction lies above that of the cleaned one."""
    assert bits(rig.stop(cleaning())) == bits(rig.stop())


def test_the_condition_of_the_library_cleans_as_its_numbers_written_out(rig):
    shipped = rig.stop("initial_speed=120 km/h", "rail.condition=wet-cleaning", "rail.friction=0.08")
    assert bits(shipped) == bits(rig.stop(*SLIPPERY, cleaning()))


def test_energy_closes_as_on_a_rail_that_is_not_cleaned(rig):
    """Cleaning moves no energy: what the contacts lose is heat as before."""
    for stop in (LOCKED, SLIPPERY):
        for extra in ((), (cleaning(),)):
            assert abs(rig.stop(*stop, *extra).measures.energy_residual) < 1e-9


@pytest.mark.parametrize("finer", ["simulation.time_step=0.25 ms", "controller.cycle_time=5 ms"])
def test_halving_step_or_cycle_hardly_moves_a_stop_without_cycling(rig, finer):
    coarse, fine = rig.stop(*LOCKED, cleaning()), rig.stop(*LOCKED, cleaning(), finer)
    for measure in ("end_distance", "end_time"):
        assert fine.measures[measure] == pytest.approx(coarse.measures[measure], rel=1e-3)


def test_distance_falls_as_less_energy_cleans(rig):
    energies = (1e9, 4e4, 2e4, 1e4, 5300.0, 3000.0)
    distances = [rig.stop(*LOCKED, cleaning(energy)).measures.end_distance for energy in energies]
    assert np.all(np.diff(distances) < -5.0)
    assert rig.stop(*LOCKED).measures.end_distance == pytest.approx(distances[0], rel=1e-3)


def test_trailing_wheelsets_profit_from_those_ahead(rig):
    """Published in direction (Allotta et al. 2014; Voltr and Lata 2015): each meets a better rail."""
    alone, after = (rig.columns(*LOCKED, cleaning(carry_over=share)) for share in (0.0, 0.5))
    met = after["friction"].mean(axis=0)
    assert met[0] < min(met[1:])
    assert met[1] < met[3]
    sliding = after["distance"] < 400.0
    advantage = after["cleaned_share"][sliding].mean(axis=0)
    without = alone["cleaned_share"][alone["distance"] < 400.0].mean(axis=0)
    assert np.all(advantage[1:] - advantage[0] > without[1:] - without[0] + 0.02)


def test_cleaning_shortens_a_stop_with_wsp_and_saves_air(rig):
    """Published in direction: shorter stops with cleaning. Fewer vents and less air follow, in the median."""
    seeds = [f"seed={seed}" for seed in range(5)]
    without = [rig.stop(*SLIPPERY, seed) for seed in seeds]
    cleaned = [rig.stop(*SLIPPERY, cleaning(), seed) for seed in seeds]
    for name in ("end_distance", "air_consumed"):
        assert max(stop.measures[name] for stop in cleaned) < min(stop.measures[name] for stop in without)
    vents = [
        [stop.wheelset_measures.valve_actuations.sum() for stop in stops] for stops in (cleaned, without)
    ]
    assert max(vents[0]) < min(vents[1])


def test_the_friction_met_is_that_of_the_cleaned_share(rig):
    columns = rig.columns(*SLIPPERY, cleaning())
    np.testing.assert_allclose(columns["friction"], 0.08 + columns["cleaned_share"] * 0.2, rtol=1e-12)
    assert columns["cleaned_share"].max() > 0.2


@pytest.mark.parametrize("wsp", ["active", "bypassed"])
@pytest.mark.parametrize(("energy", "carry_over"), [(5300.0, 0.5), (12e3, 1.0)])
def test_an_independent_solution_gives_the_recorded_shares(rig, wsp, energy, carry_over):
    """The equations solved from a recording of every step: contact loss is adhesion x load x slip.

    The rig averages the loss over a controller cycle; the shares differ by less than 1 % of a clean rail
    and in the mean by less than 0.05 %.
    """
    stop = ("initial_speed=80 km/h", "rail.condition=wet", "rail.friction=0.07", f"rig.wsp={wsp}")
    arguments = (*stop, cleaning(energy, 0.5, carry_over))
    columns = rig.columns(*arguments, every=1)
    shares = solved(columns, rig.parameters(*arguments)[0], energy, 0.5, carry_over)
    # A row written at the end of a cycle shows the share that was computed at its beginning.
    ends = np.arange(20, len(columns["time"]), 20)
    difference = np.abs(columns["cleaned_share"][ends] - shares[ends - 20])
    assert columns["cleaned_share"].max() > 0.3
    assert difference.max() < 0.01
    assert difference.mean() < 5e-4


def solved(columns, p, energy, reach, carry_over):
    """Cleaned share under each wheelset at every row, from the channels of a recording and the geometry."""
    wheelbase, pivots = 2.0 * p.half_wheelbase, 2.0 * p.half_pivot_distance
    behind = np.array([0.0, wheelbase, pivots, pivots + wheelbase])
    place = columns["distance"][:, None] - behind
    force = 2.0 * columns["adhesion"] * columns["wheel_load"]
    power = force * (columns["speed"][:, None] - columns["wheel_speed"])
    advance = np.diff(columns["distance"])
    per_metre = power[1:] * np.diff(columns["time"])[:, None] / advance[:, None]
    settled = -np.expm1(-np.maximum(per_metre, 0.0) / energy)
    own = np.zeros_like(place)
    for row, length in enumerate(advance):
        own[row + 1] = settled[row] + (own[row] - settled[row]) * np.exp(-length / reach)
    left = own.copy()
    for i in (1, 2, 3):
        arrived = np.interp(place[:, i], place[:, i - 1], left[:, i - 1], left=0.0)
        left[:, i] = 1.0 - (1.0 - own[:, i]) * (1.0 - carry_over * arrived)
    return left

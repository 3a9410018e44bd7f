"""Friction that varies at random: its distribution, and that seed and place alone decide it."""

import math
from contextlib import contextmanager
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from uictest.rig.lanes import run_in_lanes
from uictest.rig.model import rail as random_rail
from uictest.rig.model.cycle import sensor_noise
from uictest.rig.model.rail import FAR_BEHIND, RAIL_KEY, innovation, vary_friction

from ...stop_bits import bits

POINTS = 100_000
DEVIATIONS = 4.0
"""Of an estimate from what it estimates, in its own standard deviations: one in 16 000 is farther away."""
BEHIND = (0.0, 2.5, 17.5, 20.0)


def variation(spread=20.0, length=10.0, left_right=1.0):
    return (
        f"rail.variation={{spread: {spread} %, correlation_length: {length} m,"
        f" left_right_correlation: {left_right}}}"
    )


@pytest.fixture(name="numbers", scope="module")
def _numbers(rig):
    """Return the numbers of a rail that varies, under a seed."""

    def numbers(seed=1, **values):
        record, _ = rig.parameters(variation(**values), f"seed={seed}")
        return SimpleNamespace(**{name: record[name].tolist() for name in record.dtype.names})

    return numbers


def met(p, positions, behind=BEHIND):
    """Factors that wheelsets meet, shape (positions, wheelsets)."""
    wheelsets = [SimpleNamespace(behind=each, friction=0.0) for each in behind]
    rows = []
    for cycle, position in enumerate(positions):
        for wheelset in wheelsets:
            wheelset.friction = 1.0
        vary_friction(SimpleNamespace(position=float(position), cycle=cycle), wheelsets, p)
        rows.append([wheelset.friction for wheelset in wheelsets])
    return np.array(rows)


@contextmanager
def drawn_at_once(p, count):
    """Draw for the first points of a rail by one call for all of them; the first four are compared below."""
    drawn = innovation(p, np.arange(count)).tolist()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(random_rail, "innovation", lambda p, point: drawn[point])
        yield


@pytest.fixture(name="track", scope="module")
def _track(numbers):
    """Deviations at the points of a long track, their number and the parameters."""
    p = numbers(spread=30.0)
    places = np.arange(POINTS) / p.variation_points_per_metre - FAR_BEHIND
    with drawn_at_once(p, POINTS + 1):
        factors = met(p, places, (0.0, 1e9, 1e9, 1e9))[:, 0]
    return p, factors, (np.log(factors) + 0.5 * p.variation_log_spread**2) / p.variation_log_spread


def test_mean_spread_and_shape_of_the_distribution_are_those_of_the_file(track):
    p, factors, _ = track
    rho = p.variation_persistence
    deviation = 0.3 * math.sqrt((1.0 + rho) / (1.0 - rho) / POINTS)
    assert factors.mean() == pytest.approx(1.0, abs=DEVIATIONS * deviation)
    p, factors, z = track
    deviation = math.sqrt(2.0 * (1.0 + rho**2) / (1.0 - rho**2) / POINTS)
    assert z.var() == pytest.approx(1.0, abs=DEVIATIONS * deviation)
    assert factors.std() == pytest.approx(0.3, rel=DEVIATIONS * deviation)
    # Skewness and kurtosis are within what as many independent points as the track is worth show.
    p, _, z = track
    worth = POINTS * (1.0 - rho) / (1.0 + rho)
    assert (z**3).mean() == pytest.approx(0.0, abs=DEVIATIONS * math.sqrt(15.0 / worth))
    assert (z**4).mean() == pytest.approx(3.0, abs=DEVIATIONS * math.sqrt(96.0 / worth))


@pytest.mark.parametrize("distance", [1.0, 5.0, 10.0, 20.0, 200.0])
def test_correlation_falls_with_the_distance(track, distance):
    p, _, z = track
    rho, lag = p.variation_persistence, round(distance * p.variation_points_per_metre)
    found = np.corrcoef(z[:-lag], z[lag:])[0, 1]
    expected = math.exp(-distance / 10.0)
    # Bartlett: of a process of first order.
    bartlett = (1.0 + rho**2) * (1.0 - rho ** (2 * lag)) / (1.0 - rho**2) - 2.0 * lag * rho ** (2 * lag)
    assert found == pytest.approx(expected, abs=DEVIATIONS * math.sqrt(bartlett / POINTS))


@pytest.mark.parametrize("left_right", [0.0, 0.5])
def test_mean_of_two_rails_varies_less_than_one(numbers, left_right):
    one, both = numbers(left_right=1.0), numbers(left_right=left_right)
    spreads = [math.sqrt(math.expm1(p.variation_log_spread**2)) for p in (one, both)]
    assert spreads == pytest.approx([0.2, 0.2 * math.sqrt(0.5 * (1.0 + left_right))])


def test_wheelsets_meet_the_same_friction_at_the_same_place(numbers):
    p = numbers()
    positions = np.arange(0.0, 60.0, 0.5)
    factors = met(p, positions)
    for wheelset, behind in enumerate(BEHIND):
        later = factors[round(2 * behind) :, wheelset]
        np.testing.assert_array_equal(later, factors[: len(later), 0])


@settings(max_examples=20)
@given(steps=st.lists(st.floats(0.0, 7.0), min_size=1, max_size=40), start=st.floats(-900.0, 900.0))
def test_the_way_to_a_place_has_no_part_in_its_friction(numbers, steps, start):
    p = numbers()
    positions = start + np.cumsum(steps)
    with drawn_at_once(p, 2300):
        np.testing.assert_array_equal(met(p, positions)[-1], met(p, positions[-1:])[0])


def test_only_the_seed_draws_another_rail(numbers):
    p = numbers(seed=1)
    places = np.arange(0.0, 400.0, 50.0)
    rail = met(p, places)
    for name in ("noise_key", "initial_speed", "controller", "commanded_pressure"):
        vars(p)[name] += 1
    np.testing.assert_array_equal(met(p, places), rail)
    other = met(numbers(seed=2), places)[:, 0]
    assert np.abs(other - rail[:, 0]).min() > 1e-4


def test_deviations_follow_the_equation_from_the_first_point_on(track):
    p, _, z = track
    rho = p.variation_persistence
    drawn = np.array([innovation(p, point) for point in range(4)])
    np.testing.assert_allclose(z[0], drawn[0], rtol=1e-9)
    np.testing.assert_allclose(z[1:4], rho * z[:3] + math.sqrt(1.0 - rho**2) * drawn[1:], rtol=1e-9)


def test_friction_is_linear_between_two_points_and_as_far_back_as_a_train_is_long(numbers):
    """Points are 1 m apart, on whole metres."""
    p = numbers()
    first, quarter, last = met(p, [10.0, 10.25, 11.0])[:, 0]
    assert abs(last - first) > 1e-3
    assert quarter == pytest.approx(0.75 * first + 0.25 * last)
    of_long_train = met(p, [0.0], (1000.0, 1500.0, 3000.0, 4000.0))[0]
    assert (of_long_train == of_long_train[0]).all()
    p.variation_log_spread = 0.0
    assert (met(p, np.arange(0.0, 50.0)) == 1.0).all()


def test_no_sensor_has_the_draws_of_the_rail(numbers):
    """Not even in a case whose key happens to be that of the rail."""
    p = numbers()
    p.noise_key = RAIL_KEY
    of_rail = [innovation(p, point) for point in range(5)]
    for channel in range(1024):
        assert [sensor_noise(p, cycle, channel) for cycle in range(5)] != of_rail


SLIPPERY = ("initial_speed=120 km/h", "rail.condition=wet", "rail.friction=0.08")
COARSE = "simulation.time_step=1 ms"


def test_no_spread_gives_the_bits_of_a_rail_that_does_not_vary(rig):
    without, varied = bits(rig.stop(*SLIPPERY)), bits(rig.stop(*SLIPPERY, variation(left_right=0.5)))
    assert bits(rig.stop(*SLIPPERY, variation(spread=0.0))) == without
    assert bits(rig.stop(*SLIPPERY, variation(), variation_log_spread=0.0)) == without
    assert varied != without
    of_library = ("initial_speed=120 km/h", "rail.condition=wet-varied", "rail.friction=0.08")
    assert bits(rig.stop(*of_library)) == varied
    assert bits(rig.stop(*of_library, variation(spread=0.0))) == without


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
    varied = variation(length=length)
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

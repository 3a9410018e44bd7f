"""Differences of pairs against SciPy, against statistics by hand, and against the truth they estimate."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy import stats

from uictest.analysis.comparison import Draw, paired_group
from uictest.analysis.comparison.paired_stops import drawn_stops
from uictest.judging.evaluation import effective_parts
from uictest.plans.scenario import load
from uictest.running.campaign import run_cases

NUMBERS = st.floats(-1e6, 1e6, allow_nan=False)


def _stops(values, first_seed=0, key="ab"):
    return {Draw("", key, first_seed + n): {"locked_time_s": value} for n, value in enumerate(values)}


def _difference(first, second):
    (difference,) = paired_group("x", _stops(first), _stops(second)).differences
    return difference


def test_the_interval_of_the_mean_is_that_of_the_paired_t_test():
    draws = np.random.default_rng(1).normal(size=(2, 12))
    difference = _difference(draws[0].tolist(), (draws[1] + 3.0).tolist())
    test = stats.ttest_rel(draws[1] + 3.0, draws[0]).confidence_interval(0.95)
    assert (difference.mean.low, difference.mean.high) == pytest.approx((test.low, test.high))
    assert difference.mean.value == pytest.approx(np.mean(draws[1] + 3.0 - draws[0]))


def test_the_median_of_ten_lies_between_the_second_and_the_ninth_difference():
    differences = [5.0, -1.0, 2.0, 8.0, 3.0, 13.0, 21.0, 34.0, 0.5, 1.5]
    difference = _difference([100.0] * 10, [100.0 + each for each in differences])
    ranked = sorted(differences)
    assert (difference.median.low, difference.median.high) == (ranked[1], ranked[8])
    assert difference.median.value == 4.0
    assert (difference.first, difference.second) == (100.0, 104.0)
    assert (difference.larger, difference.smaller, difference.unit) == (9, 1, "s")


def test_both_intervals_contain_the_true_difference_as_often_as_they_say():
    generator, trials = np.random.default_rng(7), 400
    inside = np.zeros(2)
    for _ in range(trials):
        noise = generator.normal(size=20)
        own = generator.normal(scale=0.3, size=(2, 20))
        difference = _difference((noise + own[0]).tolist(), (noise + own[1] + 1.0).tolist())
        inside += [each.low <= 1.0 <= each.high for each in (difference.mean, difference.median)]
    assert (inside / trials > 0.92).all()
    assert inside[0] / trials < 0.98


@given(st.lists(st.tuples(NUMBERS, NUMBERS), min_size=2, max_size=20))
def test_sides_exchanged_the_difference_changes_its_sign(pairs):
    first, second = ([pair[place] for pair in pairs] for place in (0, 1))
    there, back = _difference(first, second), _difference(second, first)
    assert there.mean.value == -back.mean.value
    assert there.median.value == -back.median.value
    assert (there.larger, there.smaller) == (back.smaller, back.larger)
    assert there.mean.low == pytest.approx(-back.mean.high, nan_ok=True)


def test_differences_that_are_all_alike_have_no_interval_of_their_mean():
    difference = _difference([1.0] * 8, [1.5] * 8)
    assert math.isnan(difference.mean.low)
    assert (difference.median.low, difference.median.high) == (0.5, 0.5)
    same = _difference([2.0, 3.0], [2.0, 3.0])
    assert same.is_zero
    assert not difference.is_zero


def test_stops_pair_by_seed_and_not_by_place():
    first = {Draw("", "ab", seed): {"locked_time_s": float(seed)} for seed in (1, 2, 3)}
    second = {Draw("", "ab", seed): {"locked_time_s": 10.0 + seed} for seed in (4, 3, 2)}
    group = paired_group("x", first, second)
    (difference,) = group.differences
    assert (difference.mean.value, difference.mean.smallest) == (10.0, 10.0)
    assert (group.seeds, group.pairs, group.unpaired) == ((2, 3), 2, (1, 1))


def test_a_pair_without_a_number_is_left_out_and_counted():
    difference = _difference([1.0, math.nan, 3.0, 4.0], [2.0, 3.0, 5.0, math.nan])
    assert (difference.pairs, difference.missing, difference.mean.value) == (2, 2, 1.5)
    assert paired_group("x", _stops([1.0, math.nan]), _stops([2.0, 2.0])).differences == ()


def test_stops_under_other_conditions_that_met_the_same_noise_count_as_one_draw():
    draws = [Draw(name, "ab", seed) for name in ("wet", "cleaning") for seed in (1, 2, 3)]
    sides = ({draw: {"locked_time_s": shift + draw.seed} for draw in draws} for shift in (0.0, 1.0))
    group = paired_group("x", *sides)
    assert (group.pairs, group.draws) == (6, 3)


@pytest.mark.parametrize(("random_rail", "draws"), [(False, 6), (True, 3)])
def test_stops_on_random_rails_are_one_draw_for_each_seed(random_rail, draws):
    """Seed and place alone decide the rail, so that it is the same one under other sensor noise."""
    sides = (
        {
            Draw("", key, seed, varies): {"locked_time_s": shift + seed}
            for key in ("ab", "cd")
            for seed in (1, 2, 3)
        }
        for shift, varies in ((0.0, False), (1.0, random_rail))
    )
    group = paired_group("x", *sides)
    assert (group.pairs, group.draws) == (6, draws)


@pytest.mark.parametrize(
    ("rail", "varies"),
    [
        ("rail.condition=wet", False),
        ("rail.condition=wet-varied", True),
        ("rail.variation={spread: 9 %, correlation_length: 9 m, left_right_correlation: 0}", True),
        ("rail.variation={spread: 0 %, correlation_length: 9 m, left_right_correlation: 0}", False),
    ],
)
def test_a_result_tells_whether_its_rail_varies_at_random(tmp_path, rail, varies):
    path = tmp_path / "stop.yaml"
    path.write_text("schema: uictest/scenario/1\nname: stop\ninitial_speed: 9 km/h\n", "utf-8")
    [case] = load([path], [rail])
    [(draw, _)] = drawn_stops(replace(run_cases([case]).results[0], parts=effective_parts(case.scenario)))
    assert draw.random_rail == varies


@pytest.mark.parametrize(
    ("first", "second", "reason"),
    [
        (_stops([1.0, 2.0]), _stops([1.0, 2.0], key="cd"), "other noise"),
        (_stops([1.0, 2.0]), _stops([1.0, 2.0], 10), "no seed is on both sides: seeds 0, 1; seeds 10, 11"),
        (_stops([1.0, 2.0]), _stops([1.0, 2.0], 1), "1 pair, 2 are needed"),
        (
            _stops([1.0, 2.0], key=""),
            _stops([1.0, 2.0]),
            "the noise of the first side is not known: its stops are recorded",
        ),
        (_stops([1.0, 2.0]), _stops([1.0, 2.0], key=""), "the noise of the second side is not known"),
        (_stops([1.0, 2.0], key=""), _stops([1.0, 2.0], key=""), "noise of the first side is not known"),
        ({Draw("", "ab", None): {}}, {Draw("", "ab", None): {}}, "no known seed; no known seed"),
        (_stops([]), _stops([1.0, 2.0]), "no stop of the first side has measures"),
    ],
)
def test_stops_that_did_not_meet_the_same_noise_are_refused(first, second, reason):
    with pytest.raises(ValueError, match=reason):
        paired_group("x", first, second)

"""The agreement of recorded and simulated stops, and how often the interval of its bias contains the bias."""

import hashlib
import math
import os

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy import stats

from uictest.analysis.validation import (
    ComparedStop,
    agreement_of,
    as_recorded,
    figures_of,
    read_validation,
    seed_of,
)
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import PASS, load

RECORDED = [450.0, 460.0, 470.0, 455.0]
NAN = math.nan
distances = st.lists(st.floats(100.0, 1000.0), min_size=2, max_size=8)


def test_a_known_bias_and_spread_are_found():
    """Differences of 1, 3, 5 and 3 m: mean 3, standard deviation sqrt(8 / 3)."""
    agreement = agreement_of("d", "m", RECORDED, [451.0, 463.0, 475.0, 458.0])
    assert (agreement.stops, agreement.recorded_mean) == (4, 458.75)
    found, spread = agreement.absolute, math.sqrt(8.0 / 3.0)
    assert (found.bias, found.deviation) == pytest.approx((3.0, spread))
    interval = stats.t.interval(0.95, 3, 3.0, spread / 2.0)
    limits = stats.t.interval(0.95, 3, 3.0, spread * math.sqrt(1.25))
    assert (found.bias_low, found.bias_high) == pytest.approx(interval, rel=1e-12)
    assert (found.limits_low, found.limits_high) == pytest.approx(limits, rel=1e-12)


def test_relative_differences_are_shares_of_what_was_recorded_if_that_is_positive():
    relative = agreement_of("d", "m", [100.0, 400.0], [110.0, 400.0]).relative
    assert relative.bias == pytest.approx(0.05)
    assert relative.deviation == pytest.approx(0.1 / math.sqrt(2.0))
    for recorded in ([0.0, 3.0], [-1.0, 3.0]):
        assert agreement_of("vents", "1", recorded, [1.0, 4.0]).relative is None


def test_one_stop_shows_a_difference_and_no_spread_and_unknown_ones_do_not_count():
    agreement = agreement_of("d", "m", [450.0], [459.0])
    assert (agreement.absolute.bias, agreement.stops) == (9.0, 1)
    spread = agreement.absolute
    shown = (spread.deviation, spread.bias_low, spread.bias_high, spread.limits_low, spread.limits_high)
    assert all(map(math.isnan, shown))
    agreement = agreement_of("d", "m", [450.0, NAN, 470.0, 100.0], [451.0, 460.0, 473.0, NAN])
    assert (agreement.stops, agreement.absolute.bias) == (2, 2.0)
    assert agreement_of("d", "m", [NAN, 1.0], [1.0, NAN]) is None


@given(distances, st.floats(-50.0, 50.0))
def test_a_constant_error_is_all_bias(recorded, error):
    agreement = agreement_of("d", "m", recorded, [each + error for each in recorded])
    assert agreement.absolute.bias == pytest.approx(error, abs=1e-9)
    assert agreement.absolute.deviation == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("stops", [2, 5])
def test_equal_differences_have_a_bias_and_no_intervals(stops):
    """Student's t would put the mean of all such stops into an interval without width."""
    recorded = [400.0 + 8.0 * place for place in range(stops)]
    agreement = agreement_of("d", "m", recorded, [each + 4.0 for each in recorded])
    found = agreement.absolute
    assert (found.bias, found.deviation) == (4.0, 0.0)
    shown = (found.bias_low, found.bias_high, found.limits_low, found.limits_high)
    assert all(map(math.isnan, shown))
    assert agreement.relative.bias_low < agreement.relative.bias < agreement.relative.bias_high


@given(distances)
def test_the_order_of_stops_makes_no_difference_and_the_sign_is_simulated_minus_recorded(recorded):
    simulated = list(np.linspace(100.0, 900.0, len(recorded)))
    one = agreement_of("d", "m", recorded, simulated)
    other = agreement_of("d", "m", simulated[::-1], recorded[::-1])
    assert one.absolute.bias == pytest.approx(-other.absolute.bias, abs=1e-9)
    assert one.absolute.limits_low == pytest.approx(-other.absolute.limits_high, abs=1e-6)


@pytest.mark.parametrize(
    ("tuned", "not_counted", "counted"),
    [(False, "", True), (True, "", False), (False, "a copy of a.csv", False), (True, "a gap", False)],
)
def test_a_stop_counts_that_can_be_compared_and_that_nothing_was_tuned_with(tuned, not_counted, counted):
    stop = ComparedStop("a", "a.csv", "00", 33.0, tuned=tuned, not_counted=not_counted)
    assert stop.counted == counted


def test_figures_of_wheelsets_are_numbered_from_1_which_leads():
    measures, slides = {"braking_distance_m": 470.0}, {n: 0.1 * n for n in (1, 2, 3, 4)}
    wheelsets = tuple({"maximum_slide": share} for share in slides.values())
    result = CaseResult("a", "a.yaml", {}, PASS, "pass", measures=measures, wheelsets=wheelsets)
    assert figures_of(result) == measures | {f"maximum_slide_{n}": share for n, share in slides.items()}
    assert figures_of(CaseResult("a", "a.yaml", {}, PASS, "error")) == {}


def test_a_pipe_is_not_waited_for_and_deep_nesting_rejected(tmp_path):
    pipe = tmp_path / "pipe.json"
    os.mkfifo(pipe)
    with pytest.raises(ValueError, match="no regular file"):
        read_validation(pipe)
    path = tmp_path / "validation.json"
    path.write_text("[" * 1_000_000)
    with pytest.raises(ValueError, match="nested too deeply"):
        read_validation(path)


# Recorded and simulated stops of one and the same rig: a stand-in draws the stop that a seed gives, normal
# about 450 m. The true bias is zero: an interval with 95 % must contain it in 95 of 100 campaigns.
CAMPAIGNS = 1000
WITHIN = 0.02
"""Tolerance of a share of 1000 campaigns, some three of its standard deviations."""
DIGESTS = [hashlib.sha256(f"record {k}".encode()).hexdigest() for k in range(30)]


def distance(seed):
    return 450.0 + float(np.random.Generator(np.random.Philox(seed)).standard_normal())


def coverage(stops, seed_of_stop):
    """Return the share of campaigns whose interval of the bias contains zero."""
    covered = 0
    for campaign in range(CAMPAIGNS):
        digests = [hashlib.sha256(f"{campaign} {stop}".encode()).hexdigest() for stop in range(stops)]
        recorded = np.random.Generator(np.random.PCG64([1, campaign])).normal(450.0, 1.0, stops)
        simulated = [distance(seed_of_stop(campaign, digest)) for digest in digests]
        agreement = agreement_of("d", "m", recorded.tolist(), simulated)
        covered += agreement.absolute.bias_low <= 0.0 <= agreement.absolute.bias_high
    return covered / CAMPAIGNS


@pytest.mark.parametrize("stops", [2, 5, 30])
def test_the_interval_of_the_bias_covers_it_as_often_as_it_says(stops):
    assert coverage(stops, seed_of) == pytest.approx(0.95, abs=WITHIN)


@pytest.mark.parametrize(("stops", "at_most"), [(5, 0.75), (30, 0.40)])
def test_stops_that_share_a_draw_would_not(stops, at_most):
    """The seed of the scenario for every stop: the more stops, the less the interval contains the bias."""
    assert coverage(stops, lambda seed, digest: seed) < at_most


def test_a_seed_depends_on_scenario_and_record_alone():
    assert len({seed_of(0, digest) for digest in DIGESTS}) == len(DIGESTS)
    assert seed_of(0, DIGESTS[0]) != seed_of(1, DIGESTS[0])
    # The rule that docs/validation.md states, worked out by hand.
    words = hashlib.sha256(f"7 {DIGESTS[0]}".encode()).hexdigest()
    assert seed_of(7, DIGESTS[0]) == int(words[:8], 16) // 2


def test_a_recorded_stop_is_simulated_under_its_own_seed(tmp_path):
    path = tmp_path / "stop.yaml"
    path.write_text("schema: uictest/scenario/1\nname: a\ninitial_speed: 120 km/h\nseed: 3\nrepeat: 1000\n")
    [case] = load([path])
    stop = as_recorded(case, "stop", 33.0, DIGESTS[1])
    assert (stop.scenario.seed, float(stop.scenario.initial_speed)) == (seed_of(3, DIGESTS[1]), 33.0)
    assert stop.scenario.seed + case.scenario.repeat < 2**32

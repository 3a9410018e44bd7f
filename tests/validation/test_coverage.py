"""How often the interval of the bias contains the bias: recorded and simulated stops of one and the same rig.

A stand-in draws the stop that a seed gives: normal about 450 m. The recorded stops come from it as well, so
that the true bias is zero and an interval with 95 % must contain it in 95 of 100 campaigns.
"""

import hashlib

import numpy as np
import pytest

from uictest.analysis.validation import agreement_of, as_recorded, seed_of
from uictest.plans.scenario import load

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

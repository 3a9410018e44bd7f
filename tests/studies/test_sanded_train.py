"""Sand under a train of point axles: closed forms, balances and order."""

import numpy as np
import pytest

from studies.sanded_train import GRAVITY, Nozzle, Sander, SandLaw, bisect, places_of_axles, stop

SPEED, DEMAND = 24.6, 0.9
LAW = SandLaw(slope=0.03, end=0.15)
SECOND = Sander(7, 33.3)


def test_without_sand_the_rail_alone_stops_the_train_or_the_brake_where_the_rail_carries_it():
    assert stop(SPEED, DEMAND, LAW).distance == pytest.approx(SPEED**2 / (2 * 0.02 * GRAVITY), rel=1e-12)
    dry = SandLaw(slope=0.03, end=0.3, untreated=0.2)
    found = stop(SPEED, DEMAND, dry, [Sander(1, 1e3)]).distance
    assert found == pytest.approx(SPEED**2 / (2 * DEMAND), rel=1e-12)


def test_a_law_starts_untreated_with_its_slope_and_ends_at_its_end():
    low, close, far = LAW.adhesion(np.array([0.0, 1e-6, 1e3]))
    assert low == LAW.untreated
    assert (close - low) / 1e-6 == pytest.approx(LAW.slope, rel=1e-5)
    assert far == pytest.approx(LAW.end)


def sanded(steps, sander, kept):
    """Return the density that each axle meets after some steps of a metre."""
    nozzle = Nozzle(sander, places_of_axles(), kept, 1.0)
    for _ in range(steps):
        density = np.zeros(16)
        nozzle.add_sand(density, SPEED)
    return density


def test_sand_stays_at_its_place_and_each_axle_leaves_a_share():
    density = sanded(200, Sander(3, np.inf, 2.0), 0.8)
    assert list(density[:2]) == [0.0, 0.0]
    assert density[2:] == pytest.approx(2.0 * 0.8 ** np.arange(14))
    # In the first metres only axles that have passed a nozzle's first place meet its sand.
    behind, run = places_of_axles(), 20
    density = sanded(run, Sander(3, np.inf, 1.0), 1.0)
    assert list(np.nonzero(density)[0]) == [j for j in range(2, 16) if round(behind[j] - behind[2]) < run]


def test_sand_that_every_axle_uses_up_helps_one_axle_alone():
    alone = stop(SPEED, DEMAND, LAW, [Sander(3, 1e6)], kept=0.0).distance
    carried = (15 * 0.02 + DEMAND / GRAVITY) / 16
    assert alone == pytest.approx(SPEED**2 / (2 * carried * GRAVITY), rel=1e-6)


def test_more_sand_further_forward_and_kept_longer_shortens_the_stop():
    fixed = Sander(3, 33.3)
    distance = stop(SPEED, DEMAND, LAW, [fixed]).distance
    both, turned = (stop(SPEED, DEMAND, LAW, pair).distance for pair in ([fixed, SECOND], [SECOND, fixed]))
    assert both < distance
    assert both == pytest.approx(turned, rel=1e-12)
    assert stop(SPEED, DEMAND, LAW, [Sander(1, 33.3)]).distance < distance
    assert stop(SPEED, DEMAND, LAW, [fixed], kept=0.9).distance < distance


def test_a_device_lays_its_rate_in_thirty_seconds():
    (laid,) = stop(SPEED, DEMAND, LAW, [Sander(3, 2.0)]).sand_in_30_s
    assert laid == pytest.approx(60.0, rel=0.01)


def test_shorter_steps_change_no_distance_by_half_a_metre():
    sanders = [Sander(3, 33.3), Sander(7, 100.0, 7.5)]
    fine = stop(SPEED, DEMAND, LAW, sanders, step=0.2).distance
    assert stop(SPEED, DEMAND, LAW, sanders).distance == pytest.approx(fine, abs=0.5)


def test_bisection_finds_the_value_or_the_nearer_end():
    for wanted, value in ((-3.0, 3.0), (-9.0, 4.0), (1.0, 0.0)):
        assert bisect(lambda x: -x, 0.0, 4.0, wanted) == pytest.approx(value, abs=1e-6)

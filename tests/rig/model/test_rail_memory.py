"""What the rail remembers: shares left behind, read by the next wheelset at the same place."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from numpy.typing import NDArray

from uictest.core.rail_laws import LAWS
from uictest.rig.model.rail import MARGIN, POINTS, RAIL_MEMORY, clean_rail, forget_rail

Array = NDArray[np.float64]
BEHIND = (0.0, 2.5, 17.5, 20.0)
"""Places of the wheelsets behind the first one, m."""
GRID = 15.0 / (POINTS - MARGIN)
"""Distance of the points of the memory, m."""


class Track:
    """Wheelsets driven over a rail at a speed, each losing energy to it as a function of place.

    Attributes:
        place: of each wheelset after each cycle, shape (cycles, 4).
        share: cleaned share under each of them, shape (cycles, 4).
        friction: that each of them met, shape (cycles, 4).
    """

    def __init__(self, losses, advance, **numbers):
        settings = {"cleaning_response": 1 / 5300, "cleaning_decay": 2.0, "recovered_friction": 0.28}
        curve = ("friction_ratio", "friction_decay", "reduction_adhesion", "reduction_slip")
        settings |= {name: 0.4 for each in curve for name in (each, f"clean_{each}")} | {"spent_share": 0.0}
        settings |= {"rail_law": 0, "law_numbers": []}
        p = SimpleNamespace(rail_points_per_metre=1.0 / GRID, carry_over=1.0, **settings)
        vars(p).update(numbers)
        car = SimpleNamespace(position=0.0)
        wheelsets = [SimpleNamespace(behind=behind, contact_loss=0.0, cleaned_share=0.0) for behind in BEHIND]
        memory = np.full(1, 9.0, RAIL_MEMORY)[0]
        forget_rail(memory, p)
        rows = [[], [], []]
        for cycle in range(round(60.0 / advance)):
            for wheelset, loss in zip(wheelsets, losses, strict=True):
                middle = car.position - 0.5 * advance - wheelset.behind
                wheelset.contact_loss += (advance if cycle else 0.0) * loss(middle)
                wheelset.friction = 0.08
            clean_rail(car, wheelsets, p, memory)
            rows[0].append([car.position - wheelset.behind for wheelset in wheelsets])
            rows[1].append([wheelset.cleaned_share for wheelset in wheelsets])
            rows[2].append([wheelset.friction for wheelset in wheelsets])
            car.position += advance
        self.place, self.share, self.friction = (np.array(each) for each in rows)

    def share_at(self, number, places):
        """What a wheelset left at places of the track."""
        return np.interp(places, self.place[:, number], self.share[:, number])


def patch(first, last, loss=8000.0):
    return lambda place: loss if first <= place < last else 0.0


def rolls(place):
    return 0.0


@pytest.mark.parametrize("speed", [2.0, 9.0, 33.0])
def test_a_wheelset_meets_at_a_place_what_the_one_before_left_there_later_by_distance_over_speed(speed):
    """Only the first slides, between 10 m and 14 m. The others find its patch there, at any speed."""
    track = Track([patch(10.0, 14.0), rolls, rolls, rolls], 0.01 * speed)
    assert track.share[:, 0].max() == pytest.approx(1.0 - np.exp(-8000.0 / 5300.0), rel=0.01)
    for number in (1, 2, 3):
        here = track.place[:, number] > 0.0
        expected = track.share_at(0, track.place[here, number])
        # Half a cell of the grid, on a slope of at most one per reach, at each of the passings.
        np.testing.assert_allclose(track.share[here, number], expected, atol=number * GRID)
        cleaned = track.share[:, number] > 0.4
        assert track.place[cleaned, number].min() == pytest.approx(10.4, abs=0.01 * speed + GRID)
    first = [np.flatnonzero(track.share[:, number] > 0.3)[0] for number in range(4)]
    np.testing.assert_allclose(np.subtract(first, first[0]), np.divide(BEHIND, 0.01 * speed), atol=1.0)


def test_carry_over_counts_once_for_every_wheelset_that_follows():
    track = Track([patch(10.0, 20.0), rolls, rolls, rolls], 0.1, carry_over=0.5)
    place = np.array([18.0])
    left = [track.share_at(number, place)[0] for number in range(4)]
    settled = 1.0 - np.exp(-8000.0 / 5300.0)
    np.testing.assert_allclose(left, [settled, settled / 2, settled / 4, settled / 8], rtol=1e-3)


def test_each_wheelset_cleans_what_the_others_have_left():
    track = Track([patch(5.0, 25.0)] * 4, 0.1, carry_over=0.5)
    one = 1.0 - np.exp(-8000.0 / 5300.0)
    expected = [one]
    for _ in range(3):
        expected.append(1.0 - (1.0 - one) * (1.0 - 0.5 * expected[-1]))
    left = [track.share_at(number, np.array([22.0]))[0] for number in range(4)]
    np.testing.assert_allclose(left, expected, rtol=1e-3)
    met = [np.interp(22.0, track.place[:, k], track.friction[:, k]) for k in range(4)]
    np.testing.assert_allclose(met, 0.08 + np.array(expected) * 0.2, rtol=1e-3)


def test_the_first_wheelset_does_not_depend_on_the_carry_over():
    kept, lost = (Track([patch(5.0, 25.0)] * 4, 0.1, carry_over=share) for share in (1.0, 0.0))
    np.testing.assert_array_equal(kept.share[:, 0], lost.share[:, 0])
    places = lost.place[60:, 0]
    np.testing.assert_allclose(lost.share_at(1, places), lost.share_at(0, places), atol=1e-12)
    assert np.all(kept.share[200:, 1:].max(axis=0) > lost.share[200:, 1:].max(axis=0))


def test_rail_that_was_passed_before_the_brake_command_was_not_cleaned():
    """The followers start on it."""
    track = Track([patch(-50.0, 50.0), rolls, rolls, rolls], 0.1)
    for number in (1, 2, 3):
        before = track.place[:, number] < 0.0
        np.testing.assert_allclose(track.share[before, number], 0.0, atol=1e-12)


def test_a_rail_better_than_a_cleaned_one_keeps_its_friction():
    track = Track([patch(5.0, 25.0)] * 4, 0.1, recovered_friction=0.05)
    assert np.all(track.friction == 0.08)


@given(
    st.lists(
        st.tuples(st.floats(0.0, 40.0), st.floats(0.1, 20.0), st.floats(0.0, 1e5)), min_size=4, max_size=4
    ),
    st.floats(0.2, 1.0),
    st.floats(0.0, 1.0),
)
@settings(max_examples=20)
def test_shares_stay_between_nothing_and_all(slides, advance, carry_over):
    losses = [patch(first, first + length, loss) for first, length, loss in slides]
    track = Track(losses, advance, carry_over=carry_over)
    assert np.all((track.share >= 0.0) & (track.share <= 1.0))
    assert np.all((track.friction >= 0.08) & (track.friction <= 0.28))


def test_a_film_is_remembered_by_what_is_bare_not_by_what_it_counts():
    """Else a wheelset would find the rail behind another one less bare than it was left."""
    losses, film = [patch(10.0, 30.0, 3000.0)] * 4, list(LAWS).index("film")
    mixture, counted = Track(losses, 0.3), Track(losses, 0.3, rail_law=film, law_numbers=[25.0])
    bare = mixture.share
    np.testing.assert_allclose(counted.share, bare / (bare + 25.0 * (1.0 - bare)), rtol=1e-9)
    assert counted.share.max() > 0.01

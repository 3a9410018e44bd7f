"""Wheelsets beside their neighbours, in stops whose numbers are made up."""

import math
import random

import pytest
from hypothesis import given, strategies as st

from uictest.analysis.logged_stops.neighbours import (
    FEWEST,
    findings_table,
    neighbour_differences,
    sliding_sentence,
)
from uictest.recorded.service_log import SIGNS, WheelsetSigns

NONE = (math.nan,) * 4


def stops(sign, numbers, count=12, spread=0.0, seed=0):
    """Return stops that know one sign alone, each number with a normal deviation of so large a share."""
    draw = random.Random(seed)
    return [
        WheelsetSigns(
            f"stop-{k:04d}",
            dict.fromkeys(SIGNS, NONE)
            | {sign: tuple(each * (1.0 + draw.gauss(0.0, spread)) for each in numbers)},
            (0, 0, 0, 0),
            (0, 0, 0, 0),
            ((), (), (), ()),
        )
        for k in range(count)
    ]


def told(signs):
    return [(row[0], row[1]) for row in findings_table(signs, neighbour_differences(signs)).rows]


@pytest.mark.parametrize("wheelset", [1, 2, 3, 4])
def test_a_weak_brake_is_told_of_its_wheelset_alone(wheelset):
    forces = [14.0] * 4
    forces[wheelset - 1] = 12.0
    assert told(stops("brake_force", forces, spread=0.01)) == [(wheelset, "brakes weakly")]


def test_of_two_wheelsets_against_two_neither_pair_is_told_to_be_wrong():
    findings = told(stops("brake_force", (12.0, 12.0, 14.0, 14.0)))
    assert findings == [(None, "1 and 2: brakes weakly, or 3 and 4: brakes with more force")]


def test_of_three_wheelsets_only_the_odd_one_is_told():
    assert told(stops("brake_force", (12.0, 14.0, 14.0, math.nan))) == [(1, "brakes weakly")]


def test_a_slow_brake_may_build_up_by_a_share_of_its_time_later():
    assert told(stops("build_up", (11.9, 11.4, 11.4, 11.4))) == []
    assert told(stops("build_up", (1.3, 1.1, 1.1, 1.1))) == [(1, "brakes late")]


def test_too_few_stops_tell_nothing():
    numbers = (14.0, 12.0, 14.0, 14.0)
    assert told(stops("brake_force", numbers, count=FEWEST)) == [(2, "brakes weakly")]
    assert told(stops("brake_force", numbers, count=FEWEST - 1)) == []


def test_a_difference_within_the_limit_is_no_finding_however_sure():
    assert told(stops("brake_force", (14.0, 13.4, 14.0, 14.0), count=500)) == []


def test_a_few_odd_stops_do_not_make_a_finding():
    odd = stops("brake_force", (14.0, 7.0, 14.0, 14.0), count=5)
    assert told([*odd, *stops("brake_force", (14.0,) * 4, count=7)]) == []


@given(st.permutations([11.0, 14.0, 14.1, 13.9]))
def test_the_order_of_the_wheelsets_does_not_matter(forces):
    assert told(stops("brake_force", forces)) == [(forces.index(11.0) + 1, "brakes weakly")]


def test_two_sensors_are_no_neighbours():
    assert neighbour_differences(stops("brake_force", (14.0, 10.0, math.nan, math.nan))) == []


def test_sliding_more_is_said_and_is_no_finding():
    signs = stops("slid_distance", (10.0, 60.0, 12.0, 61.0))
    assert told(signs) == []
    sentence = sliding_sentence(neighbour_differences(signs))
    assert "slides more than its neighbours: wheelset 2 (+48 % of the distance), 4 (+49 %" in sentence
    assert sliding_sentence(neighbour_differences(stops("slid_distance", (50.0, 60.0, 52.0, 61.0)))) == ""


def test_a_valve_that_does_not_vent_is_told_from_one_stop_on():
    (stop,) = stops("brake_force", (14.0,) * 4, count=1)
    assert told([stop._replace(vents=(9, 9, 9, 9), unanswered=(0, 9, 1, 0))]) == [(2, "does not vent")]
    assert told([stop._replace(vents=(2, 2, 2, 2), unanswered=(0, 2, 0, 0))]) == []


def test_defects_are_gathered_by_channel():
    signs = [
        each._replace(defects=((), (), ("stuck: wheel_speed_3 stays at 3 m/s",), ()))
        for each in stops("brake_force", (14.0,) * 4, count=3)
    ]
    (row,) = findings_table(signs, neighbour_differences(signs)).data.rows
    assert (row["wheelset"], row["finding"], row["shown_in"]) == (3, "stuck: wheel_speed_3", "3 of 3 stops")

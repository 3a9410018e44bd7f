"""The comparison of rigs on made-up stops."""

import pytest

from studies.experiments.rig_equivalence import RIGS, TRAIN, differences_at, overall
from studies.neighbourhood import FOUR_CALIPER, SETTINGS, Point, mean_counts


@pytest.fixture
def point(stop):
    """A point at which the rig with four calipers scatters by a metre, and `none` runs 5 m shorter."""
    four = [stop(11, 11, 11, 11, braking_distance_m=distance) for distance in (199.0, 200.0, 201.0)]
    stops = dict.fromkeys(SETTINGS, four)
    stops["none"] = [stop(11, 21, 20, 22, braking_distance_m=195.0)] * 3
    nothing = None
    return Point("0.146", "100 %", nothing, {**stops, FOUR_CALIPER: four})


def test_a_rig_against_itself_shows_its_scatter_and_others_their_differences(point):
    found = list(differences_at(point))
    for rig in ("full", FOUR_CALIPER):
        reading = overall(found, "braking_distance", rig)
        assert (reading.low, reading.value, reading.high) == (-1.0, 0.0, 1.0)
    assert overall(found, "braking_distance", "none").value == -5.0
    of_none = [each for each in found if (each.measure, each.rig) == ("valve_actuations", "none")]
    vents = {each.wheelset: each for each in of_none}
    assert [list(vents[n].values) for n in (1, 2, 3, 4)] == [[0.0] * 3, [10.0] * 3, [9.0] * 3, [11.0] * 3]
    assert {each.wheelset for each in found if each.measure == "braking_time"} == {TRAIN}
    assert {each.rig for each in found} == set(RIGS)
    assert mean_counts(point.stops["none"]).tolist() == [21.0] * 3

import pytest

from studies import slip_brake_tests
from studies.slip_brake_tests import CLEANED, CONTROLLERS, slip_tests

SMALL, DEEP = CONTROLLERS


@pytest.fixture(name="tests", scope="module")
def _tests(stop_runner):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(slip_brake_tests, "FRICTIONS", (0.05, 0.08, 0.10))
        patch.setattr(slip_brake_tests, "ENERGIES", ("none", CLEANED))
        patch.setattr(slip_brake_tests, "SEEDS", range(2))
        return slip_tests(stop_runner)


def test_the_map_has_every_point_once(tests):
    assert list(tests) == [
        (name, energy, friction)
        for name in CONTROLLERS
        for energy in ("none", CLEANED)
        for friction in (0.05, 0.08, 0.10)
    ]
    assert all((test.controller, test.energy, test.friction) == key for key, test in tests.items())


def test_on_a_rail_that_is_not_cleaned_the_slip_brake_test_counts(tests):
    """The deeper the slides, the longer the stop."""
    assert tests[SMALL, "none", 0.05].counts
    for friction in (0.05, 0.08, 0.10):
        small, deep = (tests[name, "none", friction] for name in CONTROLLERS)
        assert deep.counts
        assert deep.distance > 1.05 * small.distance


def test_cleaning_takes_the_deep_slides_from_the_default_controller(tests):
    """It slides for long, so that the test counts, but never deep: the readings of its limit disagree."""
    cleaned = tests[SMALL, CLEANED, 0.05]
    assert cleaned.depth < 35.0 < cleaned.sliding
    assert cleaned.counts


def test_a_controller_with_deep_slides_meets_both_limits_and_stops_earlier(tests):
    small, deep = (tests[name, CLEANED, 0.05] for name in CONTROLLERS)
    assert deep.counts
    assert min(deep.depth, deep.sliding) > 35.0
    assert deep.distance < small.distance


def test_a_rail_of_more_friction_is_not_slippery_enough_once_it_is_cleaned(tests):
    cleaned = tests[DEEP, CLEANED, 0.10]
    assert cleaned.initial_adhesion > 0.08
    assert cleaned.sliding > 35.0
    assert not cleaned.counts

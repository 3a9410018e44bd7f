"""Repeats in a scenario file, and what is said of wrong ones."""

import pytest

from uictest.plans.scenario import ShareOfStops


@pytest.mark.parametrize(
    ("text", "overrides", "repeat", "outcome"),
    [
        ("", [], 1, "all"),
        ("repeat: 10\noutcome_of_repeats: median", [], 10, "median"),
        ("repeat: 10", ["repeat=3"], 3, "all"),
        ("seed: 4294967286\nrepeat: 10", [], 10, "all"),  # the last seed is the largest
    ],
)
def test_one_stop_unless_the_file_says_more(loaded, head, text, overrides, repeat, outcome):
    (case,) = loaded(head + text, *overrides)
    assert (case.scenario.repeat, case.scenario.outcome_of_repeats) == (repeat, outcome)


def test_a_share_of_the_stops(loaded, head):
    (case,) = loaded(head + "repeat: 10\noutcome_of_repeats: {at_least: 90 %}")
    share = case.scenario.outcome_of_repeats
    assert isinstance(share, ShareOfStops)
    assert share.at_least == pytest.approx(0.9)


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("repeat: 0", "repeat: 0 is out of range: it must be at least 1", ""),
        ("repeat: 1001", "repeat: 1001 is out of range: it must be at most 1000", ""),
        ("repeat: 2.5", "repeat: expected a whole number, found a number ('2.5')", ""),
        (
            "outcome_of_repeats: 90 %",
            "outcome_of_repeats: unknown value '90 %', expected one of all, median",
            "write {at_least: 90 %} for a share of the stops",
        ),
        (
            "outcome_of_repeats: {at_least: 0.9}",
            "outcome_of_repeats.at_least: '0.9' has no unit",
            "write `90 %` (a bare 0.9 is ambiguous)",
        ),
        (
            "outcome_of_repeats: {at_least: 0 %}",
            "outcome_of_repeats.at_least: 0 % is out of range: it must be above 0 %",
            "accepted: above 0 % and at most 100 %",
        ),
        (
            "seed: 4294967290\nrepeat: 10",
            "repeat: 10 stops from seed 4294967290 end with seed 4294967299; the largest is 4294967295",
            "take a seed of at most 4294967286",
        ),
    ],
)
def test_what_is_wrong_is_said(refused, head, text, message, hint):
    (diagnostic,) = refused(head + text)
    assert f"{diagnostic.key}: {diagnostic.message}" == message
    assert diagnostic.hint.startswith(hint)

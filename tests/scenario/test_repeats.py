"""Repeats in a scenario file, and what is said of wrong ones."""

import pytest

from uictest.plans.scenario import ShareOfStops

OUTCOME = "outcome_of_repeats: "
LAST = 2**32 - 1
"""The largest seed."""


@pytest.mark.parametrize(
    ("text", "overrides", "repeat", "outcome"),
    [
        ("", [], 1, "all"),
        ("repeat: 10\noutcome_of_repeats: median", [], 10, "median"),
        ("repeat: 10", ["repeat=3"], 3, "all"),
        (f"seed: {LAST - 9}\nrepeat: 10", [], 10, "all"),  # the last seed is the largest
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
        (OUTCOME + "90 %", "unknown value '90 %', expected one of all, median", "write {at_least: 90 %} for"),
        (OUTCOME + "{at_least: 0.9}", "'0.9' has no unit", "write `90 %` (a bare 0.9 is ambiguous)"),
        (OUTCOME + "{at_least: 0 %}", "0 % is out of range: it must be above 0 %", "accepted: above 0 % and"),
        (
            f"seed: {LAST - 5}\nrepeat: 10",
            f"10 stops from seed {LAST - 5} end with seed {LAST + 4}; the largest is {LAST}",
            f"take a seed of at most {LAST - 9}",
        ),
    ],
)
def test_what_is_wrong_is_said(refused, head, text, message, hint):
    (diagnostic,) = refused(head + text)
    assert message in f"{diagnostic.key}: {diagnostic.message}"
    assert diagnostic.key.partition(".")[0] in text
    assert diagnostic.hint.startswith(hint)

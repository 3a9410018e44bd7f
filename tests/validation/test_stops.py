"""Recorded stops beside their simulations: which of them count, and what their figures are called."""

from __future__ import annotations

import pytest

from uictest.analysis.validation import ComparedStop, figures_of
from uictest.judging.evaluation import CaseResult


@pytest.mark.parametrize(
    ("tuned", "not_counted", "counted"),
    [(False, "", True), (True, "", False), (False, "a copy of a.csv", False), (True, "a gap", False)],
)
def test_a_stop_counts_that_can_be_compared_and_that_nothing_was_tuned_with(
    tuned: bool, not_counted: str, counted: bool
) -> None:
    stop = ComparedStop("a", "a.csv", "00", 33.0, tuned=tuned, not_counted=not_counted)
    assert stop.counted == counted


def test_figures_of_wheelsets_are_numbered_from_1_which_leads() -> None:
    slides = tuple({"maximum_slide": share} for share in (0.1, 0.2, 0.3, 0.4))
    result = CaseResult(
        "a", "a.yaml", {}, "pass", "pass", measures={"braking_distance_m": 470.0}, wheelsets=slides
    )
    assert figures_of(result) == {
        "braking_distance_m": 470.0,
        "maximum_slide_1": 0.1,
        "maximum_slide_2": 0.2,
        "maximum_slide_3": 0.3,
        "maximum_slide_4": 0.4,
    }


def test_a_stop_that_came_to_no_figures_has_none() -> None:
    assert figures_of(CaseResult("a", "a.yaml", {}, "pass", "error")) == {}

"""Recorded stops beside their simulations: which of them count, and what their figures are called."""

import pytest

from uictest.analysis.validation import ComparedStop, figures_of
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import PASS


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

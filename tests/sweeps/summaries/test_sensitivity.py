"""Sobol indices of functions whose indices are known."""

import numpy as np
import pytest

from uictest.analysis.summaries.sensitivity import confidence_interval, sobol_sensitivities, uncertainty_note
from uictest.plans.sweeps.plan import saltelli_sample
from uictest.report import SobolIndex, SobolSensitivity, WrittenValue

TEXT = """\
matrix: {seed: [1, 2]}
sample:
  method: saltelli
  size: 512
  parameters:
    rail.friction: {uniform: [0.05, 0.15]}
    brake.command: {uniform: [50 %, 100 %]}
    rail.gradient: {uniform: [0 permille, 10 permille]}
"""


def columns(load):
    plan = load(TEXT)
    settings = plan.settings(np.arange(plan.size))
    return plan, {key: np.array([value.number for value in values]) for key, values in settings.items()}


def test_a_sum_has_the_shares_of_its_variances_and_a_product_acts_only_together(load):
    plan, x = columns(load)
    # Variances of a uniform variable go with the square of its width: 1 : 4.
    found, why_not = sobol_sensitivities(plan, "y", 10.0 * x["rail.friction"] + 4.0 * x["brake.command"])
    assert not why_not
    assert len(found) == 2 * 3
    for each, expected in zip(found, [0.2, 0.8, 0.0] * 2, strict=True):
        assert each.first.value == pytest.approx(expected, abs=0.02)
        assert each.total.value == pytest.approx(expected, abs=0.02)
        assert each.first.low <= each.first.value <= each.first.high
    assert [each.circumstances for each in found[::3]] == [
        {"seed": WrittenValue("1")},
        {"seed": WrittenValue("2")},
    ]
    # A product of centred variables.
    y = (x["rail.friction"] - 0.1) * (x["brake.command"] - 0.75)
    found, _ = sobol_sensitivities(plan, "y", y)
    assert [each.first.value for each in found[:2]] == pytest.approx([0.0, 0.0], abs=0.1)
    assert [each.total.value for each in found[:2]] == pytest.approx([1.0, 1.0], abs=0.15)


def test_the_interval_of_a_mean_is_that_of_the_normal_distribution():
    """95 % of it lie within 1.96 deviations: mean +- 1.96 s/sqrt(n), here on average over 400 columns."""
    rows = np.random.default_rng(1).normal(size=(400, 400))
    low, high = confidence_interval(lambda drawn: drawn.mean(axis=0), rows, seed=2)
    deviation = rows.std(axis=0) / np.sqrt(400)
    for distance in (rows.mean(axis=0) - low, high - rows.mean(axis=0)):
        assert np.mean(distance / deviation) == pytest.approx(1.96, rel=0.04)


def test_the_same_values_give_the_same_intervals_and_where_there_are_none_it_says_why(load):
    plan, x = columns(load)
    y = x["rail.friction"].copy()
    y[3] = np.nan
    assert sobol_sensitivities(plan, "y", y) == ([], f"1 of {y.size} cases have no y")
    assert sobol_sensitivities(plan, "y", np.ones(y.size)) == ([], "y is the same in all cases")
    assert saltelli_sample(load()) is None
    y = np.sin(40.0 * x["rail.friction"]) + x["brake.command"] ** 2
    assert sobol_sensitivities(plan, "y", y) == sobol_sensitivities(plan, "y", y)


@pytest.mark.parametrize(("width", "doubted"), [(0.15, False), (0.75, True)])
def test_wide_intervals_are_noted(width, doubted):
    narrow, index = SobolIndex(0.5, 0.45, 0.55), SobolIndex(0.5, 0.5 - width / 2, 0.5 + width / 2)
    found = [SobolSensitivity("met", {}, "rail.friction", narrow, index)]
    assert bool(uncertainty_note(found)) == doubted
    assert ("up to 0.75 wide" in uncertainty_note(found)) == doubted

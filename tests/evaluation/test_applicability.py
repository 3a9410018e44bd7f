"""Conditions of a stop that a criterion requires."""

import pytest

from uictest.plans import scenario, scenario as scenarios

CONDITIONS = scenarios.TestConditions("soap", "active", "R", 1.0, 0.0, "one-caliper")


@pytest.mark.parametrize(
    ("required", "unmet"),
    [
        ({"rail_condition": ("wet", "soap")}, []),
        ({"rail_condition": ("wet",)}, ["rail is soap, the criterion is for wet"]),
        ({"rail_condition_other_than": ("dry",)}, []),
        ({"rail_condition_other_than": ("dry", "soap")}, ["rail is soap, the criterion is for any other"]),
    ],
)
def test_a_criterion_names_the_rails_it_is_for_or_not_for(required, unmet):
    applies = scenario.Applicability(**required)
    assert [str(each) for each in scenarios.unmet_conditions(applies, CONDITIONS, None)] == unmet

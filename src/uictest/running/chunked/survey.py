"""What the survey step does to measures, as the study of it found over the shipped scenarios."""

from __future__ import annotations

import csv
from collections.abc import Collection, Mapping
from dataclasses import replace
from functools import cache
from types import MappingProxyType

from uictest.core.measures import MEASURES
from uictest.plans import library
from uictest.plans.sweeps import REGULAR_STEP, SURVEY_STEP, Plan, scenarios_with_each
from uictest.report import SurveyBias, SurveyStep

SURVEY_TABLE = "survey_step.csv"
"""File of the library: for each shipped case and measure the mean difference of stops in survey steps from
the same stops in regular steps, with its 95 % interval, what 95 % of the single stops differ by at most, and
the mean size of the measure.
`studies/survey_step.py` writes it."""


@cache
def survey_biases() -> Mapping[str, SurveyBias]:
    """Return for each measure the largest bias that the survey step has in any shipped case.

    That of a case is the end of its 95 % interval that is farther from zero, as a share of the mean size.
    """
    largest: dict[str, SurveyBias] = {}
    for row in csv.DictReader(library.table(SURVEY_TABLE).splitlines()):
        size, low, high, single = (float(row[key]) for key in ("size", "low", "high", "of_single_stops"))
        share = 1.0 / size if size else 0.0
        bias = share * max(abs(low), abs(high))
        found = SurveyBias(row["measure"], bias, row["case"], share * single)
        before = largest.setdefault(found.measure, found)
        single = max(before.of_single_stops, found.of_single_stops)
        larger = found if found.bias > before.bias else before
        largest[found.measure] = replace(larger, of_single_stops=single)
    return MappingProxyType(largest)


def biases_by_measure() -> dict[str, float]:
    """Return the largest bias of every measure, as a share of it."""
    return {name: each.bias for name, each in survey_biases().items()}


def survey_step(plan: Plan, repeated: int, columns: Collection[str]) -> SurveyStep | None:
    """Return the steps of a survey, None of another sweep.

    Args:
        plan: of the sweep.
        repeated: number of cases that were repeated in regular steps.
        columns: of results that are mapped.

    """
    if not plan.survey:
        return None
    known = survey_biases()
    biases = tuple(known[name] for name in _looked_at(plan, columns) if name in known)
    return SurveyStep(SURVEY_STEP.text, REGULAR_STEP.text, repeated, biases)


def _looked_at(plan: Plan, columns: Collection[str]) -> dict[str, None]:
    """Return the measures that are judged in any case, and those of some columns."""
    judged = (
        criterion.measure
        for scenario in scenarios_with_each(plan, "criteria")
        for profile in scenario.judged_by
        for criterion in profile.criteria
    )
    mapped = (each.name for each in MEASURES.values() if each.column and each.column.name in columns)
    return dict.fromkeys((*judged, *mapped))

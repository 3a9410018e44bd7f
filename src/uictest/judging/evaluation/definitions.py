"""The definitions that a verdict depends on: as text for people, and as numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from uictest.core.units import in_unit, value_text, with_unit
from uictest.judging.evaluation.bounds import bounds_of
from uictest.judging.evaluation.verdict import AppliedDefinition
from uictest.plans import scenario
from uictest.plans.scenario import yaml

CORRECTION: Final = (
    "s (v0/v)^2 / (1 - 2 g i s/v^2) of a distance, a - g i of a deceleration (chosen: the balance of energy;"
    " UIC 544-1 and EN 16834, said to correct likewise, were not available)"
)


def definition_texts(
    criterion: scenario.Criterion, profile: scenario.Criteria, resolved: scenario.Scenario
) -> dict[str, str]:
    """Return clause, measure, bound, aggregation and every definition of a verdict, as text for people.

    Definitions of the criterion come with their range. Those of the scenario's `measures`, which turned
    samples into measures while the stop was observed, and what a measure is corrected for have none.
    """
    bound = with_unit(str(bounds_of(criterion)), criterion.unit)
    if criterion.of_dry_stop:
        bound = f"{bound} of the dry stop"
    texts = {"clause": criterion.clause, "measure": criterion.meaning, "bound": bound}
    if aggregation := criterion.aggregation:
        texts["wheelsets"] = aggregation
    if criterion.readings:
        own = profile.sources.get(criterion.reading_source)
        texts["reading"] = f"{criterion.reading} ({f'{own.mark}: {own.text}' if own else 'user'})"
    for name, parameter in criterion.definition.parameters().items():
        texts[name] = _parameter(parameter, profile.sources)
    if criterion.corrected:
        texts["correction"] = CORRECTION
    for name, quantity, mark in scenario.observed_quantities(criterion, profile, resolved):
        texts[name] = f"{quantity.text} ({mark})"
    return texts


def applied_definitions(
    criterion: scenario.Criterion, profile: scenario.Criteria, resolved: scenario.Scenario
) -> tuple[AppliedDefinition, ...]:
    """Return every definition that a verdict depends on, as numbers; names as in :func:`definition_texts`."""
    own = (
        AppliedDefinition(
            name,
            float(parameter.value),
            parameter.value.unit,
            scenario.mark_of(parameter.value, profile.sources),
            *map(float, parameter.range),
        )
        for name, parameter in criterion.definition.parameters().items()
    )
    given = (
        AppliedDefinition(name, float(quantity), quantity.unit, mark)
        for name, quantity, mark in scenario.observed_quantities(criterion, profile, resolved)
    )
    return (*own, *given)


def _parameter(parameter: scenario.RangedDefinition, sources: Mapping[str, yaml.Source]) -> str:
    value, lower, upper = (
        value_text(in_unit(number, parameter.unit), parameter.unit)
        for number in (parameter.value, *parameter.range)
    )
    return f"{value} ({scenario.mark_of(parameter.value, sources)}; range {lower} .. {upper})"

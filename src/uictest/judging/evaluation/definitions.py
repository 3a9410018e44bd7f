"""The definitions that a verdict depends on, as numbers and as texts."""

from __future__ import annotations

from collections.abc import Mapping

from uictest.core.units import in_unit, value_text, with_unit
from uictest.judging.evaluation.bounds import bounds_of
from uictest.judging.evaluation.verdict import AppliedDefinition
from uictest.plans import scenario
from uictest.plans.scenario import yaml


def definition_texts(
    criterion: scenario.Criterion, profile: scenario.Criteria, observation: scenario.MeasureDefinitions
) -> dict[str, str]:
    """Return clause, measure, bound, aggregation and every definition of a verdict, as text for people.

    Definitions of the criterion come with their range. Those of `observation`, which turned samples into
    measures while the stop was observed, have none.
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
    for name in criterion.observed_by:
        quantity = getattr(observation, name)
        texts[name] = f"{quantity.text} ({scenario.mark_of(quantity, observation.sources)})"
    return texts


def applied_definitions(
    criterion: scenario.Criterion, profile: scenario.Criteria, observation: scenario.MeasureDefinitions
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
    observed = (
        AppliedDefinition(
            name, float(quantity), quantity.unit, scenario.mark_of(quantity, observation.sources)
        )
        for name in criterion.observed_by
        for quantity in (getattr(observation, name),)
    )
    return (*own, *observed)


def _parameter(parameter: scenario.RangedDefinition, sources: Mapping[str, yaml.Source]) -> str:
    value, lower, upper = (
        value_text(in_unit(number, parameter.unit), parameter.unit)
        for number in (parameter.value, *parameter.range)
    )
    return f"{value} ({scenario.mark_of(parameter.value, sources)}; range {lower} .. {upper})"

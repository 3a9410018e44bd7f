"""What a criterion was taken to mean, in words and in numbers: part of its verdict."""

from __future__ import annotations

from collections.abc import Mapping

from uictest import scenario
from uictest.evaluation.decision import bounds_of
from uictest.evaluation.verdict import AppliedDefinition
from uictest.scenario import yaml
from uictest.units import in_unit, value_text, with_unit


def meaning_of(
    criterion: scenario.Criterion, profile: scenario.Criteria, observation: scenario.MeasureDefinitions
) -> dict[str, str]:
    """Return clause, measure, bound, aggregation and every definition that a criterion's verdict rests on.

    Definitions of the criterion come with their range. Those of `observation`, by which samples became
    measures, were used up when the stop was observed: they have none.
    """
    bound = with_unit(str(bounds_of(criterion)), criterion.unit)
    meaning = {"clause": criterion.clause, "measure": criterion.meaning, "bound": bound}
    if aggregation := criterion.aggregation:
        meaning["wheelsets"] = aggregation
    for name, parameter in criterion.definition.parameters().items():
        meaning[name] = _parameter(parameter, profile.sources)
    for name in criterion.observed_by:
        quantity = getattr(observation, name)
        meaning[name] = f"{quantity.text} ({_mark(quantity, observation.sources)})"
    return meaning


def applied_definitions(
    criterion: scenario.Criterion, profile: scenario.Criteria, observation: scenario.MeasureDefinitions
) -> tuple[AppliedDefinition, ...]:
    """Return every definition that a criterion's verdict rests on, as :func:`meaning_of` names them."""
    own = (
        AppliedDefinition(
            name,
            float(parameter.value),
            parameter.value.unit,
            _mark(parameter.value, profile.sources),
            *map(float, parameter.range),
        )
        for name, parameter in criterion.definition.parameters().items()
    )
    observed = (
        AppliedDefinition(name, float(quantity), quantity.unit, _mark(quantity, observation.sources))
        for name in criterion.observed_by
        for quantity in (getattr(observation, name),)
    )
    return (*own, *observed)


def _parameter(parameter: scenario.Parameter, sources: Mapping[str, yaml.Source]) -> str:
    value, lower, upper = (
        value_text(in_unit(number, parameter.unit), parameter.unit)
        for number in (parameter.value, *parameter.range)
    )
    return f"{value} ({_mark(parameter.value, sources)}; range {lower} .. {upper})"


def _mark(quantity: yaml.Quantity, sources: Mapping[str, yaml.Source]) -> str:
    # Only who judges has scenarios loaded: results are read without them.

    return scenario.mark_of(quantity, sources)

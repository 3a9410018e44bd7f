"""Criteria applied to the measures of a stop: verdicts, the definitions they rest on, reasons of the rig."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final, Literal, Protocol

from uictest.controllers import ResponseTimes
from uictest.core.measures import MEASURES, StopMeasures, Wheelsets
from uictest.core.units import all_in_unit, value_text
from uictest.judging.evaluation.decision import (
    Bounds,
    Coverage,
    Decision,
    ObservedStop,
    bounds_of,
    decide,
    sensitivity,
)
from uictest.judging.evaluation.verdict import (
    READINGS,
    AppliedDefinition,
    ReadVerdict,
    Sensitivity,
    Status,
    Verdict,
    VerdictInterval,
)
from uictest.plans import scenario
from uictest.plans.scenario import UnmetCondition, unmet_conditions

CORRECTION: Final = (
    "s (v0/v)^2 / (1 - 2 g i s/v^2) of a distance, a - g i of a deceleration (chosen: the balance of energy;"
    " UIC 544-1 and EN 16834, said to correct likewise, were not available)"
)


class Decide(Protocol):
    """Decides a criterion that applies with given definitions (SI), with the reason if `explained`."""

    def __call__(self, definition: Mapping[str, float], *, explained: bool) -> Decision:
        """Return the decision."""


DeciderOf = Callable[[scenario.Criterion, Bounds], Decide]
"""Returns what decides a criterion, or what it is by another reading."""
Detail = Literal["status", "readings", "full"]
"""How much a verdict says, see :func:`judge`."""
_READ: Final = ("status", "measure", "value", "unit", "lower", "upper", "margin", "reason", "sensitivity")
"""What a verdict may be another in by another reading."""
_OVER_A_SERIES: Final = "judged over the stops of a series"
_NO_RIG: Final = (
    "not known: rig.compensation_model does not list the rig that it was identified for,"
    " or states other numbers than were identified"
)


def judge(
    resolved: scenario.Scenario,
    measures: StopMeasures,
    wheelset_measures: Wheelsets,
    *,
    detail: Detail = "full",
    coverage: Coverage | None = None,
) -> list[Verdict]:
    """Judge one stop by every criterion of its scenario, in the order written, then by the checks of the rig.

    Args:
        resolved: scenario with the conditions of the stop and the criteria.
        measures: record of the stop, SI, as observed with `resolved.measures`.
        wheelset_measures: one record per wheelset from the leading end, SI.
        detail: `status`: verdicts alone; `readings`: with those of the other readings of a criterion; `full`:
            also with their definitions, and whether another value in their range would change them, which
            takes most of the time.
        coverage: what the record of a real stop lacks; None for a simulation.

    Returns:
        One verdict per criterion, those of the rig for simulated stops alone:
        `not_applicable` where the criterion does not apply to such a stop,
        `inconclusive` where data to judge it are missing, both with the reason. NaN never passes.

    """
    stop = ObservedStop(resolved, measures, wheelset_measures, coverage)
    verdicts = []
    for profile in resolved.judged_by if coverage is None else resolved.criteria:
        for criterion in profile.criteria:
            verdict = _judge_criterion(criterion, profile, stop, detail=detail)
            if verdict.layer == "rig" and verdict.status == "fail":
                why = why_rig_fails(criterion, resolved, measures, list(wheelset_measures))
                verdict = replace(verdict, reason=why or verdict.reason)
            if detail == "full":
                verdict = with_definitions(verdict, criterion, profile, resolved)
            verdicts.append(verdict)
    return verdicts


def _judge_criterion(
    criterion: scenario.Criterion, profile: scenario.Criteria, stop: ObservedStop, *, detail: Detail
) -> Verdict:
    bounds = bounds_of(criterion)
    decided = undecided(criterion, profile, stop)
    if decided is not None:
        return verdict_of(criterion, bounds, decided)

    def decider_of(read: scenario.Criterion, bounds: Bounds) -> Decide:
        undecided_reading = None if read is criterion else undecided(read, profile, stop)

        def decide_with(definition: Mapping[str, float], *, explained: bool) -> Decision:
            return undecided_reading or decide(read, bounds, definition, stop, explained=explained)

        return decide_with

    return verdict_by(criterion, bounds, decider_of, detail=detail)


def verdict_by(
    criterion: scenario.Criterion, bounds: Bounds, decider_of: DeciderOf, *, detail: Detail
) -> Verdict:
    """Return the verdict of a criterion that applies, without definitions."""
    stated, decide_with = criterion.definition.stated, decider_of(criterion, bounds)
    decision = decide_with(stated, explained=True)
    verdict = verdict_of(criterion, bounds, decision)
    explains = detail == "full" and decision.status != "inconclusive"
    if explains and stated:
        verdict = replace(verdict, sensitivity=tuple(_sensitivities(criterion, stated, decide_with)))
    if detail == "status" or not criterion.readings:
        return verdict
    readings = tuple(_verdicts_of_readings(criterion, bounds, verdict, decider_of, detail))
    if not explains:
        return replace(verdict, readings=readings)
    # The readings are like the range of a definition: the verdict turns where they do not all agree.
    intervals = (VerdictInterval(k, k, each.status, each.id) for k, each in enumerate(readings, start=1))
    turns = Sensitivity(READINGS, "", 1, len(readings), tuple(intervals))
    return replace(verdict, readings=readings, sensitivity=(*verdict.sensitivity, turns))


def _verdicts_of_readings(
    criterion: scenario.Criterion, bounds: Bounds, own: Verdict, decider_of: DeciderOf, detail: Detail
) -> Iterator[ReadVerdict]:
    """Yield the verdict by each reading: that of the criterion itself, which decides, then the others."""
    yield _read_verdict(criterion.reading, replace(own, sensitivity=()), decides=True)
    for reading in criterion.readings:
        read = criterion.read_as(reading)
        # The kind of quantity is the same, the unit may be another.
        verdict = verdict_by(read, bounds_of(read), decider_of, detail=detail)
        yield _read_verdict(reading.id, verdict, decides=False)


def _read_verdict(reading: str, verdict: Verdict, *, decides: bool) -> ReadVerdict:
    return ReadVerdict(reading, decides, **{name: getattr(verdict, name) for name in _READ})


def by_reading(verdict: Verdict, reading: ReadVerdict) -> Verdict:
    """Return the verdict on a criterion by one of its readings, with an id such as `slide read as depth`."""
    read = {name: getattr(reading, name) for name in _READ}
    return replace(verdict, id=f"{verdict.id} read as {reading.id}", readings=(), over_stops=None, **read)


def with_definitions(
    verdict: Verdict, criterion: scenario.Criterion, profile: scenario.Criteria, resolved: scenario.Scenario
) -> Verdict:
    """Return a verdict with the definitions that it depends on."""
    texts, numbers = _definition_texts_and_numbers(criterion, profile, resolved)
    return replace(
        verdict,
        definition=texts,
        definitions=numbers,
        readings=tuple(_defined_readings(verdict.readings, criterion, profile, resolved)),
    )


def _defined_readings(
    readings: Sequence[ReadVerdict],
    criterion: scenario.Criterion,
    profile: scenario.Criteria,
    resolved: scenario.Scenario,
) -> Iterator[ReadVerdict]:
    """Yield the verdict by each reading with its source and, but for the deciding one, its definitions."""
    others = {each.id: each for each in criterion.readings}
    for read in readings:
        other = others.get(read.id)
        source = profile.sources.get(other.source if other else criterion.reading_source)
        texts = definition_texts(criterion.read_as(other), profile, resolved) if other else {}
        mark, text = (source.mark, source.text) if source else ("user", "")
        yield replace(read, mark=mark, source=text, definition=texts)


def undecided(
    criterion: scenario.Criterion, profile: scenario.Criteria, stop: ObservedStop
) -> Decision | None:
    """Return the decision on a criterion that its measure has no part in; None where it has.

    That is where it does not apply, or may not apply, and where its measure was never observed.
    """
    if criterion.needs_series:
        return Decision("not_applicable", None, _OVER_A_SERIES)
    conditions, measure = stop.conditions, MEASURES[criterion.measure]
    unknown = "" if stop.coverage is None else stop.coverage.no_initial_speed
    initial_speed = None if unknown else stop.measures.initial_speed

    def unmet_by(other: scenario.Criterion) -> list[UnmetCondition]:
        return unmet_conditions(other.applies, conditions, initial_speed)

    if unmet := unmet_by(criterion):
        # Another test of that kind, whose validity nothing in the profile judges.
        of_validity = (each for each in profile.criteria if each.layer == "validity")
        same = [each for each in of_validity if each.measure == criterion.measure]
        of_kind = criterion.layer == "validity" and all(each.tells_tests_apart for each in unmet)
        status: Status = "inconclusive" if of_kind and all(map(unmet_by, same)) else "not_applicable"
        words = [each.no_such_test if status == "inconclusive" else str(each) for each in unmet]
        return Decision(status, None, "; ".join(words))
    if stop.no_stopping and (measure.of_standstill or (conditions.drag and measure.of_braking)):
        # What would have shown that it is a test is missing.
        status = "inconclusive" if criterion.layer == "validity" else "not_applicable"
        return Decision(status, None, stop.no_stopping)
    if measure.of_simulation and stop.coverage is not None:
        return Decision("not_applicable", None, "a balance of the simulation: a recorded stop has none")
    if stop.coverage is not None and (absent := stop.coverage.not_computed.get(criterion.measure)):
        return Decision("not_applicable", None, f"not recorded: {absent}", lacks_data=True)
    if unknown and criterion.applies.initial_speed is not None:
        return Decision("inconclusive", None, unknown)
    if measure.of_faults and conditions.has_faults and math.isnan(stop.measures.fault_time):
        return Decision("inconclusive", None, "no fault of the scenario began while the train moved")
    if criterion.measure == "compensation_misfit" and math.isnan(stop.measures.compensation_misfit):
        return Decision("inconclusive", None, _NO_RIG)
    if "moving_speed" in measure.observed_by and not unknown:
        # Its zero says nothing: the deceleration is kept from the first sample at this speed on.
        moving = stop.resolved.measures.moving_speed
        if stop.measures.initial_speed < moving and math.isnan(stop.measures.maximum_deceleration):
            reason = f"the train never reached `moving_speed` ({moving.text}), above which this is observed"
            return Decision("not_applicable", None, reason)
    return None


def _sensitivities(
    criterion: scenario.Criterion, stated: dict[str, float], decide_with: Decide
) -> Iterator[Sensitivity]:
    for name, parameter in criterion.definition.parameters().items():

        def at(value: float, name: str = name) -> Decision:
            return decide_with({**stated, name: value}, explained=False)

        lower, upper = parameter.range
        yield sensitivity(name, parameter.unit, lower, upper, parameter.step, at)


def verdict_of(criterion: scenario.Criterion, bounds: Bounds, decision: Decision) -> Verdict:
    """Return a decision as a verdict, without definitions and what depends on them."""
    return Verdict(
        id=criterion.id,
        layer=criterion.layer,
        value=decision.value,
        unit=bounds.unit,
        lower=bounds.lower,
        upper=bounds.upper,
        margin=None if decision.value is None else bounds.margin(decision.value),
        status=decision.status,
        reason=decision.reason,
        measure=criterion.measure,
        requirements=criterion.requirements,
        missed_by=decision.missed_by,
        in_valid_test=criterion.in_valid_test,
        lacks_data=decision.lacks_data,
    )


def definition_texts(
    criterion: scenario.Criterion, profile: scenario.Criteria, resolved: scenario.Scenario
) -> dict[str, str]:
    """Return clause, measure, bound, aggregation and every definition of a verdict, as text for people.

    Definitions of the criterion come with their range. Those of the scenario's `measures`, which turned
    samples into measures while the stop was observed, and what a measure is corrected for have none.
    """
    return _definition_texts_and_numbers(criterion, profile, resolved)[0]


def _definition_texts_and_numbers(
    criterion: scenario.Criterion, profile: scenario.Criteria, resolved: scenario.Scenario
) -> tuple[dict[str, str], tuple[AppliedDefinition, ...]]:
    """Return the definitions of a verdict as text, and under the same names those that are numbers."""
    bound = bounds_of(criterion).text
    if criterion.of_dry_stop:
        bound = f"{bound} of the dry stop"
    texts = {"clause": criterion.clause, "measure": criterion.meaning, "bound": bound}
    if aggregation := criterion.aggregation:
        texts["wheelsets"] = aggregation
    if criterion.readings:
        source = profile.sources.get(criterion.reading_source)
        texts["reading"] = f"{criterion.reading} ({f'{source.mark}: {source.text}' if source else 'user'})"
    numbers = []
    for name, parameter in criterion.definition.parameters().items():
        mark, unit = scenario.mark_of(parameter.value, profile.sources), parameter.unit
        ends = tuple(map(float, parameter.range))
        in_unit = all_in_unit((parameter.value, *ends), unit)
        value, lower, upper = (value_text(number, unit) for number in in_unit)
        texts[name] = f"{value} ({mark}; range {lower} .. {upper})"
        numbers.append(AppliedDefinition(name, float(parameter.value), parameter.value.unit, mark, *ends))
    if criterion.corrected:
        texts["correction"] = CORRECTION
    for name, quantity, mark in scenario.observed_quantities(criterion, profile, resolved):
        texts[name] = f"{quantity.text} ({mark})"
        numbers.append(AppliedDefinition(name, float(quantity), quantity.unit, mark))
    return texts, tuple(numbers)


_SATURATIONS: Final = ("loadcell_saturation", "pressure_saturation")


def why_rig_fails(
    criterion: scenario.Criterion, resolved: scenario.Scenario, measures: Any, wheelsets: Sequence[Any]
) -> str:
    """Return the limited sensors, or the misfits of the compensation, in words; else an empty text."""
    if criterion.measure == "compensation_misfit":
        misfits = scenario.misfits(resolved)
        return "; ".join((*map(str, misfits), scenario.FIT_HINT)) if misfits else ""
    if criterion.measure not in _SATURATIONS:
        return ""
    limited = list(_limited_sensors(criterion.measure, resolved, measures, wheelsets))
    other_sensor = next(measure for measure in _SATURATIONS if measure != criterion.measure)
    both = any(_limited_sensors(other_sensor, resolved, measures, wheelsets))
    first = "the first of any kind" if both else "the first"
    return f"{'; '.join(limited)}; {first} by {value_text(float(measures.saturation_time), 's')}"


def _limited_sensors(
    measure: str, resolved: scenario.Scenario, measures: Any, wheelsets: Sequence[Any]
) -> Iterator[str]:
    sensors = resolved.rig.sensors
    of_force = measure == "loadcell_saturation"
    what, reach = (
        ("loadcells", sensors.loadcell.range) if of_force else ("pressure sensor", sensors.pressure.range)
    )
    times = {f"wheelset {n}": float(getattr(each, measure)) for n, each in enumerate(wheelsets, start=1)}
    if not of_force:
        times["the brake line"] = float(measures.line_saturation)
    for sensor_location, time in times.items():
        if time > 0.0:
            yield f"{what} of {sensor_location} limited to {reach.text} for {value_text(time, 's')}"


def missed_deadlines(times: ResponseTimes | None) -> Iterator[Verdict]:
    """Yield the verdict that a stop with missed deadlines is invalid; nothing where there are none."""
    if times is not None and times.missed_deadlines > 0:
        missed = float(times.missed_deadlines)
        yield Verdict(
            id="real-time",
            layer="rig",
            value=missed,
            unit="1",
            lower=None,
            upper=0.0,
            margin=-missed,
            status="fail",
            reason=f"{times.missed_deadlines} of {times.answers} answers came after the end of their cycle of"
            f" {1e3 * times.cycle_time_s:g} ms; the longest took {1e3 * times.longest_answer_s:.3g} ms"
            f" (cycle {times.longest_answer_cycle})",
        )

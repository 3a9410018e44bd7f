"""Criteria applied to the measures of a stop."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final, Literal

from uictest.core.measures import StopMeasures, Wheelsets
from uictest.judging.evaluation.bounds import (
    Bounds,
    Coverage,
    ObservedStop,
    bounds_of,
    why_cut_off,
    why_no_stopping,
)
from uictest.judging.evaluation.decision import Decision, decide, sensitivity
from uictest.judging.evaluation.definitions import applied_definitions, definition_texts
from uictest.judging.evaluation.rig_reasons import why_rig_fails
from uictest.judging.evaluation.verdict import (
    NOT_RECORDED,
    READINGS,
    ReadVerdict,
    Sensitivity,
    Status,
    Verdict,
    VerdictInterval,
)
from uictest.plans import scenario
from uictest.plans.scenario import (
    TestConditions,
    UnmetCondition,
    test_conditions_of,
    unmet_conditions,
)

DecideBy = Callable[[scenario.Criterion, Mapping[str, float]], Decision]
"""Decides a criterion that applies, or what it is by another reading, with given definitions (SI)."""
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
    conditions = test_conditions_of(resolved)
    cut_off = why_cut_off(resolved, measures, coverage)
    stop = ObservedStop(measures, wheelset_measures, cut_off, coverage, why_no_stopping(resolved), resolved)
    verdicts = []
    for profile in resolved.judged_by if coverage is None else resolved.criteria:
        for criterion in profile.criteria:
            verdict = _judge(criterion, profile, conditions, stop, resolved.measures, detail=detail)
            if verdict.layer == "rig" and verdict.status == "fail":
                why = why_rig_fails(criterion, resolved, measures, list(wheelset_measures))
                verdict = replace(verdict, reason=why or verdict.reason)
            if detail == "full":
                verdict = with_definitions(verdict, criterion, profile, resolved)
            verdicts.append(verdict)
    return verdicts


def _judge(
    criterion: scenario.Criterion,
    profile: scenario.Criteria,
    conditions: TestConditions,
    stop: ObservedStop,
    observation: scenario.MeasureDefinitions,
    *,
    detail: Detail,
) -> Verdict:
    bounds = bounds_of(criterion)
    decided = undecided(criterion, profile, conditions, stop, observation)
    if decided is not None:
        return verdict_of(criterion, bounds, decided)

    def decide_by(read: scenario.Criterion, definition: Mapping[str, float]) -> Decision:
        if read is criterion:
            return decide(criterion, bounds, definition, stop)
        without_value = undecided(read, profile, conditions, stop, observation)
        return without_value or decide(read, bounds_of(read), definition, stop)

    return verdict_by(criterion, bounds, decide_by, detail=detail)


def verdict_by(
    criterion: scenario.Criterion,
    bounds: Bounds,
    decide_by: DecideBy,
    *,
    detail: Detail,
) -> Verdict:
    """Return the verdict of a criterion that applies, without definitions."""
    stated = criterion.definition.stated()
    decision = decide_by(criterion, stated)
    verdict = verdict_of(criterion, bounds, decision)
    explains = detail == "full" and decision.status != "inconclusive"
    if explains:
        verdict = replace(verdict, sensitivity=tuple(_sensitivities(criterion, stated, decide_by)))
    if detail == "status" or not criterion.readings:
        return verdict
    readings = tuple(_readings(criterion, verdict, decide_by, detail))
    turns = [_over_readings(readings)] if explains else []
    return replace(verdict, readings=readings, sensitivity=(*verdict.sensitivity, *turns))


def _readings(
    criterion: scenario.Criterion, own: Verdict, decide_by: DecideBy, detail: Detail
) -> Iterator[ReadVerdict]:
    """Yield what each reading says: that of the criterion itself, which decides, then the others."""
    yield _read_verdict(criterion.reading, replace(own, sensitivity=()), decides=True)
    for reading in criterion.readings:
        read = criterion.read_as(reading)
        verdict = verdict_by(read, bounds_of(read), decide_by, detail=detail)
        yield _read_verdict(reading.id, verdict, decides=False)


def _read_verdict(reading: str, verdict: Verdict, *, decides: bool) -> ReadVerdict:
    return ReadVerdict(reading, decides, **{name: getattr(verdict, name) for name in _READ})


def by_reading(verdict: Verdict, reading: ReadVerdict) -> Verdict:
    """Return what a criterion says by one of its readings, with an id such as `slide read as depth`."""
    read = {name: getattr(reading, name) for name in _READ}
    return replace(verdict, id=f"{verdict.id} read as {reading.id}", readings=(), over_stops=None, **read)


def _over_readings(readings: Sequence[ReadVerdict]) -> Sensitivity:
    """Return the readings as the range of a definition: the verdict flips where they do not all agree."""
    intervals = (VerdictInterval(k, k, each.status, each.id) for k, each in enumerate(readings, start=1))
    return Sensitivity(READINGS, "", 1, len(readings), tuple(intervals))


def with_definitions(
    verdict: Verdict,
    criterion: scenario.Criterion,
    profile: scenario.Criteria,
    resolved: scenario.Scenario,
) -> Verdict:
    """Return a verdict with the definitions that it depends on."""
    return replace(
        verdict,
        definition=definition_texts(criterion, profile, resolved),
        definitions=applied_definitions(criterion, profile, resolved),
        readings=tuple(_defined_readings(verdict.readings, criterion, profile, resolved)),
    )


def _defined_readings(
    readings: Sequence[ReadVerdict],
    criterion: scenario.Criterion,
    profile: scenario.Criteria,
    resolved: scenario.Scenario,
) -> Iterator[ReadVerdict]:
    """Yield what each reading says with its source and, but for the deciding one, its definitions."""
    others = {each.id: each for each in criterion.readings}
    for read in readings:
        other = others.get(read.id)
        source = profile.sources.get(other.source if other else criterion.reading_source)
        texts = definition_texts(criterion.read_as(other), profile, resolved) if other else {}
        mark, text = (source.mark, source.text) if source else ("user", "")
        yield replace(read, mark=mark, source=text, definition=texts)


def undecided(
    criterion: scenario.Criterion,
    profile: scenario.Criteria,
    conditions: TestConditions,
    stop: ObservedStop,
    observation: scenario.MeasureDefinitions,
) -> Decision | None:
    """Return the decision on a criterion that its measure has no part in; None where it has."""
    if criterion.needs_series:
        return Decision("not_applicable", None, _OVER_A_SERIES)
    return _not_applicable(criterion, profile, conditions, stop) or _unobserved(criterion, observation, stop)


def _not_applicable(
    criterion: scenario.Criterion, profile: scenario.Criteria, conditions: TestConditions, stop: ObservedStop
) -> Decision | None:
    """Return the decision on a criterion that does not apply, or may not apply; None where it applies."""
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
    if stop.no_stopping and (criterion.of_standstill or (conditions.drag and criterion.of_braking)):
        # What would have shown that it is a test is missing.
        status = "inconclusive" if criterion.layer == "validity" else "not_applicable"
        return Decision(status, None, stop.no_stopping)
    if criterion.of_simulation and stop.coverage is not None:
        return Decision("not_applicable", None, "a balance of the simulation: a recorded stop has none")
    if stop.coverage is not None and (absent := stop.coverage.not_computed.get(criterion.measure)):
        return Decision("not_applicable", None, NOT_RECORDED + absent)
    if unknown and criterion.applies.initial_speed is not None:
        return Decision("inconclusive", None, unknown)
    if criterion.of_faults and conditions.has_faults and math.isnan(stop.measures.fault_time):
        return Decision("inconclusive", None, "no fault of the scenario began while the train moved")
    if criterion.measure == "compensation_misfit" and math.isnan(stop.measures.compensation_misfit):
        return Decision("inconclusive", None, _NO_RIG)
    return None


def _unobserved(
    criterion: scenario.Criterion, observation: scenario.MeasureDefinitions, stop: ObservedStop
) -> Decision | None:
    """Return the decision on a measure that was never observed: its zero says nothing; else None."""
    if stop.coverage is not None and stop.coverage.no_initial_speed:
        return None
    moving_speed = observation.moving_speed
    if "moving_speed" not in criterion.observed_by:
        return None
    # The deceleration is kept from the first sample at this speed on.
    if stop.measures.initial_speed < moving_speed and math.isnan(stop.measures.maximum_deceleration):
        reason = f"the train never reached `moving_speed` ({moving_speed.text}), above which this is observed"
        return Decision("not_applicable", None, reason)
    return None


def _sensitivities(
    criterion: scenario.Criterion,
    stated: dict[str, float],
    decide_by: DecideBy,
) -> Iterator[Sensitivity]:
    for name, parameter in criterion.definition.parameters().items():

        def at(value: float, name: str = name) -> Decision:
            return decide_by(criterion, {**stated, name: value})

        lower, upper = parameter.range
        yield sensitivity(name, parameter.unit, lower, upper, parameter.step, at)


def verdict_of(criterion: scenario.Criterion, bounds: Bounds, decision: Decision) -> Verdict:
    """Return a decision as a verdict, without definitions and what depends on them."""
    return Verdict(
        id=criterion.id,
        layer=criterion.layer,
        value=decision.value,
        unit=criterion.unit,
        lower=bounds.lower,
        upper=bounds.upper,
        margin=_margin(decision, bounds),
        status=decision.status,
        reason=decision.reason,
        measure=criterion.measure,
        requirements=criterion.requirements,
        missed_by=decision.missed_by,
        in_valid_test=criterion.in_valid_test,
    )


def _margin(decision: Decision, bounds: Bounds) -> float | None:
    return None if decision.value is None else bounds.margin(decision.value)

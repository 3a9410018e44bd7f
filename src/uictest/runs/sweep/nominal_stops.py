"""Run the nominal case of a sweep, whose deceleration K_dry is a share of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from uictest import report
from uictest.analysis import summaries
from uictest.judging import evaluation
from uictest.plans import sweeps
from uictest.running import campaign
from uictest.runs.sweep.run import SweepRun


def with_nominal_stops(run: SweepRun, result: report.SweepResult) -> report.SweepResult:
    """Return the result of a sweep with K_dry over the nominal deceleration, where the file states none.

    A note names each nominal case without a deceleration. Raises KeyboardInterrupt if interrupted.
    """
    if not result.k_dry or result.k_dry[0].nominal_is_stated:
        return result
    stops = _nominal_stops(run)
    tables = zip(result.k_dry, stops, strict=True)
    k_dry = tuple(table.over((stop.measures or {}).get(table.measure)) for table, stop in tables)
    notes = [
        f"no K_dry: the nominal case {stop.id} has no {table.measure}: {stop.outcome}, {stop.reason}"
        for table, stop in zip(k_dry, stops, strict=True)
        if table.nominal is None
    ]
    return replace(result, k_dry=k_dry, notes=(*result.notes, *notes))


def _nominal_stops(run: SweepRun) -> Sequence[evaluation.CaseResult]:
    plan = sweeps.nominal_plan(run.selection.plan)
    cases = summaries.full_cases(plan, range(plan.size))
    batch = campaign.run_cases(
        cases,
        jobs=run.jobs,
        recording=campaign.RecordingRequest("none"),
        parts=campaign.parts_of_cases(cases),
        in_process=run.in_process,
    )
    if batch.interrupted:
        raise KeyboardInterrupt
    return batch.results

"""Publish a finished sweep: its result, its worst and nominal cases, its reports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from uictest import report
from uictest.analysis import summaries
from uictest.core import files
from uictest.judging import evaluation
from uictest.plans import sweeps
from uictest.running import campaign, chunked
from uictest.runs.sweep.run import SweepObserver, SweepRun, prepared_runner


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


@dataclass(frozen=True, slots=True)
class FinishedSweep:
    """A sweep whose results are written.

    Args:
        result: of the sweep.
        document: the text of sweep.json.
        content: what its reports show.

    """

    result: report.SweepResult
    document: str
    content: report.SweepContent


def publish(run: SweepRun, store: chunked.ChunkStore, observer: SweepObserver) -> FinishedSweep:
    """Write the result of a finished sweep and its reports. Raises OSError, and MissingChunksError."""
    files.begin_list(store.folder)
    summary = summaries.summarize(
        run.selection, store, run.pair, run.measures, run.reference, csv=run.writes_csv
    )
    frontier = None if run.search is None else _frontier(run, summary, run.search, observer)
    worst, subjects = _run_worst(run, summary, store.folder)
    result = replace(summary.result, frontier=frontier, worst=worst, subjects=subjects)
    result = with_nominal_stops(run, result)
    document = report.write_sweep_result(store.folder, result, run.selection.plan.file)
    content = report.read_sweep(store.folder, traces=report.draws_stops(run.reports))
    report.write_sweep_formats(store.folder, content, run.reports)
    store.remove_partial_files()
    return FinishedSweep(result, document, content)


def _run_worst(
    run: SweepRun, summary: summaries.SweepSummary, folder: Path
) -> tuple[tuple[evaluation.CaseResult, ...], Mapping[str, report.CaseDescription]]:
    """Run the worst cases again as their rows were, with explanations, and write their recordings.

    Return their results, and their descriptions by id. Raises OSError, and KeyboardInterrupt if interrupted.
    """
    cases = summaries.full_cases(run.selection.plan, summary.worst_indices, summary.surveyed)
    files.remove_listed(folder, f"{report.RECORDINGS}/*")

    def write_recording(case_run: campaign.CaseRun) -> None:
        if case_run.recording is not None:
            report.write_recording(folder, case_run.result.id, case_run.recording)

    request = campaign.RecordingRequest("all")
    request = replace(request, every=min(request.every, campaign.shortest_cycle(cases)))
    parts = campaign.parts_of_cases(cases)
    domains = {} if run.reference is None else run.reference.domains_of(parts)
    batch = campaign.run_cases(
        cases,
        jobs=run.jobs,
        recording=request,
        parts=parts,
        domains=domains,
        in_process=run.in_process,
        on_result=write_recording,
    )
    if batch.interrupted:
        raise KeyboardInterrupt
    return tuple(batch.results), campaign.descriptions_of(cases)


def _frontier(
    run: SweepRun, summary: summaries.SweepSummary, search: summaries.FrontierSearch, observer: SweepObserver
) -> report.Frontier:
    observer.searching(search.key)
    runner = prepared_runner(run, observer)
    scans = search.run(
        summary.verdicts, lambda plan, indices: summaries.verdicts_of(plan, indices, runner, run.jobs)
    )
    return report.Frontier(search.key, tuple(scans))

"""Publish a finished sweep: its result, its worst cases, its reports."""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from uictest import campaign, evaluation, recording, report, sweep
from uictest.cli.output import message
from uictest.cli.sweep.nominal_stops import with_nominal_stops
from uictest.cli.sweep.run import SweepRun, prepared_runner


def publish(run: SweepRun, store: sweep.ChunkStore) -> tuple[report.SweepResult, str, report.SweepContent]:
    """Write the result of a finished sweep; return it, its document, and the content of reports.

    Raises OSError, and MissingChunksError.
    """
    summary = sweep.summarize(run.selection, store, run.pair, run.measures)
    frontier = None if run.search is None else _frontier(run, summary, run.search)
    worst, subjects = _run_worst(run, summary.worst_indices, store.folder)
    result = replace(summary.result, frontier=frontier, worst=worst, subjects=subjects)
    result = with_nominal_stops(run, result)
    file = run.selection.plan.file
    document = report.write_sweep_result(store.folder, result, file)
    content = _write_reports(run, store.folder)
    if run.junit is not None:
        recording.write_text_atomic(run.junit, report.sweep_junit_xml(result, file))
    store.remove_partial_files()
    return result, document, content


def _write_reports(run: SweepRun, folder: Path) -> report.SweepContent:
    content = report.read_sweep(folder, traces=report.draws_stops(run.formats))
    report.write_sweep_formats(folder, content, run.formats)
    # The results are written already: a failure to write the step summary does not undo them.
    try:
        report.append_sweep_step_summary(content)
    except OSError as error:
        message(f"uictest: GITHUB_STEP_SUMMARY cannot be written: {error}")
    return content


def _run_worst(
    run: SweepRun, indices: Sequence[int], folder: Path
) -> tuple[tuple[evaluation.CaseResult, ...], Mapping[str, report.CaseDescription]]:
    """Run the worst cases again with explanations, and write their recordings next to the tables.

    Return their results, and their descriptions by id. Raises OSError, and KeyboardInterrupt if interrupted.
    """
    cases = sweep.full_cases(run.selection.plan, indices)
    shutil.rmtree(folder / report.RECORDINGS, ignore_errors=True)

    def write_recording(case_run: campaign.CaseRun) -> None:
        if case_run.recording is not None:
            report.write_recording(folder, case_run.result.id, case_run.recording)

    request = campaign.RecordingRequest("all")
    request = replace(request, every=min(request.every, campaign.shortest_cycle(cases)))
    parts = campaign.parts_of_cases(cases)
    batch = campaign.run_cases(
        cases,
        jobs=run.jobs,
        recording=request,
        parts=parts,
        in_process=run.in_process,
        on_result=write_recording,
    )
    if batch.interrupted:
        raise KeyboardInterrupt
    return tuple(batch.results), campaign.descriptions_of(cases)


def _frontier(run: SweepRun, summary: sweep.SweepSummary, search: sweep.FrontierSearch) -> report.Frontier:
    if not run.quiet:
        message(f"uictest: searching the frontier along {search.key}")
    runner = prepared_runner(run)
    scans = search.run(
        summary.verdicts, lambda plan, indices: sweep.verdicts_of(plan, indices, runner, run.jobs)
    )
    return report.Frontier(search.key, tuple(scans))

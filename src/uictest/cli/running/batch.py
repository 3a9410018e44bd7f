"""A batch of cases from simulation to the published reports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from time import perf_counter

from uictest import campaign, comparison, recording, report, rig, scenario
from uictest.cli.output import message
from uictest.cli.progress import announce_compilation, announce_in_process, progress
from uictest.cli.running.display import Display
from uictest.cli.running.drawing import TraceCollection


@dataclass(frozen=True, slots=True)
class Batch:
    """Cases to run, options of the run, and the places of the reports."""

    cases: Sequence[scenario.Case]
    parts: campaign.PartsOfCases
    manifest: report.RunManifest
    recording: campaign.RecordingRequest
    jobs: int
    maxfail: int | None
    output: Path
    junit: Path | None
    formats: Sequence[str]
    quiet: bool
    verbose: bool
    in_process: bool = False
    real_time: bool = False
    baseline: comparison.Baseline | None = None
    """The baseline to compare with, if any."""


@dataclass(frozen=True, slots=True)
class Published:
    """A run whose reports are written: their folder, their content, and the text of results.json."""

    place: Path
    content: report.RunContent
    document: str


def run_batch(batch: Batch, display: Display) -> tuple[campaign.BatchResult, Published | None]:
    """Run a batch and publish its reports; after an interruption, those of the finished cases.

    Returns the results, and the published run, None if no case is finished. Raises OSError if the reports
    cannot be written, and removes those that were.
    """
    started = perf_counter()
    # The folder comes first: if it cannot be written, nothing should be simulated.
    with report.RunFolder(batch.output, report.run_name(datetime.now(UTC), batch.manifest)) as folder:
        drawing = TraceCollection(
            batch.cases,
            batch.recording,
            needed=report.draws_stops(batch.formats),
            repeatable=all(case.scenario.controller.program is None for case in batch.cases),
        )
        done = _simulate(batch, folder.path, display, drawing)
        if not done.results:
            message("uictest: interrupted before the first case was finished; there is nothing to report")
            return done, None
        traces = drawing.finish(done, batch.jobs)
        content, document = _write_reports(batch, folder, done, traces)
        place = folder.publish()
    report.point_latest(place)
    _append_step_summary(content)
    _write_junit(batch.junit, content)
    display.end(content, document)
    if not batch.quiet:
        _sum_up(batch, content, done, perf_counter() - started, place)
    return done, Published(place, content, document)


def _write_reports(
    batch: Batch, folder: report.RunFolder, done: campaign.BatchResult, traces: Mapping[str, report.PlotTrace]
) -> tuple[report.RunContent, str]:
    """Write all reports; return their content and the text of results.json."""
    complete = len(done.results) == len(batch.cases)
    subjects = campaign.descriptions_of(batch.cases)
    content = report.RunContent(folder.name, done.results, batch.manifest, complete, subjects, traces)
    if batch.baseline is not None:
        content = replace(content, baseline=batch.baseline.compare(content))
    document = report.write_reports(folder.path, content)
    report.write_formats(
        folder.path, content, [each for each in batch.formats if each not in report.IN_EVERY_RUN]
    )
    return content, document


def _append_step_summary(content: report.RunContent) -> None:
    # The run is published already: a failure to write the summary does not undo it.
    try:
        report.append_step_summary(content)
    except OSError as error:
        message(f"uictest: GITHUB_STEP_SUMMARY cannot be written: {error}")


def _simulate(batch: Batch, folder: Path, display: Display, drawing: TraceCollection) -> campaign.BatchResult:
    foreign = any(case.scenario.controller.program for case in batch.cases)
    announce_in_process(foreign=batch.in_process and foreign, quiet=batch.quiet)
    announce_compilation(warm=rig.is_compiled(batch.cases), quiet=batch.quiet)
    with progress(len(batch.cases), quiet=batch.quiet) as advance:

        def publish(case_run: campaign.CaseRun) -> None:
            drawing.add(case_run)
            if case_run.recording is not None and batch.recording.wants(case_run.result):
                report.write_recording(folder, case_run.result.id, case_run.recording)
            display.case(case_run.result, _differences(batch, case_run))
            if batch.verbose and case_run.traceback:
                message(case_run.traceback.rstrip())
            advance()

        return campaign.run_cases(
            batch.cases,
            jobs=batch.jobs,
            recording=drawing.recording,
            maxfail=batch.maxfail,
            parts=batch.parts,
            in_process=batch.in_process,
            real_time=batch.real_time,
            on_result=publish,
        )


def _differences(batch: Batch, case_run: campaign.CaseRun) -> Sequence[report.Difference]:
    return () if batch.baseline is None else batch.baseline.differences(case_run.result)


def _write_junit(path: Path | None, content: report.RunContent) -> None:
    if path is not None:
        recording.write_text_atomic(path, report.junit_xml(content.results, content.baseline))


def _sum_up(
    batch: Batch, content: report.RunContent, done: campaign.BatchResult, seconds: float, place: Path
) -> None:
    ended = "interrupted, " if done.interrupted else ""
    remaining = len(batch.cases) - len(done.results)
    not_run = f", {remaining} not run" if remaining else ""
    message(f"uictest: {ended}{content.tally}{not_run} in {seconds:.1f} s; reports in {place}")

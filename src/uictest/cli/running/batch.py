"""A batch of cases from simulation to the published reports."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from time import perf_counter

from uictest import campaign, comparison, evaluation, recording, report, rig, scenario, series
from uictest.cli.output import message
from uictest.cli.progress import announce_compilation, announce_in_process, progress
from uictest.cli.running.display import Display
from uictest.cli.running.drawing import TraceCollection
from uictest.cli.running.series_runs import SeriesBatch, run_series


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
    series: Sequence[series.Series] = ()

    @property
    def all_cases(self) -> list[scenario.Case]:
        """All cases, those of series too."""
        return [*self.cases, *(case for each in self.series for case in each.cases)]


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
            batch.all_cases,
            batch.recording,
            needed=report.draws_stops(batch.formats),
            repeatable=all(case.scenario.controller.program is None for case in batch.all_cases),
        )
        done = _simulate(batch, batch.cases, folder.path, display.case, drawing, batch.maxfail)
        judged = _run_series(batch, done, folder.path, display, drawing)
        if not (done.results or judged.results):
            message("uictest: interrupted before the first case was finished; there is nothing to report")
            return done, None
        content, document = _write_reports(batch, folder, done, judged, drawing)
        place = folder.publish()
    report.point_latest(place)
    _append_step_summary(content)
    _write_junit(batch.junit, content)
    display.end(content, document)
    if not batch.quiet:
        _sum_up(batch, content, done, perf_counter() - started, place)
    return done, Published(place, content, document)


def _run_series(
    batch: Batch, done: campaign.BatchResult, folder: Path, display: Display, drawing: TraceCollection
) -> SeriesBatch:
    """Run the series of a batch behind its cases, unless these end it."""
    missed = sum(not result.met for result in done.results)
    if done.interrupted or (batch.maxfail is not None and missed >= batch.maxfail):
        return SeriesBatch()

    def show(result: evaluation.CaseResult, differences: Sequence[report.Difference] = ()) -> None:
        if batch.verbose:
            display.case(result, differences)

    judged = run_series(
        batch.series,
        lambda cases: _simulate(batch, cases, folder, show, drawing, None),
        maxfail=None if batch.maxfail is None else batch.maxfail - missed,
        show=display.series,
    )
    done.interrupted = judged.interrupted
    return judged


def _write_reports(
    batch: Batch,
    folder: report.RunFolder,
    done: campaign.BatchResult,
    judged: SeriesBatch,
    drawing: TraceCollection,
) -> tuple[report.RunContent, str]:
    """Write all reports; return their content and the text of results.json."""
    content = report.RunContent(
        folder.name,
        done.results,
        batch.manifest,
        complete=(len(done.results), len(judged.results)) == (len(batch.cases), len(batch.series)),
        subjects=campaign.descriptions_of(batch.all_cases),
        series=judged.results,
    )
    everything = campaign.BatchResult(content.all_results, done.interrupted)
    content = replace(content, traces=drawing.finish(everything, batch.jobs))
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


def _simulate(
    batch: Batch,
    cases: Sequence[scenario.Case],
    folder: Path,
    show: Callable[[evaluation.CaseResult, Sequence[report.Difference]], None],
    drawing: TraceCollection,
    maxfail: int | None,
) -> campaign.BatchResult:
    """Run some cases of a batch."""
    if not cases:
        return campaign.BatchResult()
    foreign = any(case.scenario.controller.program for case in cases)
    announce_in_process(foreign=batch.in_process and foreign, quiet=batch.quiet)
    announce_compilation(warm=rig.is_compiled(cases), quiet=batch.quiet)
    stops = sum(case.scenario.repeat for case in cases)
    unit = "stops" if stops > len(cases) else "cases"
    with progress(stops, quiet=batch.quiet, unit=unit) as advance:

        def publish(case_run: campaign.CaseRun) -> None:
            drawing.add(case_run)
            if case_run.recording is not None and batch.recording.wants(case_run.result):
                report.write_recording(folder, case_run.result.id, case_run.recording)
            show(case_run.result, _differences(batch, case_run))
            if batch.verbose and case_run.traceback:
                message(case_run.traceback.rstrip())

        return campaign.run_cases(
            cases,
            jobs=batch.jobs,
            recording=drawing.recording,
            maxfail=maxfail,
            parts=batch.parts,
            in_process=batch.in_process,
            real_time=batch.real_time,
            on_result=publish,
            on_stop=advance,
        )


def _differences(batch: Batch, case_run: campaign.CaseRun) -> Sequence[report.Difference]:
    return () if batch.baseline is None else batch.baseline.differences(case_run.result)


def _write_junit(path: Path | None, content: report.RunContent) -> None:
    if path is not None:
        recording.write_text_atomic(path, report.junit_xml(content.results, content.baseline, content.series))


def _sum_up(
    batch: Batch, content: report.RunContent, done: campaign.BatchResult, seconds: float, place: Path
) -> None:
    ended = "interrupted, " if done.interrupted else ""
    remaining = len(batch.all_cases) - len(content.all_results)
    not_run = f", {remaining} not run" if remaining else ""
    message(f"uictest: {ended}{content.tally}{not_run} in {seconds:.1f} s; reports in {place}")

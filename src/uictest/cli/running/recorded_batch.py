"""Recorded stops, from their files to the published reports."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

from uictest import campaign, evaluation, field_data, recording, report, scenario, series
from uictest.cli.output import message
from uictest.cli.recordings import each_file, stop_names
from uictest.cli.running.display import Display
from uictest.cli.running.series_runs import cases_of
from uictest.scenario import yaml
from uictest.units import KILOMETRE_PER_HOUR

CaseOfStop = Callable[[str, float], "scenario.Case"]
"""Returns the case that a recorded stop is judged as: from its name and its initial speed, m/s."""
_UNKNOWN_SPEED = 120.0 * KILOMETRE_PER_HOUR
"""m/s, for the scenario of a record whose speed cannot be used; its result is an error at any speed."""


@dataclass(frozen=True, slots=True)
class RecordedFile:
    """A file with a recorded stop.

    Args:
        path: of the file.
        name: of the stop in the reports.
        digest: SHA-256 of the file.
        stop: the stop in it; None where it cannot be used.
        defects: what is wrong with the record.

    """

    path: Path
    name: str
    digest: str
    stop: field_data.RecordedStop | None
    defects: tuple[field_data.Defect, ...]

    def case(self, case_of: CaseOfStop, inputs: dict[str, str]) -> scenario.Case:
        """Return the case that this stop is judged as; `inputs` are the other files read for it."""
        speed = _UNKNOWN_SPEED if self.stop is None else float(self.stop.recording["speed"][0])
        case = case_of(self.name, speed)
        shown = yaml.display_name(self.path)
        return replace(
            case, id=self.name, path=Path(shown), inputs={**case.inputs, **inputs, shown: self.digest}
        )


@dataclass(frozen=True, slots=True)
class RecordedBatch:
    """Recorded stops with the cases that they are judged as, and where their reports go.

    `recording` selects the cases whose samples are kept; `arguments` are those of the command line.
    """

    files: Sequence[RecordedFile]
    cases: Sequence[scenario.Case]
    arguments: Sequence[str]
    recording: campaign.RecordingRequest
    output: Path
    junit: Path | None
    series: Sequence[series.Series] = ()
    """Series whose stops, in this order, are all of the recorded ones; none where each stop is by itself."""


def read_files(paths: Sequence[Path], channel_map: field_data.ChannelMap) -> list[RecordedFile]:
    """Read every file. Raises InvalidInputError with the errors of all files that cannot be read."""

    def read(path: Path) -> RecordedFile:
        try:
            stop = field_data.stop_in(path, channel_map)
        except field_data.UnusableError as error:
            return RecordedFile(path, "", field_data.digest_of(path), None, error.defects)
        return RecordedFile(path, "", field_data.digest_of(path), stop, stop.defects)

    files = each_file(paths, read)
    return [replace(file, name=name) for file, name in zip(files, stop_names(paths), strict=True)]


def run_recorded(batch: RecordedBatch, display: Display) -> tuple[report.RunContent, Path]:
    """Judge every stop and publish the reports; return what they show and the folder. Raises OSError."""
    parts = campaign.parts_of_recorded(batch.cases)
    inputs = {name: digest for case in batch.cases for name, digest in case.inputs.items()}
    manifest = report.run_manifest(batch.arguments, None, inputs, len(batch.cases), parts.values())
    case_runs = [campaign.with_parts(case_run, parts) for case_run in _judge(batch)]
    return _publish(batch, case_runs, manifest, display)


def _judge_series(
    planned: Sequence[series.Series], results: Sequence[evaluation.CaseResult]
) -> list[series.SeriesResult]:
    """Return the series judged; `results` are those of all their stops, in order."""
    waiting = iter(results)
    return [
        series.judge_series(each, cases_of(each, list(itertools.islice(waiting, len(each.stops)))))
        for each in planned
    ]


def _judge(batch: RecordedBatch) -> list[campaign.CaseRun]:
    """Judge every stop; each result has the samples that it was judged by."""
    return [
        campaign.CaseRun(field_data.unusable_result(case, file.defects))
        if file.stop is None
        else campaign.CaseRun(*field_data.judge_recording(case, file.stop))
        for file, case in zip(batch.files, batch.cases, strict=True)
    ]


def _publish(
    batch: RecordedBatch,
    case_runs: Sequence[campaign.CaseRun],
    manifest: report.RunManifest,
    display: Display,
) -> tuple[report.RunContent, Path]:
    with report.RunFolder(batch.output, report.run_name(datetime.now(UTC), manifest)) as folder:
        content = _content(batch, folder.name, case_runs, manifest)
        _write_recordings(folder.path, case_runs, batch.recording)
        document = report.write_reports(folder.path, content)
        report.write_formats(folder.path, content, ["html"])
        place = folder.publish()
    report.point_latest(place)
    if batch.junit is not None:
        recording.write_text_atomic(batch.junit, report.junit_xml(content.results, series=content.series))
    for result in content.results:
        display.case(result)
    for judged in content.series:
        display.series(judged)
    display.end(content, document)
    return content, place


def _content(
    batch: RecordedBatch, name: str, case_runs: Sequence[campaign.CaseRun], manifest: report.RunManifest
) -> report.RunContent:
    descriptions = {
        case.id: field_data.recorded_description(case, file.stop)
        for file, case in zip(batch.files, batch.cases, strict=True)
    }
    traces = {
        each.result.id: report.trace_of(each.recording, each.result.criteria)
        for each in case_runs
        if each.recording is not None
    }
    results = [each.result for each in case_runs]
    content = report.RunContent(name, results, manifest, subjects=descriptions, traces=traces)
    if not batch.series:
        return content
    return replace(content, results=[], series=_judge_series(batch.series, results))


def _write_recordings(
    folder: Path, case_runs: Sequence[campaign.CaseRun], request: campaign.RecordingRequest
) -> None:
    for each in case_runs:
        if each.recording is not None and request.wants(each.result):
            report.write_recording(folder, each.result.id, each.recording)


def write_preparation(files: Sequence[RecordedFile]) -> None:
    """Write to stderr how each record was prepared, and its defects."""
    for file in files:
        if file.stop is not None:
            choices = "; ".join(f"{name}: {text}" for name, text in file.stop.choices.items())
            message(f"uictest: {file.path}: {choices}")
        for defect in file.defects:
            message(f"uictest: {file.path}: {defect}")

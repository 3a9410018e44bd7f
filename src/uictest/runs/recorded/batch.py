"""Recorded stops, judged: what reports show of them."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from uictest import report
from uictest.core import recording
from uictest.judging import evaluation, series
from uictest.plans import scenario, series as series_plans
from uictest.recorded import field_data
from uictest.running import campaign
from uictest.runs.recorded.files import RecordedFile
from uictest.runs.series_runs import cases_of


@dataclass(frozen=True, slots=True)
class RecordedBatch:
    """Recorded stops with the cases that they are judged as; `arguments` are those of the command line."""

    files: Sequence[RecordedFile]
    cases: Sequence[scenario.Case]
    arguments: Sequence[str]
    series: Sequence[series_plans.Series] = ()
    """Series whose stops, in this order, are all of the recorded ones; none where each stop is by itself."""
    strict: bool = False
    """Whether a stop is met only if all of its verdicts are settled, too."""


@dataclass(frozen=True, slots=True)
class JudgedRecordings:
    """What reports show of recorded stops, and the samples that they were judged by, by id."""

    content: report.RunContent
    recordings: dict[str, recording.Recording] = field(default_factory=dict)

    def wanted(self, request: campaign.RecordingRequest) -> dict[str, recording.Recording]:
        """Return the recordings that a request asks for."""
        wanted = {result.id for result in self.content.all_results if request.wants(result)}
        return {name: samples for name, samples in self.recordings.items() if name in wanted}


def judge_recordings(batch: RecordedBatch) -> JudgedRecordings:
    """Judge every stop."""
    parts = campaign.parts_of_recorded(batch.cases)
    inputs = {name: digest for case in batch.cases for name, digest in case.inputs.items()}
    manifest = report.run_manifest(batch.arguments, None, inputs, len(batch.cases), parts.values())
    judged = [campaign.with_parts(case_run, parts) for case_run in _judge(batch)]
    case_runs = [replace(each, result=replace(each.result, strict=batch.strict)) for each in judged]
    recordings = {each.result.id: each.recording for each in case_runs if each.recording is not None}
    return JudgedRecordings(_content(batch, case_runs, manifest), recordings)


def _judge(batch: RecordedBatch) -> list[campaign.CaseRun]:
    """Judge every stop; each result has the samples that it was judged by."""
    return [
        campaign.CaseRun(field_data.unusable_result(case, file.defects))
        if file.stop is None
        else campaign.CaseRun(*field_data.judge_recording(case, file.stop))
        for file, case in zip(batch.files, batch.cases, strict=True)
    ]


def _content(
    batch: RecordedBatch, case_runs: Sequence[campaign.CaseRun], manifest: report.RunManifest
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
    content = report.RunContent("", results, manifest, subjects=descriptions, traces=traces)
    if not batch.series:
        return content
    return replace(content, results=[], series=_judge_series(batch.series, results))


def _judge_series(
    planned: Sequence[series_plans.Series], results: Sequence[evaluation.CaseResult]
) -> list[series.SeriesResult]:
    """Return the series judged; `results` are those of all their stops, in order."""
    waiting = iter(results)
    return [
        series.judge_series(each, cases_of(each, list(itertools.islice(waiting, len(each.stops)))))
        for each in planned
    ]

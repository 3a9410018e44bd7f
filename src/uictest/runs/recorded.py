"""Recorded stops: the conditions that they are judged under, and the batch of them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from uictest import report
from uictest.core import recording
from uictest.plans import scenario as scenarios, series
from uictest.recorded import field_data
from uictest.running import campaign
from uictest.runs.batch import Batch, all_cases, run_batch
from uictest.runs.observer import Observer
from uictest.runs.recorded_files import CaseOfStop, RecordedFile


class MissingStatementsError(Exception):
    """A recording does not say what was tested, and nobody else does; `keys` are those to state."""

    def __init__(self, keys: Sequence[str]) -> None:
        self.keys = tuple(keys)
        super().__init__(*keys)


def case_of_stop(
    case: scenarios.Case | None, statements: Sequence[str], trusted: Sequence[Path] | None
) -> CaseOfStop:
    """Return the function that makes the case of a recording: as `case` states, or the statements alone.

    Raises MissingStatementsError if there is neither a case nor every statement that is needed.
    """
    if case is not None:
        return lambda name, speed: case
    keys = {statement.partition("=")[0].strip() for statement in statements}
    missing = [key for key in field_data.REQUIRED_STATEMENTS if key not in keys]
    if missing:
        raise MissingStatementsError(missing)
    return lambda name, speed: field_data.stated_case(name, speed, statements, trusted or ())


def recorded_batch(
    files: Sequence[RecordedFile],
    arguments: Sequence[str],
    *,
    cases: Sequence[scenarios.Case] = (),
    planned: Sequence[series.Series] = (),
    strict: bool = False,
) -> Batch:
    """Return the batch of recorded stops: of cases, or of the stops of series, in the order of the files.

    `arguments` are those of the command line; `strict` as for :class:`campaign.RunSettings`.
    """
    everything = all_cases(cases, planned)
    stops = {case.id: file for file, case in zip(files, everything, strict=True)}
    parts = campaign.parts_of_recorded(everything)
    inputs = {name: digest for case in everything for name, digest in case.inputs.items()}

    def judge(case: scenarios.Case) -> campaign.CaseRun:
        file = stops[case.id]
        if file.stop is None:
            return campaign.CaseRun(field_data.unusable_result(case, file.defects))
        return campaign.CaseRun(*field_data.judge_recording(case, file.stop))

    return Batch(
        cases,
        planned,
        report.run_manifest(arguments, None, inputs, len(everything), parts.values()),
        {case.id: field_data.recorded_description(case, stops[case.id].stop) for case in everything},
        campaign.RunSettings(recording=campaign.RecordingRequest("all"), strict=strict, parts=parts),
        judge=judge,
    )


def judge_recordings(batch: Batch) -> tuple[report.RunContent, dict[str, recording.Recording]]:
    """Judge every recorded stop; return what reports show, and the samples that each was judged by, by id."""
    recordings: dict[str, recording.Recording] = {}
    judged = run_batch(batch, Observer(), draws_stops=True, keep=recordings.__setitem__)
    return judged.content, recordings

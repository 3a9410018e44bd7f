"""Recorded stops: the conditions that they are judged under, and the batch of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from uictest import report
from uictest.core import recording
from uictest.plans import scenario as scenarios, series
from uictest.recorded import field_data
from uictest.running import campaign
from uictest.runs.batch import Batch, all_cases, run_batch
from uictest.runs.observer import Observer
from uictest.runs.recorded_files import CaseOfStop, RecordedFile, read_files, read_recorded_series
from uictest.runs.scenario_files import InvalidInputError, is_series


class Conditions(NamedTuple):
    """The map that recordings are read through, the files read for it, and the cases they are judged as."""

    channel_map: field_data.ChannelMap
    inputs: dict[str, str]
    case_of: CaseOfStop


def case_of_stop(
    case: scenarios.Case | None,
    statements: Sequence[str],
    trusted: Sequence[Path] | None,
    how: Callable[[Sequence[str]], str],
) -> CaseOfStop:
    """Return the function that makes the case of a recording: as `case` states, or the statements alone.

    Raises InvalidInputError if there is neither a case nor every statement that is needed; `how` says by what
    the missing keys are stated.
    """
    if case is not None:
        return lambda name, speed: case
    keys = {statement.partition("=")[0].strip() for statement in statements}
    missing = [key for key in field_data.REQUIRED_STATEMENTS if key not in keys]
    if missing:
        raise InvalidInputError(f"a recording does not say what was tested: state it with {how(missing)}")
    return lambda name, speed: field_data.stated_case(name, speed, statements, trusted or ())


def recorded_batch(
    paths: Sequence[Path],
    arguments: Sequence[str],
    conditions: Callable[[], Conditions],
    overrides: Sequence[str] | None,
    trusted: Sequence[Path] | None,
    *,
    stated: Iterable[object],
    option: str,
    strict: bool,
) -> tuple[Batch, list[RecordedFile]]:
    """Return the batch of recorded stops, and the files that were read for it in the order of its cases.

    `paths` are recordings, judged under `conditions`, or series, which say themselves what their stops are
    judged under: see :func:`read_recorded_series`. `arguments` are those of the command line; `strict` as for
    :class:`campaign.RunSettings`. Raises InvalidInputError, ScenarioErrors.
    """
    planned: Sequence[series.Series] = ()
    cases: Sequence[scenarios.Case] = ()
    if any(map(is_series, paths)):
        planned, files = read_recorded_series(paths, overrides, trusted, stated, option)
    else:
        of_all = conditions()
        files = read_files(paths, of_all.channel_map)
        cases = [file.case(of_all.case_of, of_all.inputs) for file in files]
    everything = all_cases(cases, planned)
    stops = {case.id: file for file, case in zip(files, everything, strict=True)}
    parts = campaign.parts_of_recorded(everything)
    inputs = {name: digest for case in everything for name, digest in case.inputs.items()}

    def judge(case: scenarios.Case) -> campaign.CaseRun:
        file = stops[case.id]
        if file.stop is None:
            return campaign.CaseRun(field_data.unusable_result(case, file.defects))
        return campaign.CaseRun(*field_data.judge_recording(case, file.stop))

    batch = Batch(
        cases,
        planned,
        report.run_manifest(arguments, None, inputs, len(everything), parts.values()),
        {case.id: field_data.recorded_description(case, stops[case.id].stop) for case in everything},
        campaign.RunSettings(recording=campaign.RecordingRequest("all"), strict=strict, parts=parts),
        judge=judge,
    )
    return batch, files


def judge_recordings(batch: Batch) -> tuple[report.RunContent, dict[str, recording.Recording]]:
    """Judge every recorded stop; return what reports show, and the samples that each was judged by, by id."""
    recordings: dict[str, recording.Recording] = {}
    judged = run_batch(batch, Observer(), draws_stops=True, keep=recordings.__setitem__)
    return judged.content, recordings

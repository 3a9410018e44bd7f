"""Recorded stops: the conditions that they are judged under, and the batch of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from uictest import report
from uictest.judging import evaluation
from uictest.plans import scenario, series
from uictest.recorded import field_data
from uictest.running import campaign
from uictest.runs.batch import Batch, all_cases
from uictest.runs.errors import InvalidInputError
from uictest.runs.recorded_files import CaseOfStop, RecordedFile, named_map, read_files
from uictest.runs.scenario_files import is_series, load_series


@dataclass(frozen=True, slots=True)
class RecordedStops:
    """Recorded stops to judge.

    Args:
        files: of the recordings, in the order of the cases and then of the stops of series.
        cases: that stops are judged as.
        series: with one stop for each recording.

    """

    files: Sequence[RecordedFile]
    cases: Sequence[scenario.Case] = ()
    series: Sequence[series.Series] = ()


def stops_in_recordings(
    paths: Sequence[Path],
    channel_map: field_data.ChannelMap,
    inputs: Mapping[str, str],
    case_of: CaseOfStop,
    *,
    found: bool = False,
) -> RecordedStops:
    """Return the stops in recordings; `inputs` are the files read for the channel map, `found` as above.

    Raises InvalidInputError where a recording cannot be read, ScenarioErrors.
    """
    files = read_files(paths, channel_map, found=found)
    return RecordedStops(files, [file.case(case_of, inputs) for file in files])


def stops_of_series(
    paths: Sequence[Path], overrides: Sequence[str] | None, trusted: Sequence[Path] | None
) -> RecordedStops:
    """Return the stops of series that name recordings.

    Raises InvalidInputError where a recording cannot be read, a stop names none or a path is none of a
    series; and ScenarioErrors.
    """
    if not all(map(is_series, paths)):
        raise InvalidInputError("name series files or recordings, not both")
    read = [_recorded(each, trusted) for each in load_series(paths, overrides, None, trusted)]
    return RecordedStops(
        [file for _, files in read for file in files], series=[planned for planned, _ in read]
    )


def require_nothing_stated(stated: Iterable[object], option: str) -> None:
    """Raise InvalidInputError if anything is stated of the recordings of series; `option` changes series."""
    if any(stated):
        raise InvalidInputError(
            "a series says itself which scenario and channel map each of its recordings has:"
            f" state it in the file, or with {option}"
        )


def _recorded(
    planned: series.Series, trusted: Sequence[Path] | None
) -> tuple[series.Series, list[RecordedFile]]:
    """Return a series whose stops are the recordings that its file names, and these."""
    stops: list[series.PlannedStop] = []
    files: list[RecordedFile] = []
    for stop in planned.stops:
        if stop.role == "bypassed":
            continue  # simulated beside simulated stops only
        own, inputs = _files_of(stop, trusted)
        named = [replace(file, name=f"{stop.case.id}.{file.name}") for file in own]
        stops += [_as_recorded(stop, file, inputs) for file in named]
        files += named
    _require_distinct_stops(planned, stops)
    _require_distinct_recordings(planned, files)
    return replace(planned, stops=tuple(stops)), files


def _as_recorded(stop: series.PlannedStop, file: RecordedFile, inputs: dict[str, str]) -> series.PlannedStop:
    """Return a stop as the one in a recording."""
    return replace(stop, rail="", case=file.case(lambda name, speed: stop.case, inputs))


def _files_of(
    stop: series.PlannedStop, trusted: Sequence[Path] | None
) -> tuple[list[RecordedFile], dict[str, str]]:
    """Return the recordings of a stop, and the files read besides them."""
    if stop.recorded is None:
        raise InvalidInputError(
            f"{stop.case.id} names no recording: list them under `recordings` of its stops, or"
            " simulate the series with 'uictest run'"
        )
    mapped, inputs = named_map(stop.recorded.channel_map, trusted)
    return read_files(stop.recorded.files, mapped), inputs


def _require_distinct_stops(planned: series.Series, stops: Sequence[series.PlannedStop]) -> None:
    seen: set[str] = set()
    for stop in stops:
        if stop.case.id in seen:
            raise InvalidInputError(f"{planned.path}: a second recorded stop {stop.case.id!r}")
        seen.add(stop.case.id)


def _require_distinct_recordings(planned: series.Series, files: Sequence[RecordedFile]) -> None:
    """Raise InvalidInputError for a copy of a recording: one stop counted twice would feign certainty."""
    first: dict[str, Path] = {}
    for file in files:
        if (path := first.setdefault(file.digest, file.path)) != file.path:
            raise InvalidInputError(f"{planned.path}: {file.path} is a copy of {path}: one stop counts once")


def case_of_stop(
    case: scenario.Case | None,
    statements: Sequence[str],
    trusted: Sequence[Path] | None,
    how: Callable[[Sequence[str]], str],
) -> CaseOfStop:
    """Return the function that makes the case of a recording: as `case` states, or the statements alone.

    Raises InvalidInputError if there is neither a case nor every statement that is needed; `how` says by what
    the missing keys are stated.
    """
    if case is not None:
        for key in ("until", "drag"):
            if getattr(case.scenario, key) is not None:
                raise InvalidInputError(
                    f"{case.path}: {key}: says how a stop is simulated, a recorded one is judged to its end:"
                    f" state --set {key}=null"
                )
        return lambda name, speed: case
    keys = {statement.partition("=")[0].strip() for statement in statements}
    missing = [key for key in field_data.REQUIRED_STATEMENTS if key not in keys]
    if missing:
        raise InvalidInputError(f"a recording does not say what was tested: state it with {how(missing)}")
    return lambda name, speed: field_data.stated_case(name, speed, statements, trusted or ())


def recorded_batch(
    stops: RecordedStops,
    arguments: Sequence[str],
    request: campaign.RecordingRequest,
    *,
    strict: bool,
    observe: Callable[[scenario.Case, field_data.RecordedStop, evaluation.CaseResult], None] | None = None,
) -> Batch:
    """Return the batch that judges recorded stops.

    `arguments` are those of the command line; `request` and `strict` as for :class:`campaign.RunSettings`;
    `observe` is called with every stop that was judged.
    """
    everything = all_cases(stops.cases, stops.series)
    files = {case.id: file for file, case in zip(stops.files, everything, strict=True)}
    parts = campaign.parts_of_recorded(everything)
    inputs = {name: digest for case in everything for name, digest in case.inputs.items()}

    def judge(case: scenario.Case) -> campaign.CaseRun:
        file = files[case.id]
        if file.stop is None:
            return campaign.CaseRun(evaluation.error_result(case, file.unusable))
        result, samples = field_data.judge_recording(case, file.stop)
        if observe is not None:
            observe(case, file.stop, result)
        return campaign.CaseRun(result, samples)

    return Batch(
        stops.cases,
        stops.series,
        report.run_manifest(arguments, None, inputs, len(everything), parts.values()),
        {case.id: field_data.recorded_description(case, files[case.id].stop) for case in everything},
        campaign.RunSettings(recording=request, strict=strict, parts=parts),
        judge=judge,
    )

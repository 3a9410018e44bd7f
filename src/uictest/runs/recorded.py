"""Recorded stops: the conditions that they are judged under, and the batch of them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from uictest import report
from uictest.core import recording
from uictest.core.recording import formats
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging import evaluation
from uictest.plans import scenario, series
from uictest.plans.scenario import yaml
from uictest.recorded import field_data
from uictest.running import campaign
from uictest.runs.batch import Batch, all_cases
from uictest.runs.scenario_files import InvalidInputError, is_series, load_series

CaseOfStop = Callable[[str, float], scenario.Case]
"""Returns the case that a recorded stop is judged as: from its name and its initial speed, m/s."""
Result = TypeVar("Result")
_UNKNOWN_SPEED = 120.0 * KILOMETRE_PER_HOUR
"""m/s, for the scenario of a record whose speed cannot be used; its result is an error at any speed."""
_UNSAFE = re.compile(r"[^A-Za-z0-9._-]+")
_LONGEST_NAME = 80
"""Letters of the name of a stop; chosen: names of files made of it stay below 255."""


@dataclass(frozen=True, slots=True)
class RecordedFile:
    """A file with a recorded stop.

    Args:
        path: path of the file.
        name: name of the stop in the reports.
        digest: SHA-256 of the file.
        stop: the stop in it; None where it cannot be used.
        defects: what is wrong with the record.
        unusable: why it cannot be used; empty where it can.

    """

    path: Path
    name: str
    digest: str
    stop: field_data.RecordedStop | None
    defects: tuple[field_data.Defect, ...]
    unusable: str = ""

    def case(self, case_of: CaseOfStop, inputs: Mapping[str, str]) -> scenario.Case:
        """Return the case that this stop is judged as; `inputs` are the other files read for it."""
        speed = _UNKNOWN_SPEED if self.stop is None else float(self.stop.recording["speed"][0])
        case = case_of(self.name, speed)
        shown = yaml.display_name(self.path)
        return replace(
            case, id=self.name, path=Path(shown), inputs={**case.inputs, **inputs, shown: self.digest}
        )


@dataclass(frozen=True, slots=True)
class RecordedStops:
    """Recorded stops to judge.

    Args:
        files: files of the recordings, in the order of the cases and then of the stops of series.
        cases: cases that stops are judged as.
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
    read = [_recorded_series_of(planned, trusted) for planned in load_series(paths, overrides, None, trusted)]
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


def _recorded_series_of(
    planned: series.Series, trusted: Sequence[Path] | None
) -> tuple[series.Series, list[RecordedFile]]:
    """Return a series whose stops are the recordings that its file names, and these."""
    stops: list[series.PlannedStop] = []
    files: list[RecordedFile] = []
    for stop in planned.stops:
        if stop.role == "bypassed":
            continue  # simulated beside simulated stops only
        if stop.recorded is None:
            raise InvalidInputError(
                f"{stop.case.id} names no recording: list them under `recordings` of its stops, or"
                " simulate the series with 'uictest run'"
            )
        mapped, inputs = named_map(stop.recorded.channel_map, trusted)
        for read in read_files(stop.recorded.files, mapped):
            file = replace(read, name=f"{stop.case.id}.{read.name}")
            case = file.case(lambda name, speed, own=stop.case: own, inputs)  # type: ignore[misc]
            stops.append(replace(stop, rail="", case=case))
            files.append(file)
    _require_distinct(planned, stops, files)
    return replace(planned, stops=tuple(stops)), files


def _require_distinct(
    planned: series.Series, stops: Sequence[series.PlannedStop], files: Sequence[RecordedFile]
) -> None:
    """Raise InvalidInputError for two stops of one id, and for a copy: counted twice it feigns certainty."""
    ids: set[str] = set()
    for stop in stops:
        if stop.case.id in ids:
            raise InvalidInputError(f"{planned.path}: a second recorded stop {stop.case.id!r}")
        ids.add(stop.case.id)
    paths: dict[str, Path] = {}
    for file in files:
        if (path := paths.setdefault(file.digest, file.path)) != file.path:
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


def read_files(
    paths: Sequence[Path], channel_map: field_data.ChannelMap, *, found: bool = False
) -> list[RecordedFile]:
    """Read every file. Raises InvalidInputError with the errors of all files that cannot be read.

    Of stops that were `found`, one in which the channel map finds none is unusable, and no error of the user.
    """

    def read(path: Path) -> RecordedFile:
        digest = field_data.digest_of(path)
        try:
            stop = field_data.stop_in(path, channel_map)
        except field_data.UnusableError as error:
            return RecordedFile(path, "", digest, None, error.defects, str(error))
        except field_data.MapError as error:
            if not found:
                raise
            return RecordedFile(path, "", digest, None, (), str(error))
        return RecordedFile(path, "", digest, stop, stop.defects)

    files = each_file(paths, read)
    return [replace(file, name=name) for file, name in zip(files, _stop_names(paths), strict=True)]


def named_map(
    reference: str, trusted: Sequence[Path] | None = None
) -> tuple[field_data.ChannelMap, dict[str, str]]:
    """Return a channel map, a preset or a file, and the files read for it.

    Raises InvalidInputError where there is no such map, ScenarioErrors where its file is invalid.
    """
    try:
        return field_data.load_map(reference, trusted or ())
    except KeyError:
        known = ", ".join(field_data.presets())
        raise InvalidInputError(
            f"no channel map {reference!r}: name a preset ({known}) or a .yaml file"
        ) from None


def each_file(paths: Sequence[Path], use: Callable[[Path], Result]) -> list[Result]:
    """Apply `use` to every file, and return its results.

    Raises InvalidInputError with every file's error, ReadingInterruptedError where reading was cut off.
    """
    results: list[Result] = []
    errors: list[str] = []
    for path in paths:
        try:
            results.append(use(path))
        except (formats.UnreadableError, formats.MissingExtraError, field_data.MapError) as error:
            errors.append(f"{path}: {error}")
        except formats.ReadingInterruptedError:
            raise  # not an error of the file
        except OSError as error:
            errors.append(f"{path}: {error.strerror or error}")
    if errors:
        raise InvalidInputError(*errors)
    return results


def read_recording(path: Path) -> recording.Recording:
    """Return a recording as it is written, whatever its format. For :func:`each_file`."""
    if path.suffix != ".parquet":
        return recording.recording_of(formats.read_contents(path), {"source": path.name})
    try:
        return recording.read_parquet(path)
    except ValueError as error:
        raise formats.UnreadableError(str(error).removeprefix(f"{path}: ")) from error


def read_stop(path: Path, channel_map: field_data.ChannelMap) -> field_data.RecordedStop:
    """Return the stop in a recording. For :func:`each_file`."""
    try:
        return field_data.stop_in(path, channel_map)
    except field_data.UnusableError as error:
        raise formats.UnreadableError(str(error)) from error


def _stop_names(paths: Sequence[Path]) -> list[str]:
    """Return a name for each file, safe as a file name and all different."""
    names: list[str] = []
    for path in paths:
        stem = _UNSAFE.sub("-", path.stem).strip("-.")[:_LONGEST_NAME].lower() or "recording"
        name, number = stem, 1
        while name in names:
            number += 1
            name = f"{stem}-{number}"
        names.append(name)
    return names

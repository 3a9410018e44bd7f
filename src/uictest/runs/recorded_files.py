"""Files with recorded stops: read, named, each with its errors."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from uictest.core import recording
from uictest.core.recording import formats
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.plans import scenario
from uictest.plans.scenario import yaml
from uictest.recorded import field_data
from uictest.runs.errors import InvalidInputError

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
        path: of the file.
        name: of the stop in the reports.
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
        name = next(
            n for k in range(1, len(paths) + 1) if (n := stem if k == 1 else f"{stem}-{k}") not in names
        )
        names.append(name)
    return names

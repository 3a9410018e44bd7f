"""`uictest identify`: identify the numbers of the compensation from a recording."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Sequence
from datetime import UTC, datetime
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from uictest import runs
from uictest.cli.entry import command
from uictest.cli.identify_options import (
    ActingTime,
    Base,
    CommandChannel,
    CylinderChannel,
    ForceChannel,
    HeldOut,
    Intervals,
    LineChannel,
    Name,
    Output,
    PressureChannel,
    Recording,
    RigOverrides,
    TankChannel,
    TransitionTime,
    interval,
)
from uictest.cli.options import trusted_folders
from uictest.cli.output import ExitCode, data, message
from uictest.cli.recordings import rig_of_record
from uictest.core import files
from uictest.plans import library, scenario
from uictest.plans.scenario import yaml
from uictest.recorded import field_data
from uictest.rig import bench, identification

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

identify = typer.Typer(
    rich_markup_mode=None,
    help="Identify hysteresis, cylinder dynamics or the air of the module from a recording.",
)

_OPTIONS = {
    "input": "--input",
    "output": "--output-channel",
    "pressure": "--pressure",
    "force": "--force",
    "command": "--command",
    "line": "--line",
}
"""Role of a channel -> the option that names it."""


@command(identify, "hysteresis")
def hysteresis(
    context: typer.Context,
    record: Recording,
    output: Output = None,
    base: Base = "six-inch",
    name: Name = "",
    pressure: PressureChannel = "cylinder_pressure_1",
    force: ForceChannel = "clamping_force_1",
    command: CommandChannel = "valve_command_1",
    intervals: Intervals = None,
    acting_time: ActingTime = 2.0,
    transition_time: TransitionTime = 0.1,
    held_out: HeldOut = 0.25,
) -> ExitCode:
    """Fit the lines of the four phases, equations (4)-(7), to a record of pressure and clamping force."""
    base_part = _base(base)
    part_name = "" if output is None else _name(name, record)
    acting_intervals = [interval(text) for text in intervals or ()]
    roles = {"pressure": pressure, "force": force} | ({} if acting_intervals else {"command": command})
    recorded = _record(record, roles)
    acting = _wsp_acting(recorded, acting_intervals, acting_time)
    result = _hysteresis(record, recorded, acting, transition_time, held_out)
    data(identification.hysteresis_text(result))
    _warn(result.largest_error)
    if output is not None:
        provenance = _provenance(context, record, recorded)
        text = identification.with_hysteresis(
            base_part, part_name, result, provenance, acting_time, transition_time
        )
        _write(output, record, text)
    return ExitCode.MET


@command(identify, "cylinder")
def cylinder(
    context: typer.Context,
    record: Recording,
    output: Output = None,
    base: Base = "six-inch",
    name: Name = "",
    tank: TankChannel = "measured_pressure_2",
    cylinder: CylinderChannel = "cylinder_pressure_1",
    held_out: HeldOut = 0.25,
) -> ExitCode:
    """Identify the third-order transfer function, equation (8), from tank pressure to cylinder pressure."""
    base_part = _base(base)
    part_name = "" if output is None else _name(name, record)
    recorded = _record(record, {"input": tank, "output": cylinder})
    result = _cylinder(record, recorded, held_out)
    data(identification.cylinder_text(result))
    _warn(result.largest_after)
    if output is not None:
        provenance = _provenance(context, record, recorded)
        _write(output, record, identification.with_cylinder(base_part, part_name, result, provenance))
    return ExitCode.MET


@command(identify, "air")
def air(
    context: typer.Context,
    record: Recording,
    output: Output = None,
    base: Base = "six-inch",
    name: Name = "",
    tank: TankChannel = "measured_pressure_2",
    cylinder: CylinderChannel = "cylinder_pressure_1",
    line: LineChannel = "brake_line_pressure",
    command: CommandChannel = "valve_command_1",
    overrides: RigOverrides = None,
    held_out: HeldOut = 0.25,
) -> ExitCode:
    """Identify the air of the caliper's module, which the setting `thermal` follows beside a tank."""
    base_part = _base(base)
    part_name = "" if output is None else _name(name, record)
    roles = {"input": tank, "output": cylinder, "line": line, "command": command}
    recorded = _record(record, roles)
    case = rig_of_record(record, recorded.rig, overrides or (), trusted_folders())
    result = _air(record, recorded, case, held_out)
    data(identification.air_text(result))
    _warn(result.largest_after)
    if output is not None:
        provenance = _provenance(context, record, recorded)
        _write(output, record, identification.with_air(base_part, part_name, result, provenance))
    return ExitCode.MET


def _warn(largest_error: float) -> None:
    if warning := identification.distrust(largest_error):
        message(f"uictest: {warning}")


def _air(
    record: Path, recorded: identification.RecordedChannels, case: scenario.Case, held_out: float
) -> identification.AirResult:
    channels = recorded.channels
    by_name = {
        "time": channels["time"],
        "tank": channels["input"],
        "cylinder": channels["output"],
        "line": channels["line"],
        "command": channels["command"],
    }
    try:
        return bench.identify_air(by_name, case, held_out)
    except identification.UnsuitableRecordError as error:
        raise runs.InvalidInputError(f"{record}: {error}") from error


def _wsp_acting(
    recorded: identification.RecordedChannels, intervals: Sequence[tuple[float, float]], acting_time: float
) -> NDArray[np.bool_]:
    """Return for every sample whether the WSP acts: in the intervals, or else by the valve commands."""
    channels = recorded.channels
    if intervals:
        return identification.wsp_acting_in_intervals(channels["time"], intervals)
    return identification.wsp_acting_from_commands(channels["time"], channels["command"], acting_time)


def _hysteresis(
    record: Path,
    recorded: identification.RecordedChannels,
    acting: NDArray[np.bool_],
    transition_time: float,
    held_out: float,
) -> identification.HysteresisResult:
    channels = recorded.channels
    try:
        result = identification.identify_hysteresis(
            channels["time"], channels["pressure"], channels["force"], acting, transition_time, held_out
        )
        identification.require_force_fit(result)
    except identification.UnsuitableRecordError as error:
        raise runs.InvalidInputError(f"{record}: {error}") from error
    return result


def _cylinder(
    record: Path,
    recorded: identification.RecordedChannels,
    held_out: float,
) -> identification.CylinderResult:
    channels = recorded.channels
    try:
        result = identification.identify_cylinder(
            channels["time"], channels["input"], channels["output"], held_out
        )
        identification.require_fit(result)
    except identification.UnsuitableRecordError as error:
        raise runs.InvalidInputError(f"{record}: {error}") from error
    return result


def _record(record: Path, names: dict[str, str]) -> identification.RecordedChannels:
    """Read the channels of a record by role. Raises InvalidInputError where two options name the same one."""
    for (role, name), (other, same) in combinations(names.items(), 2):
        if name == same:
            raise runs.InvalidInputError(
                f"{_OPTIONS[role]} and {_OPTIONS[other]} both name {name!r}: name two channels"
            )
    try:
        return identification.read_record(_existing(record), names)
    except identification.UnsuitableRecordError as error:
        raise runs.InvalidInputError(f"{error}") from error


def _existing(record: Path) -> Path:
    if not record.is_file():
        raise runs.InvalidInputError(f"{record}: {'not a file' if record.exists() else 'no such file'}")
    return record


def _base(reference: str) -> scenario.Compensation:
    """Return the compensation, of the library or in a file, whose other numbers are kept."""
    return identification.load_compensation(reference, trusted_folders())


def _name(name: str, record: Path) -> str:
    """Return the name of `--name`, else one from the file name of the record that no library part has."""
    derived = re.sub(r"[^a-z0-9]+", "-", record.stem.lower()).strip("-")[:100]
    if name and not re.fullmatch(yaml.NAME_PATTERN, name):
        raise runs.InvalidInputError(f"--name {name!r}: write lower case letters, digits and . _ -")
    if not name and (not derived or derived in library.names("compensations")):
        raise runs.InvalidInputError(
            f"{record.name} gives no name that is free for the compensation; write --name NAME"
        )
    return name or derived


def _provenance(
    context: typer.Context, record: Path, recorded: identification.RecordedChannels
) -> identification.Provenance:
    from uictest import __version__

    return identification.Provenance(
        record=record.name,
        digest=field_data.digest_of(record),
        samples_digest=identification.samples_digest(recorded.channels),
        origin=recorded.origin,
        command=shlex.join(["uictest", *context.obj]),
        version=__version__,
        date=_date(),
        rig=recorded.rig,
    )


def _date() -> str:
    """Return the day of SOURCE_DATE_EPOCH, empty without it: then the same record gives the same file."""
    text = os.environ.get("SOURCE_DATE_EPOCH", "")
    try:
        return f"{datetime.fromtimestamp(int(text), UTC):%Y-%m-%d}" if text else ""
    except (ValueError, OverflowError, OSError) as error:
        raise runs.InvalidInputError(f"SOURCE_DATE_EPOCH={text!r}: write seconds since 1970") from error


def _write(output: Path, record: Path, text: str) -> None:
    """Write a compensation file. Raises InvalidInputError for numbers that no compensation can have."""
    files.require_place(output)
    if output.exists() and output.samefile(record):
        raise runs.InvalidInputError(f"--output {output} is the recording itself: name another file")
    try:
        identification.check_compensation(text, output)
    except yaml.ScenarioErrors as errors:
        raise runs.InvalidInputError(
            f"{record}: nothing written, since the identified numbers fit no caliper\n{errors}"
        ) from errors
    files.write_to(output, text)
    message(f"uictest: wrote {output}")
    if not identification.is_of_one_rig(identification.load_compensation(str(output)).provenance):
        message(
            "uictest: it lists no rig that it was identified for, since hysteresis, cylinder dynamics and air"
            " are not all known to be of one"
        )

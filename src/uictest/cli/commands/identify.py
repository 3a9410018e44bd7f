"""`uictest identify`: identify the numbers of the compensation from a recording."""

from __future__ import annotations

import math
import os
import re
import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from itertools import combinations
from pathlib import Path
from typing import Annotated

import typer

from uictest import __version__, runs
from uictest.cli.entry import command
from uictest.cli.options import argument, option, trusted_folders
from uictest.cli.output import ExitCode, data, message
from uictest.cli.recordings import rig_of_record
from uictest.core import files
from uictest.plans import library
from uictest.plans.scenario import yaml
from uictest.recorded import field_data
from uictest.rig import bench, identification

identify = typer.Typer(
    rich_markup_mode=None,
    help="Identify hysteresis, cylinder dynamics or the air of the module from a recording.",
)

Recording = Annotated[Path, argument("RECORDING", "Parquet, CSV or another measurement file.")]
Output = Annotated[Path | None, option("-o --output FILE", "Compensation file to write [default: none].")]
Base = Annotated[str, option("--base NAME|FILE", "Compensation whose other numbers are kept.")]
Name = Annotated[
    str,
    option(
        "--name NAME",
        "Name of the compensation in FILE [default: from the file name of RECORDING].",
        show_default=False,
    ),
]
HeldOut = Annotated[
    float, option("--held-out", "Share of the record held out from the fit.", min=0.05, max=0.5)
]
PressureChannel = Annotated[str, option("--pressure CHANNEL", "Channel of the brake cylinder pressure.")]
ForceChannel = Annotated[str, option("--force CHANNEL", "Channel of the clamping force.")]
CommandChannel = Annotated[
    str, option("--command CHANNEL", "Channel of the valve command (0 fill, 1 hold, 2 vent).")
]
Intervals = Annotated[
    list[str] | None,
    option("--wsp FROM..TO", "Time in s in which the WSP acts, instead of --command. May be repeated."),
]
ActingTime = Annotated[
    float, option("--acting-time", "Filling time in s after which the WSP no longer acts.", min=0.0, max=60.0)
]
TransitionTime = Annotated[
    float, option("--transition-time", "Time in s from one pair of lines to the other.", min=0.0, max=10.0)
]
TankChannel = Annotated[str, option("--input CHANNEL", "Channel of the tank pressure.")]
CylinderChannel = Annotated[
    str, option("--output-channel CHANNEL", "Channel of the brake cylinder pressure.")
]
LineChannel = Annotated[str, option("--line CHANNEL", "Channel of the brake line's pressure.")]
RigOverrides = Annotated[
    list[str] | None, option("--set KEY=VALUE", "Set a key of the rig of the record. May be repeated.")
]


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
    base_part = identification.load_compensation(base, trusted_folders())
    part_name = "" if output is None else _name(name, record)
    acting_intervals = [_interval(text) for text in intervals or ()]
    roles = {"pressure": pressure, "force": force} | ({} if acting_intervals else {"command": command})
    recorded = _record(record, roles)
    channels = recorded.channels
    if acting_intervals:
        acting = identification.wsp_acting_in_intervals(channels["time"], acting_intervals)
    else:
        acting = identification.wsp_acting_from_commands(channels["time"], channels["command"], acting_time)
    with _naming(record):
        result = identification.identify_hysteresis(
            channels["time"], channels["pressure"], channels["force"], acting, transition_time, held_out
        )
        identification.require_force_fit(result)
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
    base_part = identification.load_compensation(base, trusted_folders())
    part_name = "" if output is None else _name(name, record)
    recorded = _record(record, {"input": tank, "output": cylinder})
    channels = recorded.channels
    with _naming(record):
        result = identification.identify_cylinder(
            channels["time"], channels["input"], channels["output"], held_out
        )
        identification.require_fit(result)
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
    base_part = identification.load_compensation(base, trusted_folders())
    part_name = "" if output is None else _name(name, record)
    roles = {"input": tank, "output": cylinder, "line": line, "command": command}
    recorded = _record(record, roles)
    case = rig_of_record(record, recorded.rig, overrides or (), trusted_folders())
    by_name = {"time": recorded.channels["time"]}
    by_name |= {
        name: recorded.channels[role]
        for name, role in (
            ("tank", "input"),
            ("cylinder", "output"),
            ("line", "line"),
            ("command", "command"),
        )
    }
    with _naming(record):
        result = bench.identify_air(by_name, case, held_out)
    data(identification.air_text(result))
    _warn(result.largest_after)
    if output is not None:
        provenance = _provenance(context, record, recorded)
        _write(output, record, identification.with_air(base_part, part_name, result, provenance))
    return ExitCode.MET


def _interval(text: str) -> tuple[float, float]:
    """Return first and last time in s of a `--wsp` option. Raises InvalidInputError."""
    first, dots, last = text.partition("..")
    try:
        begin, end = float(first), float(last)
    except ValueError:
        begin, end = 1.0, 0.0
    if not dots or not -math.inf < begin < end < math.inf:
        raise runs.InvalidInputError(f"--wsp {text!r}: write the first and the last time in s, such as 4..12")
    return begin, end


def _warn(largest_error: float) -> None:
    if warning := identification.distrust(largest_error):
        message(f"uictest: {warning}")


@contextmanager
def _naming(record: Path) -> Iterator[None]:
    """Let a record that supports nothing be an InvalidInputError that names its file."""
    try:
        yield
    except identification.UnsuitableRecordError as error:
        raise runs.InvalidInputError(f"{record}: {error}") from error


def _record(record: Path, names: dict[str, str]) -> identification.RecordedChannels:
    """Read the channels of a record by role. Raises InvalidInputError where two options name the same one."""
    for (role, name), (other, same) in combinations(names.items(), 2):
        if name == same:
            raise runs.InvalidInputError(
                f"{_OPTIONS[role]} and {_OPTIONS[other]} both name {name!r}: name two channels"
            )
    if not record.is_file():
        raise runs.InvalidInputError(f"{record}: {'not a file' if record.exists() else 'no such file'}")
    try:
        return identification.read_record(record, names)
    except identification.UnsuitableRecordError as error:
        raise runs.InvalidInputError(f"{error}") from error


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
    # Without a stated time the same record gives the same file.
    text = os.environ.get("SOURCE_DATE_EPOCH", "")
    try:
        date = f"{datetime.fromtimestamp(int(text), UTC):%Y-%m-%d}" if text else ""
    except (ValueError, OverflowError, OSError) as error:
        raise runs.InvalidInputError(f"SOURCE_DATE_EPOCH={text!r}: write seconds since 1970") from error
    return identification.Provenance(
        record=record.name,
        digest=field_data.digest_of(record),
        samples_digest=identification.samples_digest(recorded.channels),
        origin=recorded.origin,
        command=shlex.join(["uictest", *context.obj]),
        version=__version__,
        date=date,
        rig=recorded.rig,
    )


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

"""Arguments and options of `uictest identify`."""

import math
from pathlib import Path
from typing import Annotated

from uictest import runs
from uictest.cli.options import argument, option

Recording = Annotated[Path, argument("RECORDING", "Parquet, CSV or another measurement file.")]
Output = Annotated[
    Path | None,
    option("-o --output FILE", "Compensation file to write [default: none]."),
]
Base = Annotated[
    str,
    option("--base NAME|FILE", "Compensation whose other numbers are kept."),
]
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
    str,
    option("--command CHANNEL", "Channel of the valve command (0 fill, 1 hold, 2 vent)."),
]
Intervals = Annotated[
    list[str] | None,
    option("--wsp FROM..TO", "Time in s in which the WSP acts, instead of --command. May be repeated."),
]
ActingTime = Annotated[
    float,
    option("--acting-time", "Filling time in s after which the WSP no longer acts.", min=0.0, max=60.0),
]
TransitionTime = Annotated[
    float,
    option("--transition-time", "Time in s from one pair of lines to the other.", min=0.0, max=10.0),
]
TankChannel = Annotated[str, option("--input CHANNEL", "Channel of the tank pressure.")]
CylinderChannel = Annotated[
    str,
    option("--output-channel CHANNEL", "Channel of the brake cylinder pressure."),
]
LineChannel = Annotated[str, option("--line CHANNEL", "Channel of the brake line's pressure.")]
RigOverrides = Annotated[
    list[str] | None,
    option("--set KEY=VALUE", "Set a key of the rig of the record. May be repeated."),
]


def interval(text: str) -> tuple[float, float]:
    """Return first and last time in s of a `--wsp` option. Raises InvalidInputError."""
    first, dots, last = text.partition("..")
    try:
        begin, end = float(first), float(last)
    except ValueError:
        begin, end = 1.0, 0.0
    if not dots or not -math.inf < begin < end < math.inf:
        raise runs.InvalidInputError(f"--wsp {text!r}: write the first and the last time in s, such as 4..12")
    return begin, end

"""Arguments and options of `uictest identify`."""

import math
from pathlib import Path
from typing import Annotated

import typer

from uictest import runs

Recording = Annotated[
    Path, typer.Argument(metavar="RECORDING", help="Parquet, CSV or another measurement file.")
]
Output = Annotated[
    Path | None,
    typer.Option("-o", "--output", metavar="FILE", help="Compensation file to write [default: none]."),
]
Base = Annotated[
    str,
    typer.Option("--base", metavar="NAME|FILE", help="Compensation whose other numbers are kept."),
]
Name = Annotated[
    str,
    typer.Option(
        "--name",
        metavar="NAME",
        help="Name of the compensation in FILE [default: from the file name of RECORDING].",
        show_default=False,
    ),
]
HeldOut = Annotated[
    float, typer.Option("--held-out", min=0.05, max=0.5, help="Share of the record held out from the fit.")
]
PressureChannel = Annotated[
    str, typer.Option("--pressure", metavar="CHANNEL", help="Channel of the brake cylinder pressure.")
]
ForceChannel = Annotated[
    str, typer.Option("--force", metavar="CHANNEL", help="Channel of the clamping force.")
]
CommandChannel = Annotated[
    str,
    typer.Option(
        "--command", metavar="CHANNEL", help="Channel of the valve command (0 fill, 1 hold, 2 vent)."
    ),
]
Intervals = Annotated[
    list[str] | None,
    typer.Option(
        "--wsp",
        metavar="FROM..TO",
        help="Time in s in which the WSP acts, instead of --command. May be repeated.",
    ),
]
ActingTime = Annotated[
    float,
    typer.Option(
        "--acting-time", min=0.0, max=60.0, help="Filling time in s after which the WSP no longer acts."
    ),
]
TransitionTime = Annotated[
    float,
    typer.Option(
        "--transition-time", min=0.0, max=10.0, help="Time in s from one pair of lines to the other."
    ),
]
TankChannel = Annotated[str, typer.Option("--input", metavar="CHANNEL", help="Channel of the tank pressure.")]
CylinderChannel = Annotated[
    str,
    typer.Option("--output-channel", metavar="CHANNEL", help="Channel of the brake cylinder pressure."),
]
LineChannel = Annotated[
    str, typer.Option("--line", metavar="CHANNEL", help="Channel of the brake line's pressure.")
]
RigOverrides = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Set a key of the rig of the record. May be repeated."),
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

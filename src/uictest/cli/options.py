"""The options that several commands share, each described once."""

from __future__ import annotations

import codecs
import os
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, Final

import typer

from uictest import report, runs
from uictest.analysis import comparison
from uictest.core import files
from uictest.plans import scenario


class Format(StrEnum):
    """Format of the output on stdout."""

    TEXT = "text"
    JSON = "json"
    GITHUB = "github"


class PlainFormat(StrEnum):
    """Format of the output on stdout of commands without annotations."""

    TEXT = "text"
    JSON = "json"


class Recorded(StrEnum):
    """Which cases are recorded."""

    ALL = "all"
    FAILED = "failed"
    NONE = "none"


def option(spelling: str, meaning: str, **settings: Any) -> Any:
    """Return an option by how `--help` spells it, such as `-o --output DIR`, and what it does."""
    words = spelling.split()
    names = [word for word in words if word.startswith("-")]
    return typer.Option(*names, metavar=" ".join(words[len(names) :]) or None, help=meaning, **settings)


def argument(spelling: str, meaning: str, **settings: Any) -> Any:
    """Return an argument by what `--help` calls it, such as `FILE`, and what it is."""
    return typer.Argument(metavar=spelling, help=meaning, **settings)


def _parsed_jobs(text: str) -> int:
    if text == "auto":
        return runs.available_processors()
    if text.isascii() and text.isdigit() and int(text) > 0:
        return int(text)
    raise typer.BadParameter(f"{text!r} is neither a number of threads from 1 nor 'auto'")


Paths = Annotated[
    list[Path] | None, argument("PATH", "Scenario files or folders [default: scenarios].", show_default=False)
]
Expression = Annotated[
    str | None,
    option(
        "-k EXPR",
        "Select cases whose id, file name or tag contains EXPR; combine words with and, or, not, ( ).",
    ),
]
Draw = Annotated[
    str | None,
    option(
        "--draw EXPR",
        "Draw the cases that match in index.html, as with -k, up to 60 of them; then others, up to 18.",
    ),
]
Tag = Annotated[
    str | None, option("-m TAG", "Select cases with this tag; combine tags with and, or, not, ( ).")
]
Overrides = Annotated[
    list[str] | None,
    option(
        "--set KEY=VALUE",
        "Set a key in every scenario; a list (a,b) or range(a,b,step) sweeps it. May be repeated.",
    ),
]
Seed = Annotated[
    int | None,
    option("--seed N", "Seed of sensor noise and random rails in every case.", min=0, max=2**32 - 1),
]
InProcess = Annotated[
    bool,
    option(
        "--in-process",
        "Run controllers from outside in this process: faster, but a crash or a hang ends everything.",
    ),
]
RealTime = Annotated[
    bool,
    option(
        "--real-time", "Pace controllers at a socket by the clock; a missed deadline makes a stop invalid."
    ),
]
TRUSTED_FOLDERS: Final = "UICTEST_TRUST"
"""Variable of the environment with folders as those of `--trust`, which every command trusts."""


def trusted_folders(named: list[Path] | None = None) -> list[Path]:
    """Return the named folders and those of UICTEST_TRUST. Raises InvalidInputError for other paths."""
    folders = [Path(text) for text in os.environ.get(TRUSTED_FOLDERS, "").split(os.pathsep) if text]
    for folder in folders:
        if not folder.is_dir():
            raise runs.InvalidInputError(f"{TRUSTED_FOLDERS}: {folder} is no folder")
    return [*(named or ()), *folders]


Trusted = Annotated[
    list[Path] | None,
    option(
        "--trust DIR",
        "Allow references into this folder, besides the folders of the given files, the working"
        f" folder and those of {TRUSTED_FOLDERS}. May be repeated.",
        exists=True,
        file_okay=False,
        callback=trusted_folders,
    ),
]
Validated = Annotated[
    Path | None,
    option(
        "--validated FILE",
        "Flag the cases outside of what was validated: validation.json of 'uictest validate'; in place"
        " of what scenarios name.",
    ),
]
Strict = Annotated[
    bool,
    option(
        "--strict",
        "Exit 1 also where a criterion that applies is inconclusive, a verdict turns within the range of a"
        " definition, what is missed is allowed only or not named by `expect`, or --firm does not show the"
        " outcome to be firm; 4 where a train is implausible.",
    ),
]
StrictCheck = Annotated[bool, option("--strict", "Take an implausible train for an error.")]
Firm = Annotated[
    bool,
    option(
        "--firm",
        "Find out whether numbers that nobody measured turn the verdicts: runs some 1 700 stops of each"
        " case with other values within their plausible ranges.",
    ),
]


def calibration(
    named: Sequence[Path] | None, trusted: Sequence[Path] | None = None, *, firm: bool
) -> list[scenario.Case]:
    """Return the cases of calibrating scenarios. Raises ScenarioErrors, and InvalidInputError for none."""
    if not named:
        return []
    if not firm:
        raise typer.BadParameter("goes with --firm", param_hint="--calibrated-by")
    cases = runs.load_cases(named, trusted=trusted)
    if not cases:
        raise runs.InvalidInputError("--calibrated-by: takes scenarios, not series")
    return cases


CalibratedBy = Annotated[
    list[Path] | None,
    option(
        "--calibrated-by SCENARIO",
        "With --firm: also say how firm verdicts are among the draws in which this stop, such as dry-120,"
        " comes to what it expects. May be repeated.",
    ),
]
Verbose = Annotated[bool, option("-v --verbose", "More detail.", show_default=False)]
Quiet = Annotated[bool, option("-q --quiet", "Show only cases that are not as expected.")]
Output = Annotated[Path, option("-o --output DIR", "Folder for reports; each run gets a folder in it.")]
KeptRuns = Annotated[
    int | None,
    option(
        "--keep N", "Afterwards remove older folders of this command beyond the N newest; names each.", min=1
    ),
]
ExitFirst = Annotated[bool, option("-x", "Stop at the first case that is not as expected.")]
MaxFail = Annotated[int | None, option("--maxfail N", "Stop after N cases that are not as expected.", min=1)]
DryRun = Annotated[bool, option("--dry-run", "List the selected cases without running them.")]
JUNIT: Final = "--junitxml"
JUnitFile = Annotated[Path | None, option(f"{JUNIT} FILE", "Also write the JUnit XML to FILE.")]
Jobs = Annotated[int, option("-n --jobs N|auto", "Number of threads.", parser=_parsed_jobs)]
RunFormat = Annotated[
    Format,
    option("--format", "Output on stdout: text, json (results.json) or github (text and annotations)."),
]
CheckFormat = Annotated[
    Format, option("--format", "Output on stdout: text (none), json (the errors), github (annotations).")
]
ListFormat = Annotated[PlainFormat, option("--format", "Output on stdout: text or json.")]
RecordingChoice = Annotated[
    Recorded, option("--record", "Keep recordings of all cases, those not as expected, or none.")
]
RecordRate = Annotated[
    float, option("--record-rate HZ", "Samples per second of a recording.", min=1.0, max=100e3)
]
Reports = Annotated[
    str, option("--report FORMATS", f"Reports to write, joined by commas: {', '.join(report.FORMATS)}.")
]
ToleranceTexts = Annotated[
    list[str] | None,
    option(
        "--tolerance [NAME=]VALUE",
        "Allowed difference: 0.5 (absolute), 1% (of the range); NAME may contain *. May be repeated.",
    ),
]


def tolerances_of(texts: list[str] | None) -> comparison.Tolerances:
    """Return the tolerances that `--tolerance` asks for. Raises typer.BadParameter."""
    with rejected("--tolerance"):
        return comparison.Tolerances.read(texts or ())


@contextmanager
def rejected(option: str, kind: type[ValueError] = ValueError) -> Iterator[None]:
    """Let an error of this kind be a typer.BadParameter of an option."""
    try:
        yield
    except kind as error:
        raise typer.BadParameter(str(error), param_hint=option) from error


def junit_file(path: Path | None, output: Path) -> Path | None:
    """Return the file of `--junitxml`. Raises files.WriteError where it cannot be written.

    A folder in or above `output` may be missing: the command makes it.
    """
    if path is not None:
        folder, reports = path.absolute().parent, output.absolute()
        is_made = reports.is_relative_to(folder) or folder.is_relative_to(reports)
        if not is_made or folder.exists():
            files.require_place(path)
        if not is_replaceable(path):
            text = f"{path} holds no XML: name another file, or remove it"
            raise typer.BadParameter(text, param_hint=JUNIT)
    return path


def is_replaceable(path: Path) -> bool:
    """Return whether a report may take the place of a file: it is missing, empty, or XML. Raises OSError."""
    if not path.is_file():
        return True
    with path.open("rb") as file:
        return file.read(4).removeprefix(codecs.BOM_UTF8)[:1] in (b"", b"<")


def report_formats(text: str, option: str, accepted: Collection[str]) -> list[str]:
    """Return the formats in a comma list, each once. Raises typer.BadParameter for an unknown one."""
    words = [word.strip() for word in text.split(",") if word.strip()]
    for word in words:
        if word not in accepted:
            message = f"no format {word!r}; accepted: {', '.join(accepted)}"
            raise typer.BadParameter(message, param_hint=option)
    return list(dict.fromkeys(words))

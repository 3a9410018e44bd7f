"""`uictest export`: a recording in the formats of the engineers' own viewers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import recording
from uictest.cli.exit_codes import ExitCode, InvalidInputError
from uictest.cli.options import Verbosity
from uictest.cli.output import data
from uictest.cli.recordings import Files, each_file


def export(
    files: Files,
    formats: Annotated[
        list[str],
        typer.Option(
            "--to", metavar="FORMAT", help="mdf (or mf4), tdms, mat, csv, parquet; commas join several."
        ),
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder for the files.")
    ] = Path(),
    force: Annotated[bool, typer.Option("--force", help="Replace files that are there already.")] = False,
    verbosity: Verbosity = 0,
) -> ExitCode:
    """Write recordings as MDF 4.10, TDMS, MAT 5, CSV or Parquet. Shows the files it wrote."""
    from uictest.recording.formats import SUFFIXES, writer_of

    wanted = _formats(formats)
    targets = {(path, name): output / f"{path.stem}{SUFFIXES[name]}" for path in files for name in wanted}
    _refuse_overwriting(list(targets.values()), force=force)
    recordings = dict(zip(files, each_file(files, _recording), strict=True))
    output.mkdir(parents=True, exist_ok=True)
    for (path, name), target in targets.items():
        each_file([path], lambda p, n=name, t=target: writer_of(n)(recordings[p], t))  # type: ignore[misc]
        data(str(target))
    return ExitCode.MET


def _formats(texts: Sequence[str]) -> list[str]:
    from uictest.recording.formats import FORMATS, SUFFIXES

    # A format is known by the suffix of its files, too: engineers say MF4 for MDF 4.
    names = {suffix.removeprefix("."): name for name, suffix in SUFFIXES.items()}
    words = [word.strip().lower() for text in texts for word in text.split(",")]
    wanted = list(dict.fromkeys(names.get(word, word) for word in words))
    for word in wanted:
        if word not in FORMATS:
            raise typer.BadParameter(f"no format {word!r}; accepted: {', '.join(FORMATS)}", param_hint="--to")
    return wanted


def _refuse_overwriting(targets: Sequence[Path], *, force: bool) -> None:
    twice = sorted({str(target) for target in targets if targets.count(target) > 1})
    if twice:
        raise InvalidInputError(f"uictest: several recordings would be written to {', '.join(twice)}")
    there = [str(target) for target in targets if target.exists()]
    if there and not force:
        raise InvalidInputError(f"uictest: already there: {', '.join(there)}; --force replaces them")


def _recording(path: Path) -> recording.Recording:
    from uictest import __version__
    from uictest.recording.formats import read_contents

    return recording.recording_of(
        read_contents(path), {"program": f"uictest {__version__}", "source": path.name}
    )

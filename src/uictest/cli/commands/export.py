"""`uictest export`: convert recordings to the formats of other programs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from uictest import __version__, recording, runs
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import Verbosity
from uictest.cli.output import data
from uictest.cli.recordings import Files
from uictest.files import make_folder
from uictest.recording import formats as file_formats


def export(
    files: Files,
    formats: Annotated[
        list[str],
        typer.Option(
            "--to", metavar="FORMAT", help="Formats, joined by commas: mdf (or mf4), tdms, mat, csv, parquet."
        ),
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder for the files.")
    ] = Path(),
    force: Annotated[bool, typer.Option("--force", help="Overwrite existing files.")] = False,
    verbosity: Verbosity = 0,
) -> ExitCode:
    """Write recordings as MDF 4.10, TDMS, MAT 5, CSV or Parquet. Prints the names of the files."""
    names = _formats(formats)
    targets = {
        (path, name): output / f"{path.stem}{file_formats.FORMATS[name].suffix}"
        for path in files
        for name in names
    }
    _reject_overwriting(list(targets.values()), force=force)
    recordings = dict(zip(files, runs.each_file(files, _recording), strict=True))
    make_folder(output)
    for (path, name), target in targets.items():
        write = partial(file_formats.writer_of(name), recordings[path], target)
        runs.each_file([path], lambda _, write=write: write())  # type: ignore[misc]
        data(str(target))
    return ExitCode.MET


def _formats(texts: Sequence[str]) -> list[str]:
    # A format is also known by the suffix of its files: engineers say MF4 for MDF 4.
    by_suffix = {each.suffix.removeprefix("."): name for name, each in file_formats.FORMATS.items()}
    words = [word.strip().lower() for text in texts for word in text.split(",")]
    names = list(dict.fromkeys(by_suffix.get(word, word) for word in words))
    for word in names:
        if word not in file_formats.FORMATS:
            raise typer.BadParameter(
                f"no format {word!r}; accepted: {', '.join(file_formats.FORMATS)}", param_hint="--to"
            )
    return names


def _reject_overwriting(targets: Sequence[Path], *, force: bool) -> None:
    twice = sorted({str(target) for target in targets if targets.count(target) > 1})
    if twice:
        raise runs.InvalidInputError(f"several recordings would be written to {', '.join(twice)}")
    there = [str(target) for target in targets if target.exists()]
    if there and not force:
        raise runs.InvalidInputError(f"already there: {', '.join(there)}; --force replaces them")


def _recording(path: Path) -> recording.Recording:
    return recording.recording_of(
        file_formats.read_contents(path), {"program": f"uictest {__version__}", "source": path.name}
    )

"""`uictest export`: convert recordings to the formats of other programs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Final

import typer

from uictest import __version__, runs
from uictest.cli.options import option
from uictest.cli.output import ExitCode, data
from uictest.cli.recordings import Files
from uictest.core import files as file_system, recording
from uictest.core.recording import formats as file_formats

_BY_SUFFIX: Final = {
    file_format.suffix.removeprefix("."): name for name, file_format in file_formats.FORMATS.items()
}
"""Suffix of its files -> format; engineers say MF4 for MDF 4."""


def export(
    files: Files,
    formats: Annotated[
        list[str] | None,
        option(
            "--to FORMAT",
            "Formats, joined by commas: mdf (or mf4), tdms, mat, csv, parquet."
            " Not needed where -o names a file.",
        ),
    ] = None,
    output: Annotated[
        Path, option("-o --output DIR|FILE", "Folder for the files, or a file whose suffix is a format.")
    ] = Path(),
    force: Annotated[bool, option("--force", "Overwrite existing files.")] = False,
) -> ExitCode:
    """Write recordings as MDF 4.10, TDMS, MAT 5, CSV or Parquet. Prints the names of the files."""

    def read(path: Path) -> recording.Recording:
        about = {"program": f"uictest {__version__}", "source": path.name}
        return recording.recording_of(file_formats.read_contents(path), about)

    targets = _targets(files, formats or [], output)
    _reject_overwriting(list(targets.values()), force=force)
    recordings = dict(zip(files, runs.each_file(files, read), strict=True))
    for (path, name), target in targets.items():
        encode = partial(file_formats.encoded, recordings[path], name)
        [content] = runs.each_file([path], lambda _, encode=encode: encode())  # type: ignore[misc]
        file_system.write_all({target: content})
        data(str(target))
    return ExitCode.MET


def _targets(files: Sequence[Path], formats: Sequence[str], output: Path) -> dict[tuple[Path, str], Path]:
    """Return the file for each recording and format. Raises typer.BadParameter where none is named."""
    names, of_suffix = _formats(formats), _BY_SUFFIX.get(output.suffix.lower().removeprefix("."))
    if of_suffix is not None and not os.path.isdir(output) and names in ([], [of_suffix]):  # noqa: PTH112 - no error
        if len(files) > 1:
            reason = f"{output} is one file for {len(files)} recordings; name a folder, and formats with --to"
            raise typer.BadParameter(reason, param_hint="-o")
        return {(files[0], of_suffix): output}
    if not names:
        suffixes = ", ".join(file_format.suffix for file_format in file_formats.FORMATS.values())
        reason = f"no format: name formats, or a file with a suffix ({suffixes}) with -o"
        raise typer.BadParameter(reason, param_hint="--to")
    return {
        (path, name): output / f"{path.stem}{file_formats.FORMATS[name].suffix}"
        for path in files
        for name in names
    }


def _formats(texts: Sequence[str]) -> list[str]:
    words = [word.strip().lower() for text in texts for word in text.split(",")]
    names = list(dict.fromkeys(_BY_SUFFIX.get(word, word) for word in words))
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
    there = [str(target) for target in targets if os.path.lexists(target)]
    if there and not force:
        raise runs.InvalidInputError(f"already there: {', '.join(there)}; --force replaces them")

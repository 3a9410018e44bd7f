"""What the commands that write an FMU have in common."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from uictest import runs
from uictest.api import fmu
from uictest.core import files


class Fmi(StrEnum):
    """Version of FMI."""

    TWO = "2"
    THREE = "3"

    @property
    def number(self) -> fmu.FmiVersion:
        """The version as a number."""
        return 2 if self is Fmi.TWO else 3


Output = Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The FMU, a .fmu file.")]
Version = Annotated[Fmi, typer.Option("--fmi", help="Version of FMI.")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")]


def reject_target(output: Path, *, force: bool) -> None:
    """Raise InvalidInputError where the name is none of an FMU or is taken, WriteError for no place."""
    if output.suffix != ".fmu":
        raise runs.InvalidInputError(f"{output}: the name of an FMU ends with .fmu")
    files.require_place(output)
    if output.exists() and not force:
        raise runs.InvalidInputError(f"already there: {output}; --force replaces it")


@contextmanager
def building() -> Iterator[None]:
    """Report what this machine or this package lacks to write an FMU."""
    try:
        yield
    except fmu.CannotBuildError as error:
        raise runs.InvalidInputError(f"{error}") from error

"""`uictest export-controller`: a WSP controller as an FMU."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from uictest import controllers, runs
from uictest.api import fmu
from uictest.cli import fmu_options
from uictest.cli.options import trusted_folders
from uictest.cli.output import ExitCode, data, message
from uictest.core import files
from uictest.plans import scenario

Reference = Annotated[
    str,
    typer.Argument(
        metavar="CONTROLLER",
        help="Part or scenario (.yaml) with a library in C, the library (.so), its source (.c), or the name"
        " of a built-in controller.",
    ),
]
Sources = Annotated[
    list[Path] | None,
    typer.Option(
        "--source",
        metavar="FILE",
        help="C source, compiled in place of the library that the part names. May be repeated.",
    ),
]


def export_controller(
    reference: Reference,
    sources: Sources = None,
    output: fmu_options.Output = Path("controller.fmu"),
    version: fmu_options.Version = fmu_options.Fmi.TWO,
    force: fmu_options.Force = False,
) -> ExitCode:
    """Write a WSP controller as an FMU for co-simulation. Prints the name of the file.

    Its variables have the names that `controller: {fmu: FILE}` looks for, its parameters are parameters of
    the FMU. A library is loaded in a child process.
    """
    fmu_options.reject_target(output, force=force)
    own = [Path(reference)] if reference.endswith(".c") else []
    if sources and not own and not reference.endswith((".yaml", ".yml")):
        raise runs.InvalidInputError(f"{reference}: --source is for a part (.yaml) that names a library")
    paths = [*own, *(sources or ())]
    with files.temporary_folder() as folder, fmu_options.building():
        libraries = _compiled(paths) if paths else None
        library = _own(libraries, paths[0], folder) if libraries else None
        named = str(library) if own else reference
        part: Any = scenario.load_controller(named, "", trusted_folders(), None if own else library)
        try:
            built = fmu.build_controller_fmu(part, version.number, libraries)
        except fmu.NotExportableError as error:
            raise runs.InvalidInputError(f"{reference}: {error}") from error
        except controllers.ControllerError as error:
            usage = f"uictest export-controller PART --source {reference}"
            hint = f"\nwhere a part declares its parameters: {usage}" if own else ""
            raise runs.InvalidInputError(f"{reference}: {error}{hint}") from error
    for note in built.notes:
        message(f"note: {note}")
    files.write_to(output, built.content)
    data(str(output))
    return ExitCode.MET


def _compiled(sources: Sequence[Path]) -> dict[str, bytes]:
    """Return the libraries of these sources. Raises InvalidInputError, CannotBuildError."""
    for path in sources:
        if path.suffix != ".c" or not path.is_file():
            raise runs.InvalidInputError(f"{path}: no such C source; other languages: build a library (.so)")
    try:
        return fmu.compiled(sources)
    except RuntimeError as error:
        raise runs.InvalidInputError(f"{error}") from error


def _own(libraries: Mapping[str, bytes], source: Path, folder: Path) -> Path:
    """Return the library that this system can ask, in a folder."""
    own = fmu.this_system()
    name = f"{source.stem}.{fmu.SYSTEMS[own].suffix}"
    files.write(folder, name, libraries[own])
    return folder / name

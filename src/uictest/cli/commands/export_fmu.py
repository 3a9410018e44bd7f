"""`uictest export-rig`, `export-controller`: the rig of a case, or a WSP controller, as an FMU."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from uictest import controllers, runs
from uictest.api import fmu
from uictest.cli.cases import case_lines
from uictest.cli.options import Overrides, argument, option, trusted_folders
from uictest.cli.output import ExitCode, data, message
from uictest.core import files
from uictest.plans import scenario


class Fmi(StrEnum):
    """Version of FMI."""

    TWO = "2"
    THREE = "3"

    @property
    def number(self) -> fmu.FmiVersion:
        """The version as a number."""
        return 2 if self is Fmi.TWO else 3


Output = Annotated[Path, option("-o --output FILE", "The FMU, a .fmu file.")]
Version = Annotated[Fmi, option("--fmi", "Version of FMI.")]
Force = Annotated[bool, option("--force", "Overwrite an existing file.")]
ScenarioFile = Annotated[Path, argument("SCENARIO", "Scenario file.")]
CaseId = Annotated[str | None, option("--case ID", "Id of the case, where the file has several.")]
Contract = Annotated[
    int,
    option(
        "--contract VERSION",
        "Version of the contract of controllers that the commands keep: 2 reduces the dynamic brake and asks"
        " for sand and track brake.",
    ),
]
Reference = Annotated[
    str,
    argument(
        "CONTROLLER",
        "Part or scenario (.yaml) with a library in C, the library (.so), its source (.c), or the name of a"
        " built-in controller.",
    ),
]
Sources = Annotated[
    list[Path] | None,
    option(
        "--source FILE", "C source, compiled in place of the library that the part names. May be repeated."
    ),
]


def export_rig(
    path: ScenarioFile,
    output: Output = Path("rig.fmu"),
    version: Version = Fmi.TWO,
    case_id: CaseId = None,
    contract: Contract = 1,
    overrides: Overrides = None,
    force: Force = False,
) -> ExitCode:
    """Write the rig of one case as an FMU for co-simulation. Prints the name of the file."""
    _reject_target(output, force=force)
    if contract not in controllers.CONTRACTS:
        accepted = " or ".join(map(str, controllers.CONTRACTS))
        raise typer.BadParameter(f"{contract} is no version, expected {accepted}", param_hint="--contract")
    cases = runs.load_cases([path], overrides, None, trusted_folders())
    selected = [case for case in cases if case_id in (None, case.id)]
    if not selected:
        message(f"uictest: {runs.nothing_selected(cases)}")
        message(case_lines(cases))
        return ExitCode.NOTHING_SELECTED
    if len(selected) > 1 and not all(case.train for case in selected):  # no car of a train can be chosen
        raise runs.InvalidInputError(
            f"{len(selected)} cases; an FMU holds one: choose it with --case ID\n{case_lines(selected)}"
        )
    case = selected[0]
    if case.scenario.repeat > 1:
        message(
            f"note: {case.id}: `repeat` plays no part; the parameter `seed` of the FMU begins other stops"
        )
    try:
        with _building():
            content = fmu.build_fmu(case, version.number, contract)
    except ValueError as error:
        raise runs.InvalidInputError(f"{error}") from error
    files.write_to(output, content)
    data(str(output))
    return ExitCode.MET


def export_controller(
    reference: Reference,
    sources: Sources = None,
    output: Output = Path("controller.fmu"),
    version: Version = Fmi.TWO,
    force: Force = False,
) -> ExitCode:
    """Write a WSP controller as an FMU for co-simulation. Prints the name of the file.

    Its variables have the names that `controller: {fmu: FILE}` looks for, its parameters are parameters of
    the FMU. A library is loaded in a child process.
    """
    _reject_target(output, force=force)
    in_c = [Path(reference)] if reference.endswith(".c") else []
    if sources and not in_c and not reference.endswith((".yaml", ".yml")):
        raise runs.InvalidInputError(f"{reference}: --source is for a part (.yaml) that names a library")
    paths = [*in_c, *(sources or ())]
    with files.temporary_folder() as folder, _building():
        libraries = _compiled(paths) if paths else None
        library = None
        if libraries:  # the one that this system can ask
            system = fmu.this_system()
            library = folder / f"{paths[0].stem}.{fmu.SYSTEMS[system].suffix}"
            files.write(folder, library.name, libraries[system])
        named = str(library) if in_c else reference
        part: Any = scenario.load_controller(named, "", trusted_folders(), None if in_c else library)
        try:
            built = fmu.build_controller_fmu(part, version.number, libraries)
        except fmu.NotExportableError as error:
            raise runs.InvalidInputError(f"{reference}: {error}") from error
        except controllers.ControllerError as error:
            usage = f"uictest export-controller PART --source {reference}"
            hint = f"\nwhere a part declares its parameters: {usage}" if in_c else ""
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


def _reject_target(output: Path, *, force: bool) -> None:
    """Raise InvalidInputError where the name is none of an FMU or is taken, WriteError for no place."""
    if output.suffix != ".fmu":
        raise runs.InvalidInputError(f"{output}: the name of an FMU ends with .fmu")
    files.require_place(output)
    if output.exists() and not force:
        raise runs.InvalidInputError(f"already there: {output}; --force replaces it")


@contextmanager
def _building() -> Iterator[None]:
    """Report what this machine or this package lacks to write an FMU."""
    try:
        yield
    except fmu.CannotBuildError as error:
        raise runs.InvalidInputError(f"{error}") from error

"""`uictest export-rig`: the rig of one case as an FMU."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from uictest import runs
from uictest.api import rig_fmu
from uictest.cli.cases import case_lines
from uictest.cli.options import Overrides, trusted_folders
from uictest.cli.output import ExitCode, data, message
from uictest.cli.progress import compilation_shown
from uictest.core import files
from uictest.plans import scenario


class Fmi(StrEnum):
    """Version of FMI."""

    TWO = "2"
    THREE = "3"


ScenarioFile = Annotated[Path, typer.Argument(metavar="SCENARIO", help="Scenario file.")]
Output = Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The FMU, a .fmu file.")]
Version = Annotated[Fmi, typer.Option("--fmi", help="Version of FMI.")]
CaseId = Annotated[
    str | None, typer.Option("--case", metavar="ID", help="Id of the case, where the file has several.")
]
Force = Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")]


def export_rig(
    path: ScenarioFile,
    output: Output = Path("rig.fmu"),
    version: Version = Fmi.TWO,
    case_id: CaseId = None,
    overrides: Overrides = None,
    force: Force = False,
) -> ExitCode:
    """Write the rig of one case as an FMU for co-simulation. Prints the name of the file."""
    _reject_target(output, force=force)
    cases = runs.load_cases([path], overrides, None, trusted_folders())
    selected = [case for case in cases if case_id in (None, case.id)]
    if not selected:
        message(f"uictest: {runs.nothing_selected(cases)}")
        message(case_lines(cases))
        return ExitCode.NOTHING_SELECTED
    case = _only(selected)
    if case.scenario.repeat > 1:
        message(
            f"note: {case.id}: `repeat` plays no part; the parameter `seed` of the FMU begins other stops"
        )
    content = _built(case, version)
    files.write_to(output, content)
    data(str(output))
    return ExitCode.MET


def _reject_target(output: Path, *, force: bool) -> None:
    """Raise InvalidInputError where the FMU cannot be written."""
    if output.suffix != ".fmu":
        raise runs.InvalidInputError(f"{output}: the name of an FMU ends with .fmu")
    if not output.parent.is_dir():
        raise runs.InvalidInputError(f"{output}: there is no folder {output.parent}")
    if output.exists() and not force:
        raise runs.InvalidInputError(f"already there: {output}; --force replaces it")


def _only(cases: Sequence[scenario.Case]) -> scenario.Case:
    if len(cases) > 1:
        raise runs.InvalidInputError(
            f"{len(cases)} cases; an FMU holds one: choose it with --case ID\n{case_lines(cases)}"
        )
    return cases[0]


def _built(case: scenario.Case, version: Fmi) -> bytes:
    """Return the FMU; what the machine lacks is reported before anything is compiled."""
    try:
        compiler = rig_fmu.usable_compiler()
    except rig_fmu.CannotBuildError as error:
        raise runs.InvalidInputError(f"{error}") from error
    try:
        with compilation_shown():
            return rig_fmu.build_fmu(case, 2 if version is Fmi.TWO else 3, compiler)
    except ValueError as error:
        raise runs.InvalidInputError(f"{error}") from error

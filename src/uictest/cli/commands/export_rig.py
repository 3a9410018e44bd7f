"""`uictest export-rig`: the rig of one case as an FMU."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import controllers, runs
from uictest.api import fmu
from uictest.cli import fmu_options
from uictest.cli.cases import case_lines
from uictest.cli.options import Overrides, trusted_folders
from uictest.cli.output import ExitCode, data, message
from uictest.core import files
from uictest.plans import scenario

ScenarioFile = Annotated[Path, typer.Argument(metavar="SCENARIO", help="Scenario file.")]
CaseId = Annotated[
    str | None, typer.Option("--case", metavar="ID", help="Id of the case, where the file has several.")
]

Contract = Annotated[
    int,
    typer.Option(
        "--contract",
        metavar="VERSION",
        help="Version of the contract of controllers that the commands keep: 2 reduces the dynamic brake and "
        "asks for sand and track brake.",
    ),
]


def export_rig(
    path: ScenarioFile,
    output: fmu_options.Output = Path("rig.fmu"),
    version: fmu_options.Version = fmu_options.Fmi.TWO,
    case_id: CaseId = None,
    contract: Contract = 1,
    overrides: Overrides = None,
    force: fmu_options.Force = False,
) -> ExitCode:
    """Write the rig of one case as an FMU for co-simulation. Prints the name of the file."""
    fmu_options.reject_target(output, force=force)
    if contract not in controllers.CONTRACTS:
        accepted = " or ".join(map(str, controllers.CONTRACTS))
        raise typer.BadParameter(f"{contract} is no version, expected {accepted}", param_hint="--contract")
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
    try:
        with fmu_options.building():
            content = fmu.build_fmu(case, version.number, contract)
    except ValueError as error:
        raise runs.InvalidInputError(f"{error}") from error
    files.write_to(output, content)
    data(str(output))
    return ExitCode.MET


def _only(cases: Sequence[scenario.Case]) -> scenario.Case:
    if len(cases) > 1 and not all(case.train for case in cases):  # no car of a train can be chosen
        raise runs.InvalidInputError(
            f"{len(cases)} cases; an FMU holds one: choose it with --case ID\n{case_lines(cases)}"
        )
    return cases[0]

"""What the commands for recordings share."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

from uictest import runs
from uictest.cli.cases import malformed
from uictest.cli.options import argument, option, rejected
from uictest.cli.output import message
from uictest.plans import scenario
from uictest.recorded import field_data
from uictest.rig import bench

Files = Annotated[list[Path], argument("FILE", "Recordings.", show_default=False)]
MapName = Annotated[
    str, option("--map NAME|FILE", "Channel map: a preset (uictest, common-names) or a YAML file.")
]
Trigger = Annotated[
    str | None,
    option(
        "--trigger HOW|TIME",
        "Brake command at: auto, stated, start, command, demand, pressure, or a time such as '12.3 s'.",
    ),
]


def channel_map(
    reference: str, trusted: Sequence[Path] | None, trigger: str | None
) -> tuple[field_data.ChannelMap, dict[str, str]]:
    """Return a channel map, its trigger that of the option, and the files read for it.

    Raises as :func:`uictest.runs.named_map`, and typer.BadParameter for a text that is not a trigger.
    """
    loaded, inputs = runs.named_map(reference, trusted)
    with rejected("--trigger"):
        return loaded.triggered_by(trigger), inputs


def one_case(
    path: Path, expression: str | None, overrides: Sequence[str], trusted: Sequence[Path] | None
) -> scenario.Case:
    """Return the one case of a scenario file. Raises InvalidInputError where there are several or none."""
    with malformed("-k", expression):
        return runs.only_case(path, expression, overrides, trusted)


def case_of_stop(
    scenario: Path | None, expression: str | None, statements: Sequence[str], trusted: Sequence[Path] | None
) -> runs.CaseOfStop:
    """Return the function that makes the case of a recording. Raises InvalidInputError."""
    case = None if scenario is None else one_case(scenario, expression, statements, trusted)
    if case is not None and case.scenario.repeat > 1:
        message(f"note: {case.id}: `repeat` plays no part: a recording is one stop")
    return runs.case_of_stop(
        case,
        statements,
        trusted,
        lambda keys: f"--scenario FILE, or with {' '.join(f'--set {key}=...' for key in keys)}",
    )


def rig_of_record(
    record: Path, stated: Mapping[str, str], overrides: Sequence[str], trusted: Sequence[Path]
) -> scenario.Case:
    """Return the rig of the library with overrides.

    Raises InvalidInputError where the record states another tank or valve (`stated`, by the keys of a
    scenario).
    """
    case = bench.trace_recipe(record, "", None, overrides, None, trusted).case
    assumed = scenario.rig_as_built(case.scenario)
    of_air = [key for key in stated if key in assumed and key.startswith("brake.system.")]
    recorded = bench.trace_recipe(record, "", None, [f"{key}={stated[key]}" for key in of_air]).case
    values = scenario.rig_as_built(recorded.scenario)
    other = [key for key in of_air if values[key] != assumed[key]]
    if other:
        listed = "; ".join(f"{key} {values[key].text}, not {assumed[key].text}" for key in other)
        options = " ".join(f"--set {shlex.quote(f'{key}={values[key].text}')}" for key in other)
        raise runs.InvalidInputError(
            f"{record}: recorded on another rig than assumed: {listed}; write {options}"
        )
    return case

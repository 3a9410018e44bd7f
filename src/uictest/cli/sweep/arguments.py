"""Convert the arguments of `uictest sweep` to plans, selections and searches."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePath
from typing import Literal

import typer

from uictest import campaign, sweep
from uictest.cli.exit_codes import InvalidInputError
from uictest.scenario import yaml


def load_plan(
    file: Path, overrides: Sequence[str] | None, seed: int | None, trusted: Sequence[Path] | None = None
) -> sweep.Plan:
    """Return the plan of a sweep file. Raises InvalidInputError with every diagnostic."""
    try:
        return sweep.load_sweep(file, tuple(overrides or ()), seed, trusted or ())
    except yaml.ScenarioErrors as errors:
        raise InvalidInputError(str(errors)) from errors


def selected_cases(
    plan: sweep.Plan, expression: str | None, device: Literal["cpu", "cuda"] = "cpu"
) -> sweep.CaseSelection:
    """Return the cases that `-k` selects. Raises typer.BadParameter for a malformed expression."""
    try:
        return sweep.select_cases(plan, expression, device)
    except campaign.ExpressionError as error:
        raise typer.BadParameter(f"{error} in {expression!r}", param_hint="-k") from error


def reject_programs_on_gpu(plan: sweep.Plan, device: Literal["cpu", "cuda"]) -> None:
    """Raise typer.BadParameter where a GPU would have to run a controller from outside."""
    program = next(sweep.programs_of(plan), None) if device == "cuda" else None
    if program is not None:
        name = PurePath(program.location).name if program.sha256 else program.location
        message = f"a GPU runs built-in controllers only, not {name}; leave --device out"
        raise typer.BadParameter(message, param_hint="--device")


def shard_of(text: str | None) -> sweep.Shard:
    """Return the shard that `--shard` names, else the only one. Raises typer.BadParameter."""
    try:
        return sweep.Shard() if text is None else sweep.parse_shard(text)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--shard") from error


def cluster_address(address: str | None) -> str | None:
    """Return the address that `--dask` names. Raises typer.BadParameter."""
    try:
        if address is not None:
            sweep.check_address(address)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--dask") from error
    return address


def frontier_search(plan: sweep.Plan, key: str | None, tolerance: str | None) -> sweep.FrontierSearch | None:
    """Return the search of `--frontier` and `--tolerance`. Raises typer.BadParameter."""
    if key is None:
        return None
    try:
        width = None if tolerance is None else sweep.parse_decimal_quantity(tolerance)
        return sweep.FrontierSearch(plan, key, width)
    except sweep.FrontierError as error:
        raise typer.BadParameter(str(error), param_hint="--frontier") from error
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--tolerance") from error


def map_pair(plan: sweep.Plan, text: str | None) -> tuple[str, str] | None:
    """Return the parameters that `--map` names, else the first two with several listed values.

    Raises typer.BadParameter.
    """
    if text is None:
        listed = [key for key, values in plan.listed().items() if len(values) > 1]
        return (listed[0], listed[1]) if len(listed) > 1 else None
    first, _, second = text.partition(",")
    pair = (first.strip(), second.strip())
    unknown = [key for key in pair if key not in plan.keys]
    if unknown or pair[0] == pair[1]:
        accepted = ", ".join(plan.keys)
        raise typer.BadParameter(f"name two parameters of {accepted}, as KEY,KEY", param_hint="--map")
    return pair


def measure_names(names: Sequence[str] | None) -> tuple[str, ...]:
    """Return the columns that `--measure` names, else the braking distance. Raises typer.BadParameter."""
    columns = sweep.measure_columns()
    for name in names or ():
        if name not in columns:
            hint = yaml.suggestion(name, columns)
            raise typer.BadParameter(f"no measure {name!r}; {hint}", param_hint="--measure")
    return tuple(dict.fromkeys(names or ("braking_distance_m",)))

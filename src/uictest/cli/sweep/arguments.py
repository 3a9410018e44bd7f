"""Convert the arguments of `uictest sweep` to plans, selections and searches; find sweep files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import typer

from uictest import runs
from uictest.analysis import summaries
from uictest.plans import scenario, sweeps
from uictest.running import campaign, chunked


def selected_cases(plan: sweeps.Plan, expression: str | None) -> chunked.CaseSelection:
    """Return the cases that `-k` selects. Raises typer.BadParameter for a malformed expression."""
    try:
        return chunked.select_cases(plan, expression)
    except campaign.ExpressionError as error:
        raise typer.BadParameter(f"{error} in {expression!r}", param_hint="-k") from error


def shard_of(text: str | None) -> chunked.Shard:
    """Return the shard that `--shard` names, else the only one. Raises typer.BadParameter."""
    try:
        return chunked.Shard() if text is None else chunked.parse_shard(text)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--shard") from error


def cluster_address(address: str | None) -> str | None:
    """Return the address that `--dask` names. Raises typer.BadParameter."""
    try:
        if address is not None:
            chunked.check_address(address)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--dask") from error
    return address


def frontier_search(
    plan: sweeps.Plan, key: str | None, tolerance: str | None
) -> summaries.FrontierSearch | None:
    """Return the search of `--frontier` and `--tolerance`. Raises typer.BadParameter."""
    try:
        return runs.frontier_search(plan, key, tolerance)
    except summaries.FrontierError as error:
        raise typer.BadParameter(str(error), param_hint="--frontier") from error
    except runs.ToleranceError as error:
        raise typer.BadParameter(str(error), param_hint="--tolerance") from error


def map_pair(plan: sweeps.Plan, text: str | None) -> tuple[str, str] | None:
    """Return the parameters that `--map` names, else the first two with several listed values.

    Raises typer.BadParameter.
    """
    if text is None:
        return runs.first_pair(plan)
    first, _, second = text.partition(",")
    pair = (first.strip(), second.strip())
    unknown = [key for key in pair if key not in plan.keys]
    if unknown or pair[0] == pair[1]:
        accepted = ", ".join(plan.keys)
        raise typer.BadParameter(f"name two parameters of {accepted}, as KEY,KEY", param_hint="--map")
    return pair


def measure_names(names: Sequence[str] | None) -> tuple[str, ...]:
    """Return the columns that `--measure` names, else the braking distance. Raises typer.BadParameter."""
    try:
        return runs.measure_names(names)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--measure") from error


def is_sweep(path: Path) -> bool:
    """Return whether a path names a sweep file."""
    return path.name.endswith(scenario.SWEEP_SUFFIXES)


def sweep_files(paths: Sequence[Path]) -> Iterator[Path]:
    """Yield the sweep files among the paths, and those below folders that are not hidden."""
    for path in paths:
        if path.is_dir():
            below = sorted(path.rglob("*.sweep.y*ml"), key=Path.as_posix)
            yield from (each for each in below if is_sweep(each) and not _hidden(each.relative_to(path)))
        elif is_sweep(path):
            yield path


def _hidden(path: Path) -> bool:
    return any(part.startswith(".") for part in path.parts)

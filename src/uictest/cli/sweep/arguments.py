"""Convert the arguments of `uictest sweep` to plans, selections and searches."""

from __future__ import annotations

from collections.abc import Sequence

import typer

from uictest import runs
from uictest.analysis import summaries
from uictest.cli.cases import malformed
from uictest.cli.options import rejected
from uictest.plans import sweeps
from uictest.running import chunked


def selected_cases(plan: sweeps.Plan, expression: str | None) -> chunked.CaseSelection:
    """Return the cases that `-k` selects. Raises typer.BadParameter for a malformed expression."""
    with malformed("-k", expression):
        return chunked.select_cases(plan, expression)


def shard_of(text: str | None) -> chunked.Shard:
    """Return the shard that `--shard` names, else the only one. Raises typer.BadParameter."""
    with rejected("--shard"):
        return chunked.Shard() if text is None else chunked.parse_shard(text)


def cluster_address(address: str | None) -> str | None:
    """Return the address that `--dask` names. Raises typer.BadParameter."""
    with rejected("--dask"):
        if address is not None:
            chunked.check_address(address)
    return address


def frontier_search(
    plan: sweeps.Plan, key: str | None, tolerance: str | None
) -> summaries.FrontierSearch | None:
    """Return the search of `--frontier` and `--tolerance`. Raises typer.BadParameter."""
    with rejected("--frontier", summaries.FrontierError), rejected("--tolerance", runs.ToleranceError):
        return runs.frontier_search(plan, key, tolerance)


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
    with rejected("--measure"):
        return runs.measure_names(names)

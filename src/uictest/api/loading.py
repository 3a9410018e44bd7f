"""Load and select cases."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from uictest import runs
from uictest.api.arguments import PathName, Trusted, as_paths, checked_seed, expression_of
from uictest.api.assignments import Assignments, override_texts
from uictest.plans import scenario, series


def load(
    *paths: PathName,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    seed: int | None = None,
    select: str | None = None,
    tag: str | None = None,
    trust: Trusted = (),
) -> tuple[scenario.Case, ...]:
    """Load the cases of scenario files.

    Args:
        paths: scenario files or folders [default: `scenarios`]; series in folders are left out.
        set: dotted key -> value in every scenario: a text as in a file (`90 %`), a number where a key is a
            pure number, or a list of them, which becomes an axis.
        seed: of the sensor noise in every case, 0 to 2^32 - 1.
        select: expression over ids, file names and tags, as `-k`.
        tag: expression over tags, as `-m`.
        trust: folders that scenarios may refer to, besides their own and the working folder.

    Returns:
        The cases in the order of `uictest list`; ids are unique.

    Raises:
        uictest.ScenarioErrors: files are invalid, or a key of `set`; the message has every error in it.
        ValueError: nothing is selected, or an argument is invalid.

    """
    texts, folders = override_texts(set), as_paths(trust)
    places = as_paths(paths) or runs.scenario_paths(None)
    for path in places:
        if runs.is_series(path):
            raise ValueError(f"{path} is a series: uictest.run judges its stops together")
    cases = runs.load_cases(places, texts, checked_seed(seed), folders)
    return tuple(selected(cases, (), select, tag)[0])


def selected(
    cases: Sequence[scenario.Case],
    planned: Sequence[series.Series],
    select: str | None,
    tag: str | None,
) -> tuple[list[scenario.Case], list[series.Series]]:
    """Return the selected cases and series. Raises ValueError where there are none."""
    with expression_of("select", select):
        chosen, of_series = runs.select_cases(cases, select), runs.select_series(planned, select)
    with expression_of("tag", tag):
        chosen, of_series = runs.select_cases(chosen, tag=tag), runs.select_series(of_series, tag=tag)
    if not (chosen or of_series):
        raise ValueError(runs.nothing_selected(cases, planned))
    return chosen, of_series


def one_case(
    path: Path, case: str | None, texts: Sequence[str], seed: int | None, trusted: Sequence[Path]
) -> scenario.Case:
    """Return the case of an id, or the only one, of a scenario file. Raises ValueError, ScenarioErrors."""
    return scenario.chosen_case(runs.load_cases([path], texts, seed, trusted), case)

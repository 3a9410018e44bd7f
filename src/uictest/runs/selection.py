"""Select cases and series by expression and tag."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from uictest.plans import scenario, series
from uictest.report import RunContent, counted
from uictest.running import campaign
from uictest.runs.scenario_files import InvalidInputError, load_cases


def select_cases(
    cases: Sequence[scenario.Case], expression: str | None = None, tag: str | None = None
) -> list[scenario.Case]:
    """Return the cases that an expression (`-k`) and tags (`-m`) select. Raises ExpressionError."""
    selected = list(cases)
    if expression is not None:
        selected = campaign.by_expression(selected, expression)
    return selected if tag is None else campaign.by_tag(selected, tag)


def select_series(
    loaded: Sequence[series.Series], expression: str | None = None, tag: str | None = None
) -> list[series.Series]:
    """Return the series that an expression (`-k`) and tags (`-m`) select. Raises ExpressionError."""
    selected = list(loaded)
    for text, whole in ((expression, False), (tag, True)):
        if text is not None:
            holds = campaign.parse(text)
            selected = [each for each in selected if holds(_matcher(each, whole=whole))]
    return selected


def _matcher(each: series.Series, *, whole: bool) -> campaign.Matches:
    if whole:
        return frozenset(each.file.tags).__contains__
    return _mentioned_in([each.id, each.path.stem, *each.file.tags])


def _mentioned_in(names: Sequence[str]) -> campaign.Matches:
    folded = [name.casefold() for name in names]
    return lambda word: any(word.casefold() in name for name in folded)


def result_ids(content: RunContent, expression: str) -> frozenset[str]:
    """Return the ids of the cases of a finished run that an expression (`-k`) selects.

    Raises ExpressionError.
    """
    holds = campaign.parse(expression)
    names = {
        each.id: [each.id, Path(each.scenario).stem, *content.subject(each.id).tags]
        for each in content.all_results
    }
    return frozenset(name for name, own in names.items() if holds(_mentioned_in(own)))


def nothing_selected(cases: Sequence[scenario.Case], planned: Sequence[series.Series] = ()) -> str:
    """Return the message for an empty selection, with the number of cases and series and their tags."""
    of_series = {tag for each in planned for tag in each.file.tags}
    tags = sorted({tag for case in cases for tag in case.scenario.tags} | of_series)
    among = f"{counted(len(cases), 'case')}{f' and {len(planned)} series' if planned else ''}"
    return f"nothing selected among {among}; their tags: {', '.join(tags) or 'none'}"


def only_case(
    path: Path,
    expression: str | None,
    overrides: Sequence[str],
    trusted: Sequence[Path] | None,
    how: str = "choose with -k",
) -> scenario.Case:
    """Return the one case of a scenario file; `how` says how to choose one.

    Raises InvalidInputError where there are several or none, ScenarioErrors, ExpressionError.
    """
    cases = select_cases(load_cases([path], overrides, None, trusted), expression)
    if len(cases) != 1:
        ids = ", ".join(case.id for case in cases[:8]) or "none is selected"
        raise InvalidInputError(f"{path} has {len(cases)} cases where one is needed ({ids}); {how}")
    return cases[0]

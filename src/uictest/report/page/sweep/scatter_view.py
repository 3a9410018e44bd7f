"""The points of a sampled sweep as a page holds them: numbers as JSON, and sentences on what is shown."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from uictest.report.escaping import printable
from uictest.report.page.stop.overlay_view import script_json
from uictest.report.sweep.cases import every_case
from uictest.report.sweep.scatter import PointNumbers, Scatter
from uictest.report.wording import counted, tone

FIRST_PARAMETERS, FIRST_MEASURES = 4, 2
"""Panels across and down that are shown before the reader chooses."""
MOST_PARAMETERS, MOST_MEASURES = 6, 4
"""Panels across and down at the same time."""


@dataclass(frozen=True, slots=True)
class ScatterView:
    """A matrix of panels: parameters across, measures down.

    Args:
        parameters: keys.
        measures: names.
        chosen: those of both that are shown first.
        sentences: what is shown of what there is.
        data: the JSON that the panels are drawn from.

    """

    parameters: Sequence[str]
    measures: Sequence[str]
    chosen: Sequence[str]
    sentences: Sequence[str]
    data: str


def scatter_view(scatter: Scatter, fragments: Mapping[str, str]) -> ScatterView:
    """Return the points of a sampled sweep; `fragments` has what links to each drawn stop, by id."""
    parameters, measures = ([each.name for each in some] for some in (scatter.parameters, scatter.measures))
    return ScatterView(
        parameters,
        measures,
        [*parameters[:FIRST_PARAMETERS], *measures[:FIRST_MEASURES]],
        list(_sentences(scatter)),
        script_json(_form(scatter, fragments)),
    )


def _sentences(scatter: Scatter) -> Iterator[str]:
    shown = len(scatter.ids)
    if shown < scatter.cases:
        by_chance = f"{_grouped(shown - scatter.added)} of {_grouped(scatter.cases)} cases"
        own = f", and {counted(scatter.added, 'drawn stop')} besides" if scatter.added else ""
        yield f"Shown: {by_chance}, chosen at random{own}."
        yield f"Rare cases may be missing here; {every_case(scatter.cases)} has every case."
    else:
        yield f"Shown: all {counted(shown, 'case')}."
    if scatter.left_out:
        yield f"Not numbers of one unit, and not here: {', '.join(scatter.left_out)}."


def _form(scatter: Scatter, fragments: Mapping[str, str]) -> dict[str, Any]:
    # A verdict that no point has is in the legend, too.
    words = sorted(scatter.all_words, key=lambda word: -scatter.all_words[word])
    return {
        "parameters": list(map(_numbers, scatter.parameters)),
        "measures": list(map(_numbers, scatter.measures)),
        "ids": list(map(printable, scatter.ids)),
        "words": [{"word": word, "tone": tone(word), "all": scatter.all_words[word]} for word in words],
        "word": [words.index(word) for word in scatter.words],
        "stops": {place: fragments[name] for place, name in enumerate(scatter.ids) if name in fragments},
        "limits": {"parameter": MOST_PARAMETERS, "measure": MOST_MEASURES},
    }


def _numbers(numbers: PointNumbers) -> dict[str, Any]:
    values = [_rounded(value) if value == value else None for value in numbers.numbers.tolist()]
    return {
        "name": printable(numbers.name),
        "unit": printable(numbers.unit),
        "logarithmic": numbers.logarithmic,
        "values": values,
    }


def _rounded(value: float) -> float:
    """Return a number with seven digits, and a whole one, as a seed is, with all."""
    return value if value.is_integer() else float(f"{value:.7g}")


def _grouped(count: int) -> str:
    return f"{count:,}".replace(",", " ")

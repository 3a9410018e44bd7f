"""Series side by side: the value of every criterion with its interval, and which of them are missed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from uictest.core.series_measures import SeriesValue
from uictest.judging.series import SeriesResult, SeriesVerdict
from uictest.report.series.wording import interval, of_dry_stop, series_word, short

_REMARKS = {"fail": "fail", "inconclusive": "inconclusive", "not_applicable": "not applicable"}
_NOT_CERTAIN = "not certain"


def comparison_columns(results: Sequence[SeriesResult]) -> list[str]:
    """Return the headings of the comparison: a column for each criterion of any series, with its unit."""
    return ["series", "verdict", "wet stops", *(_heading(each) for each in _criteria(results).values())]


def comparison_rows(results: Sequence[SeriesResult]) -> Iterator[list[str]]:
    """Yield the cells of every series: how many wet stops count, then what each criterion came to."""
    for result in results:
        by_id = {each.verdict.id: each for each in result.criteria}
        cells = [_cell(by_id[name]) if name in by_id else "-" for name in _criteria(results)]
        yield [
            result.id,
            series_word(result),
            f"{result.wet_stops.counted} of {result.wet_stops.run}",
            *cells,
        ]


def value_with_interval(value: SeriesValue) -> str:
    """Return a value with its interval in parentheses, `-` where there is none."""
    if value.estimate is None:
        return "-"
    shown = interval(value.estimate)
    return f"{short(value.estimate.value)} ({shown})" if shown else short(value.estimate.value)


def _criteria(results: Sequence[SeriesResult]) -> dict[str, SeriesVerdict]:
    """Return the first verdict of every criterion by its id."""
    found: dict[str, SeriesVerdict] = {}
    for result in results:
        for each in result.criteria:
            found.setdefault(each.verdict.id, each)
    return found


def _heading(each: SeriesVerdict) -> str:
    unit = "" if each.verdict.unit == "1" else each.verdict.unit
    return f"{each.verdict.id}, {unit}{of_dry_stop(each)}" if unit else each.verdict.id


def _cell(each: SeriesVerdict) -> str:
    known = short(each.verdict.value)
    value = known if each.estimate is None else value_with_interval(SeriesValue(each.estimate))
    remark = _REMARKS.get(each.verdict.status, "")
    return ", ".join(
        filter(None, (f"{value} {remark}".strip(), _NOT_CERTAIN if each.confident is False else ""))
    )

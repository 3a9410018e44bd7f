"""How firm verdicts are, in sentences, and the numbers that were varied as a table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

from uictest.core.document import Cell, Column, Table
from uictest.report.escaping import printable

if TYPE_CHECKING:
    from uictest.judging.evaluation import CaseResult, Firmness, NumberEffect, Turn, VerdictFirmness
    from uictest.judging.series import SeriesResult

_MOST_TURNS: Final = 6
"""Numbers that a sentence names; chosen."""
_MOST_NUMBERS: Final = 12
"""Numbers that a summary shows; chosen."""
_WORDS: Final = {
    "firm": "firm",
    "turns": "not firm",
    "noise": "not firm: it turns over the seeds (noise, random rail) at the nominal values, too",
    "not_shown": "not shown to be firm",
}


def firmness_sentences(result: CaseResult | SeriesResult) -> Iterator[str]:
    """Yield how firm an outcome is, and which verdicts are not firm and by what they turn; else nothing."""
    firmness = result.firmness
    if firmness is None:
        return
    if result.outcome != firmness.nominal:
        yield (
            f"{result.outcome} is not shown to be firm: the stops that were varied come to"
            f" {firmness.nominal}, of which the following is said"
        )
    yield printable(f"{firmness.nominal} is {_status(firmness, firmness)}")
    for each in firmness.criteria:
        if each.turned or each.turned_by or each.status == "noise":
            told = [f"{each.criterion} {each.nominal} is {_status(each, firmness)}", *_turns(each)]
            yield printable("; ".join(told))
    yield from map(printable, _remarks(firmness))


def firmness_lines(result: CaseResult | SeriesResult) -> Iterator[str]:
    """Yield the same as lines for grep: the word `firmness`, the id of the case or series, and a sentence."""
    for sentence in firmness_sentences(result):
        yield f"firmness {printable(result.id)} {sentence}"


def firmness_property(result: CaseResult | SeriesResult) -> dict[str, str]:
    """Return the property of a testcase: `{"firmness": "turns: a.b above 6.1 kJ/m"}`; {} if not asked."""
    firmness = result.firmness
    if firmness is None:
        return {}
    if result.outcome != firmness.nominal:
        return {"firmness": "not_shown"}  # what was varied came to another outcome
    turns = [f"{each.key} {each.side} {each.value or each.stands_to}" for each in firmness.turned_by]
    return {"firmness": ": ".join(filter(None, (firmness.status, ", ".join(turns))))}


def _status(verdict: VerdictFirmness, firmness: Firmness) -> str:
    word = _WORDS[verdict.status]
    if not firmness.numbers:
        return f"{word}: no number states a plausible range"
    if not verdict.counted:
        return f"{word}: none of {firmness.draws} draws is a test"
    draws = f"{verdict.counted} draws of {len(firmness.numbers)} numbers within their ranges"
    calibrated = _calibrated(verdict, firmness)
    if verdict.turned or verdict.share_at_least is None:
        low, high = verdict.lowest_block, verdict.highest_block
        blocks = "" if low is None or high is None else f" ({_percent(low)} to {_percent(high)} in blocks)"
        return f"{word}: it stands in {_percent(verdict.share)} of {draws}{blocks}{calibrated}"
    least = _percent(verdict.share_at_least, 4)
    return f"{word}: it stands in all of {draws}, a share above {least}{calibrated}"


def _calibrated(verdict: VerdictFirmness, firmness: Firmness) -> str:
    """Return in which share of the calibrated draws a verdict stands; nothing where no stops calibrate."""
    if verdict.calibrated is None:
        return ""
    stops, counted = ", ".join(firmness.calibrated_by), verdict.calibrated.counted
    share = f" and in {_percent(verdict.calibrated.share)} of the" if counted else ", of which"
    count = f"{counted} of them" if counted else "none"
    return f"{share} {count} in which {stops} comes to what it expects"


def _turns(verdict: VerdictFirmness) -> Iterator[str]:
    turns = verdict.turned_by
    for turn in turns[:_MOST_TURNS]:
        yield turn_text(turn)
    if len(turns) > _MOST_TURNS:
        yield f"and by {len(turns) - _MOST_TURNS} more numbers alone"
    if verdict.turned and not turns and verdict.status == "turns":
        yield "by several numbers together, or by one between the ends of its range; by none alone at an end"


def turn_text(turn: Turn) -> str:
    """Return where a number turns a verdict, as in `turned by a.b above 6.1 kJ/m (k-wet fail; ...)`."""
    if not turn.value:
        return (
            f"turned by {turn.key} in places or under some seeds between {turn.stands_to} and {turn.end}"
            f" ({turn.to})"
        )
    under_all = f", under every seed {turn.side} {turn.turned_from}" if turn.turned_from else ""
    return (
        f"turned by {turn.key} {turn.side} {turn.value}"
        f" ({turn.to}{under_all}; it stands to {turn.stands_to}; range to {turn.end})"
    )


def _remarks(firmness: Firmness) -> Iterator[str]:
    no_test = firmness.draws - firmness.infeasible - firmness.counted
    left_out = [
        f"{count} {words}"
        for count, words in ((no_test, "are no test"), (firmness.infeasible, "do not fit together"))
        if count and firmness.nominal != "error"
    ]
    if left_out:
        yield f"of {firmness.draws} draws {', '.join(left_out)}: they do not count"
    if firmness.not_run:
        yield f"no stop could be run at an end of the range of {', '.join(firmness.not_run)}"
    if firmness.without_range:
        yield f"not varied, as no range is stated: {', '.join(firmness.without_range)}"
    if firmness.on_four_calipers:
        yield (
            "run with a caliper in every module: a compensation stands in only for the rig that it was"
            " identified for"
        )
    if firmness.in_survey_steps:
        yield "simulated in steps of 1 ms; in 0.5 ms where the bias of the longer step may decide a verdict"


class _Row(NamedTuple):
    number: NumberEffect
    criterion: VerdictFirmness
    turned: str


def firmness_table(firmness: Firmness, car: str = "") -> Table:
    """Return the numbers, those that turn a verdict first, then by how much they change a margin.

    Its title names the `car` where there are several.
    """
    turned = {each.key: "yes" for verdict in firmness.criteria for each in verdict.turned_by}
    rows = [
        _Row(number, _most_changed(number, firmness.criteria), turned.get(number.key, ""))
        for number in firmness.numbers
        if firmness.criteria
    ]
    rows.sort(key=lambda row: (not row.turned, -_change(row)))
    title = f"What the numbers do to the margins{car and f' of {car}'}"
    return Table(_COLUMNS, rows, title, most=_MOST_NUMBERS, more=_MORE)


_MORE: Final = "more in firmness.csv"
_COLUMNS: Final[Sequence[Column[_Row]]] = (
    Column(heading="number", text=lambda row: row.number.key, literal=True),
    Column(heading="value", text=lambda row: row.number.value, right=True),
    Column(heading="range", text=lambda row: f"{row.number.lowest} .. {row.number.highest}", rank=3),
    Column(heading="prior", text=lambda row: row.number.prior, rank=3),
    Column(heading="turns", text=lambda row: row.turned, tone=lambda row: "bad" if row.turned else None),
    Column(heading="criterion", text=lambda row: row.criterion.criterion),
    Column(heading="margin\n%", text=lambda row: _share(row.criterion.margin), right=True),
    Column(heading="at lowest\n%", text=lambda row: _share(_ends(row)[0]), right=True),
    Column(heading="at highest\n%", text=lambda row: _share(_ends(row)[1]), right=True),
    Column(heading="mark", text=lambda row: row.number.mark, rank=4),
    Column(heading="why this range and prior", text=lambda row: row.number.reason, rank=5, wraps=True),
)


def firmness_rows(name: str, firmness: Firmness) -> Iterator[dict[str, Cell]]:
    """Yield a row for each number and criterion, for programs."""
    for number in firmness.numbers:
        for verdict in firmness.criteria:
            low, high = number.margins.get(verdict.criterion, (None, None))
            yield {
                "id": name,
                "key": number.key,
                "value": number.value,
                "lowest": number.lowest,
                "highest": number.highest,
                "prior": number.prior,
                "mark": number.mark,
                "criterion": verdict.criterion,
                "margin": verdict.margin,
                "margin_at_lowest": low,
                "margin_at_highest": high,
                "turns": any(each.key == number.key for each in verdict.turned_by),
                "reason": number.reason,
            }


def _most_changed(number: NumberEffect, verdicts: Sequence[VerdictFirmness]) -> VerdictFirmness:
    turning = [each for each in verdicts if any(turn.key == number.key for turn in each.turned_by)]
    return max(turning or verdicts, key=lambda each: number.effect(each.criterion, each.margin))


def _change(row: _Row) -> float:
    return row.number.effect(row.criterion.criterion, row.criterion.margin)


def _ends(row: _Row) -> tuple[float | None, float | None]:
    return row.number.margins.get(row.criterion.criterion, (None, None))


def _share(value: float | None) -> str:
    return "" if value is None else f"{100 * value:.3g}"


def _percent(value: float | None, digits: int = 3) -> str:
    return "none" if value is None else f"{100 * value:.{digits}g} %"

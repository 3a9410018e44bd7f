"""How robust an outcome is: over the stops of a repeated case, and over numbers that nobody measured."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

from uictest.core import statistics
from uictest.core.document import Cell, Column, Table
from uictest.judging import evaluation
from uictest.report.words import percent, printable

if TYPE_CHECKING:
    from uictest.judging.evaluation import CaseResult, Firmness, NumberEffect, Turn, VerdictFirmness
    from uictest.judging.series import SeriesResult

SHARE_COLUMNS: Final = ("stops", "passed", "share", "share_low", "share_high")
"""Columns of a table of cases that say how many stops came out as `pass`, and the interval of their share."""
_COUNTS: Final = ("passed", "failed", "inconclusive", "not_applicable")
CRITERION_COLUMNS: Final = ("stops", *_COUNTS, "share", "share_low", "share_high", "lowest", "highest")
"""Columns of a table of criteria that say how one came out over the stops of a case."""
_OUTCOMES: Final = ("pass", "fail", "invalid", "inconclusive", "skipped", "error")


def any_repeated(results: Iterable[CaseResult]) -> bool:
    """Return whether one of the cases repeats its stop."""
    return any(result.repeats is not None for result in results)


def stops_text(result: CaseResult) -> str:
    """Return the stops that came out as expected, e.g. `pass 6/10`; empty for a case with one stop."""
    repeats = result.repeats
    if repeats is None:
        return ""
    if repeats.none_judged:
        return f"skipped {len(repeats.stops)}"
    return f"{_expected(result)} {repeats.as_expected(result.expect)}/{len(repeats.stops)}"


def _expected(result: CaseResult) -> str:
    return "as expected" if result.expect.is_allowance else result.expect.outcome


def repeat_sentences(result: CaseResult) -> Iterator[str]:
    """Yield how the stops of a repeated case came out, and what their number can show; else nothing."""
    repeats = result.repeats
    if repeats is None:
        return
    stops, expected = len(repeats.stops), repeats.as_expected(result.expect)
    head = f"{stops} stops, seeds {repeats.stops[0].seed}..{repeats.stops[-1].seed}"
    if repeats.none_judged:
        yield f"{head}: all skipped; none was judged"
        return
    seeds_of = {outcome: repeats.seeds(outcome) for outcome in _OUTCOMES}
    outcomes = ", ".join(
        f"all {outcome}"
        if len(seeds) == stops
        else f"{len(seeds)} {outcome} ({evaluation.seeds_text(seeds)})"
        for outcome, seeds in seeds_of.items()
        if seeds
    )
    low, high = statistics.proportion_interval(expected, stops)
    share = f"{100 * expected / stops:.3g} % ({100 * low:.3g} .. {percent(high, 3)} with 95 % confidence)"
    yield f"{head}: {outcomes}; {_expected(result)} {share}; rule: {rule_text(repeats)}"
    if repeats.required_share is not None and low < repeats.required_share:
        yield _not_shown(repeats.required_share, stops)


def _not_shown(required: float, stops: int) -> str:
    """Return the reason for which so many stops do not show the share that they must have."""
    share = f"a share of {100 * required:g} %"
    needed = statistics.trials_needed(required)
    if needed is None:
        return f"no number of stops shows {share}"
    if needed > stops:
        return f"{stops} stops cannot show {share} with 95 % confidence: that takes {needed}, all as expected"
    return f"these stops do not show {share}: its 95 % interval begins below"


def rule_text(repeats: evaluation.Repeats) -> str:
    """Return the rule of a repeated case: `all`, `median` or `at least 90 %`."""
    required = repeats.required_share
    return repeats.rule if required is None else f"at least {100 * required:g} %"


def drawn_sentence(result: CaseResult) -> str:
    """Return which of the stops of a repeated case is recorded and drawn; empty for a case with one stop."""
    if result.repeats is None:
        return ""
    first = result.repeats.stops[0]
    return f"the stop that is recorded and drawn is the first, of seed {first.seed}: {first.outcome}"


def band_text(result: CaseResult, stops: int) -> str:
    """Return the caption of the band of the first `stops` repeats; empty without a band."""
    if result.repeats is None or not stops:
        return ""
    of_all = len(result.repeats.stops)
    which = f"{stops}" if stops == of_all else f"the first {stops} of {of_all}"
    return f"lowest and highest of {which} repeats, of those still running"


def share_cells(result: CaseResult) -> dict[str, Cell]:
    """Return the cells of `SHARE_COLUMNS`; none for a case with one stop."""
    repeats = result.repeats
    if repeats is None:
        return {}
    values = len(repeats.stops), repeats.passed, repeats.share, *repeats.interval
    return dict(zip(SHARE_COLUMNS, values, strict=True))


def range_columns(columns: Iterable[str]) -> list[str]:
    """Return the columns that hold the lowest and the highest value of columns over the stops of a case."""
    return [f"{name}_{end}" for name in columns for end in ("lowest", "highest")]


def range_cells(result: CaseResult, columns: Iterable[str], wheelset: int | None = None) -> dict[str, Cell]:
    """Return the cells of `range_columns` of the stop, or of one wheelset; none for a case with one stop."""
    cells: dict[str, Cell] = {}
    if result.repeats is not None:
        for name in columns:
            spread = evaluation.spread_of(result.repeats.values(name, wheelset))
            if spread is not None:
                cells |= {f"{name}_lowest": spread.lowest, f"{name}_highest": spread.highest}
    return cells


def criterion_share_cells(verdict: evaluation.Verdict) -> dict[str, Cell]:
    """Return the cells of `CRITERION_COLUMNS`; none for a verdict on one stop.

    The share is that of the stops that pass among those that the criterion applies to.
    """
    counts = verdict.over_stops
    if counts is None:
        return {}
    cells: dict[str, Cell] = {
        name: getattr(counts, name) for name in ("stops", *_COUNTS, "lowest", "highest")
    }
    applicable = counts.stops - counts.not_applicable
    if applicable:
        low, high = statistics.proportion_interval(counts.passed, applicable)
        cells |= {"share": counts.passed / applicable, "share_low": low, "share_high": high}
    return cells


def wheelset_cells(wheelsets: Iterable[Mapping[str, float]]) -> dict[str, Cell]:
    """Return the measures of wheelsets as cells of one row: `maximum_slide_1`, ..., wheelset 1 leading."""
    return {
        f"{name}_{position}": value
        for position, wheelset in enumerate(wheelsets, start=1)
        for name, value in wheelset.items()
    }


def stop_rows(results: Iterable[CaseResult]) -> Iterator[dict[str, Cell]]:
    """Yield one row per stop of every repeated case: seed, outcome, why, its measures, those of wheelsets."""
    for result in results:
        for stop in result.repeats.stops if result.repeats else ():
            yield {
                "id": result.id,
                "seed": stop.seed,
                "outcome": stop.outcome,
                "test_validity": evaluation.validity_of(stop.criteria),
                "requirement_status": evaluation.requirements_of(stop.criteria),
                "reason": stop.reason,
                **(stop.measures or {}),
                **wheelset_cells(stop.wheelsets),
            }


_MOST_TURNS: Final = 6
"""Numbers that a sentence names; chosen."""
_MOST_NUMBERS: Final = 12
"""Numbers that a summary shows; chosen."""
_FIRMNESS: Final = {
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
    for verdict in firmness.criteria:
        if verdict.turned or verdict.turned_by or verdict.status == "noise":
            stands = f"{verdict.criterion} {verdict.nominal} is {_status(verdict, firmness)}"
            yield printable("; ".join([stands, *_turns(verdict)]))
    yield from map(printable, _remarks(firmness))


def firmness_property(result: CaseResult | SeriesResult) -> dict[str, str]:
    """Return the property of a testcase: `{"firmness": "turns: a.b above 6.1 kJ/m"}`; {} if not asked."""
    firmness = result.firmness
    if firmness is None:
        return {}
    if result.outcome != firmness.nominal:
        return {"firmness": "not_shown"}  # what was varied came to another outcome
    turns = [f"{turn.key} {turn.side} {turn.value or turn.stands_to}" for turn in firmness.turned_by]
    return {"firmness": ": ".join(filter(None, (firmness.status, ", ".join(turns))))}


def _status(verdict: VerdictFirmness, firmness: Firmness) -> str:
    word = _FIRMNESS[verdict.status]
    if not firmness.numbers:
        return f"{word}: no number states a plausible range"
    if not verdict.counted:
        return f"{word}: none of {firmness.draws} draws is a test"
    draws = f"{verdict.counted} draws of {len(firmness.numbers)} numbers within their ranges"
    calibrated = _calibrated(verdict, firmness)
    if verdict.turned or verdict.share_at_least is None:
        low, high = verdict.lowest_block, verdict.highest_block
        blocks = (
            "" if low is None or high is None else f" ({percent(low, 3)} to {percent(high, 3)} in blocks)"
        )
        return f"{word}: it stands in {_share(verdict.share)} of {draws}{blocks}{calibrated}"
    return f"{word}: it stands in all of {draws}, a share above {percent(verdict.share_at_least)}{calibrated}"


def _calibrated(verdict: VerdictFirmness, firmness: Firmness) -> str:
    """Return in which share of the calibrated draws a verdict stands; nothing where no stops calibrate."""
    if verdict.calibrated is None:
        return ""
    stops, counted = ", ".join(firmness.calibrated_by), verdict.calibrated.counted
    share = f" and in {_share(verdict.calibrated.share)} of the" if counted else ", of which"
    return f"{share} {f'{counted} of them' if counted else 'none'} in which {stops} comes to what it expects"


def _share(share: float | None) -> str:
    return "none" if share is None else percent(share, 3)


def _turns(verdict: VerdictFirmness) -> Iterator[str]:
    turns = verdict.turned_by
    yield from map(turn_text, turns[:_MOST_TURNS])
    if len(turns) > _MOST_TURNS:
        yield f"and by {len(turns) - _MOST_TURNS} more numbers alone"
    if verdict.turned and not turns and verdict.status == "turns":
        yield "by several numbers together, or by one between the ends of its range; by none alone at an end"


def turn_text(turn: Turn) -> str:
    """Return where a number turns a verdict, as in `turned by a.b above 6.1 kJ/m (k-wet fail; ...)`."""
    if not turn.value:
        between = f"between {turn.stands_to} and {turn.end} ({turn.to})"
        return f"turned by {turn.key} in places or under some seeds {between}"
    under_all = f", under every seed {turn.side} {turn.turned_from}" if turn.turned_from else ""
    stands = f"it stands to {turn.stands_to}; range to {turn.end}"
    return f"turned by {turn.key} {turn.side} {turn.value} ({turn.to}{under_all}; {stands})"


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


class _Effect(NamedTuple):
    """What a number does to a criterion; `id` is that of the case or series."""

    id: str
    number: NumberEffect
    criterion: VerdictFirmness

    @property
    def turns(self) -> bool:
        return any(turn.key == self.number.key for turn in self.criterion.turned_by)

    @property
    def margins(self) -> tuple[float | None, float | None]:
        """The margins with the number at either end of its range."""
        return self.number.margins.get(self.criterion.criterion, (None, None))

    @property
    def change(self) -> float:
        return self.number.effect(self.criterion.criterion, self.criterion.margin)


def _margin_column(key: str, heading: str, margin: Callable[[_Effect], float | None]) -> Column[_Effect]:
    def text(row: _Effect) -> str:
        share = margin(row)
        return "" if share is None else f"{100 * share:.3g}"

    return Column(key=key, heading=heading, unit="%", value=margin, text=text, right=True)


_COLUMNS: Final[Sequence[Column[_Effect]]] = (
    Column(key="id", value=lambda row: row.id),
    Column(key="key", heading="number", value=lambda row: row.number.key, literal=True),
    Column(key="value", heading="value", value=lambda row: row.number.value, right=True),
    Column(key="lowest", value=lambda row: row.number.lowest),
    Column(key="highest", value=lambda row: row.number.highest),
    Column(heading="range", text=lambda row: f"{row.number.lowest} .. {row.number.highest}", rank=3),
    Column(key="prior", heading="prior", value=lambda row: row.number.prior, rank=3),
    Column(key="mark", heading="mark", value=lambda row: row.number.mark, rank=4),
    Column(key="criterion", heading="criterion", value=lambda row: row.criterion.criterion),
    _margin_column("margin", "margin", lambda row: row.criterion.margin),
    _margin_column("margin_at_lowest", "at lowest", lambda row: row.margins[0]),
    _margin_column("margin_at_highest", "at highest", lambda row: row.margins[1]),
    Column(
        key="turns",
        heading="turns",
        value=lambda row: row.turns,
        text=lambda row: "yes" if row.turns else "",
        tone=lambda row: "bad" if row.turns else None,
    ),
    Column(
        key="reason",
        heading="why this range and prior",
        value=lambda row: row.number.reason,
        rank=5,
        wraps=True,
    ),
)


def firmness_table(judged: Sequence[CaseResult | SeriesResult]) -> Table:
    """Return the effect of every number on every criterion of the cases and series studied."""
    rows = [
        _Effect(result.id, number, criterion)
        for result in judged
        if result.firmness is not None
        for number in result.firmness.numbers
        for criterion in result.firmness.criteria
    ]
    return Table(_COLUMNS, rows, name="firmness")


def strongest_numbers_table(firmness: Firmness, car: str = "") -> Table:
    """Return the numbers, each with the criterion that it turns or else changes most, the strongest first.

    Its title names the `car` where there are several.
    """
    rows = [
        max(
            (_Effect("", number, criterion) for criterion in firmness.criteria),
            key=lambda row: (row.turns, row.change),
        )
        for number in firmness.numbers
        if firmness.criteria
    ]
    rows.sort(key=lambda row: (not row.turns, -row.change))
    title = f"What the numbers do to the margins{car and f' of {car}'}"
    return Table(_COLUMNS, rows, title, name="firmness", most=_MOST_NUMBERS)

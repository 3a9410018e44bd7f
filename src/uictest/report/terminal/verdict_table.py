"""The table of verdicts on a terminal, and one line per case elsewhere."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

from uictest.core.document import Column, Table, Tone
from uictest.core.measures import MEASURES, STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.judging import evaluation
from uictest.report.car_wording import car_facts
from uictest.report.case_table import FAILING, measure_columns
from uictest.report.case_words import DIFFERS, EXPLAINED, line_word, tone
from uictest.report.difference import (
    BaselineComparison,
    Difference,
    case_explanation,
    case_word,
    difference_sentences,
)
from uictest.report.escaping import printable
from uictest.report.part_wording import part_sentences, slide_speed
from uictest.report.repeat_wording import any_repeated, range_cells, repeat_sentences, share_cells, stops_text
from uictest.report.terminal.table_lines import columns_not_shown, fitted, table_columns
from uictest.report.train_wording import train_cells
from uictest.report.verdict_sentences import (
    criterion_sentences,
    definition_sentence,
    listed,
    number,
    reading_sources,
    real_time_sentences,
    statement_sentence,
    without_checks_that_hold,
)

if TYPE_CHECKING:
    from rich.console import JustifyMethod
    from rich.table import Table as RichTable
    from rich.text import Text

    from uictest.report.content import RunContent


SHOWN_MEASURES = tuple(name for name, column in STOP_COLUMNS.items() if column.overview)

MOST_DIFFERENCES: Final = 3
"""Quantities out of the tolerance of a baseline that a case shows on a terminal; results.json has all."""


def case_line(result: evaluation.CaseResult, differences: Sequence[Difference] = ()) -> str:
    """Return the line of one case, ending with the reason if it is not met or differs from the baseline."""
    words = [line_word(case_word(result, differences)), printable(result.id)]
    words += [f"outcome={result.outcome}", f"expect={_one_word(result.expect)}"]
    if result.criteria:
        words += [f"test_validity={result.test_validity}", f"requirements={result.requirement_status}"]
    if result.rail is not None:
        words.append(f"rail_validity={result.rail.test_validity}")
    words += [*_stops(result), *_measures(result)]
    if differences or not result.met or result.outcome in EXPLAINED:
        outcomes, *more = case_explanation(result, differences, MOST_DIFFERENCES)
        reasons = [each for each in more if each != statement_sentence(result)]
        words.append(f"reason={'; '.join(reasons or [outcomes])}")
    return " ".join(words)


def _one_word(text: object) -> str:
    return str(text).replace(" ", "")


def missing_lines(baseline: BaselineComparison) -> Iterator[str]:
    """Yield one line per case of the baseline that is missing, and per series that differs from it."""
    for own_id in baseline.beside_cases:
        reason = "; ".join(difference_sentences(baseline.differences[own_id], MOST_DIFFERENCES))
        yield f"{DIFFERS} {printable(own_id)} reason={reason}"


def criterion_lines(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield one line per criterion of a case, each beginning with the case id."""
    for sentence in criterion_sentences(result):
        yield f"criterion {printable(result.id)} {sentence}"


def definition_lines(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the definitions of each criterion, once for all cases in which they are the same."""
    cases: dict[tuple[str, str], list[str]] = {}
    for result in results:
        for verdict in without_checks_that_hold(result.criteria):
            cases.setdefault((verdict.id, definition_sentence(verdict)), []).append(result.id)
            for reading, sentence in reading_sources(verdict).items():
                cases.setdefault((f"{verdict.id} read as {reading}", sentence), []).append(result.id)
    meanings = [criterion for criterion, _ in cases]
    for (criterion, sentence), names in cases.items():
        where = f" (in {listed(names)})" if meanings.count(criterion) > 1 else ""
        if sentence:
            yield f"definition {printable(criterion)}{where}: {sentence}"


def part_lines(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the parts that cases were run with and their changes, once for all cases with the same part."""
    cases: dict[tuple[str, str], list[str]] = {}
    for result in results:
        of_car = ", ".join(f"{name} {text}" for name, text in car_facts(result).items())
        sentences = {"car": of_car} if of_car else {}
        for role, sentence in (sentences | part_sentences(result.parts, result.controller_version)).items():
            cases.setdefault((role, sentence), []).append(result.id)
    for (role, sentence), names in cases.items():
        where = "" if len(names) == len(results) else f" (in {listed(names)})"
        yield f"part {role}{where}: {sentence}"


def _stops(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield how many stops of a repeated case passed, and the range of what `_measures` gives medians of."""
    for name, value in share_cells(result).items():
        yield f"{name}={value:.4g}"
    for name, value in range_cells(result, SHOWN_MEASURES[:1]).items():
        yield f"{name}={value:.5g}"


def _measures(result: evaluation.CaseResult) -> Iterator[str]:
    for name in SHOWN_MEASURES:
        if result.measures is not None:
            yield f"{name}={number(result.measures[name])}"
    if result.wheelsets:
        yield f"slide_above={slide_speed([result]).replace(' ', '')}"
        yield "maximum_slide=" + "/".join(number(wheelset["maximum_slide"]) for wheelset in result.wheelsets)
        vents = (number(wheelset["valve_actuations"]) for wheelset in result.wheelsets)
        yield "valve_actuations=" + "/".join(vents)
    for name, force in train_cells(result).items():
        if isinstance(force, float):
            yield f"{name}={number(force)}"
    if (times := result.response_times) is not None:
        yield f"missed_deadlines={times.missed_deadlines}"
        yield f"longest_answer_s={number(times.longest_answer_s)}"
        yield f"start_jitter_s={number(times.start_jitter_s)}"
    if result.controller_log:
        yield f"controller_log={result.controller_log}"


def _deciding(result: evaluation.CaseResult) -> evaluation.CaseResult | evaluation.RailValidity:
    return result.rail if result.rail is not None and result.rail.decides else result


_SHORT: Final = {"valid": "yes", "not_valid": "no", "not_judged": "-", "met": "met", "missed": "missed"}
_STYLES: Final[dict[Tone, str]] = {"good": "green", "bad": "bold red", "odd": "bold magenta"}


def verdict_table(
    results: Sequence[evaluation.CaseResult], word: Callable[[evaluation.CaseResult], str], width: int
) -> tuple[RichTable, str]:
    """Return the table of all cases in so many characters, and a line that names the columns left out.

    `word` gives the word of each case. User text enters as text, never as markup.
    """
    from rich.table import Table as RichTable
    from rich.text import Text

    table = Table(_columns(results, word), results, more="summary.csv and wheelsets.csv have all measures")
    columns, hidden = fitted(table_columns(table), width)
    shown = RichTable(box=None, pad_edge=False, header_style="bold")
    for column in columns:
        justify: JustifyMethod = "right" if column.right else "left"
        shown.add_column(column.title, justify=justify, no_wrap=not column.wraps, overflow="fold")
    for result, *row in zip(results, *(column.cells for column in columns), strict=True):
        styles = (_STYLES[tone(word(result))] if each.title == "verdict" else "" for each in columns)
        shown.add_row(*map(Text, row, styles))
    return shown, columns_not_shown(hidden, table.more)


def _columns(
    results: Sequence[evaluation.CaseResult], word: Callable[[evaluation.CaseResult], str]
) -> list[Column[Any]]:
    missed, repeated = _missed_criteria(results), any_repeated(results)
    columns: list[Column[Any]] = [
        Column(heading="case", text=lambda result: result.id, wraps=True),
        Column(heading="verdict", text=word),
        Column(heading="stops", text=lambda result: stops_text(result) or ("-" if repeated else "")),
        Column(heading="valid\ntest", text=lambda result: _SHORT[_deciding(result).test_validity], rank=1),
        Column(heading="require-\nments", text=lambda result: _SHORT[result.requirement_status], rank=1),
        *measure_columns(results, terminal=True, failing=missed.values()),
    ]
    shown = {name for name, column in (STOP_COLUMNS | WHEELSET_COLUMNS).items() if column.overview}
    others = [criterion for criterion, column in missed.items() if column not in shown]
    return [*columns, *(_criterion_column(results, each) for each in others)]


def _missed_criteria(results: Iterable[evaluation.CaseResult]) -> dict[str, str]:
    """Return the criteria by which cases are not as expected, and the column that each rests on, or ""."""
    verdicts = (
        verdict
        for result in results
        if not result.met
        for verdict in result.criteria
        if verdict.status in ("fail", "inconclusive")
    )
    measures = {verdict.id: MEASURES.get(verdict.measure) for verdict in verdicts}
    return {
        criterion: measure.column.name if measure is not None and measure.column is not None else ""
        for criterion, measure in measures.items()
    }


def _criterion_column(
    results: Iterable[evaluation.CaseResult], criterion: str
) -> Column[evaluation.CaseResult]:
    """Return the values of a criterion whose measure the table does not have."""
    verdicts = {result.id: each for result in results for each in result.criteria if each.id == criterion}
    unit = next(each.unit for each in verdicts.values()).removeprefix("1")

    def text(result: evaluation.CaseResult) -> str:
        value = verdicts[result.id].value if result.id in verdicts else None
        return "-" if value is None or math.isnan(value) else f"{value:.4g}"

    return Column(heading=f"{printable(criterion)}\n{unit}", text=text, rank=FAILING, right=True)


def explanation_text(
    content: RunContent, result: evaluation.CaseResult, *, every_criterion: bool = False
) -> Text:
    """Return the reasons for the outcome of a case, or all its verdicts, as lines below its id."""
    from rich.text import Text

    word = content.word(result)
    text = Text(f"{word} ", style=_STYLES[tone(word)])
    text.append(printable(result.id), style="bold")
    lines = content.explanation(result, MOST_DIFFERENCES)
    if every_criterion:
        differences = difference_sentences(content.differences(result.id))
        lines = [
            *repeat_sentences(result),
            *criterion_sentences(result),
            *real_time_sentences(result),
            *differences,
        ]
    for line in lines:
        text.append(f"\n  {line}", style="not bold default")
    return text

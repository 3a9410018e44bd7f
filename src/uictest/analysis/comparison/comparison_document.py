"""The result of a comparison: in data, and as one document for terminal, page, Markdown and CSV."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Final

from uictest.analysis.comparison.answer import (
    Answer,
    Condition,
    JudgedChange,
    column_names,
    half_interval,
    signed,
)
from uictest.analysis.comparison.overlay import Overlay
from uictest.analysis.comparison.paired_stops import (
    FEWEST_PAIRS,
    PairedComparison,
    PairedDifference,
    PairedGroup,
    paired_form,
)
from uictest.analysis.comparison.parameters import ParameterChange, parameter_lines
from uictest.core import envelope
from uictest.core.document import Cell, Column, Document, Lines, Section, Table, Tone, keyed_columns, table_of
from uictest.core.series_measures import Estimate
from uictest.judging import evaluation
from uictest.report import (
    Difference,
    counted,
    differences_form,
    differences_table,
    furthest_out,
    listed,
    measure_heading,
    number,
    percent_text,
    relative_percent,
)


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two things compared.

    Args:
        first, second: their names.
        compared: how many quantities were compared.
        differences: those that are not the same, within tolerance or not.
        notes: inputs, versions and settings that differ.
        overlays: plots of both sides.
        undrawn: which stops are not drawn, and why.
        parameters: those that differ between two runs.
        paired: differences of stops, between two runs or variants; None for recordings.
        answer: which is better; None for recordings.
        series: ids of the series among the differences.
        about: sentences on two recordings: how far and how long each of them runs.

    """

    first: str
    second: str
    compared: int = 0
    differences: Sequence[Difference] = ()
    notes: Sequence[str] = ()
    overlays: Sequence[Overlay] = field(default=(), repr=False)
    undrawn: Sequence[str] = ()
    parameters: Sequence[ParameterChange] = ()
    paired: PairedComparison | None = None
    answer: Answer | None = None
    series: Sequence[str] = ()
    about: Sequence[str] = ()

    @property
    def beyond(self) -> list[Difference]:
        """The differences that are out of tolerance."""
        return [difference for difference in self.differences if not difference.within]

    @property
    def agrees(self) -> bool:
        """Whether everything is within tolerance."""
        return not self.beyond

    @property
    def is_empty(self) -> bool:
        """Whether nothing differs because nothing can be compared."""
        return self.agrees and self.answer is not None and self.answer.standing == "not comparable"

    @property
    def subjects(self) -> tuple[str, str]:
        """What both sides are called."""
        return (self.first, self.second) if self.answer is None else self.answer.subjects

    @property
    def verdict(self) -> str:
        """The shortest answer."""
        if self.answer is not None:
            return self.answer.verdict
        return "Within tolerance" if self.agrees else "Out of tolerance"

    @property
    def sentences(self) -> list[str]:
        """The answer in sentences: which is better, by how much and where; the verdicts that turned."""
        if self.answer is not None:
            return self.answer.sentences
        return [*self.about, f"{verdict_line(self)}."]

    @property
    def headings(self) -> list[str]:
        """What tables call both sides, where that is not their names."""
        first, second = self.subjects
        is_said = first == second or column_names(self.subjects)[0] != "first"
        return [] if is_said else [f"In tables, first is {first} and second is {second}."]

    @property
    def groups_with_intervals(self) -> int:
        """How many groups have several pairs of stops."""
        return sum(group.pairs >= FEWEST_PAIRS for group in self.paired.groups) if self.paired else 0

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form, overlays left out."""
        return {
            **envelope.head(envelope.RESULT, "comparison"),
            "first": self.first,
            "second": self.second,
            "agrees": self.agrees,
            "compared": self.compared,
            **({} if self.answer is None else {"answer": _answer_form(self.answer)}),
            "notes": list(self.notes),
            "parameters": [asdict(change) for change in self.parameters],
            "differences": differences_form(self.differences),
            **({} if self.paired is None else {"paired": paired_form(self.paired)}),
        }


def _answer_form(answer: Answer) -> dict[str, Any]:
    turned = [
        {"case": each.case, "layer": each.layer, **asdict(each.change), "turn": each.change.turn}
        for each in answer.turned
    ]
    return {
        "standing": answer.standing,
        "sentences": answer.sentences,
        "subjects": list(answer.subjects),
        "conditions": list(conditions_table(answer).records),
        "turned": turned,
    }


def comparison_json(comparison: Comparison) -> str:
    """Return the comparison as a JSON document."""
    return json.dumps(comparison.to_dict(), indent=2, allow_nan=False)


def variants_json(run: str, compared: Sequence[Comparison]) -> str:
    """Return the variants of a run as a JSON document."""
    variants = [
        paired_form(each.paired) | {"answer": _answer_form(each.answer)}
        for each in compared
        if each.paired is not None and each.answer is not None
    ]
    form = {**envelope.head(envelope.RESULT, "variants"), "run": run, "variants": variants}
    return json.dumps(form, indent=2, allow_nan=False)


def verdict_line(comparison: Comparison) -> str:
    """Return how many quantities differ on one line."""
    if comparison.is_empty:
        return comparison.verdict
    count = counted(comparison.compared, "quantity", "quantities")
    if not comparison.differences:
        return f"{count} compared, no difference"
    within = len(comparison.differences) - len(comparison.beyond)
    return f"{count} compared: {len(comparison.beyond)} out of tolerance, {within} different within tolerance"


_MOST_LINES: Final = 3
"""Parameters, and notes, that a terminal lists without `-v`; chosen."""
_MOST_CONDITIONS: Final = 20
"""Conditions, and channels, that a terminal lists without `-v`; chosen: half a screen."""


def comparison_document(*compared: Comparison, every: bool = False) -> Document:
    """Return the answer, conditions in the order of effect, judged measures, and what went in differently.

    With `every`, all quantities that differ, and all paired differences, too.
    """
    sections = [section for each in compared for section in _sections(each, every=every)]
    subjects = dict.fromkeys(name for each in compared for name in each.subjects)
    return Document(" and ".join(subjects) or "Variants", sections)


def _sections(comparison: Comparison, *, every: bool) -> Iterator[Section]:
    answer = comparison.answer
    basis = [answer.basis] if answer is not None and answer.basis else []
    yield Lines([*comparison.sentences, *comparison.headings, *basis])
    if answer is not None:
        conditions = conditions_table(answer)
        rows = list(conditions.rows)
        yield conditions if every else dataclasses.replace(conditions, rows=rows[:_MOST_CONDITIONS])
        yield Lines(_more(rows, _MOST_CONDITIONS, "condition", every=every))
        yield judged_table(answer)
    of_series = [each for each in comparison.beyond if each.case in comparison.series]
    if every:
        yield differing_table(comparison.differences, comparison.subjects)
    elif answer is None:
        beyond = differing_table(comparison.beyond, comparison.subjects)
        yield dataclasses.replace(beyond, rows=list(beyond.rows)[:_MOST_CONDITIONS])
        yield Lines(_more(comparison.beyond, _MOST_CONDITIONS, "channel", every=every))
    elif of_series:
        yield differing_table(of_series, comparison.subjects)
    if every and comparison.paired is not None:
        for group in comparison.paired.groups:
            if group.pairs >= FEWEST_PAIRS and differing(group):
                yield Lines([group_text(group, comparison.subjects)])
                yield paired_table(group, comparison.subjects)
    parameters = list(parameter_lines(comparison.parameters))
    for lines, noun in ((parameters, "parameter"), ([f"note: {each}" for each in comparison.notes], "note")):
        yield Lines(lines if every else lines[:_MOST_LINES])
        yield Lines(_more(lines, _MOST_LINES, noun, every=every))


def _more(rows: Sequence[object], most: int, noun: str, *, every: bool) -> list[str]:
    more = len(rows) - most
    return [] if every or more <= 0 else [f"{counted(more, f'more {noun}')}: -v lists them"]


_CONDITION_KEYS: Final = (
    *("condition", "standing", "quantity", "unit", "first", "second"),
    *("difference", "low", "high", "percent", "pairs", "remark"),
)
_LONGEST_CONDITION: Final = 40
"""Letters of a condition that are not wrapped; chosen."""
STANDING_TONES: Final[dict[str, Tone]] = {
    "better": "good",
    "worse": "bad",
    "different": "odd",
    "not comparable": "odd",
}


def conditions_table(answer: Answer) -> Table:
    """Return the conditions, the largest difference in per cent first."""
    first, second = column_names(answer.subjects)
    leads = {condition.lead.quantity for condition in answer.conditions if condition.lead}
    unit = next((each.lead.unit for each in answer.conditions if each.lead), "") if len(leads) == 1 else ""
    title = measure_heading(next(iter(leads))).words if len(leads) == 1 else "conditions"

    def shown(text: Callable[[PairedDifference], str]) -> Callable[[Condition], str]:
        return lambda condition: "" if condition.lead is None else text(condition.lead)

    wraps = max((len(each.name) for each in answer.conditions), default=0) > _LONGEST_CONDITION
    columns: list[Column[Condition]] = [
        Column(key="subject", value=lambda _: answer.subjects[1]),
        Column(key="against", value=lambda _: answer.subjects[0]),
        *keyed_columns(_CONDITION_KEYS, _record),
        Column(heading="condition", text=lambda each: each.name, wraps=wraps, literal=True),
        Column(
            heading=f"{second} is",
            text=lambda each: each.standing.removesuffix(" shown"),
            tone=lambda each: STANDING_TONES.get(each.standing),
        ),
        Column(heading="measure" if len(leads) > 1 else "", text=shown(lambda lead: lead.title)),
        Column(heading=first, unit=unit, text=shown(lambda lead: number(lead.first)), right=True, rank=2),
        Column(heading=second, unit=unit, text=shown(lambda lead: number(lead.second)), right=True, rank=2),
        Column(
            heading="change",
            unit=unit,
            text=shown(lambda lead: f"{signed(lead.mean.value)} {half_interval(lead)}".rstrip()),
            right=True,
        ),
        Column(heading="%", text=lambda each: percent_text(each.percent) if each.percent else "", right=True),
        Column(heading="verdicts, remarks", text=lambda each: each.remark, wraps=True),
    ]
    by_effect = sorted(answer.conditions, key=lambda condition: -abs(condition.percent or 0.0))
    return Table(columns, by_effect, title=title, name="conditions", all_in="--format csv")


def _record(condition: Condition) -> dict[str, Cell]:
    """Return what programs read of a condition."""
    record: dict[str, Cell] = {"condition": condition.name, "standing": condition.standing}
    if lead := condition.lead:
        record |= {"quantity": lead.quantity, "unit": lead.unit, "first": lead.first, "second": lead.second}
        record |= {"difference": lead.mean.value, "low": lead.mean.low, "high": lead.mean.high}
        record |= {"percent": condition.percent, "pairs": lead.pairs}
    return record | {"remark": condition.remark}


_JUDGED: Final[tuple[Column[JudgedChange], ...]] = (
    Column(heading="judged measure", text=lambda change: change.largest.title, wraps=True),
    Column(heading="better in", value=lambda change: change.counts["better"], right=True),
    Column(heading="worse in", value=lambda change: change.counts["worse"], right=True),
    Column(
        heading="largest change",
        text=lambda change: signed(change.largest.mean.value, change.largest.unit),
        right=True,
    ),
    Column(heading="where", text=lambda change: change.where, wraps=True, rank=1),
)


def csv_table(comparison: Comparison) -> Table:
    """Return the table for programs: the conditions, or the quantities of recordings that differ."""
    if comparison.answer is not None:
        return conditions_table(comparison.answer)
    return table_of("differences", differences_form(comparison.differences), _KEYS)


_KEYS: Final = ("quantity", "first", "second", "deviation", "allowed", "unit", "within", "remark")


def judged_table(answer: Answer) -> Table:
    """Return what the other measures did that requirements judge."""
    return Table(
        _JUDGED, answer.judged, title="Other measures that requirements judge", all_in="--format json"
    )


def differing_table(differences: Sequence[Difference], subjects: tuple[str, str]) -> Table:
    """Return differences of the second side from the first, those furthest out of tolerance first."""
    rows = sorted(furthest_out(differences), key=lambda each: each.within)
    return differences_table(rows, column_names(subjects), all_in="--format json")


def parameters_table(changes: Sequence[ParameterChange], subjects: tuple[str, str]) -> Table:
    """Return the changes between two runs, each with its cases where they are not the same for all."""
    first, second = column_names(subjects)
    columns: list[Column[ParameterChange]] = [
        Column(heading="parameter", text=lambda change: change.key, literal=True),
        Column(heading=first, text=lambda change: change.texts[0]),
        Column(heading=second, text=lambda change: change.texts[1]),
    ]
    if len({change.cases for change in changes}) > 1:
        columns.append(Column(heading="cases", text=lambda change: listed(change.cases)))
    return Table(columns, changes)


def group_text(group: PairedGroup, subjects: tuple[str, str]) -> str:
    """Return the sentence on which stops of a group pair."""
    pairs = f"{group.name}: {counted(group.pairs, 'pair')}"
    if group.seeds:
        pairs += f", {evaluation.seeds_text(group.seeds)}"
    if group.draws < group.pairs:
        pairs += f"; only {counted(group.draws, 'draw')} of noise, so that the intervals are too narrow"
    if any(group.unpaired):
        alone = (f"{count} of {name}" for count, name in zip(group.unpaired, subjects, strict=True))
        pairs += f"; without a partner: {', '.join(alone)}"
    return pairs


def differing(group: PairedGroup) -> list[PairedDifference]:
    """Return the quantities that differ in some pair."""
    return [each for each in group.differences if not each.is_zero]


def _ends_text(estimate: Estimate) -> str:
    return "-" if math.isnan(estimate.low) else f"{number(estimate.low)} .. {number(estimate.high)}"


def _larger_count_text(each: PairedDifference) -> str:
    return f"{each.larger} of {each.pairs}" + (f" ({each.missing} without)" if each.missing else "")


def paired_table(group: PairedGroup, subjects: tuple[str, str]) -> Table:
    """Return the quantities of a group that differ in some pair."""
    first, second = column_names(subjects)

    def percent(difference: PairedDifference) -> str:
        share = relative_percent(difference.first, difference.first + difference.mean.value, difference.unit)
        return percent_text(share)

    columns: tuple[Column[PairedDifference], ...] = (
        Column(heading="quantity", text=lambda each: each.quantity),
        Column(heading=first, text=lambda each: number(each.first), rank=4, right=True),
        Column(heading=second, text=lambda each: number(each.second), rank=4, right=True),
        Column(heading="mean", text=lambda each: signed(each.mean.value), right=True),
        Column(heading=f"% of {first}", text=percent, rank=5, right=True),
        Column(heading="interval", text=lambda each: _ends_text(each.mean), right=True),
        Column(heading="median", text=lambda each: number(each.median.value), rank=2, right=True),
        Column(
            heading="interval of the median", text=lambda each: _ends_text(each.median), rank=2, right=True
        ),
        Column(heading=f"{second} larger", text=_larger_count_text, rank=3, right=True),
        Column(heading="unit", text=lambda each: each.unit, rank=1),
    )
    return Table(columns, differing(group), all_in="--format json")

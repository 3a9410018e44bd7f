"""What is not the same on two sides, in data and in words; how a run compares with its baseline."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from uictest.core import measures
from uictest.core.document import Column, Table, Tone
from uictest.core.recording import state_kind
from uictest.core.units import SIZES
from uictest.judging import evaluation
from uictest.report.traces.quantities import WHEELSETS, channel_title, shown_unit
from uictest.report.verdict_sentences import explanation, tally
from uictest.report.words import (
    DIFFERS,
    counted,
    listed,
    measure_heading,
    number,
    printable,
    quantity,
    result_word,
)

CELSIUS: Final = "degC"
_DIGITS: Final = 6
"""Digits of the sides of a difference: a tolerance may be a thousandth of them. Chosen."""
_LARGEST_PERCENT: Final = 1000
"""A relative figure that is still written out; chosen."""

Value = int | float | str
"""A number, NaN where there is none; or a text: an outcome, a verdict, a unit."""


@dataclass(frozen=True, slots=True)
class StatusChange:
    """The outcome of a case or series on both sides, or the status of one criterion; None: there is none."""

    first: evaluation.Outcome | evaluation.Status | None
    second: evaluation.Outcome | evaluation.Status | None
    criterion: str = ""
    """Its id; empty for the outcome."""

    @property
    def turn(self) -> str:
        """What turned: `new` where only the second side is missed, `fixed` where only the first is."""
        if {None, "not_applicable"} & {self.first, self.second}:
            return "turned"
        was, is_now = (status in ("pass", "skipped") for status in (self.first, self.second))
        return "turned" if was == is_now else "fixed" if is_now else "new"

    @property
    def words(self) -> str:
        """What turned, in words; what lacks data for a verdict is not missed."""
        if self.first is None or self.second is None:
            return f"on the {'second' if self.first is None else 'first'} side alone"
        if self.turn == "new":
            return "newly missed" if self.second == "fail" else "no longer shown to be met"
        return "now met" if self.turn == "fixed" else "turned otherwise"


@dataclass(frozen=True, slots=True)
class Difference:
    """One quantity that is not the same on both sides.

    `case` is empty for a recording. `first`, `second`, `deviation` and `allowed` are in `unit`; the last two
    are None where the sides cannot be subtracted. `remark` says where or why. `status` is what an outcome or
    a verdict was and is.
    """

    case: str
    quantity: str
    first: Value
    second: Value
    within: bool
    unit: str = ""
    deviation: float | None = None
    allowed: float | None = None
    remark: str = ""
    status: StatusChange | None = field(default=None, compare=False)


def status_difference(case: str, status: StatusChange) -> Difference | None:
    """Return the difference of an outcome or a verdict, None where both sides are the same."""
    if status.first == status.second:
        return None
    quantity = f"criterion {status.criterion}" if status.criterion else "outcome"
    first, second = (
        "none" if side is None else side.replace("_", " ") for side in (status.first, status.second)
    )
    return Difference(case, quantity, first, second, within=False, status=status)


def side_text(value: Value) -> str:
    """Return one side of a difference without its unit."""
    return value if isinstance(value, str) else number(value, _DIGITS)


def relative_percent(first: Value, second: Value, unit: str = "") -> float | None:
    """Return by how many per cent of the first side's size the second exceeds it.

    None where a side is not a finite number, where the first is 0, and in degC, whose zero is arbitrary.
    """
    if isinstance(first, str) or isinstance(second, str) or unit == CELSIUS or not first:
        return None
    percent = 100.0 * (second - first) / abs(first)
    return percent if math.isfinite(percent) else None


def relative_text(first: Value, second: Value, unit: str = "") -> str:
    """Return this as text; `from 0` where the first side is 0, else `-` where there is none."""
    if first == 0.0 and not isinstance(second, str):
        return "from 0"
    return percent_text(relative_percent(first, second, unit))


def percent_text(percent: float | None) -> str:
    """Return a relative figure with its sign and three digits, `-` where there is none.

    A multiple beyond ten is written `> 1000`: it says only that its base is nearly 0.
    """
    if percent is None:
        return "-"
    if abs(percent) < _LARGEST_PERCENT:
        return f"{percent:+.3g}"
    return f"> {_LARGEST_PERCENT}" if percent > 0 else f"< -{_LARGEST_PERCENT}"


def difference_sentence(difference: Difference) -> str:
    """Return one line: `outcome was pass, is fail`, for numbers with deviation and tolerance."""
    first, second = (
        side if isinstance(side, str) else quantity(side, difference.unit, _DIGITS)
        for side in (difference.first, difference.second)
    )
    sentence = f"{difference.quantity} was {first}, is {second}"
    if difference.deviation is not None and difference.allowed is not None:
        allowed = quantity(difference.allowed, difference.unit)
        sentence += f" ({signed_deviation(difference)}; ±{allowed} allowed)"
    return printable(f"{sentence} ({difference.remark})" if difference.remark else sentence)


def quantity_title(difference: Difference) -> str:
    """Return the title of a quantity; a name that is neither a measure of a case nor a channel stays."""
    if not difference.case:
        return channel_title(difference.quantity)
    measure, wheelset = measures.without_wheelset(difference.quantity)
    heading = measure_heading(measure).words
    if heading == difference.quantity:
        return heading
    title = heading.capitalize()
    return f"{title} of wheelset {wheelset}" if wheelset else title


def in_page_units(difference: Difference) -> Difference:
    """Return a difference of measures in the units of every page: kN, and shares in %."""
    measure, _ = measures.without_wheelset(difference.quantity)
    measure_unit = measure_heading(measure).unit if difference.case else ""
    unit = shown_unit(measure, measure_unit or difference.unit)
    if unit == difference.unit or not {unit, difference.unit} <= SIZES.keys():
        return difference
    size = SIZES[unit] / SIZES[difference.unit]
    return dataclasses.replace(
        difference,
        unit=unit,
        first=_scaled_value(difference.first, size),
        second=_scaled_value(difference.second, size),
        deviation=None if difference.deviation is None else difference.deviation / size,
        allowed=None if difference.allowed is None else difference.allowed / size,
    )


def _scaled_value(value: Value, size: float) -> Value:
    return value if isinstance(value, str) else value / size


def signed_deviation(difference: Difference) -> str:
    """Return second - first with its sign; `-` where the sides cannot be subtracted."""
    first, second = difference.first, difference.second
    if isinstance(first, str) or isinstance(second, str) or difference.deviation is None:
        return "-"
    return f"{second - first:+.5g}"


def relative_cell(quantity: str, first: Value, second: Value, unit: str) -> str:
    """Return by how many per cent of A's size B exceeds A, or why it is not said; states have no size."""
    return "-" if state_kind(quantity) else relative_text(first, second, unit)


def _quantity_text(difference: Difference) -> str:
    title = quantity_title(difference)
    return title if title == difference.quantity else f"{title} ({difference.quantity})"


def _of_numbers(text: Callable[[Difference], str]) -> Callable[[Difference], str]:
    """Return the text of a column in which verdicts and other texts have none."""
    return lambda each: "" if isinstance(each.first, str) else text(each)


_CASE: Final[Column[Difference]] = Column(
    heading="case", text=lambda each: each.case, wraps=True, literal=True
)


def differences_table(
    differences: Iterable[Difference],
    sides: tuple[str, str] = ("baseline", "this run"),
    *,
    all_in: str = "results.json",
    most: int | None = None,
) -> Table:
    """Return differences in the units of every page, under the names of both sides."""
    first, second = sides
    columns: tuple[Column[Difference], ...] = (
        Column(heading="verdict", text=turn, tone=turn_tone),
        _CASE,
        Column(heading="quantity", text=_quantity_text, wraps=True, literal=True),
        Column(heading=first, text=lambda each: side_text(each.first), right=True),
        Column(heading=second, text=lambda each: side_text(each.second), right=True),
        Column(heading="change", text=_of_numbers(signed_deviation), right=True),
        Column(
            heading=f"% of {first}",
            text=_of_numbers(lambda each: relative_cell(each.quantity, each.first, each.second, each.unit)),
            right=True,
            rank=2,
        ),
        Column(heading="allowed", text=_of_numbers(lambda each: number(each.allowed)), right=True, rank=3),
        Column(heading="unit", text=lambda each: each.unit),
        Column(heading="remark", text=lambda each: each.remark, wraps=True, rank=4),
    )
    return Table(columns, list(map(in_page_units, differences)), all_in=all_in, most=most, grouped_by=_CASE)


def turn(difference: Difference) -> str:
    """Return the word of a difference: a verdict that is missed on the second side alone is `new`."""
    if difference.within:
        return "within"
    return DIFFERS if difference.status is None else difference.status.turn


def turn_tone(difference: Difference) -> Tone:
    """Return the tone of this word."""
    word = turn(difference)
    return "odd" if word == "turned" else "good" if word in ("fixed", "within") else "bad"


def wheelset_quantity(measure: str, wheelset: int) -> str:
    """Return the name of a measure of one wheelset among the quantities of a stop."""
    return f"{measure}_{wheelset}"


def worst_of_wheelsets(differences: Iterable[Difference]) -> list[Difference]:
    """Return the differences, with only the worst wheelset for each measure of wheelsets."""
    columns = {wheelset_quantity(name, n): name for name in measures.WHEELSET_COLUMNS for n in WHEELSETS}
    # The train may have a measure of the same name, as `adhesion_utilisation`: it is not of a wheelset.
    groups: dict[tuple[str, str, bool], list[Difference]] = {}
    for difference in differences:
        column = columns.get(difference.quantity)
        group = difference.case, column or difference.quantity, column is not None
        groups.setdefault(group, []).append(difference)
    return list(_worst_of_each(groups.values()))


def furthest_out(differences: Iterable[Difference]) -> list[Difference]:
    """Return the differences by how many times their tolerance they are, the largest first."""
    return sorted(differences, key=_excess, reverse=True)


def _worst_of_each(groups: Iterable[Sequence[Difference]]) -> Iterator[Difference]:
    for group in groups:
        worst = max(group, key=_excess)
        remark = worst.remark if len(group) == 1 else f"worst of {len(group)} wheelsets"
        yield dataclasses.replace(worst, remark=remark)


def _excess(difference: Difference) -> float:
    if difference.deviation is None or not difference.allowed:
        return math.inf
    return difference.deviation / difference.allowed


@dataclass(frozen=True, slots=True)
class BaselineComparison:
    """A run against its baseline.

    Args:
        folder: the baseline's folder, without the machine's folders.
        sha256: digest of the baseline's results.json.
        compared: how many quantities were compared.
        within: how many of them differ within their tolerance.
        differences: quantities out of tolerance by the id of a case or series; `first` is the baseline,
            `second` the run.
        missing: cases that the scenario files no longer have, id -> file; `differences` has them as well.
        series: files of the series in `differences`, by id.
        not_run: ids of cases of the baseline that were selected and not run.
        not_selected: ids of cases of the baseline that were not selected.
        series_not_compared: ids of series of the baseline that were not run or not selected.
        notes: inputs that differ.
        values: case -> criterion -> its value in the baseline, in the unit of the run; ids.
        informing: quantities out of tolerance that no criterion judges: they decide nothing.

    """

    folder: str
    sha256: str
    compared: int = 0
    within: int = 0
    differences: Mapping[str, Sequence[Difference]] = field(default_factory=dict)
    missing: Mapping[str, str] = field(default_factory=dict)
    series: Mapping[str, str] = field(default_factory=dict)
    not_run: Sequence[str] = ()
    not_selected: Sequence[str] = ()
    series_not_compared: Sequence[str] = ()
    notes: Sequence[str] = ()
    values: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    informing: Sequence[Difference] = ()

    @property
    def agrees(self) -> bool:
        """Whether every outcome, verdict and judged measure is within tolerance."""
        return not self.differences

    @property
    def beside_cases(self) -> Mapping[str, str]:
        """What differs and is not a case of the run: missing cases, and series; id -> file."""
        return {**self.missing, **self.series}

    @property
    def all_differences(self) -> list[Difference]:
        """The quantities out of tolerance, case after case."""
        return [difference for each in self.differences.values() for difference in each]


def case_word(result: evaluation.CaseResult, differences: Sequence[Difference]) -> str:
    """Return the word of a case: `differs` where it meets its expectation and differs from the baseline."""
    return DIFFERS if differences and result.met else result_word(result)


def case_explanation(
    result: evaluation.CaseResult,
    differences: Sequence[Difference],
    instants: Mapping[str, str] | None = None,
    *,
    briefly: bool = False,
) -> list[str]:
    """Return the reasons for the outcome of a case, and the quantities out of tolerance.

    `instants` says when the values of criteria, by their ids, were taken. `briefly` leaves out what a table
    of the criteria says.
    """
    outcome, *reasons = explanation(result, instants, briefly=briefly)
    if differences:
        outcome += ". Differs from the baseline"
    return [outcome, *reasons, *difference_sentences(differences)]


def difference_sentences(differences: Sequence[Difference], most: int | None = None) -> list[str]:
    """Return one line per quantity of a case that is out of tolerance.

    With `most` only so many, those furthest out first, and a line that counts the others.
    """
    worst = worst_of_wheelsets(differences)
    shown = worst if most is None else furthest_out(worst)[:most]
    lines = [f"baseline: {difference_sentence(each)}" for each in shown]
    if more := len(worst) - len(shown):
        lines.append(
            f"baseline: {counted(more, 'more quantity', 'more quantities')} out of tolerance, in results.json"
        )
    return lines


def run_tally(results: Iterable[evaluation.CaseResult], baseline: BaselineComparison | None) -> str:
    """Return the counts of a run, e.g. `3 cases: 2 pass, 1 different from the baseline`."""
    counts = tally(results, baseline.differences if baseline else ())
    missing = len(baseline.missing) if baseline else 0
    return f"{counts}; {counted(missing, 'case')} of the baseline missing" if missing else counts


def baseline_summary(baseline: BaselineComparison) -> str:
    """Return the result of the comparison with the baseline on one line."""
    quantities = counted(baseline.compared, "quantity", "quantities")
    beyond = len(baseline.all_differences)
    others = len(baseline.informing)
    counts = f"{beyond} out of tolerance, {baseline.within} different within tolerance"
    if others:
        counts += f"; {others} more that no criterion judges, for information"
    result = counts if beyond or others or baseline.within else "no difference"
    return f"{quantities} compared with the baseline {printable(baseline.folder)}: {result}"


def not_compared_sentences(baseline: BaselineComparison) -> Iterator[str]:
    """Yield the cases and series of the baseline that were not compared, with the reason."""
    for ids, reason in ((baseline.not_run, "not run"), (baseline.not_selected, "not selected")):
        if ids:
            yield f"not compared with the baseline: {counted(len(ids), 'case')} {reason} ({listed(ids)})"
    if ids := baseline.series_not_compared:
        yield f"not compared with the baseline: {len(ids)} series not run or not selected ({listed(ids)})"

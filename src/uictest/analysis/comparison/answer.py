"""Which of two subjects is better: under each condition, and in one sentence."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, Literal, NamedTuple, get_args

from uictest.analysis.comparison.paired_stops import (
    FEWEST_PAIRS,
    LARGEST,
    SINGLE_STOP,
    MatchedGroup,
    NotPaired,
    PairedDifference,
    Standing,
)
from uictest.analysis.comparison.parameters import ParameterChange
from uictest.analysis.comparison.tolerance import Tolerances
from uictest.core.measures import MEASURES
from uictest.judging.evaluation import CaseResult, Layer, Verdict, failed_checks
from uictest.report import (
    RunContent,
    StatusChange,
    controller_of,
    counted,
    counted_in,
    listed,
    number,
    relative_percent,
    shared_conditions,
)

LEAD: Final = "braking_distance_m"
"""The column by which a condition is better or worse, where both sides have it."""
_LONGEST_WHERE: Final = 70
"""Letters that a sentence has for the conditions in which something is so; chosen."""
_LONGEST_HEADING: Final = 9
"""Letters of a name at the head of a column; chosen."""
_LONGEST_NAME: Final = 32
"""Letters of the name of a subject that has room; chosen."""


@dataclass(frozen=True, slots=True)
class TurnedVerdict:
    """A criterion whose verdict is another one on the second side, and in which case or series."""

    case: str
    layer: Layer
    change: StatusChange
    of_series: bool = False


@dataclass(frozen=True, slots=True)
class Condition:
    """How the second subject stands against the first under one condition.

    Args:
        name: the condition in words.
        standing: of the second side.
        lead: the number that stands for the condition; None where both sides have none.
        judged: the other measures that requirements judge.
        remark: which requirements turned, or why the sides are not comparable.
        case: by which sentences name the condition; None for a series.
        by_number: whether the number says the same as `standing`, which turned requirements may decide.

    """

    name: str
    standing: Standing
    lead: PairedDifference | None = None
    judged: tuple[PairedDifference, ...] = ()
    remark: str = ""
    case: CaseResult | None = field(default=None, repr=False, compare=False)
    by_number: bool = False

    @property
    def percent(self) -> float | None:
        """The mean difference in per cent of the first side; None where there is no such share."""
        lead = self.lead
        return None if lead is None else relative_percent(lead.first, lead.first + lead.mean.value, lead.unit)


class JudgedChange(NamedTuple):
    """A judged measure beside the lead: its largest change, where that is, and its standings counted."""

    largest: PairedDifference
    where: str
    counts: Mapping[Standing, int]


@dataclass(frozen=True, slots=True)
class Answer:
    """How the second subject stands against the first: names, every condition, and turned verdicts."""

    subjects: tuple[str, str]
    conditions: tuple[Condition, ...]
    turned: tuple[TurnedVerdict, ...] = ()
    judged: tuple[JudgedChange, ...] = ()
    missing: tuple[int, int] = (0, 0)
    """How many cases of each side miss requirements."""

    @property
    def standing(self) -> Standing | Literal["mixed"]:
        """How it stands overall: better where it is better under some condition and worse under none."""
        found = {condition.standing for condition in self.conditions}
        if {"better", "worse"} <= found:
            return "mixed"
        order: tuple[Standing, ...] = get_args(Standing)
        return next((standing for standing in order if standing in found), "not comparable")

    @property
    def verdict(self) -> str:
        """The shortest answer."""
        first, second = short_names(self.subjects)[0], self.subjects[1]
        counts: Counter[str] = Counter(condition.standing for condition in self.conditions)
        total = counted(len(self.conditions), "condition")
        count = counts[self.standing]
        share = "" if count == len(self.conditions) else f" in {count} of {total}"
        if self.standing == "mixed":
            better, worse = counts["better"], counts["worse"]
            return f"{second} is better than {first} in {better} and worse in {worse} of {total}"
        if self.standing in ("better", "worse", "different"):
            joint = "from" if self.standing == "different" else "than"
            return f"{second} is {self.standing} {joint} {first}{share}"
        if self.standing == "no difference shown":
            return f"No difference shown between {first} and {second}{share}"
        return f"{first} and {second} cannot be compared"

    @property
    def sentences(self) -> list[str]:
        """Where and by how much the second is better or worse; which verdicts turned."""
        first, second = self.subjects
        is_same = first == second and self.standing == "no difference shown"
        against = "itself" if is_same else short_names(self.subjects)[0]
        clauses = list(_clauses(self.conditions)) or ["nothing is on both sides"]
        opening = f"{second} against {against}: {clauses[0]}."
        others = [f"{each[0].upper()}{each[1:]}." for each in clauses[1:]]
        return [opening, *others, *([] if self.standing == "not comparable" else [self.turned_sentence])]

    @property
    def turned_sentence(self) -> str:
        """The turned verdicts by criterion: those of requirements, of validity, and of checks."""
        turns: dict[str, dict[str, Counter[tuple[str, bool]]]] = {
            "requirements": {},
            "validity as a test": {},
            "checks": {},
        }
        layers = {"requirement": "requirements", "validity": "validity as a test"}
        for turned in self.turned:
            criteria = turns[layers.get(turned.layer, "checks")]
            turn = turned.change.words, turned.of_series
            criteria.setdefault(turned.change.criterion, Counter())[turn] += 1
        texts = [
            f"{layer}: {', '.join(f'{name} {_counts_text(counts)}' for name, counts in criteria.items())}"
            for layer, criteria in turns.items()
            if criteria
        ]
        sentence = f"Verdicts that turned: {'; '.join(texts)}." if texts else "No verdict turned."
        if not any(self.missing):
            return sentence
        names = short_names(self.subjects)
        counts = (
            f"{counted(count, 'case')} with {name}" for count, name in zip(self.missing, names, strict=True)
        )
        return f"{sentence} Requirements are missed in {' and '.join(counts)}."

    @property
    def basis(self) -> str:
        """What the numbers rest on, in a sentence; empty without any."""
        pairs = [condition.lead.pairs for condition in self.conditions if condition.lead]
        if not pairs:
            return ""
        if max(pairs) < FEWEST_PAIRS:
            return (
                f"One stop each, so no intervals: below {100 * SINGLE_STOP:g} % no difference is shown;"
                " --repeat 5 in both runs gives intervals."
            )
        counts = f"{min(pairs)} to {max(pairs)}" if min(pairs) < max(pairs) else f"{max(pairs)}"
        return (
            f"{counts} pairs of stops per condition under the same noise; mean difference with its 95 %"
            " interval by Student's t, each by itself."
        )


def _counts_text(counts: Mapping[tuple[str, bool], int]) -> str:
    words = dict.fromkeys(word for word, _ in counts)
    return ", ".join(f"{word} in {counted_in(counts[word, False], counts[word, True])}" for word in words)


def answer_of(matched: Sequence[MatchedGroup], subjects: tuple[str, str], tolerances: Tolerances) -> Answer:
    """Return how the second side stands in the groups of both."""
    examples = [group.known.example for group in matched if group.known.example]
    turned = [list(_turned(group)) for group in matched]
    conditions = [
        _condition(group, examples, of_group, tolerances)
        for group, of_group in zip(matched, turned, strict=True)
    ]
    # A series is in several groups: its verdicts turn once.
    every = dict.fromkeys(verdict for of_group in turned for verdict in of_group)
    judged = tuple(_judged_changes(conditions, tolerances))
    return Answer(subjects, tuple(conditions), tuple(every), judged, _missing_requirements(matched))


def _condition(
    group: MatchedGroup,
    examples: Sequence[CaseResult],
    turned: Sequence[TurnedVerdict],
    tolerances: Tolerances,
) -> Condition:
    """Return how the second side stands in a group.

    Requirements that turn one way decide, else the braking distance; where a side has none, the first judged
    measure.
    """
    example = group.known.example
    name = group.known.name
    if example is not None:
        words = shared_conditions([example], examples)
        name = words if words != "all cases" else name
    if isinstance(group.pairs, NotPaired):
        return Condition(name, "not comparable", remark=group.pairs.reason, case=example)
    if failed := _failed_checks(group):
        return Condition(name, "not comparable", remark=f"checks fail: {listed(failed)}", case=example)
    by_name = {difference.quantity: difference for difference in group.pairs.differences}
    judged = [by_name[quantity] for quantity in _judged_quantities(group) if quantity in by_name]
    lead = by_name.get(LEAD) or next(iter(judged), None)
    remarks = [_turned_text(turned, "requirement"), _turned_text(turned, "validity")]
    if not _stop_alike(group, by_name.get(LEAD), group.pairs.pairs):
        lead, judged = None, []
        remarks.append("not every stop came to a standstill")
    others = tuple(difference for difference in judged if difference is not lead)
    turns = {each.change.turn for each in turned if each.layer == "requirement"} & {"new", "fixed"}
    if len(turns) == 1:
        standing: Standing = "better" if turns == {"fixed"} else "worse"
    else:
        standing = "not comparable" if lead is None else lead.standing(tolerances)
    if lead is None and not any(remarks):
        remarks.append("no measure is on both sides")
    remark = "; ".join(filter(None, remarks))
    by_number = lead is not None and lead.standing(tolerances) == standing
    return Condition(name, standing, lead, others, remark, example, by_number)


def _judged_quantities(group: MatchedGroup) -> list[str]:
    """Return the quantities of stops that requirements of a group judge."""
    cases = [case for side in group.sides if side for case in side.cases.values()]
    quantities: dict[str, None] = {}
    for verdict in (verdict for case in cases for verdict in case.criteria):
        measure = MEASURES.get(verdict.measure)
        if verdict.layer == "requirement" and measure is not None and measure.column is not None:
            name = measure.column.name
            quantities[f"{LARGEST}{name}" if measure.of_wheelsets else name] = None
    return list(quantities)


def _failed_checks(group: MatchedGroup) -> list[str]:
    """Return the checks of the rig or of the record that fail on a side: its numbers are not of the test."""
    cases = [case for pair in group.common_cases for case in pair]
    return list(dict.fromkeys(failed.id for case in cases for failed in failed_checks(case.criteria)))


def _stop_alike(group: MatchedGroup, distance: PairedDifference | None, pairs: int) -> bool:
    """Return whether every pair of stops has a braking distance, or no stop of either side has one."""
    stops = [figures for side in group.sides if side is not None for figures in side.stops.values()]
    none_stops = not any(math.isfinite(figures.get(LEAD, math.nan)) for figures in stops)
    return none_stops or (distance is not None and distance.pairs == pairs)


def _turned_text(turned: Iterable[TurnedVerdict], layer: str) -> str:
    of_test = "test: " if layer == "validity" else ""
    criteria: dict[str, dict[str, None]] = {}
    for change in (each.change for each in turned if each.layer == layer):
        if change.turn != "turned" or None in (change.first, change.second):
            criteria.setdefault(change.words, {})[change.criterion] = None
    return "; ".join(f"{of_test}{words}: {listed(list(names))}" for words, names in sorted(criteria.items()))


def _missing_requirements(matched: Iterable[MatchedGroup]) -> tuple[int, int]:
    """Return how many cases that are on both sides miss a requirement on each."""
    pairs = [pair for group in matched for pair in group.common_cases]
    first, second = (sum(pair[side].requirement_status == "missed" for pair in pairs) for side in (0, 1))
    return first, second


def _turned(group: MatchedGroup) -> Iterator[TurnedVerdict]:
    """Yield the criteria of the cases, or of the series, of a group whose verdict is another one."""
    for first, second in group.common_cases:
        yield from _turned_between(first.id, first.criteria, second.criteria)
    series = [side.series for side in group.sides if side is not None and side.series is not None]
    if len(series) == 2:
        verdicts = ([judged.verdict for judged in result.criteria] for result in series)
        yield from _turned_between(series[0].id, *verdicts, of_series=True)


def _turned_between(
    case: str, first: Iterable[Verdict], second: Iterable[Verdict], *, of_series: bool = False
) -> Iterator[TurnedVerdict]:
    before, after = ({verdict.id: verdict for verdict in side} for side in (first, second))
    for name, known in (before | after).items():
        status, other = (side[name].status if name in side else None for side in (before, after))
        if status != other:
            yield TurnedVerdict(case, known.layer, StatusChange(status, other, name), of_series)


def _judged_changes(conditions: Iterable[Condition], tolerances: Tolerances) -> list[JudgedChange]:
    """Return what the judged measures beside the lead did, those that changed most often first."""
    by_quantity: dict[str, list[tuple[Condition, PairedDifference]]] = {}
    for condition in conditions:
        for difference in condition.judged:
            by_quantity.setdefault(difference.quantity, []).append((condition, difference))
    changes = []
    for own in by_quantity.values():
        counts = Counter(difference.standing(tolerances) for _, difference in own)
        condition, largest = max(own, key=lambda pair: abs(pair[1].mean.value))
        if not all(difference.is_zero for _, difference in own):
            changes.append(JudgedChange(largest, condition.name, counts))
    return sorted(changes, key=lambda change: change.counts["no difference shown"])


def _clauses(conditions: Sequence[Condition]) -> Iterator[str]:
    """Yield in how many conditions, by how much and where the second side is better, worse, ..."""
    named, total = "", f" of {counted(len(conditions), 'condition')}"
    for standing in get_args(Standing):
        alike = [condition for condition in conditions if condition.standing == standing]
        if not alike:
            continue
        share = (
            f" in {len(alike)}{total}" if len(alike) < len(conditions) else f" in all {len(alike)} conditions"
        )
        share, total = share if len(conditions) > 1 else "", ""
        amount, named = _amount(standing, alike, named)
        yield f"{standing}{share}{_where(alike, conditions)}{amount}"


def _where(alike: Sequence[Condition], conditions: Sequence[Condition]) -> str:
    """Return what some of the conditions have in common, in brackets; nothing where that is long, or all."""
    cases, known = ([each.case for each in some if each.case] for some in (alike, conditions))
    if not len(cases) == len(alike) < len(conditions) == len(known):
        return ""
    where = shared_conditions(cases, known)
    return f" ({where})" if len(where) <= _LONGEST_WHERE else ""


def _amount(standing: Standing, conditions: Sequence[Condition], named: str) -> tuple[str, str]:
    """Return by how much conditions of one standing differ, and the measure that was named last."""
    if standing in ("no difference shown", "not comparable"):
        remarks = {condition.remark for condition in conditions if standing == "not comparable"}
        return f": {remarks.pop()}" if len(remarks) == 1 else "", named
    by_number = [condition for condition in conditions if condition.by_number]
    amount, named = _difference(by_number, named) if by_number else ("", named)
    if len(by_number) < len(conditions):
        turned = "no longer" if standing == "worse" else "now"
        others = f" in {len(conditions) - len(by_number)}" if by_number else ""
        amount += f"{',' if by_number else ':'} requirements {turned} met{others}"
    return amount, named


def _difference(conditions: Sequence[Condition], named: str) -> tuple[str, str]:
    """Return by how much conditions differ, and the measure; not again one that was `named` before."""
    leads = [condition.lead for condition in conditions if condition.lead]
    if len({lead.quantity for lead in leads}) != 1:
        return "", named
    title, unit = leads[0].title, leads[0].unit
    values = [lead.mean.value for lead in leads]
    lowest, highest = min(values), max(values)
    if lowest <= 0.0 <= highest:
        text = signed(highest, unit) if lowest == highest else f"{lowest:+.4g} to {signed(highest, unit)}"
    else:
        words = ("longer", "shorter") if unit in ("m", "s") else ("larger", "smaller")
        sizes = dict.fromkeys(number(end) for end in sorted((abs(lowest), abs(highest))))
        text = f"{with_unit(' to '.join(sizes), unit)} {words[highest < 0.0]}"
    if len(leads) == 1 and leads[0].mean.low < leads[0].mean.high:
        text += f" ({with_unit(half_interval(leads[0]), unit)}, {counted(leads[0].pairs, 'pair')})"
    joint = ", " if len(conditions) == 1 and not named else ": "
    return f"{joint}{text if title == named else f'{title} {text}'}", title


def with_unit(text: str, unit: str) -> str:
    """Return a number with its unit; a pure number has none."""
    return text if unit in ("", "1") else f"{text} {unit}"


def signed(value: float, unit: str = "") -> str:
    """Return a difference with its sign and unit."""
    return with_unit(f"{value:+.4g}" if value else "0", unit)


def half_interval(difference: PairedDifference) -> str:
    """Return half the interval of the mean difference, `±2.6`; empty where there is none."""
    half = 0.5 * (difference.mean.high - difference.mean.low)
    return "" if math.isnan(half) else f"±{half:.2g}"


def short_names(subjects: tuple[str, str]) -> tuple[str, str]:
    """Return shorter names where there are: of one controller the versions alone."""
    (first, _, one), (second, _, other) = (name.rpartition(" ") for name in subjects)
    return (one, other) if first == second != "" else subjects


def column_names(subjects: tuple[str, str]) -> tuple[str, str]:
    """Return names for the headings of a table: `first` and `second` where a name is long."""
    names = short_names(subjects)
    return names if names[0] != names[1] and max(map(len, names)) <= _LONGEST_HEADING else ("first", "second")


def subject_names(
    first: RunContent, second: RunContent, changes: Sequence[ParameterChange]
) -> tuple[str, str]:
    """Return what both sides are called: what differs between them.

    Their controllers with versions; else the first part or parameter that differs; else the version of
    uictest; else the runs.
    """
    controllers = _controllers(first), _controllers(second)
    if all(controllers) and controllers[0] != controllers[1]:
        return controllers
    # The name of a part, such as `vehicle`, stands before its parameters.
    told = [change for change in changes if not change.key.endswith(".sha256")] or changes
    named = sorted(told, key=lambda change: "." in change.key)
    if named:
        # Of an entry of a list the name of the list.
        key = [part for part in named[0].key.split(".") if not part.isdigit()][-1]
        more = len(named) - 1
        others = f" and {more} more" if more else ""
        one, other = (shortened(f"{key} {text}") + others for text in named[0].texts)
        return one, other
    versions = first.uictest_version, second.uictest_version
    if all(versions) and versions[0] != versions[1]:
        return f"uictest {versions[0]}", f"uictest {versions[1]}"
    return first.name, second.name


def _controllers(run: RunContent) -> str:
    """Return the controllers of a run, those from outside with their versions."""
    names = []
    for result in run.all_results:
        name, version = controller_of(result)
        names.append(f"{name} {version}" if version and name else name)
    return shortened(listed(list(dict.fromkeys(filter(None, names)))))


def shortened(name: str) -> str:
    """Return the end of a name that is too long for a sentence or a drawing."""
    return name if len(name) <= _LONGEST_NAME else f"…{name[1 - _LONGEST_NAME :]}"

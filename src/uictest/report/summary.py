"""What failed, grouped by cause, and what is close: the one summary that every report shows."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

from uictest.core.document import Block, Lines, Tone
from uictest.core.measures import without_wheelset
from uictest.judging import evaluation
from uictest.report.behaviour_sentences import behaviour_causes
from uictest.report.case_conditions import vehicles_text
from uictest.report.case_lines import MOST_CLOSE, CloseCall, close_calls
from uictest.report.conditions import shared_conditions
from uictest.report.content import RunContent
from uictest.report.difference import (
    Difference,
    difference_sentences,
    furthest_out,
    signed_deviation,
    worst_of_wheelsets,
)
from uictest.report.rerun import rerun_command
from uictest.report.series_report import series_explanation, series_value_text
from uictest.report.traces.instants import Taken, shown_when, taken_at
from uictest.report.traces.trace import PlotTrace
from uictest.report.verdict_sentences import (
    MISSES,
    MissKind,
    allowed_sentences,
    cause_sentences,
    decisive_verdicts,
    explanation,
    miss_kind,
    value_with_limit,
)
from uictest.report.words import argument, counted, listed, printable

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult

MOST_GROUPS: Final = 6
"""Groups that a reader is shown; the rest is counted. Chosen."""
_MOST_MISSES: Final = 6
"""Criteria of a group that are named; chosen."""
_MOST_STOPS: Final = 8
"""Stops of a log of which a group says when and where they were; the table of stops has all. Chosen."""
_DIFFERENCES: Final = 3
"""Quantities out of the tolerance of the baseline that a group names; chosen."""


class Miss(NamedTuple):
    """A criterion that cases of a group miss on the same side; `verdict` and `taken` are of the worst."""

    verdict: evaluation.Verdict
    cases: Sequence[evaluation.CaseResult]
    worst: evaluation.CaseResult
    taken: Taken | None

    @property
    def value_text(self) -> str:
        """The worst value with its limit, where and when: `77 s (limit 1 s), wheelset 4, 27.6 to 104.7 s`.

        Of a check the reason, which says more.
        """
        verdict, taken, decided = self.verdict, self.taken, shown_when(self.verdict)
        if verdict.value is None or not math.isfinite(verdict.value) or (verdict.is_check and verdict.reason):
            return printable(verdict.reason)
        text = value_with_limit(verdict)
        if taken is not None and decided is not None and decided.how not in ("end", "span"):
            text += f"{f', wheelset {taken.wheelset}' if taken.wheelset else ''}, {taken.times}"
        return printable(text)


class GroupLine(NamedTuple):
    """One line of a group, in the order of its parts.

    On a page `name` is set off and `value` leads to the case `of`, there to the criterion `at`.
    """

    name: str = ""
    before: str = ""
    value: str = ""
    text: str = ""
    of: str = ""
    at: str = ""

    def __str__(self) -> str:
        """Return it as text."""
        return f"{self.name}{self.before}{self.value}{self.text}"


@dataclass(frozen=True, slots=True)
class FailureGroup:
    """Cases that are not as expected for the same reason.

    Args:
        kind: of the reason.
        ids: of its cases, or of its series.
        where: conditions that the cases share.
        misses: criteria that they miss, the most severe first.
        causes: what explains the worst case.
        sentences: what is to be said where no criterion is missed.
        worst: id of the case that speaks for the group.
        command: runs the worst case again; empty where nothing can.
        check: tries the controller by itself, where its checks may tell why it fails.
        of_series: whether it is of a series, which may have the id of a case.

    """

    kind: MissKind
    ids: Sequence[str]
    where: str
    misses: Sequence[Miss] = ()
    causes: Sequence[str] = ()
    sentences: Sequence[str] = ()
    worst: str = ""
    command: str = ""
    check: str = ""
    of_series: bool = False

    @property
    def heading(self) -> str:
        """What happened to how many cases, and where: `7 cases miss requirements: friction 0.06`."""
        one, several = MISSES[self.kind]
        if len(self.ids) == 1:
            return f"{printable(self.ids[0])} {one}"
        return f"{len(self.ids)} cases {several}{f': {self.where}' if self.where else ''}"

    @property
    def block(self) -> Block:
        """The group as a document shows it."""
        check = [f"try the controller by itself: {self.check}"] if self.check else []
        tone: Tone = "odd" if self.kind in ("error", "check") else "bad"
        return Block(self.heading, [*map(str, self.lines), *check], self.command, tone)

    @property
    def lines(self) -> Iterator[GroupLine]:
        """What is said of the cases: criteria, the case that speaks for the group, causes, sentences."""
        for miss in self.misses[:_MOST_MISSES]:
            name, at = printable(miss.verdict.id), miss.verdict.id if miss.taken else ""
            yield GroupLine(name, self._count(miss), miss.value_text, self._worst_of(miss), miss.worst.id, at)
        if (more := len(self.misses) - _MOST_MISSES) > 0:
            yield GroupLine(text=f"{counted(more, 'more criterion', 'more criteria')} in criteria.csv")
        # Else the command names it.
        if self.example and not (self.misses and self.command):
            yield GroupLine(before=f"{self.example}: ", value=printable(self.worst), of=self.worst)
        for cause in self.causes:
            yield GroupLine(name=f"cause{' in the worst case' if self.example else ''}:", text=f" {cause}")
        yield from (GroupLine(text=sentence) for sentence in self.sentences)

    @property
    def example(self) -> str:
        """What the case is that speaks for several; empty for one case."""
        by_size = self.misses or self.kind == "differs"
        return "" if len(self.ids) == 1 else "worst case" if by_size else "first case"

    def _count(self, miss: Miss) -> str:
        """Return what stands between a criterion and its worst value: ` in 3 cases, worst `."""
        if len(self.ids) == 1:
            return ": "
        every = "both" if len(self.ids) == 2 else f"all {len(self.ids)}"
        count = every if len(miss.cases) == len(self.ids) else counted(len(miss.cases), "case")
        return f" in {count}, worst "

    def _worst_of(self, miss: Miss) -> str:
        """Return the case of a worst value, where it is not the one that speaks for the group.

        In a group of one scenario the values of its sweep are enough.
        """
        scenario, bracket, values = miss.worst.id.partition("[")
        is_enough = bracket and all(name.startswith(f"{scenario}[") for name in self.ids)
        name = printable(f"[{values}" if is_enough else miss.worst.id)
        return "" if miss.worst.id == self.worst else f", {name}"


Answer = Literal["failed", "incomplete", "shown", "allowed", "passed"]


@dataclass(frozen=True, slots=True)
class RunSummary:
    """What a reader of a run must know first.

    Args:
        headline: the answer in one sentence.
        answer: that in a word: of a programme, which decides nothing but by what failed, `shown`.
        subject: what was tested: controller and vehicle.
        groups: what is not as expected, errors first.
        allowed: what was missed and is allowed.
        close: verdicts that could have been other ones, one line for each criterion.

    """

    headline: str
    answer: Answer
    subject: str
    groups: Sequence[FailureGroup]
    allowed: Sequence[str]
    close: Sequence[CloseCall]

    @property
    def blocks(self) -> list[Block]:
        """The groups as a document shows them; of more than there is room for, how many."""
        blocks = [group.block for group in self.groups[:MOST_GROUPS]]
        return [*blocks, *(Block(line, ()) for line in self.more_groups)]

    @property
    def more_groups(self) -> list[str]:
        """What is not as expected beyond these groups, one line; nothing where that is all."""
        rest = [name for group in self.groups[MOST_GROUPS:] for name in group.ids]
        are = "is" if len(rest) == 1 else "are"
        return [f"{len(rest)} more {are} not as expected: {listed(rest)}"] if rest else []

    @property
    def more_close(self) -> list[str]:
        """How many lines on close verdicts there are beyond those shown, one line; nothing without."""
        more = len(self.close) - MOST_CLOSE
        return [f"{counted(more, 'more criterion', 'more criteria')} in criteria.csv"] if more > 0 else []


def run_summary(content: RunContent) -> RunSummary:
    """Return the summary of a run."""
    groups = list(_groups(content))
    of_programme = bool(content.campaign and content.campaign.tests)  # which judges in place of the cases
    allowed = [] if of_programme else list(allowed_sentences(content.results))
    answer: Answer = "shown" if of_programme else "allowed" if allowed else "passed"
    if groups or (content.campaign and content.campaign.failed):
        answer = "failed"
    elif not content.complete:
        answer = "incomplete"
    return RunSummary(
        headline=_headline(content, groups),
        answer=answer,
        subject=_subject(content),
        groups=groups,
        allowed=allowed,
        close=[] if of_programme else list(_close_groups(close_calls(content.results, content.series))),
    )


def close_lines(summary: RunSummary) -> Lines:
    """Return what is close or not certain, a line for each criterion, and what was missed and is allowed."""
    shown = map(str, summary.close[:MOST_CLOSE])
    return Lines([*shown, *summary.more_close, *summary.allowed], title="Close or uncertain")


def case_causes(result: evaluation.CaseResult, trace: PlotTrace | None) -> list[str]:
    """Return what the trace of a case shows of why it misses a requirement; nothing for other cases."""
    verdicts = [verdict for verdict in decisive_verdicts(result) if verdict.layer == "requirement"]
    if result.repeats is not None:  # its verdicts are those of several stops
        trace = None
    if result.outcome != "fail" or not verdicts or trace is None or cause_sentences(result):
        return []
    return list(behaviour_causes(trace.behaviour))[:1]


def _subject(content: RunContent) -> str:
    results, vehicles = content.all_results, vehicles_text(content.all_results)
    mass = {f"{result.car.mass_t:.4g} t" for result in results if result.car is not None}
    named = [f"WSP {content.controllers}"] if content.controllers else []
    named += [f"car {vehicles}"] if vehicles else []
    return ", ".join([*named, *(mass if len(mass) == 1 else ())])


def _headline(content: RunContent, groups: Sequence[FailureGroup]) -> str:
    """Return how many cases failed, which and by what: `4 of 34 cases failed: wet-80 (locked-wheels)`."""
    if not groups:
        return content.tally
    parts: list[str] = []
    for kind, of_series in product(MISSES, (False, True)):
        of_kind = [group for group in groups if (group.kind, group.of_series) == (kind, of_series)]
        names = dict.fromkeys(name for group in of_kind for name in group.ids)
        if not names:
            continue
        whole = len(content.series if of_series else content.results)
        noun = "series" if of_series else "case" if whole == 1 else "cases"
        verb = "failed" if kind == "fail" else MISSES[kind][len(names) > 1]
        count = f"{len(names)} of {whole} {noun}" if not parts or of_series else str(len(names))
        if kind == "missing":
            count = counted(len(names), "case")
        parts.append(f"{count} {verb}{_headline_names(of_kind)}")
    return "; ".join(parts)


def _headline_names(groups: Sequence[FailureGroup]) -> str:
    """Return the scenarios or series of groups, with the criterion that most cases of each miss.

    Groups of one scenario are told apart by the ids of their cases.
    """
    scenarios = [tuple(dict.fromkeys(name.partition("[")[0] for name in group.ids)) for group in groups]
    texts = []
    for group, names in zip(groups, scenarios, strict=True):
        named = listed(names if scenarios.count(names) == 1 else group.ids)
        missed = max(group.misses, key=lambda miss: len(miss.cases)).verdict.id if group.misses else ""
        texts.append(f"{named} ({missed})" if missed else named)
    shown = texts[:2]
    return f": {', '.join(shown)}{f' and {len(texts) - 2} more' if len(texts) > 2 else ''}"


def _groups(content: RunContent) -> Iterator[FailureGroup]:
    """Yield the groups of what is not as expected, errors first, then by their number of cases."""
    by_kind: dict[MissKind, list[evaluation.CaseResult]] = {}
    for result in content.results:
        if not content.passes(result):
            kind: MissKind = "differs" if content.expected(result) else miss_kind(result)
            by_kind.setdefault(kind, []).append(result)
    for kind in MISSES:
        cases = by_kind.get(kind, ())
        connected = _connected([(case, _reasons(content, kind, case)) for case in cases])
        for members in sorted(connected, key=len, reverse=True):
            yield _group(content, kind, members)
    if content.baseline is not None:
        for name, file in content.baseline.beside_cases.items():
            in_run = name in content.baseline.series
            sentences = difference_sentences(content.differences(name), _DIFFERENCES)
            command = rerun_command(content, file, name) if in_run else ""
            kind = "differs" if in_run else "missing"
            yield FailureGroup(
                kind, [name], "", sentences=sentences, worst=name, command=command, of_series=in_run
            )
    for series in content.series:
        if not series.met:
            yield _series_group(content, series)


def _series_group(content: RunContent, series: SeriesResult) -> FailureGroup:
    command = rerun_command(content, series.file, series.id)
    missed = [
        f"{judged.verdict.id}: {series_value_text(judged)}"
        for judged in series.criteria
        if judged.verdict.status == "fail" and judged.verdict.value is not None
    ]
    if missed and series.outcome == "error":  # some stop failed to run
        missed.insert(0, series.reason)
    sentences = list(map(printable, missed)) or series_explanation(series)
    return FailureGroup(
        "series", [series.id], "", sentences=sentences, worst=series.id, command=command, of_series=True
    )


def _reasons(content: RunContent, kind: MissKind, case: evaluation.CaseResult) -> set[tuple[str, str]]:
    """Return why a case is not as expected: each quantity, criterion or reason with its direction."""
    if kind == "differs":
        furthest = _furthest(content, case)
        side = furthest.status.turn if furthest.status else signed_deviation(furthest)[0]
        return {(without_wheelset(furthest.quantity)[0], side)}
    verdicts = case.unsettled if kind == "unsettled" else decisive_verdicts(case)
    return {_direction(verdict) for verdict in verdicts} or {("", case.reason)}


def _furthest(content: RunContent, case: evaluation.CaseResult) -> Difference:
    """Return by which quantity a case is furthest out of the tolerance of the baseline."""
    return furthest_out(worst_of_wheelsets(content.differences(case.id)))[0]


def _direction(verdict: evaluation.Verdict) -> tuple[str, str]:
    """Return the criterion and the side on which it is missed: cases alike in it are one group."""
    if verdict.status != "fail" or verdict.value is None:
        return verdict.id, verdict.status
    low = verdict.lower is not None and verdict.value < verdict.lower
    return verdict.id, "low" if low else "high"


def _connected(
    cases: Iterable[tuple[evaluation.CaseResult, set[tuple[str, str]]]],
) -> list[list[evaluation.CaseResult]]:
    """Return cases, given with their reasons, in sets: two with a reason in common are in the same set."""
    sets: list[tuple[set[tuple[str, str]], list[evaluation.CaseResult]]] = []
    for case, reasons in cases:
        joined = [case]
        for own in [own for own in sets if own[0] & reasons]:
            sets.remove(own)
            reasons = reasons | own[0]
            joined = [*own[1], *joined]
        sets.append((reasons, joined))
    return [joined for _, joined in sets]


def _group(content: RunContent, kind: MissKind, cases: Sequence[evaluation.CaseResult]) -> FailureGroup:
    where = shared_conditions(cases, content.results)
    misses: list[Miss] = []
    worst = cases[0]
    if kind in ("check", "fail", "invalid", "inconclusive"):
        found = _misses(content, cases)
        misses = sorted(found, key=lambda miss: evaluation.relative_margin(miss.verdict) or 0.0)
    if misses:
        worst = misses[0].worst
    elif kind == "differs":
        furthest = furthest_out(_furthest(content, case) for case in cases)[0].case
        worst = next(case for case in cases if case.id == furthest)
    causes = [*cause_sentences(worst), *case_causes(worst, content.traces.get(worst.id))] if misses else []
    sentences = _sentences(content, kind, worst) if not misses else []
    located = content.locations([case.id for case in cases])
    sentences += [printable(f"{name}: {where_and_when}") for name, where_and_when in located.items()][
        :_MOST_STOPS
    ]
    return FailureGroup(
        kind,
        [case.id for case in cases],
        where,
        misses,
        causes,
        sentences,
        worst.id,
        rerun_command(content, worst.scenario, worst.id),
        _check_of_controller(content, worst) if kind == "fail" and causes else "",
    )


def _check_of_controller(content: RunContent, result: evaluation.CaseResult) -> str:
    """Return the command that tries a controller from outside by itself; empty where it has no file."""
    program = evaluation.program_in(result.parts)
    if program is None:
        return ""
    files = [name for name in content.manifest.inputs if PurePath(name).stem == program.name]
    file = next((name for name in files if name.endswith((".yaml", ".yml"))), "")
    if not file:
        return ""
    # The manifest leaves out folders of this machine: most controllers stand beside their scenario.
    path = file.replace("...", PurePath(result.scenario).parent.as_posix(), 1)
    return f"uictest controller check {argument(path)}" if Path(path).is_file() else ""


def _sentences(content: RunContent, kind: MissKind, result: evaluation.CaseResult) -> list[str]:
    if kind == "differs":
        return difference_sentences(content.differences(result.id), _DIFFERENCES)
    if kind == "unexpected":
        return [printable(f"{result.outcome}, expected: {result.expect}")]
    if kind == "error":
        return [*cause_sentences(result), printable(result.reason)]
    return explanation(result)


def _misses(content: RunContent, cases: Sequence[evaluation.CaseResult]) -> Iterator[Miss]:
    """Yield each criterion that the cases miss on one side, with the worst of them."""
    by_reason: dict[tuple[str, str], list[tuple[evaluation.Verdict, evaluation.CaseResult]]] = {}
    for case in cases:
        for verdict in decisive_verdicts(case):
            by_reason.setdefault(_direction(verdict), []).append((verdict, case))
    for judged in by_reason.values():
        verdict, worst = min(judged, key=lambda pair: evaluation.relative_margin(pair[0]) or 0.0)
        trace = None if worst.repeats is not None else content.traces.get(worst.id)
        taken = taken_at(verdict, trace) if trace else None
        yield Miss(verdict, [case for _, case in judged], worst, taken)


def _close_groups(calls: Iterable[CloseCall]) -> Iterator[CloseCall]:
    """Yield one call for each criterion and kind, the closest, which says how many others there are."""
    alike: dict[tuple[str, ...], list[CloseCall]] = {}
    for call in calls:
        key = (call.kind, call.criterion) if call.criterion else (call.kind, call.of)
        alike.setdefault(key, []).append(call)
    for closest, *others in alike.values():
        more = f", and {counted(len(others), 'more case')}" if others else ""
        yield closest._replace(text=f"{closest.text}{more}")

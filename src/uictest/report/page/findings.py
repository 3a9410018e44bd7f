"""What a page answers first: what is not as expected, by how much and where; else what came closest to it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Final, NamedTuple

from uictest.judging import evaluation
from uictest.report import series as series_views
from uictest.report.causes import cause_sentences
from uictest.report.close_calls import CloseCall, close_calls
from uictest.report.content import CaseDescription, RunContent
from uictest.report.difference import difference_sentences
from uictest.report.page.case_view import CaseView
from uictest.report.page.links import case_anchor, fragment, rerun_command, series_anchor
from uictest.report.page.stop.margins import Margin, Margins, margins_of
from uictest.report.verdict_sentences import statement_sentence

MOST_FINDINGS: Final = 12
"""Cases that the first screen names; the table below it has all of them, these first."""
_DIFFERENCES: Final = 3
_CONDITIONS: Final = ("initial speed", "brake", "rail", "WSP")
"""Names of settings that stand with a finding."""
_MOST_CRITERIA: Final = 10
"""Columns of the matrix: more would leave no room for the names of the cases."""


class Finding(NamedTuple):
    """A case or series that is not as expected.

    `causes` say what explains it, `missed` holds the criteria that decided it, `sentences` say the rest.
    `command` runs it again, and is empty where there is none. `conditions` are those of a stop, and what was
    expected of it.
    """

    word: str
    id: str
    fragment: str
    missed: Sequence[Margin]
    sentences: Sequence[str]
    command: str
    causes: Sequence[str] = ()
    conditions: str = ""


class Closest(NamedTuple):
    """The criterion with the least to spare, of a case that is as expected."""

    id: str
    fragment: str
    margin: Margin


def findings_of(
    content: RunContent, margins: Mapping[str, Margins], commands: Mapping[str, str]
) -> list[Finding]:
    """Return what is not as expected, series last: their verdict rests on the stops of many cases."""
    return [
        *(_of_case(content, each, margins, commands) for each in content.ranked if not content.passes(each)),
        *(
            Finding(
                series_views.series_word(each),
                each.id,
                fragment(series_anchor(each.id)),
                (),
                series_views.series_explanation(each),
                rerun_command(content.manifest, each.file, each.id),
            )
            for each in content.series
            if not each.met
        ),
    ]


def _of_case(
    content: RunContent,
    result: evaluation.CaseResult,
    margins: Mapping[str, Margins],
    commands: Mapping[str, str],
) -> Finding:
    missed = () if result.met else [each for each in margins[result.id].judged if _decides(each, result)]
    causes = cause_sentences(result)
    sentences = [each for each in content.explanation(result, _DIFFERENCES) if each not in causes]
    if missed:
        differences = difference_sentences(content.differences(result.id), _DIFFERENCES)
        sentences = [statement_sentence(result), *differences]
    return Finding(
        content.word(result),
        result.id,
        fragment(case_anchor(result.id)),
        missed,
        sentences,
        commands[result.id],
        causes,
        "; ".join(
            [*_conditions(content.subject(result.id)), *([f"expected: {result.expect}"] if missed else [])]
        ),
    )


def _conditions(subject: CaseDescription) -> Iterator[str]:
    """Yield what a reader must know of a stop before its values mean anything."""
    yield from (f"{name} {text}" for name, text in subject.settings.items() if name in _CONDITIONS)


def _decides(margin: Margin, result: evaluation.CaseResult) -> bool:
    """Return whether a criterion is why a case is not as expected: a steady pass never is."""
    if margin.verdict.status == "pass":
        return bool(result.unsettled) and not margin.verdict.steady
    return True


def closest_of(content: RunContent, margins: Mapping[str, Margins]) -> Closest | None:
    """Return the criterion of a passing case that has the least to spare; None where none has a share."""
    passing = (result for result in content.results if result.outcome == "pass" and content.passes(result))
    shares = [
        (each.to_spare, result.id, each)
        for result in passing
        for each in margins[result.id].judged
        if each.to_spare is not None
    ]
    if not shares:
        return None
    _, name, margin = min(shares, key=lambda share: share[:2])
    return Closest(name, fragment(case_anchor(name)), margin)


class Close(NamedTuple):
    """A close or uncertain verdict; `fragment` leads to its case or series, `taken` says when it was."""

    call: CloseCall
    fragment: str
    taken: str


def close_of(content: RunContent, margins: Mapping[str, Margins]) -> list[Close]:
    """Return what is close to its limit, or not certain, with where it is shown."""
    taken = {
        (own, each.verdict.id): each.taken_text for own, judged in margins.items() for each in judged.judged
    }
    return [
        Close(call, fragment(series_anchor(call.of)), "")
        if call.of_series
        else Close(call, fragment(case_anchor(call.of)), taken.get((call.of, call.criterion), ""))
        for call in close_calls(content.results, content.series)
    ]


def margins_of_all(content: RunContent, drawn: Iterable[CaseView]) -> dict[str, Margins]:
    """Return the margins of every case by id; those of drawn ones with the instants of their values."""
    known = {view.result.id: view.margins for view in drawn}
    return {each.id: known.get(each.id) or margins_of(each.criteria) for each in content.results}


class Matrix(NamedTuple):
    """Cases against criteria: the names of the columns, the cells of a case by its id, what has no room."""

    criteria: Sequence[str]
    cells: Mapping[str, Sequence[Margin | None]]
    left_out: int


def matrix_of(margins: Mapping[str, Margins]) -> Matrix:
    """Return the matrix of a run; of more criteria than have room those that some case misses stay first."""
    rows = {name: {each.verdict.id: each for each in _all_of(own)} for name, own in margins.items()}
    known = dict.fromkeys(criterion for row in rows.values() for criterion in row)
    missed = {each.verdict.id for row in rows.values() for each in row.values() if each.kind == "fail"}
    kept = set(sorted(known, key=lambda criterion: criterion not in missed)[:_MOST_CRITERIA])
    criteria = sorted(kept)
    cells = {name: [row.get(criterion) for criterion in criteria] for name, row in rows.items()}
    return Matrix(criteria, cells, len(known) - len(criteria))


def _all_of(margins: Margins) -> Iterator[Margin]:
    yield from margins.judged
    yield from margins.not_applicable

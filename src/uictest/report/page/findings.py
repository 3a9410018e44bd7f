"""What a page answers first: what is not as expected, by how much and where, and what runs it again."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from typing import Final, NamedTuple

from uictest.judging import evaluation
from uictest.report.content import CASES_IN_PYTHON, RunContent, RunManifest
from uictest.report.difference import difference_sentences
from uictest.report.page.margins import Margin, Margins
from uictest.report.page.rendering import case_fragment, series_fragment
from uictest.report.series_report import series_explanation
from uictest.report.verdict_sentences import cause_sentences, statement_sentence
from uictest.report.words import argument, printable, result_word

MOST_FINDINGS: Final = 12
"""Cases that the first screen names; the table below it has all of them, these first."""
_DIFFERENCES: Final = 3
_CONDITIONS: Final = ("initial speed", "brake", "rail", "WSP")
"""Names of settings that stand with a finding: what a reader must know before its values mean anything."""
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


def findings_of(
    content: RunContent, margins: Mapping[str, Margins], commands: Mapping[str, str]
) -> Iterator[Finding]:
    """Yield the cases that are not as expected, then such series: these rest on the stops of many cases."""
    for result in content.ranked:
        if not content.passes(result):
            yield _case_finding(content, result, margins[result.id], commands[result.id])
    for series in content.series:
        if not series.met:
            yield Finding(
                result_word(series),
                series.id,
                series_fragment(series.id),
                (),
                series_explanation(series),
                rerun_command(content.manifest, series.file, series.id),
            )


def _case_finding(
    content: RunContent, result: evaluation.CaseResult, margins: Margins, command: str
) -> Finding:
    deciding_margins = [] if result.met else [margin for margin in margins.judged if _decides(margin, result)]
    causes = cause_sentences(result)
    settings = content.subject(result.id).settings
    conditions = [f"{name} {text}" for name, text in settings.items() if name in _CONDITIONS]
    if deciding_margins:
        differences = difference_sentences(content.differences(result.id), _DIFFERENCES)
        sentences = [statement_sentence(result), *differences]
        conditions.append(f"expected: {result.expect}")
    else:
        explanation = content.explanation(result, _DIFFERENCES)
        sentences = [sentence for sentence in explanation if sentence not in causes]
    return Finding(
        content.word(result),
        result.id,
        case_fragment(result.id),
        deciding_margins,
        sentences,
        command,
        causes,
        "; ".join(conditions),
    )


def _decides(margin: Margin, result: evaluation.CaseResult) -> bool:
    """Return whether a criterion is why a case is not as expected: a steady pass never is."""
    if margin.verdict.status == "pass":
        return bool(result.unsettled) and not margin.verdict.steady
    return True


def closest_of(content: RunContent, margins: Mapping[str, Margins]) -> tuple[str, Margin] | None:
    """Return the passing case and its criterion that has the least to spare; None where none has a share."""
    shares = [
        (margin.to_spare, result.id, margin)
        for result in content.results
        if result.outcome == "pass" and content.passes(result)
        for margin in margins[result.id].judged
        if margin.to_spare is not None
    ]
    if not shares:
        return None
    _, case_id, margin = min(shares, key=lambda share: share[:2])
    return case_id, margin


class Matrix(NamedTuple):
    """Cases against criteria: the names of the columns, the cells of a case by its id, what has no room."""

    criteria: Sequence[str]
    cells: Mapping[str, Sequence[Margin | None]]
    left_out: int


def matrix_of(margins: Mapping[str, Margins]) -> Matrix:
    """Return the matrix of a run; of more criteria than have room those that some case misses stay first."""
    rows = {
        case_id: {margin.verdict.id: margin for margin in (*of_case.judged, *of_case.not_applicable)}
        for case_id, of_case in margins.items()
    }
    all_criteria = dict.fromkeys(criterion for row in rows.values() for criterion in row)
    missed = {margin.verdict.id for row in rows.values() for margin in row.values() if margin.kind == "fail"}
    criteria = sorted(sorted(all_criteria, key=lambda criterion: criterion not in missed)[:_MOST_CRITERIA])
    cells = {case_id: [row.get(criterion) for criterion in criteria] for case_id, row in rows.items()}
    return Matrix(criteria, cells, len(all_criteria) - len(criteria))


_WITH_VALUE: Final = ("--set", "--seed", "--repeat", "--trust")
"""Options of `uictest run` that change what a case is, or which files it may read."""
_FLAGS: Final = ("--in-process", "--real-time")


def rerun_commands(content: RunContent) -> dict[str, str]:
    """Return the command for every case, by id. A stop of a series cannot run without the series."""
    manifest = content.manifest
    commands = {result.id: rerun_command(manifest, result.scenario, result.id) for result in content.results}
    for series in content.series:
        command = rerun_command(manifest, series.file, series.id)
        commands |= {stop.case.id: command for stop in series.cases}
    return commands


def rerun_command(manifest: RunManifest, file: str, name: str) -> str:
    """Return the command that runs one case or series again; empty where there is none.

    The command keeps the options of the run that change a case. There is none for recorded stops, nor for
    cases that a program loaded: its changes to them are not known.

    Args:
        manifest: manifest of the run, which holds its command line.
        file: path of the scenario or series file.
        name: id of the case or series.

    """
    if tuple(manifest.command[1:2]) != ("run",) or CASES_IN_PYTHON in manifest.command:
        return ""
    options: list[str] = []
    words = iter(manifest.command[2:])
    for word in words:
        if word in _WITH_VALUE:
            options += [word, next(words, "")]
        elif word in _FLAGS or word.startswith(tuple(f"{option}=" for option in _WITH_VALUE)):
            options.append(word)
    return printable(f"uictest run {argument(file)} {shlex.join([*options, '-k', name])}")

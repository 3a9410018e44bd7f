"""A run as it is published: its tables, its summary for people, its testcases, its page."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import TYPE_CHECKING, Final, NamedTuple

from uictest.core import measures
from uictest.core.document import (
    Blocks,
    Cell,
    Column,
    Document,
    Lines,
    Section,
    Table,
    keyed_columns,
    table_of,
)
from uictest.judging import evaluation
from uictest.report import page
from uictest.report.case_conditions import (
    TRAIN_COLUMNS,
    changes_of,
    controller_of,
    notices,
    train_cells,
    train_text,
)
from uictest.report.ci_server import run_suites
from uictest.report.content import RunContent
from uictest.report.difference import (
    baseline_summary,
    differences_table,
    not_compared_sentences,
    worst_of_wheelsets,
)
from uictest.report.formats import Publication
from uictest.report.measure_columns import measure_columns
from uictest.report.requirements import (
    evidence_table,
    requirements_of,
    requirements_table,
    verified_requirements,
)
from uictest.report.robustness import (
    CRITERION_COLUMNS,
    SHARE_COLUMNS,
    any_repeated,
    criterion_share_cells,
    firmness_sentences,
    firmness_table,
    range_cells,
    range_columns,
    share_cells,
    stop_rows,
    stops_text,
)
from uictest.report.series_report import series_sections, series_tables
from uictest.report.summary import close_lines, run_summary
from uictest.report.traces.quantities import WHEELSETS
from uictest.report.verdict_sentences import definition_sentence, reading_sentences
from uictest.report.words import number, tone

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult

_Case = evaluation.CaseResult
_DETAIL: Final = 20
"""Rank of what a narrow terminal leaves out first."""
_SHORT: Final = {"not_valid": "no", "valid": "yes", "not_judged": "-", "met": "met", "missed": "missed"}
_NEVER_LEFT_OUT: Final = 5
"""Columns of missed criteria that the narrowest terminal has room for; chosen for 100 characters."""
_MOST: Final = 100
"""Requirements, readings and quantities out of tolerance that a reader is shown in a summary; chosen."""


def publication_of_run(content: RunContent, texts: Mapping[str, str] | None = None) -> Publication:
    """Return a run as it is published, with its documents in JSON."""
    judged: list[_Case | SeriesResult] = [*content.results, *content.series]
    return Publication(
        document=run_document(content),
        tables=run_tables(content),
        page=lambda: page.page_html(content),
        suites=lambda named: run_suites(content, with_properties=named),
        named_in_tests=any(result.test_case or requirements_of(result) for result in judged),
        texts=texts or {},
    )


def run_tables(content: RunContent) -> list[Table]:
    """Return the tables of a run, those of requirements, firmness, series or a log only where it has such."""
    results = content.results
    optional = [
        repeats_table(results),
        evidence_table(verified_requirements(results, content.series)),
        firmness_table([*results, *content.series]),
    ]
    return [
        cases_table(content),
        wheelsets_table(results),
        criteria_table(results),
        *(table for table in optional if table.rows),
        *(series_tables(content.series) if content.series else ()),
        *(content.campaign.at("first") if content.campaign else ()),
        *(content.campaign.at("detail") if content.campaign else ()),
        *(content.campaign.at("file") if content.campaign else ()),
    ]


def cases_table(content: RunContent) -> Table:
    """Return one row per case: swept parameters (as written), outcome, controller, changes, measures.

    Where a case repeats its stop, there are its share of stops that pass and the range of each measure, too;
    where one is a car of a train, its train and the forces in its couplers.
    """
    results = content.results
    swept = dict.fromkeys(key for result in results for key in result.parameters)
    in_train = any(result.train is not None for result in results)
    repeated = any_repeated(results)
    columns: list[Column[_Case]] = [
        Column(key="id", heading="case", value=lambda case: case.id, literal=True, wraps=True),
        Column(heading="verdict", text=content.word, tone=lambda case: tone(content.word(case))),
        Column(key="scenario", value=lambda case: case.scenario),
        *keyed_columns(swept, lambda case: case.parameters, "parameters."),
        Column(key="expect", value=lambda case: str(case.expect)),
        Column(key="outcome", value=lambda case: case.outcome),
        Column(
            key="test_validity",
            heading="valid\ntest",
            value=lambda case: case.test_validity,
            text=lambda case: _SHORT[_deciding(case).test_validity],
            rank=1,
        ),
        Column(key="rail_validity", value=lambda case: case.rail.test_validity if case.rail else ""),
        Column(
            key="requirement_status",
            heading="require-\nments",
            value=lambda case: case.requirement_status,
            text=lambda case: _SHORT[case.requirement_status],
            rank=1,
        ),
        Column(key="met", value=lambda case: case.met),
        Column(key="reason", value=lambda case: case.reason),
        Column(key="controller", value=lambda case: controller_of(case)[0]),
        Column(key="controller_version", value=lambda case: controller_of(case, content.uictest_version)[1]),
        Column(key="changed_parameters", value=lambda case: "; ".join(changes_of(case))),
        Column(key="test_case", value=lambda case: case.test_case),
        Column(key="requirements", value=lambda case: "; ".join(case.requirements)),
        Column(heading="stops", text=lambda case: stops_text(case) or ("-" if repeated else "")),
        *keyed_columns(TRAIN_COLUMNS if in_train else (), train_cells),
        *keyed_columns(SHARE_COLUMNS if repeated else (), share_cells),
        *_measured_columns(results),
        *keyed_columns(
            range_columns(measures.STOP_COLUMNS) if repeated else (),
            lambda case: range_cells(case, measures.STOP_COLUMNS),
        ),
        Column(heading="train", text=train_text, rank=_DETAIL),
    ]
    return Table(columns, results, name="summary")


def _deciding(case: _Case) -> _Case | evaluation.RailValidity:
    """Return the stop that decides whether a case is a valid test: its own, or that of the bypassed WSP."""
    return case.rail if case.rail is not None and case.rail.decides else case


def _missed_criteria(results: Iterable[_Case]) -> dict[str, str]:
    """Return the criteria by which cases are not as expected, each with the column that people see, or "".

    Those that most cases miss come first.
    """
    columns = measures.STOP_COLUMNS | measures.WHEELSET_COLUMNS
    missed = {}
    counts: Counter[str] = Counter()
    for result in results:
        for verdict in result.criteria if not result.met else ():
            if verdict.status in ("fail", "inconclusive"):
                counts[verdict.id] += 1
                measure = measures.MEASURES.get(verdict.measure)
                name = measure.column.name if measure is not None and measure.column is not None else ""
                missed[verdict.id] = name if name in columns and columns[name].overview else ""
    return {criterion: missed[criterion] for criterion, _ in counts.most_common()}


def _measured_columns(results: Sequence[_Case]) -> list[Column[_Case]]:
    """Return the columns of measures, and of missed criteria those that show another number than these."""
    missed = _missed_criteria(results)
    columns = measure_columns(results, failing=missed.values())
    measures_end = len(columns)
    for criterion in (name for name, column in missed.items() if not column):
        rank = 0 if len(columns) - measures_end < _NEVER_LEFT_OUT else 1
        column = _criterion_column(results, criterion, rank)
        judged = [result for result in results if column.cell(result) is not None]
        shown = (k for k, known in enumerate(columns) if known.heading)
        alike = (k for k in shown if all(columns[k].cell(case) == column.cell(case) for case in judged))
        if judged and (twin := next(alike, None)) is not None:
            columns[twin] = replace(columns[twin], rank=0)
        elif judged:
            columns.append(column)
    return columns


def _criterion_column(results: Iterable[_Case], criterion: str, rank: int) -> Column[_Case]:
    """Return the values of a criterion whose measure people see in no column."""
    verdicts = {
        result.id: verdict for result in results for verdict in result.criteria if verdict.id == criterion
    }
    unit = next(verdict.unit for verdict in verdicts.values()).removeprefix("1")

    def value(result: _Case) -> float | None:
        known = verdicts[result.id].value if result.id in verdicts else None
        return known if known is not None and math.isfinite(known) else None

    return Column(
        heading=criterion,
        unit=unit,
        value=value,
        text=lambda case: number(value(case), 4),
        rank=rank,
        right=True,
    )


def wheelsets_table(results: Sequence[_Case]) -> Table:
    """Return one row per case and wheelset; wheelset 1 leads. Ranges as in :func:`cases_table`."""
    repeated = any_repeated(results)
    ranges = range_columns(measures.WHEELSET_COLUMNS) if repeated else ()
    rows = [
        {
            "id": result.id,
            "wheelset": position,
            **wheelset,
            **(range_cells(result, measures.WHEELSET_COLUMNS, position) if repeated else {}),
        }
        for result in results
        for position, wheelset in enumerate(result.wheelsets, start=1)
    ]
    return table_of("wheelsets", rows, ["id", "wheelset", *measures.WHEELSET_COLUMNS, *ranges])


class _Judged(NamedTuple):
    case: _Case
    verdict: evaluation.Verdict


def criteria_table(results: Sequence[_Case]) -> Table:
    """Return one row per case and criterion, with the definitions that its verdict depends on.

    Where a case repeats its stop, there are the counts of its stops and the range of the values, too.
    """
    fields = {"layer": "layer", "verdict": "status"}
    fields |= {name: name for name in ("value", "unit", "lower", "upper", "margin", "reason")}
    shares = CRITERION_COLUMNS if any_repeated(results) else ()
    columns: list[Column[_Judged]] = [
        Column(key="id", value=lambda row: row.case.id),
        Column(key="criterion", value=lambda row: row.verdict.id),
        *(Column(key=key, value=attrgetter(f"verdict.{field}")) for key, field in fields.items()),
        Column(key="readings", value=lambda row: "; ".join(reading_sentences(row.verdict))),
        *keyed_columns(shares, lambda row: criterion_share_cells(row.verdict)),
        Column(key="requirements", value=lambda row: "; ".join(row.verdict.requirements)),
        Column(key="definition", value=lambda row: definition_sentence(row.verdict)),
    ]
    rows = [_Judged(result, verdict) for result in results for verdict in result.criteria]
    return Table(columns, rows, name="criteria")


def repeats_table(results: Sequence[_Case]) -> Table:
    """Return one row per stop of every repeated case: seed, outcome, measures."""
    wheelsets = (f"{name}_{position}" for position in WHEELSETS for name in measures.WHEELSET_COLUMNS)
    statements = ("outcome", "test_validity", "requirement_status", "reason")
    keys = ["id", "seed", *statements, *measures.STOP_COLUMNS, *wheelsets]
    return table_of("repeats", list(stop_rows(results)), keys)


def readings_table(results: Sequence[_Case]) -> Table:
    """Return the verdicts by each reading of the criteria that have several, for people."""
    rows = [
        {"case": result.id, "criterion": verdict.id, "reading": sentence}
        for result in results
        for verdict in result.criteria
        for sentence in reading_sentences(verdict)
    ]
    columns: list[Column[Mapping[str, Cell]]] = [
        Column(key="case", heading="case", literal=True),
        Column(key="criterion", heading="criterion", literal=True),
        Column(key="reading", heading="reading"),
    ]
    return Table(columns, rows, all_in="criteria.csv", most=_MOST)


def run_document(content: RunContent) -> Document:
    """Return the whole result of a run: what failed and what is close, then one row per case."""
    summary = run_summary(content)
    judged: list[_Case | SeriesResult] = [*content.results, *content.series]
    firm = [f"{result.id}: {line}" for result in judged for line in firmness_sentences(result)]
    sections: list[Section] = [
        Blocks(summary.blocks),
        close_lines(summary),
        *(content.campaign.sections if content.campaign else ()),
        *series_sections(content.series),
        *_baseline_sections(content),
        Lines(firm, "Firm or not firm"),
        requirements_table(verified_requirements(content.results, content.series), _MOST),
        explained_cases_table(content),
        Lines(list(content.passed_over), "Passed over"),
        readings_table(content.results),
    ]
    return Document(f"uictest: {summary.headline}", sections, list(_about(content)))


def explained_cases_table(content: RunContent) -> Table:
    """Return the cases, those not as expected first, with what was changed in each and why it failed."""

    def why(result: _Case) -> str:
        return "" if content.passes(result) else "; ".join(content.explanation(result))

    table = cases_table(content)
    explained: list[Column[_Case]] = [
        Column(heading="changed parameters", text=lambda result: "; ".join(changes_of(result))),
        Column(heading="why", text=why),
    ]
    return replace(table, columns=[*table.columns, *explained], rows=content.ranked)


def _about(content: RunContent) -> Iterator[str]:
    if not content.complete:
        yield "Incomplete: not all that was selected was run."
    if content.controllers:
        yield f"WSP controller: {content.controllers}."
    yield from (f"{line}." for line in notices(content.all_results))


def _baseline_sections(content: RunContent) -> list[Table | Lines]:
    """Return the comparison with the baseline, with a table of the quantities out of tolerance."""
    if content.baseline is None:
        return []
    lines = [baseline_summary(content.baseline), *not_compared_sentences(content.baseline)]
    worst = worst_of_wheelsets(content.baseline.all_differences)
    return [Lines(lines), differences_table(worst, most=_MOST)]

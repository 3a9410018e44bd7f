"""The workbook: cases, wheelsets, criteria, parts with their parameters, provenance. Text stays text."""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from uictest.core.measures import STOP_COLUMNS
from uictest.judging import evaluation
from uictest.report import series as series_views
from uictest.report.content import RunContent
from uictest.report.cover_sheet import COVER, insert_charts, write_cover
from uictest.report.difference import Difference, baseline_summary, not_compared_sentences
from uictest.report.formats import ReportFormat
from uictest.report.formats.csv import CHANGED, REQUIREMENTS, controller_cells, criterion_rows, wheelset_rows
from uictest.report.manifest import manifest_form
from uictest.report.part_wording import changes_of, domain_sentences
from uictest.report.repeat_wording import range_cells, share_cells, stop_rows
from uictest.report.requirements import (
    REQUIREMENTS_SHEET,
    requirement_matrix,
    verdict_columns,
    verified_requirements,
)
from uictest.report.sheet import (
    VERDICT_COLUMNS,
    Row,
    RowsMadeAnew,
    columns_of,
    open_workbook,
    styles_of,
    write_table,
)
from uictest.report.train_wording import train_cells
from uictest.report.verdict_sentences import result_word

_LONGEST_SHEET: Final = 31
"""Letters of the name of a sheet that Excel takes."""


def workbook_bytes(content: RunContent) -> bytes:
    """Return the workbook of a run. Missing numbers are empty cells."""
    buffer = io.BytesIO()
    sheets = _sheets(content)
    with open_workbook(buffer, streaming=True) as workbook:
        styles = styles_of(workbook)
        cover = workbook.add_worksheet(COVER)
        write_cover(cover, content, list(sheets), styles)
        columns = {name: columns_of(rows) for name, rows in sheets.items()}
        for name, rows in sheets.items():
            verdicts = verdict_columns(rows) if name == REQUIREMENTS_SHEET else VERDICT_COLUMNS
            write_table(workbook.add_worksheet(name), columns[name], rows, styles, verdicts=verdicts)
        insert_charts(workbook, cover, columns["Cases"], sheets["Cases"])
    return buffer.getvalue()


def _sheets(content: RunContent) -> Mapping[str, Iterable[Row]]:
    """Return the rows of each sheet by its name; those that grow with the cases are made when read.

    There is no sheet of what the run has nothing of.
    """
    results, baseline = content.results, content.baseline
    requirements = verified_requirements(results, content.series)
    known = [result for result in content.all_results if result.parts]
    sheets: dict[str, Iterable[Row]] = {
        **series_views.series_sheets(content.series),
        "Cases": RowsMadeAnew(lambda: _cases(content)),
        "Wheelsets": RowsMadeAnew(lambda: map(_of_case, wheelset_rows(results))),
        "Criteria": RowsMadeAnew(lambda: map(_of_case, criterion_rows(results))),
    }
    if next(iter(stop_rows(results)), None) is not None:
        sheets["Repeats"] = RowsMadeAnew(lambda: map(_of_case, stop_rows(results)))
    if requirements:
        sheets[REQUIREMENTS_SHEET] = requirement_matrix(requirements)
    if content.campaign is not None:
        tables = [each for each in content.campaign.tables if each.rows]
        sheets |= {
            f"Log {each.name.replace('_', ' ')}"[:_LONGEST_SHEET]: list(each.data.rows) for each in tables
        }
    if baseline is not None:
        sheets["Baseline"] = [_difference_row(each) for each in baseline.all_differences]
    if known:
        sheets["Parts"] = RowsMadeAnew(
            lambda: (
                {"case": each.id, **{role: part.id for role, part in each.parts.items()}} for each in known
            )
        )
        sheets["Parameters"] = list(parameter_rows(each.parts for each in known))
    return {**sheets, "Provenance": list(_provenance(content))}


def _of_case(row: Row) -> Row:
    """Return a row of a file as one of a sheet, where the id of a case is its case."""
    return {"case": row["id"], **{name: cell for name, cell in row.items() if name != "id"}}


def _cases(content: RunContent) -> Iterator[Row]:
    for result in content.results:
        subject = content.subject(result.id)
        row: Row = {"case": result.id, "title": subject.title, "tags": " ".join(subject.tags)}
        row |= {"scenario": result.scenario, **controller_cells(result, content.uictest_version)}
        row |= result_row(result)
        if content.baseline is not None:
            row["baseline"] = "differs" if content.differences(result.id) else "agrees"
        yield row


def result_row(result: evaluation.CaseResult) -> Row:
    """Return the word of a case, its outcome, measures, parameters and reason."""
    row: Row = {"verdict": result_word(result)}
    margin, criterion = evaluation.narrowest_margin(result)
    row |= {"outcome": result.outcome, "expect": result.expect, **share_cells(result)}
    row |= {"narrowest_margin": margin, "narrowest_criterion": criterion}
    row |= {**(result.measures or {}), **range_cells(result, STOP_COLUMNS)}
    row |= {**result.parameters, **train_cells(result)}
    named: Row = {"test_case": result.test_case, REQUIREMENTS: "; ".join(result.requirements)}
    named |= {"outside": "; ".join(domain_sentences(result))}
    row |= {column: text for column, text in named.items() if text}
    return row | {CHANGED: "; ".join(changes_of(result)), "reason": result.reason}


def _difference_row(difference: Difference) -> Row:
    return {
        "case": difference.case,
        "quantity": difference.quantity,
        "baseline": difference.first,
        "this run": difference.second,
        "deviation": difference.deviation,
        "tolerance": difference.allowed,
        "unit": difference.unit,
        "remark": difference.remark,
    }


def parameter_rows(cases: Iterable[Mapping[str, evaluation.EffectivePart]]) -> Iterator[Row]:
    """Yield every parameter of every distinct part of some cases."""
    for part_id, part in evaluation.parts_table(cases).items():
        own: Row = {"part": part_id, "name": part.name, "based on": part.based_on}
        for each in part.parameters:
            row = own | {"parameter": each.key, "value": each.value, "unit": each.unit}
            row |= {"as written": each.written, "mark": each.mark, "differs": each.differs}
            library = each.library_written or ("none" if each.differs else "")
            yield row | {"library": library, "source": part.sources.get(each.source, "")}


def _provenance(content: RunContent) -> Iterator[Row]:
    yield {"what": "run", "value": content.name}
    yield {"what": "complete", "value": content.complete}
    for sentence in content.passed_over:
        yield {"what": "passed over", "value": sentence}
    if content.baseline is not None:
        yield {"what": "baseline", "value": baseline_summary(content.baseline)}
        yield {"what": "baseline: SHA-256", "value": content.baseline.sha256}
        for sentence in not_compared_sentences(content.baseline):
            yield {"what": "baseline", "value": sentence}
    yield from manifest_rows(manifest_form(content.manifest))


def manifest_rows(manifest: Mapping[str, object]) -> Iterator[Row]:
    """Yield what a manifest says, one row per line of it."""
    for name, value in manifest.items():
        if isinstance(value, dict):
            for key, text in value.items():
                yield {"what": f"{name}: {key}", "value": str(text)}
        else:
            yield {"what": name, "value": value if isinstance(value, str) else json.dumps(value)}


FORMAT = ReportFormat(lambda content: {"report.xlsx": workbook_bytes(content)})

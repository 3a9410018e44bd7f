"""The workbook: cases, wheelsets, criteria, parts with their parameters, provenance. Text stays text."""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Iterator, Mapping

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.judging import evaluation
from uictest.report import series as series_views
from uictest.report.content import RunContent
from uictest.report.cover_sheet import COVER, insert_charts, write_cover
from uictest.report.difference import Difference, baseline_summary, not_compared_sentences
from uictest.report.formats import ReportFormat
from uictest.report.formats.csv import CHANGED, REQUIREMENTS, controller_cells, criterion_cells
from uictest.report.manifest import manifest_form
from uictest.report.part_wording import changes_of, domain_sentences
from uictest.report.repeat_wording import criterion_share_cells, range_cells, share_cells, stop_rows
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
from uictest.report.wording import definition_sentence, result_word


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
    """Return the rows of each sheet by its name; those that grow with the cases are made when read."""
    return {
        **series_views.series_sheets(content.series),
        "Cases": RowsMadeAnew(lambda: _cases(content)),
        "Wheelsets": RowsMadeAnew(lambda: _wheelsets(content)),
        "Criteria": RowsMadeAnew(lambda: _criteria(content)),
        **_repeats(content),
        **_requirements(content),
        **_baseline_sheet(content),
        **_parts(content),
        "Provenance": list(_provenance(content)),
    }


def _cases(content: RunContent) -> Iterator[Row]:
    for result in content.results:
        subject = content.subject(result.id)
        about: Row = {"title": subject.title, "tags": " ".join(subject.tags), "scenario": result.scenario}
        about |= controller_cells(result, content.uictest_version)
        yield {"case": result.id, **about, **result_row(result), **_against_baseline(content, result)}


def _against_baseline(content: RunContent, result: evaluation.CaseResult) -> Row:
    if content.baseline is None:
        return {}
    return {"baseline": "differs" if content.differences(result.id) else "agrees"}


def result_row(result: evaluation.CaseResult) -> Row:
    """Return the word of a case, its outcome, measures, parameters and reason."""
    row: Row = {"verdict": result_word(result)}
    margin, criterion = evaluation.narrowest_margin(result)
    row |= {"outcome": result.outcome, "expect": result.expect, **share_cells(result)}
    row |= {"narrowest_margin": margin, "narrowest_criterion": criterion}
    row |= {**(result.measures or {}), **range_cells(result, STOP_COLUMNS)}
    row |= dict(result.parameters)
    named: Row = {"test_case": result.test_case, REQUIREMENTS: "; ".join(result.requirements)}
    named |= {"outside": "; ".join(domain_sentences(result))}
    row |= {column: text for column, text in named.items() if text}
    return row | {CHANGED: "; ".join(changes_of(result)), "reason": result.reason}


def _wheelsets(content: RunContent) -> Iterator[Row]:
    for result in content.results:
        for position, wheelset in enumerate(result.wheelsets, start=1):
            ranges = range_cells(result, WHEELSET_COLUMNS, position)
            yield {"case": result.id, "wheelset": position, **wheelset, **ranges}


def _criteria(content: RunContent) -> Iterator[Row]:
    for result in content.results:
        for verdict in result.criteria:
            row: Row = {"case": result.id, "criterion": verdict.id}
            row |= {**criterion_cells(verdict), **criterion_share_cells(verdict)}
            firm = "; ".join(str(sensitivity) for sensitivity in verdict.sensitivity)
            yield row | {"definition": definition_sentence(verdict), "sensitivity": firm}


def _repeats(content: RunContent) -> dict[str, Iterable[Row]]:
    """Return the stops of repeated cases; no sheet where there are none."""
    if next(iter(stop_rows(content.results)), None) is None:
        return {}
    return {"Repeats": RowsMadeAnew(lambda: map(_stop_row, stop_rows(content.results)))}


def _stop_row(row: Row) -> Row:
    return {"case": row["id"], **{name: cell for name, cell in row.items() if name != "id"}}


def _requirements(content: RunContent) -> dict[str, Iterable[Row]]:
    requirements = verified_requirements(content.results, content.series)
    return {REQUIREMENTS_SHEET: requirement_matrix(requirements)} if requirements else {}


def _baseline_sheet(content: RunContent) -> dict[str, Iterable[Row]]:
    if content.baseline is None:
        return {}
    return {"Baseline": [_difference_row(each) for each in content.baseline.all_differences]}


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


def _parts(content: RunContent) -> dict[str, Iterable[Row]]:
    """Return the parts of each case, and the parameters of these; no sheet where none is known."""
    known = [result for result in content.all_results if result.parts]
    if not known:
        return {}
    return {
        "Parts": RowsMadeAnew(lambda: ({"case": each.id, **_part_ids(each)} for each in known)),
        "Parameters": list(parameter_rows(each.parts for each in known)),
    }


def _part_ids(result: evaluation.CaseResult) -> Row:
    return {role: part.id for role, part in result.parts.items()}


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


def _files(content: RunContent) -> dict[str, bytes]:
    return {"report.xlsx": workbook_bytes(content)}


FORMAT = ReportFormat(_files)

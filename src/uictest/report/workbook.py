"""The workbook: cases, wheelsets, criteria, provenance. Text stays text, whatever it begins with."""

from __future__ import annotations

import dataclasses
import io
import json
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from uictest.report.sheet import Row, open_workbook, styles_of, write_sheet
from uictest.report.tables import CRITERION_FIELDS
from uictest.report.wording import definition_sentence

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult
    from uictest.report.content import RunContent


def workbook_bytes(content: RunContent) -> bytes:
    """Return the workbook of a run. Missing figures are empty cells."""
    buffer = io.BytesIO()
    with open_workbook(buffer) as workbook:
        styles = styles_of(workbook)
        for name, rows in _sheets(content).items():
            write_sheet(workbook.add_worksheet(name), rows, styles)
    return buffer.getvalue()


def _sheets(content: RunContent) -> dict[str, list[Row]]:
    return {
        "Cases": list(_cases(content)),
        "Wheelsets": list(_wheelsets(content)),
        "Criteria": list(_criteria(content)),
        "Provenance": list(_provenance(content)),
    }


def _cases(content: RunContent) -> Iterator[Row]:
    for result in content.results:
        subject = content.subject(result.id)
        about: Row = {"title": subject.title, "tags": " ".join(subject.tags), "scenario": result.scenario}
        yield {"case": result.id, **about, **result_row(result)}


def result_row(result: CaseResult) -> Row:
    """Return how a case came out, its figures, its parameters and the reason."""
    row: Row = {"met": "met" if result.met else "missed"}
    row |= {"outcome": result.outcome, "expect": result.expect}
    row |= dataclasses.asdict(result.measures) if result.measures is not None else {}
    return row | dict(result.parameters) | {"reason": result.reason}


def _wheelsets(content: RunContent) -> Iterator[Row]:
    for result in content.results:
        for position, wheelset in enumerate(result.wheelsets, start=1):
            yield {"case": result.id, "wheelset": position, **dataclasses.asdict(wheelset)}


def _criteria(content: RunContent) -> Iterator[Row]:
    for result in content.results:
        for verdict in result.criteria:
            row: Row = {"case": result.id, "criterion": verdict.id}
            row |= {name: getattr(verdict, name) for name in CRITERION_FIELDS}
            firm = "; ".join(str(sensitivity) for sensitivity in verdict.sensitivity)
            yield row | {"definition": definition_sentence(verdict), "sensitivity": firm}


def _provenance(content: RunContent) -> Iterator[Row]:
    yield {"what": "run", "value": content.name}
    yield {"what": "complete", "value": content.complete}
    yield from manifest_rows(content.manifest)


def manifest_rows(manifest: Mapping[str, Any]) -> Iterator[Row]:
    """Yield what a manifest says, one row per line of it."""
    for name, value in manifest.items():
        if isinstance(value, dict):
            for key, text in value.items():
                yield {"what": f"{name}: {key}", "value": str(text)}
        else:
            yield {"what": name, "value": value if isinstance(value, str) else json.dumps(value)}

"""The three tables of a run: one row per case, per wheelset, per criterion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from uictest import evaluation
from uictest.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.report.content import RunContent
from uictest.report.csv_text import Cell, csv_text
from uictest.report.format_registry import ReportFormat
from uictest.report.part_wording import changes_of
from uictest.report.wording import definition_sentence

CHANGED = "changed_parameters"
_CRITERION_FIELDS = {
    "layer": "layer",
    "verdict": "status",
    **{name: name for name in ("value", "unit", "lower", "upper", "margin", "reason")},
}
"""Column -> field of a verdict."""


def summary_csv(results: Sequence[evaluation.CaseResult]) -> str:
    """Return one row per case: swept parameters (as written), outcome, changed parameters, measures."""
    keys = dict.fromkeys(f"parameters.{key}" for result in results for key in result.parameters)
    columns = [
        "id",
        "scenario",
        *keys,
        "expect",
        "outcome",
        "met",
        "reason",
        CHANGED,
        *STOP_COLUMNS,
    ]
    return csv_text(columns, map(_summary_row, results))


def wheelsets_csv(results: Sequence[evaluation.CaseResult]) -> str:
    """Return one row per case and wheelset; wheelset 1 leads."""
    return csv_text(["id", "wheelset", *WHEELSET_COLUMNS], _wheelset_rows(results))


def criteria_csv(results: Sequence[evaluation.CaseResult]) -> str:
    """Return one row per case and criterion, with the definitions that its verdict depends on."""
    return csv_text(["id", "criterion", *_CRITERION_FIELDS, "definition"], _criterion_rows(results))


def _summary_row(result: evaluation.CaseResult) -> dict[str, Cell]:
    parameters = {f"parameters.{key}": text for key, text in result.parameters.items()}
    own = {name: getattr(result, name) for name in ("id", "scenario", "expect", "outcome", "met", "reason")}
    return {
        **parameters,
        **own,
        CHANGED: "; ".join(changes_of(result)),
        **(result.measures or {}),
    }


def _wheelset_rows(results: Sequence[evaluation.CaseResult]) -> Iterator[dict[str, Cell]]:
    for result in results:
        for position, wheelset in enumerate(result.wheelsets, start=1):
            yield {"id": result.id, "wheelset": position, **wheelset}


def _criterion_rows(results: Sequence[evaluation.CaseResult]) -> Iterator[dict[str, Cell]]:
    for result in results:
        for verdict in result.criteria:
            own = {"id": result.id, "criterion": verdict.id, "definition": definition_sentence(verdict)}
            yield {**own, **criterion_cells(verdict)}


def criterion_cells(verdict: evaluation.Verdict) -> dict[str, Cell]:
    """Return the cells of a verdict that every table of criteria has."""
    return {column: getattr(verdict, name) for column, name in _CRITERION_FIELDS.items()}


def _files(content: RunContent) -> dict[str, bytes]:
    results = content.results
    return {
        "summary.csv": summary_csv(results).encode(),
        "wheelsets.csv": wheelsets_csv(results).encode(),
        "criteria.csv": criteria_csv(results).encode(),
    }


FORMAT = ReportFormat(_files)

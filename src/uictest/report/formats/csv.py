"""The tables of a run: one row per case, wheelset, criterion, requirement, and stop of repeated cases."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from uictest.core.document import Cell, Data
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.judging import evaluation
from uictest.report import series as series_views
from uictest.report.campaign import campaign_data
from uictest.report.content import RunContent
from uictest.report.firmness_sentences import firmness_rows
from uictest.report.formats import ReportFormat
from uictest.report.part_wording import changes_of, controller_of
from uictest.report.repeat_wording import (
    CRITERION_COLUMNS,
    SHARE_COLUMNS,
    any_repeated,
    criterion_share_cells,
    range_cells,
    range_columns,
    share_cells,
    stop_rows,
)
from uictest.report.requirements import requirement_rows, verified_requirements
from uictest.report.text_tables import csv_text
from uictest.report.traces.quantities import WHEELSETS
from uictest.report.train_wording import TRAIN_COLUMNS, any_in_train, train_cells
from uictest.report.verdict_sentences import definition_sentence, reading_sentences

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult

_CRITERION_FIELDS = {
    "layer": "layer",
    "verdict": "status",
    **{name: name for name in ("value", "unit", "lower", "upper", "margin", "reason")},
}
"""Column -> field of a verdict."""


def summary_table(results: Sequence[evaluation.CaseResult], uictest_version: str = "") -> Data:
    """Return one row per case: swept parameters (as written), outcome, controller, changes, measures.

    `uictest_version` is that of built-in controllers.

    Where a case repeats its stop, there are its share of stops that pass and the range of each measure, too;
    where one is a car of a train, its train and the forces in its couplers.
    """
    keys = dict.fromkeys(f"parameters.{key}" for result in results for key in result.parameters)
    columns = [
        *("id", "scenario"),
        *keys,
        *("expect", "outcome", "test_validity", "rail_validity", "requirement_status", "met", "reason"),
        *("controller", "controller_version"),
        *("changed_parameters", "test_case", "requirements"),
        *(TRAIN_COLUMNS if any_in_train(results) else ()),
        *_of_repeated(results, SHARE_COLUMNS),
        *STOP_COLUMNS,
        *_of_repeated(results, range_columns(STOP_COLUMNS)),
    ]
    return Data(columns, [_summary_row(result, uictest_version) for result in results])


def wheelsets_table(results: Sequence[evaluation.CaseResult]) -> Data:
    """Return one row per case and wheelset; wheelset 1 leads. Ranges as in :func:`summary_table`."""
    ranges = _of_repeated(results, range_columns(WHEELSET_COLUMNS))
    return Data(["id", "wheelset", *WHEELSET_COLUMNS, *ranges], list(_wheelset_rows(results)))


def criteria_table(results: Sequence[evaluation.CaseResult]) -> Data:
    """Return one row per case and criterion, with the definitions that its verdict depends on.

    Where a case repeats its stop, there are the counts of its stops and the range of the values, too.
    """
    own = [*_of_repeated(results, CRITERION_COLUMNS), "requirements"]
    columns = ["id", "criterion", *_CRITERION_FIELDS, "readings", *own, "definition"]
    return Data(columns, list(_criterion_rows(results)))


def repeats_table(results: Sequence[evaluation.CaseResult]) -> Data:
    """Return one row per stop of every repeated case: seed, outcome, measures."""
    wheelsets = (f"{name}_{position}" for position in WHEELSETS for name in WHEELSET_COLUMNS)
    statements = ("outcome", "test_validity", "requirement_status", "reason")
    columns = ["id", "seed", *statements, *STOP_COLUMNS, *wheelsets]
    return Data(columns, list(stop_rows(results)))


def requirements_table(results: Sequence[evaluation.CaseResult], series: Sequence[SeriesResult] = ()) -> Data:
    """Return one row per requirement and case or series that names it."""
    return Data.of(list(requirement_rows(verified_requirements(results, series))))


def firmness_data(results: Sequence[evaluation.CaseResult], series: Sequence[SeriesResult]) -> Data:
    """Return one row per number and criterion of each case or series of which it was asked how firm it is."""
    judged: list[evaluation.CaseResult | SeriesResult] = [*results, *series]
    asked = [(each.id, each.firmness) for each in judged if each.firmness is not None]
    return Data.of([row for name, firmness in asked for row in firmness_rows(name, firmness)])


def run_tables(content: RunContent) -> Mapping[str, Data]:
    """Return the tables of a run by the names of their files, without `.csv`.

    Without repeated cases, requirements, firmness, series or a log, the tables of these are missing.
    """
    results = content.results
    optional = {
        "repeats": repeats_table(results),
        "requirements": requirements_table(results, content.series),
        "firmness": firmness_data(results, content.series),
    }
    return {
        "summary": summary_table(results, content.uictest_version),
        "wheelsets": wheelsets_table(results),
        "criteria": criteria_table(results),
        **{name: table for name, table in optional.items() if table.rows},
        **(series_views.series_tables(content.series) if content.series else {}),
        **campaign_data(content.campaign),
    }


def _of_repeated(results: Sequence[evaluation.CaseResult], columns: Iterable[str]) -> Iterable[str]:
    return columns if any_repeated(results) else ()


def _summary_row(result: evaluation.CaseResult, uictest_version: str) -> dict[str, Cell]:
    parameters = {f"parameters.{key}": text for key, text in result.parameters.items()}
    names = ("id", "scenario", "outcome", "test_validity", "requirement_status", "met", "reason")
    own: dict[str, Cell] = {name: getattr(result, name) for name in names}
    own |= {"expect": str(result.expect), "rail_validity": result.rail.test_validity if result.rail else ""}
    controller, version = controller_of(result, uictest_version)
    return {
        **parameters,
        **own,
        "controller": controller,
        "controller_version": version,
        "changed_parameters": "; ".join(changes_of(result)),
        "test_case": result.test_case,
        "requirements": "; ".join(result.requirements),
        **train_cells(result),
        **share_cells(result),
        **(result.measures or {}),
        **range_cells(result, STOP_COLUMNS),
    }


def _wheelset_rows(results: Sequence[evaluation.CaseResult]) -> Iterator[dict[str, Cell]]:
    for result in results:
        for position, wheelset in enumerate(result.wheelsets, start=1):
            ranges = range_cells(result, WHEELSET_COLUMNS, position)
            yield {"id": result.id, "wheelset": position, **wheelset, **ranges}


def _criterion_rows(results: Sequence[evaluation.CaseResult]) -> Iterator[dict[str, Cell]]:
    for result in results:
        for verdict in result.criteria:
            yield {
                "id": result.id,
                "criterion": verdict.id,
                **{column: getattr(verdict, name) for column, name in _CRITERION_FIELDS.items()},
                "readings": "; ".join(reading_sentences(verdict)),
                "requirements": "; ".join(verdict.requirements),
                **criterion_share_cells(verdict),
                "definition": definition_sentence(verdict),
            }


FORMAT = ReportFormat(
    lambda content: {f"{name}.csv": csv_text(*table).encode() for name, table in run_tables(content).items()}
)

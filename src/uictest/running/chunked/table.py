"""Rows of a sweep: one per case, and what the survey step does to their measures."""

from __future__ import annotations

import csv
import io
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest import __version__
from uictest.core.measures import MEASURES, STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.core.units import SIZES
from uictest.judging.evaluation import CaseResult, narrowest_margin
from uictest.plans import library
from uictest.plans.sweeps import REGULAR_STEP, SURVEY_STEP, Column, Plan, controllers_of, scenarios_with_each
from uictest.report import SurveyBias, SurveyStep, SweptController

if TYPE_CHECKING:
    import pyarrow as pa


WHEELSETS: Final = 4
_STATED: Final = ("outcome", "test_validity", "requirement_status", "reason")
_OWN: Final = ("expect", *_STATED)
_NO_WHEELSETS: Final[Sequence[Mapping[str, float]]] = ({},) * WHEELSETS
TIME_STEP_COLUMN: Final = "time_step_ms"
"""Column of a survey: the step that the case was simulated in in the end."""
_CONTROLLER: Final = ("controller", "controller_version")
REPEATED_TEXTS: Final = (*_OWN, *_CONTROLLER, "narrowest_criterion")
"""Columns whose texts recur from case to case; to look for numbers that do takes half of writing."""


def text_column(key: str) -> str:
    """Return the name of the column with a parameter as written."""
    return f"parameters.{key}"


def number_column(key: str) -> str:
    """Return the name of the column with a parameter in SI units."""
    return f"values.{key}"


def measure_columns() -> list[str]:
    """Return the columns of measures: those of the stop, then those of each wheelset."""
    return [*STOP_COLUMNS, *(column for name in WHEELSET_COLUMNS for column in wheelset_columns(name))]


def wheelset_columns(name: str) -> tuple[str, ...]:
    """Return the columns of a measure of wheelsets, leading wheelset first."""
    return tuple(f"{name}_{k}" for k in range(1, WHEELSETS + 1))


def row_schema(plan: Plan) -> pa.Schema:
    """Return names and types of the columns, in order."""
    return _table_schema(plan.keys, plan.numeric_keys, plan.survey)


@cache
def _table_schema(keys: tuple[str, ...], numeric_keys: tuple[str, ...], survey: bool) -> pa.Schema:
    import pyarrow as pa

    text, number = pa.string(), pa.float64()
    return pa.schema(
        [
            ("index", pa.int64()),
            ("id", text),
            *((text_column(key), text) for key in keys),
            *((number_column(key), number) for key in numeric_keys),
            *((name, text) for name in _OWN),
            ("met", pa.bool_()),
            *((name, text) for name in _CONTROLLER),
            *([(TIME_STEP_COLUMN, number)] if survey else []),
            ("narrowest_margin", number),
            ("narrowest_criterion", text),
            *((name, number) for name in measure_columns()),
        ]
    )


def rows(
    plan: Plan,
    indices: NDArray[np.int64],
    settings: Mapping[str, Column],
    results: Sequence[CaseResult],
    repeated: Sequence[int] = (),
) -> pa.Table:
    """Return the rows of cases; a measure without a value is null.

    `repeated` are the positions of those of a survey that were simulated in regular steps in the end.
    """
    import pyarrow as pa

    columns: dict[str, Any] = {"index": indices, "id": [each.id for each in results]}
    for key, column in settings.items():
        columns[text_column(key)] = column.written
    for key in plan.numeric_keys:
        columns[number_column(key)] = settings[key].numbers
    columns["expect"] = [str(each.expect) for each in results]
    for name in (*_STATED, "met"):
        columns[name] = [getattr(each, name) for each in results]
    names = (named_controller(each) for each in _controllers_of_rows(plan, indices, settings))
    columns |= zip(_CONTROLLER, zip(*((each.name, each.version) for each in names), strict=True), strict=True)
    margins = map(narrowest_margin, results)
    columns["narrowest_margin"], columns["narrowest_criterion"] = zip(*margins, strict=True)
    if plan.survey:
        steps = np.full(len(results), SURVEY_STEP / SIZES["ms"])
        steps[list(repeated)] = REGULAR_STEP / SIZES["ms"]
        columns[TIME_STEP_COLUMN] = steps
    of_stops = [each.measures or {} for each in results]
    for name in STOP_COLUMNS:
        columns[name] = [measures.get(name) for measures in of_stops]
    wheelsets = [each.wheelsets or _NO_WHEELSETS for each in results]
    for name in WHEELSET_COLUMNS:
        for index, numbered in enumerate(wheelset_columns(name)):
            columns[numbered] = [of_stop[index].get(name) for of_stop in wheelsets]
    schema = row_schema(plan)
    return pa.table([pa.array(columns[each.name], each.type, from_pandas=True) for each in schema], schema)


def parquet_bytes(table: pa.Table) -> bytes:
    """Return a table as a Parquet file; the same table gives the same bytes."""
    import pyarrow.parquet as pq

    buffer = io.BytesIO()
    pq.write_table(
        table,
        buffer,
        compression="lz4",
        use_dictionary=list(REPEATED_TEXTS),
        write_statistics=False,  # a chunk is read as a whole
        write_page_checksum=True,
    )
    return buffer.getvalue()


def named_controller(controller: Any) -> SweptController:
    """Return the name and the version of a controller, as far as a run knows them before a stop."""
    if controller.program is None:
        return SweptController(controller.label, f"uictest {__version__}")
    return SweptController(controller.label, controller.version or "", controller.kind)


def _controllers_of_rows(
    plan: Plan, indices: NDArray[np.int64], settings: Mapping[str, Column]
) -> Iterator[Any]:
    of_cars = list(controllers_of(plan))
    for k, index in enumerate(indices.tolist()):
        key, own = of_cars[index % len(of_cars)]
        yield settings[key][k].content if key else own


def surveyed_cases(table: pa.Table) -> set[int]:
    """Return the indices of the cases whose rows are of survey steps."""
    if TIME_STEP_COLUMN not in table.column_names:
        return set()
    steps = table.column(TIME_STEP_COLUMN).to_numpy()
    return set(table.column("index").to_numpy()[steps != REGULAR_STEP / SIZES["ms"]].tolist())


def repeated_cases(table: pa.Table) -> int:
    """Return the number of cases of a survey that were simulated again in regular steps; 0 for no survey."""
    is_survey = TIME_STEP_COLUMN in table.column_names
    return table.num_rows - len(surveyed_cases(table)) if is_survey else 0


SURVEY_TABLE = "survey_step.csv"
"""File of the library: for each shipped case and measure the mean difference of stops in survey steps from
the same stops in regular steps, with its 95 % interval, what 95 % of the single stops differ by at most, and
the mean size of the measure.
`studies/survey_step.py` writes it."""


@cache
def survey_biases() -> Mapping[str, SurveyBias]:
    """Return for each measure the largest bias that the survey step has in any shipped case.

    That of a case is the end of its 95 % interval that is farther from zero, as a share of the mean size.
    """
    largest: dict[str, SurveyBias] = {}
    for row in csv.DictReader(library.table(SURVEY_TABLE).splitlines()):
        size, low, high, single = (float(row[key]) for key in ("size", "low", "high", "of_single_stops"))
        share = 1.0 / size if size else 0.0
        bias = share * max(abs(low), abs(high))
        found = SurveyBias(row["measure"], bias, row["case"], share * single)
        before = largest.setdefault(found.measure, found)
        single = max(before.of_single_stops, found.of_single_stops)
        larger = found if found.bias > before.bias else before
        largest[found.measure] = replace(larger, of_single_stops=single)
    return MappingProxyType(largest)


def biases_by_measure() -> dict[str, float]:
    """Return the largest bias of every measure, as a share of it."""
    return {name: each.bias for name, each in survey_biases().items()}


def survey_step(plan: Plan, repeated: int, columns: Collection[str]) -> SurveyStep | None:
    """Return the steps of a survey, None of another sweep.

    Args:
        plan: of the sweep.
        repeated: number of cases that were repeated in regular steps.
        columns: of results that are mapped.

    """
    if not plan.survey:
        return None
    known = survey_biases()
    names = _looked_at(plan, columns)
    biases = tuple(known[name] for name in names if name in known)
    unknown = tuple(name for name in names if name not in known)
    return SurveyStep(SURVEY_STEP.text, REGULAR_STEP.text, repeated, biases, unknown)


def _looked_at(plan: Plan, columns: Collection[str]) -> dict[str, None]:
    """Return the measures that are judged in any case, and those of some columns."""
    judged = (
        criterion.measure
        for scenario in scenarios_with_each(plan, "criteria")
        for profile in scenario.judged_by
        for criterion in profile.criteria
        if not criterion.needs_series
    )
    mapped = (each.name for each in MEASURES.values() if each.column and each.column.name in columns)
    return dict.fromkeys((*judged, *mapped))

"""Summarise a finished sweep: its rows as one table, and its result."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from uictest.analysis import validation
from uictest.analysis.summaries.domain import DomainTally
from uictest.analysis.summaries.frontier import UNKNOWN, Verdicts
from uictest.analysis.summaries.sensitivity import sobol_sensitivities, uncertainty_note
from uictest.analysis.summaries.tally import Tally, logarithmic_keys
from uictest.analysis.summaries.trends import MOST_VALUES, MapSums, MeasureSums, TrendSums, reported_measures
from uictest.analysis.summaries.worst import WorstCases, summary_file
from uictest.judging.evaluation import effective_parts
from uictest.plans.scenario import named_requirements
from uictest.plans.sweeps import Plan, drawn_ranges, each_controller, saltelli_sample
from uictest.report import (
    MET,
    SobolSensitivity,
    SurveyStep,
    SweepDomain,
    SweepResult,
    counted,
    domain_notes,
    survey_notes,
)
from uictest.running.chunked import CaseSelection, ChunkStore, named_controller, repeated_cases, survey_step

if TYPE_CHECKING:
    import pyarrow as pa

_WITHOUT_CSV = "every case is a row of summary.parquet; `--report csv,html` writes summary.csv, too"
Columns = Mapping[str, NDArray[np.float64]]
"""Measures of all cases of a plan, by name."""


@dataclass(frozen=True)
class SweepSummary:
    """The result of a sweep without its worst cases and frontier, and what these are computed from.

    `verdicts` holds for every case of the plan 1 if met, 0 if not met, -1 if not run. `worst_indices` are the
    indices of the worst cases.
    """

    result: SweepResult
    verdicts: Verdicts
    worst_indices: list[int]
    surveyed: frozenset[int] = frozenset()
    """Those of the worst cases whose rows are of survey steps."""


@contextmanager
def summarized(
    selection: CaseSelection,
    store: ChunkStore,
    pair: tuple[str, str] | None,
    measures: Sequence[str],
    reference: validation.ValidationReference | None = None,
    *,
    csv: bool = True,
) -> Iterator[Summary]:
    """Lend the summary of a sweep; summary.parquet appears when the block ends.

    Args:
        selection: the cases of the sweep.
        store: store of its chunks.
        pair: the two parameters of the maps, None for no map.
        measures: columns to map and to compute sensitivities of, besides the verdict.
        reference: validation that the cases are held against; they get a column of what lies outside.
        csv: whether summary.csv is written, too; else a note says how.

    Raises OSError where a file cannot be written.
    """
    with summary_file(store.folder) as write:
        yield Summary(selection, store, pair, measures, reference, write, csv)


@dataclass
class Summary:
    """Summarises the chunks of a sweep in their order, as they are finished; `write` takes the rows of each.

    The other fields are the arguments of :func:`summarized`.
    """

    selection: CaseSelection
    store: ChunkStore
    pair: tuple[str, str] | None
    measures: Sequence[str]
    reference: validation.ValidationReference | None
    write: Callable[[pa.Table], None]
    csv: bool
    _added: int = 0

    @cached_property
    def _sums(self) -> _Sums:
        return _Sums(self.selection, self.pair, self.measures)

    @cached_property
    def _domain(self) -> DomainTally | None:
        return None if self.reference is None else DomainTally(self.selection.plan, self.reference)

    def add_up_to(self, end: int) -> None:
        """Add the chunks before number `end` that were not added. Raises OSError and MissingChunksError."""
        if end == self._added:
            return
        for table in self.store.tables(range(self._added, end)):
            self.write(table if self._domain is None else self._domain.with_column(table))
            self._sums.add(table)
            self._added += 1

    def result(self) -> SweepSummary:
        """Add the chunks that are left, and return what all come to. Raises OSError, MissingChunksError."""
        self.add_up_to(self.selection.chunks)
        sums, plan = self._sums, self.selection.plan
        survey = survey_step(plan, sums.repeated, self.measures)
        of_validity = None if self._domain is None else self._domain.result()
        # Read a second time: only now it is known which cases count in trends.
        chunks = range(self.selection.chunks if sums.trends else 0)
        for table in self.store.tables(chunks, sums.columns_read_twice()):
            for trend in sums.trends:
                trend.add(table)
        sensitivities, notes = _sobol_sensitivities(plan, sums.sampled_columns())
        result = _sweep_result(
            sums,
            sensitivities=sensitivities,
            domain=of_validity,
            survey=survey,
            notes=(
                *survey_notes(survey, sums.tally.cases),
                *domain_notes(of_validity, sums.tally.cases),
                *_outcome_notes(plan, sums.tally.outcomes),
                *map(str, drawn_ranges(plan)),
                *notes,
                *(() if self.csv else (_WITHOUT_CSV,)),
            ),
        )
        return SweepSummary(result, sums.verdicts, sums.worst.indices(), sums.worst.surveyed())


class _Sums:
    """Everything that is added chunk by chunk."""

    def __init__(
        self, selection: CaseSelection, pair: tuple[str, str] | None, measures: Sequence[str]
    ) -> None:
        plan = selection.plan
        self.tally, self.worst = Tally(plan), WorstCases()
        shown, bins = reported_measures(measures, _moving_speed(plan)), self.tally.bins
        axes = None if pair is None else (bins[pair[0]], bins[pair[1]])
        self.maps = [MapSums(plan, *axes, name) for name in (MET, *measures)] if axes else []
        self.trends = [
            TrendSums(plan, each, shown) for each in bins.values() if len(each.values) <= MOST_VALUES
        ]
        self.measures = [MeasureSums(measure) for measure in shown]
        self.verdicts = np.full(plan.size, UNKNOWN, np.int8)
        self.repeated = 0
        """Cases of a survey that were repeated in regular steps."""
        self._is_sample = saltelli_sample(plan) is not None and selection.selected is None
        self._columns = {name: np.full(plan.size, np.nan) for name in (measures if self._is_sample else ())}

    def add(self, table: pa.Table) -> None:
        """Add the rows of a chunk."""
        self.tally.add(table)
        self.repeated += repeated_cases(table)
        self.worst.add(table)
        for sweep_map in self.maps:
            sweep_map.add(table)
        for trend in self.trends:
            trend.note(table)
        for measure in self.measures:
            measure.add(table)
        indices = table.column("index").to_numpy()
        self.verdicts[indices] = table.column(MET).to_numpy(zero_copy_only=False)
        for name, values in self._columns.items():
            values[indices] = table.column(name).to_numpy(zero_copy_only=False)

    def columns_read_twice(self) -> list[str]:
        """Return the columns that trends add up."""
        measured = (column for each in self.measures for column in each.measure.columns)
        values = (trend.bins.column for trend in self.trends)
        return list(dict.fromkeys(("index", *values, *measured)))

    def sampled_columns(self) -> Columns:
        """Return the columns that sensitivities are computed of; none without a whole Saltelli sample."""
        return {**self._columns, MET: self.verdicts.astype(float)} if self._is_sample else {}


def _moving_speed(plan: Plan) -> str:
    key = "measures.moving_speed"
    return "moving_speed" if key in plan.keys else plan.base.scenario.measures.moving_speed.text


def _sweep_result(
    sums: _Sums,
    *,
    sensitivities: tuple[SobolSensitivity, ...],
    domain: SweepDomain | None,
    survey: SurveyStep | None,
    notes: tuple[str, ...],
) -> SweepResult:
    tally, plan = sums.tally, sums.tally.plan
    return SweepResult(
        name=plan.name,
        title=plan.title,
        cases=tally.cases,
        met=tally.met,
        outcomes=tally.outcomes,
        missed=tuple(tally.missed),
        rates={key: tally.rates(key) for key in tally.bins},
        maps=tuple(each.map() for each in sums.maps),
        measures=tuple(each.range() for each in sums.measures if each.cases),
        trends=tuple(trend for each in sums.trends for trend in each.trends()),
        base=effective_parts(plan.base.scenario),
        varied=plan.keys,
        logarithmic=logarithmic_keys(plan),
        requirements=named_requirements(plan.base.scenario),
        test_case=plan.base.scenario.test_case or "",
        controllers=tuple(dict.fromkeys(map(named_controller, each_controller(plan)))),
        worst=(),
        subjects={},
        sensitivities=sensitivities,
        frontier=None,
        domain_of_validity=domain,
        survey=survey,
        notes=notes,
    )


def _outcome_notes(plan: Plan, outcomes: Mapping[str, int]) -> Iterator[str]:
    """Yield the requirements of the scenario, and how many cases are not judged."""
    if requirements := named_requirements(plan.base.scenario):
        yield f"requirements that the scenario and its criteria name: {', '.join(requirements)}"
    if count := outcomes["skipped"]:
        yield f"{counted(count, 'case')} not judged, since no criterion applies: met by `expect: skipped`"


def _sobol_sensitivities(plan: Plan, columns: Columns) -> tuple[tuple[SobolSensitivity, ...], list[str]]:
    """Return the Sobol indices of each column, and notes on missing or uncertain ones."""
    sensitivities: list[SobolSensitivity] = []
    notes: list[str] = []
    for name, values in columns.items():
        of_column, reason = sobol_sensitivities(plan, name, values)
        sensitivities.extend(of_column)
        note = f"no sensitivity of {name}: {reason}" if reason else uncertainty_note(of_column)
        notes.extend([note] if note else [])
    return tuple(sensitivities), notes

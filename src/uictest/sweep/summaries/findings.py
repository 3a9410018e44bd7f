"""What a sweep came to: its rows as one table, counts, maps, sensitivities, the frontier, as files."""

from __future__ import annotations

import contextlib
import dataclasses
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.evaluation import CaseResult, EffectiveParts, cases_document, json_form, parts_document, to_json
from uictest.recording import atomic_path, write_text_atomic
from uictest.report import (
    TREND_COLUMNS,
    CaseDescription,
    Cell,
    counted,
    csv_cell,
    csv_text,
    subjects_form,
    trend_rows,
)
from uictest.sweep.junit import junit_xml
from uictest.sweep.plan.nominal import drawn_ranges
from uictest.sweep.plan.plan import saltelli_sample
from uictest.sweep.running.case_selection import CaseSelection
from uictest.sweep.running.store import ChunkStore
from uictest.sweep.summaries.frontier import UNKNOWN, FrontierScan
from uictest.sweep.summaries.histograms import MeasureHistogram, reported_measures
from uictest.sweep.summaries.maps import MET, MapSums
from uictest.sweep.summaries.sensitivity import Sensitivity, doubts, sensitivities
from uictest.sweep.summaries.tally import OUTCOMES, OutcomeCount, Tally
from uictest.sweep.summaries.trends import MOST_VALUES, Trends
from uictest.sweep.summaries.worst import WorstCases

if TYPE_CHECKING:
    import pyarrow as pa

RESULT_SCHEMA: Final = "uictest/sweep-result/1"
RESULTS: Final = "sweep.json"


@dataclass
class SweepFindings:
    """What the rows of a finished sweep say."""

    tally: Tally
    maps: list[MapSums]
    verdicts: NDArray[np.int8]
    """Of every case of the plan: 1 met, 0 not met, -1 not run."""
    worst_indices: list[int]
    """Cases most worth looking at; `worst` has them in full, once they were examined."""
    distributions: list[MeasureHistogram] = field(default_factory=list)
    trends: list[Trends] = field(default_factory=list)
    sensitivities: list[Sensitivity] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    frontier: list[FrontierScan] = field(default_factory=list)
    frontier_key: str = ""
    worst: list[CaseResult] = field(default_factory=list)
    subjects: dict[str, CaseDescription] = field(default_factory=dict)
    """What the worst cases are about, by id."""


def gather(
    selection: CaseSelection, store: ChunkStore, pair: tuple[str, str] | None, measures: Sequence[str]
) -> SweepFindings:
    """Read all parts: write summary.csv and summary.parquet, count, and work out what they tell.

    Args:
        selection: the cases of the sweep.
        store: with every part finished.
        pair: the two parameters of the maps, None for no map.
        measures: figures to map and to compute sensitivities of, besides the verdict.

    Raises:
        OSError: a file cannot be written.
        MissingPartsError: a part is not there.
    """
    plan = selection.plan
    tally = Tally(plan)
    maps = [] if pair is None else _maps(tally, pair, (MET, *measures))
    verdicts = np.full(plan.size, UNKNOWN, np.int8)
    whole = saltelli_sample(plan) is not None and selection.selected is None
    figures = {name: np.full(plan.size, np.nan) for name in measures} if whole else {}
    shown = reported_measures(measures)
    worst, distributions = WorstCases(), [MeasureHistogram(each) for each in shown]
    trends = [Trends(plan, each, shown) for each in tally.classes.values() if len(each.labels) <= MOST_VALUES]
    with _summary_files(store.folder) as write:
        for table in store.tables(range(selection.chunks)):
            write(table)
            tally.take(table)
            worst.take(table)
            for found in maps:
                found.take(table)
            for each in distributions:
                each.span(table)
            for trend in trends:
                trend.take(table)
            indices = table.column("index").to_numpy()
            verdicts[indices] = table.column("met").to_numpy(zero_copy_only=False)
            for name, values in figures.items():
                values[indices] = table.column(name).to_numpy(zero_copy_only=False)
    findings = SweepFindings(tally, maps, verdicts, worst.indices(), trends=trends)
    findings.distributions = _counted(distributions, selection, store)
    findings.notes.extend(_not_judged(tally.total().outcomes))
    _add_sensitivities(findings, figures | ({MET: verdicts.astype(float)} if whole else {}))
    return findings


def _counted(
    spanned: Sequence[MeasureHistogram], selection: CaseSelection, store: ChunkStore
) -> list[MeasureHistogram]:
    """Count the cases of each distribution that has any: the second reading of the parts."""
    found = [each for each in spanned if each.cases]
    for each in found:
        each.begin()
    for table in store.tables(range(selection.chunks)):
        for each in found:
            each.take(table)
    return found


def _not_judged(outcomes: Mapping[str, int]) -> Iterator[str]:
    if count := outcomes["skipped"]:
        yield f"{counted(count, 'case')} not judged, since no criterion applies: met where `pass` is expected"
    if count := outcomes["inconclusive"]:
        yield f"{counted(count, 'case')} inconclusive, since data to judge are missing: never met"


def _maps(tally: Tally, pair: tuple[str, str], measures: Sequence[str]) -> list[MapSums]:
    rows, columns = (tally.classes[key] for key in pair)
    return [MapSums(tally.plan, rows, columns, name) for name in measures]


def _add_sensitivities(findings: SweepFindings, figures: Mapping[str, NDArray[np.float64]]) -> None:
    findings.notes.extend(map(str, drawn_ranges(findings.tally.plan)))
    for name, values in figures.items():
        found, why_not = sensitivities(findings.tally.plan, name, values)
        findings.sensitivities.extend(found)
        said = f"no sensitivity of {name}: {why_not}" if why_not else doubts(found)
        findings.notes.extend([said] if said else [])


def write_findings(folder: Path, findings: SweepFindings) -> str:
    """Write everything but the summary, and return the text of the result document. Raises OSError."""
    document = to_json(json_form(result_document(findings)))
    texts = {
        "rates.csv": _rates_csv(findings.tally),
        **{f"map-{each.measure}.csv": each.csv() for each in findings.maps},
        "trends.csv": _trends_csv(findings.trends),
        "junit.xml": junit_xml(findings.tally),
        RESULTS: document,
    }
    if findings.sensitivities:
        texts["sensitivity.csv"] = _sensitivity_csv(findings.sensitivities)
    if findings.frontier_key:
        texts["frontier.csv"] = frontier_csv(findings)
    for name, text in texts.items():
        write_text_atomic(folder / name, text)
    return document


def result_document(findings: SweepFindings) -> dict[str, Any]:
    """Return what a page or a program needs of a sweep: counts, maps, sensitivities, the frontier."""
    tally, stretches = findings.tally, list(map(dataclasses.asdict, findings.frontier))
    total = tally.total()
    base = EffectiveParts().of(tally.plan.base.scenario)
    return {
        "schema": RESULT_SCHEMA,
        "name": tally.plan.name,
        "title": tally.plan.title,
        "cases": total.cases,
        "met": total.met,
        "outcomes": total.outcomes,
        "missed": [dict(zip(("id", "outcome", "reason"), each, strict=True)) for each in tally.missed],
        "rates": {key: [_count_form(count) for count in tally.by_class(key)] for key in tally.classes},
        "maps": [_map_form(each) for each in findings.maps],
        "distributions": [each.form() for each in findings.distributions],
        "trends": [form for each in findings.trends for form in each.forms()],
        "base": {role: part.id for role, part in base.items()},
        "varied": list(tally.plan.keys),
        "parts": parts_document([base, *(result.parts for result in findings.worst)]),
        "worst": cases_document(findings.worst),
        "subjects": subjects_form(findings.subjects),
        "sensitivities": [dataclasses.asdict(each) for each in findings.sensitivities],
        "frontier": {"parameter": findings.frontier_key, "stretches": stretches} if stretches else None,
        "notes": findings.notes,
    }


def _count_form(count: OutcomeCount) -> dict[str, Any]:
    return {"value": count.label, "cases": count.cases, "met": count.met, "outcomes": count.outcomes}


def _map_form(found: MapSums) -> dict[str, Any]:
    met, cases = found.counts()
    return {
        "measure": found.measure,
        "rows": {"parameter": found.rows.key, "values": list(found.rows.labels)},
        "columns": {"parameter": found.columns.key, "values": list(found.columns.labels)},
        "means": found.means().tolist(),
        "met": met.tolist(),
        "cases": cases.tolist(),
    }


def _rates_csv(tally: Tally) -> str:
    def rows() -> Iterator[dict[str, Cell]]:
        for key in tally.classes:
            for count in tally.by_class(key):
                own = {"cases": count.cases, "met": count.met, "share_met": count.share_met}
                yield {"parameter": key, "value": count.label, **own, **count.outcomes}

    return csv_text(["parameter", "value", "cases", "met", "share_met", *OUTCOMES], rows())


def _trends_csv(trends: Sequence[Trends]) -> str:
    forms = (form for each in trends for form in each.forms())
    return csv_text(TREND_COLUMNS, (row for form in forms for row in trend_rows(form)))


def _sensitivity_csv(found: Sequence[Sensitivity]) -> str:
    circumstances = list(found[0].circumstances)
    indices = [f"{kind}{end}" for kind in ("first", "total") for end in ("", "_low", "_high")]

    def rows() -> Iterator[dict[str, Cell]]:
        for each in found:
            numbers = [*dataclasses.astuple(each.first), *dataclasses.astuple(each.total)]
            named = dict(zip(indices, numbers, strict=True))
            yield {"measure": each.measure, **each.circumstances, "parameter": each.key, **named}

    return csv_text(["measure", *circumstances, "parameter", *indices], rows())


def frontier_csv(findings: SweepFindings) -> str:
    """Return the frontier as CSV: one line per flip, or one that says why there is none."""
    circumstances = list(findings.frontier[0].circumstances)

    def rows() -> Iterator[dict[str, Cell]]:
        for stretch in findings.frontier:
            own: dict[str, Cell] = {
                **stretch.circumstances,
                "flips": len(stretch.flips),
                "note": stretch.note,
            }
            for flip in stretch.flips:
                yield {**own, "from": flip.low, "to": flip.high, "met_at_from": flip.met_at_low}
            if not stretch.flips:
                yield own

    return csv_text([*circumstances, "from", "to", "met_at_from", "flips", "note"], rows())


@contextlib.contextmanager
def _summary_files(folder: Path) -> Iterator[Any]:
    """Lend a function that appends rows to summary.csv and summary.parquet; both appear when all are in."""
    csv_path, parquet_path = (atomic_path(folder / f"summary.{suffix}") for suffix in ("csv", "parquet"))
    with csv_path as csv, parquet_path as parquet, contextlib.ExitStack() as open_files:
        writers: list[Any] = []

        def write(table: pa.Table) -> None:
            if not writers:
                writers.extend(_writers(open_files, csv, parquet, table.schema))
            writers[0].write_table(_harmless(table))
            writers[1].write_table(table)

        yield write


def _writers(open_files: contextlib.ExitStack, csv: Path, parquet: Path, schema: pa.Schema) -> list[Any]:
    import pyarrow as pa
    from pyarrow.csv import CSVWriter, WriteOptions
    from pyarrow.parquet import ParquetWriter

    shown = _harmless(schema.empty_table()).schema
    options = WriteOptions(quoting_style="needed", quoting_header="needed")
    return [
        open_files.enter_context(CSVWriter(pa.OSFile(str(csv), "wb"), shown, write_options=options)),
        open_files.enter_context(ParquetWriter(parquet, schema, compression="zstd")),
    ]


def _harmless(table: pa.Table) -> pa.Table:
    """Return the table with texts that no spreadsheet takes for formulas."""
    import pyarrow as pa

    for place, each in enumerate(table.schema):
        if pa.types.is_string(each.type):
            texts = table.column(place).to_pylist()
            guarded = {text: csv_cell(text) for text in set(texts)}
            table = table.set_column(
                place, each.name, pa.array([guarded[text] for text in texts], pa.string())
            )
    return table


def read_result(folder: Path) -> dict[str, Any]:
    """Return the result document of a finished sweep. Raises OSError, ValueError."""
    document: dict[str, Any] = json.loads((folder / RESULTS).read_bytes())
    if document.get("schema") != RESULT_SCHEMA:
        raise ValueError(f"{folder}: not the result of a sweep")
    return document

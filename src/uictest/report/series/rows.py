"""Tables of series for programs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from uictest.core.document import Cell, Data
from uictest.core.series_measures import SERIES_MEASURES, Estimate
from uictest.judging.series import SeriesResult, observed_stops
from uictest.report.verdict_sentences import definition_sentence

Row = dict[str, Cell]
ALL_SPEEDS = "all"
_ESTIMATE = ("low", "high", "confidence", "method", "stops", "smallest", "largest", "covered", "dry_stops")


def measure_rows(results: Sequence[SeriesResult]) -> Iterator[Row]:
    """Yield one row per series, speed, rail and measure; the speed `all` is the whole series."""
    for result in results:
        tables = {(ALL_SPEEDS, ""): dict(result.measures)}
        tables |= {(f"{each.speed_kmh:g}", each.rail): dict(each.measures) for each in result.speeds}
        if result.bypassed_k_wet is not None:
            tables[ALL_SPEEDS, ""]["bypassed_k_wet"] = result.bypassed_k_wet
        for (speed, rail), measures in tables.items():
            for name, value in measures.items():
                unit = SERIES_MEASURES[name].unit if name in SERIES_MEASURES else "1"
                about: Row = {"series": result.id, "speed_kmh": speed, "rail": rail}
                about |= {"measure": name, "unit": unit}
                estimate = value.estimate
                about["value"] = None if estimate is None else estimate.value
                yield {**about, **_estimate_cells(estimate), "reason": value.unavailable_reason}


def _estimate_cells(estimate: Estimate | None) -> Row:
    return {name: None if estimate is None else getattr(estimate, name) for name in _ESTIMATE}


def criterion_rows(results: Sequence[SeriesResult]) -> Iterator[Row]:
    """Yield one row per series and criterion."""
    for result in results:
        for each in result.criteria:
            verdict = each.verdict
            yield {
                "series": result.id,
                "criterion": verdict.id,
                "layer": verdict.layer,
                "verdict": verdict.status,
                **{name: getattr(verdict, name) for name in ("value", "unit", "lower", "upper", "margin")},
                "speed_kmh": each.speed_kmh,
                "rail": each.rail,
                "certain": each.confident,
                "kept": each.kept,
                **_estimate_cells(each.estimate),
                "stops": each.stops if each.estimate is None else each.estimate.stops,
                "reason": verdict.reason,
                "requirements": "; ".join(verdict.requirements),
                "definition": definition_sentence(verdict),
            }


def stop_rows(results: Sequence[SeriesResult]) -> Iterator[Row]:
    """Yield one row per stop of a series, repeats one by one, with all of its columns."""
    for result in results:
        for stop in observed_stops(result.cases, result.speed_tolerance_kmh):
            wheelsets = {
                f"{name}_{position}": value
                for position, wheelset in enumerate(stop.figures.wheelsets, start=1)
                for name, value in wheelset.items()
            }
            own = ("case", "role", "rail", "speed_kmh", "seed", "counts", "outcome", "reason")
            yield {
                "series": result.id,
                **{name: getattr(stop, name) for name in own},
                **stop.figures.measures,
                **wheelsets,
            }


def series_tables(results: Sequence[SeriesResult]) -> dict[str, Data]:
    """Return the tables of series by the names of their files: measures, criteria, stops."""
    return {
        "series": Data.of(list(measure_rows(results))),
        "series-criteria": Data.of(list(criterion_rows(results))),
        "series-stops": Data.of(list(stop_rows(results))),
    }

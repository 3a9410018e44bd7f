"""Criteria as they are drawn into the plots: limits, and the instants and intervals that decided them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Final

from uictest.judging import evaluation
from uictest.report.page.stop import train_marks, wheelset_marks
from uictest.report.page.stop.mark import Mark
from uictest.report.traces.trace import PlotTrace
from uictest.report.wording import failing_first

DRAWN: Final[Mapping[str, Callable[[evaluation.Verdict, PlotTrace], Iterator[Mark]]]] = MappingProxyType(
    {
        "braking_distance": train_marks.braking_distance,
        "braking_time": train_marks.braking_time,
        "mean_deceleration": train_marks.mean_deceleration,
        "standstill": train_marks.standstill,
        "initial_adhesion": train_marks.initial_adhesion,
        "minimum_deceleration": train_marks.minimum_deceleration,
        "maximum_deceleration": train_marks.maximum_deceleration,
        "reservoir_minimum_pressure": train_marks.reservoir_minimum_pressure,
        "air_consumed": train_marks.air_consumed,
        "energy_residual": train_marks.energy_residual,
        "air_residual": train_marks.air_residual,
        "air_energy_residual": train_marks.air_energy_residual,
        "maximum_slide_above_cutoff": wheelset_marks.maximum_slide,
        "locked_time": wheelset_marks.locked,
        "longest_lock": wheelset_marks.locked,
        "sliding_duration": wheelset_marks.sliding,
        "valve_actuations": wheelset_marks.vented,
        "air_vented": wheelset_marks.vented,
        "maximum_clamping_force": wheelset_marks.maximum_clamping_force,
        "maximum_disc_temperature": wheelset_marks.maximum_disc_temperature,
    }
)
"""Measure -> how a criterion that bounds it is drawn; a criterion of another measure is only listed."""


def marks_of(verdicts: Iterable[evaluation.Verdict], trace: PlotTrace) -> list[Mark]:
    """Return the marks of every criterion that applied to a stop, those of failing ones first."""
    return [
        replace(
            mark,
            criterion=verdict.id,
            status=verdict.status,
            label=_with_status(mark.label, verdict.status),
        )
        for verdict in failing_first(verdicts)
        if verdict.status != "not_applicable" and verdict.measure in DRAWN
        for mark in DRAWN[verdict.measure](verdict, trace)
    ]


def _with_status(label: str, status: evaluation.Status) -> str:
    """Return a label that says in words, not by its colour alone, that a criterion was not decided."""
    return f"{label} (inconclusive)" if label and status == "inconclusive" else label

"""Sum up recorded stops beside their simulations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from uictest import __version__
from uictest.analysis.validation.agreement import Agreement, agreement_of
from uictest.analysis.validation.conditions import Conditions
from uictest.analysis.validation.document import Validation
from uictest.analysis.validation.domain import domains_of
from uictest.analysis.validation.stops import ComparedStop
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS, column_unit
from uictest.plans.validation import ValidationPlan

_WHEELSETS: Final = (1, 2, 3, 4)


@dataclass(frozen=True, slots=True)
class StopUnderConditions:
    """A compared stop and its conditions: as planned and as recorded."""

    stop: ComparedStop
    conditions: Sequence[Conditions]


def validation_of(
    plan: ValidationPlan, stops: Sequence[StopUnderConditions], inputs: Mapping[str, str]
) -> Validation:
    """Return what compared stops come to.

    Args:
        plan: what was planned.
        stops: all of them; those that are not counted are listed and play no part.
        inputs: every file that was read, and its SHA-256.
    """
    counted = [each for each in stops if each.stop.counted]
    figures = {name: _agreement(name, counted, plan.confidence) for name in figure_names()}
    return Validation(
        name=plan.name,
        title=plan.title,
        version=__version__,
        confidence=plan.confidence,
        inputs=dict(inputs),
        stops=tuple(each.stop for each in stops),
        figures=tuple(each for each in figures.values() if each is not None),
        not_compared=tuple(name for name, each in figures.items() if each is None),
        domains=domains_of(each.conditions for each in counted),
    )


def figure_names() -> Iterator[str]:
    """Yield the figures of a stop, then those of each wheelset."""
    yield from STOP_COLUMNS
    for name in WHEELSET_COLUMNS:
        yield from (f"{name}_{number}" for number in _WHEELSETS)


def _agreement(name: str, counted: Sequence[StopUnderConditions], confidence: float) -> Agreement | None:
    recorded = [each.stop.recorded.get(name, float("nan")) for each in counted]
    simulated = [each.stop.simulated.get(name, float("nan")) for each in counted]
    return agreement_of(name, column_unit(name), recorded, simulated, confidence)

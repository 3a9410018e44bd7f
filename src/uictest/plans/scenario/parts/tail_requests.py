"""What a sweep asks of its draws: quantiles of measures, and K_dry."""

from __future__ import annotations

from typing import Annotated, Any, Final

from pydantic import AfterValidator, Discriminator, Tag
from pydantic_core import PydanticCustomError

from uictest.core.measures import MEASURES, STOP_COLUMNS, WHEELSET_COLUMNS, StopColumn, column_unit
from uictest.core.statistics import Side
from uictest.plans.scenario.parts.wheelsets import NUMBERS
from uictest.plans.scenario.yaml import Model, Quantity, quoted, suggestion
from uictest.plans.scenario.yaml.quantity_field import default, field, of_kind, optional

DECELERATION: Final = "m/s2"
_COLUMNS: Final = frozenset(
    {*STOP_COLUMNS, *(f"{name}_{number}" for name in WHEELSET_COLUMNS for number in NUMBERS)}
)
_COLUMN_OF: Final = {
    name: each.column.name for name, each in MEASURES.items() if isinstance(each.column, StopColumn)
}


def _column(name: str) -> str:
    """Return the column that a measure of a stop, or the name of a column, stands for."""
    column = _COLUMN_OF.get(name, name)
    if column not in _COLUMNS:
        hint = suggestion(name, {*_COLUMN_OF, *_COLUMNS})
        context = {"message": f"no measure {quoted(name)}", "hint": hint}
        raise PydanticCustomError("measure", "{message}", context)
    return column


def _deceleration(column: str) -> str:
    if (unit := column_unit(column)) != DECELERATION:
        decelerations = (name for name in _COLUMN_OF if column_unit(_COLUMN_OF[name]) == DECELERATION)
        context = {
            "message": f"{column} is no deceleration in {DECELERATION}: its unit is {unit}",
            "hint": f"K_dry is a ratio of decelerations, such as {', '.join(decelerations)}",
        }
        raise PydanticCustomError("measure", "{message}", context)
    return column


Column = Annotated[str, AfterValidator(_column)]
Level = Annotated[Quantity, of_kind("share", "> 0 % .. < 100 %")]
Confidence = Annotated[Quantity, of_kind("share", "50 % .. < 100 %")]
_CONFIDENCE: Final = default("95 %", "share")


class QuantileRequest(Model):
    """Quantiles of one measure, bounded by order statistics of the draws."""

    measure: Column = field("A measure of the stop, or a column of summary.csv.")
    levels: tuple[Level, ...] = field(
        "List of the shares of stops that lie at or below the quantiles.",
        min_length=1,
        max_length=100,
        examples=[["0.1 %", "1 %", "50 %"]],
    )
    confidence: Confidence = field("Confidence of each bound.", default=_CONFIDENCE)
    side: Side | None = optional(
        "Bounds to compute; if left out, lower for levels below 50 %, upper above, both at 50 %."
    )

    def side_of(self, level: float) -> Side:
        """Return which bounds the quantile of a level gets: those on its tail unless stated otherwise."""
        if self.side is not None:
            return self.side
        return "both" if level == 0.5 else "lower" if level < 0.5 else "upper"


class KDryRequest(Model):
    """K_dry: the share of its nominal deceleration that a train reaches on dry rail, by confidence level."""

    measure: Annotated[Column, AfterValidator(_deceleration)] = field(
        "The deceleration: a measure of the stop, or a column of summary.csv, in m/s2.",
        default="developed_deceleration_mps2",
    )
    nominal: Annotated[Quantity, of_kind("acceleration", "> 0 m/s2 .. 10 m/s2")] | None = optional(
        "The nominal deceleration; if left out, that of the scenario with its own values."
    )
    confidence: Confidence = field("Confidence of each bound.", default=_CONFIDENCE)


def _form(value: Any) -> str:
    return "several" if isinstance(value, list | tuple) else "one"


Quantiles = Annotated[
    Annotated[QuantileRequest, Tag("one")] | Annotated[tuple[QuantileRequest, ...], Tag("several")],
    Discriminator(_form),
]
"""One request, or a list of requests."""

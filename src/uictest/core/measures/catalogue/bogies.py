"""How the deceleration is shared between the bogies."""

from __future__ import annotations

import math
from collections.abc import Callable
from operator import attrgetter
from typing import Any

from uictest.core.measures.measure import (
    Decided,
    Measure,
    MeasureValue,
    RecordedData,
    StopColumn,
    one_value,
    unavailable,
)
from uictest.core.measures.records import StopMeasures

_POSITIONS = {1: "leading", 2: "trailing"}


def deceleration_of_bogie(stop: StopMeasures, deceleration: float) -> MeasureValue:
    """Return the mean deceleration that the rail gave through a bogie in a stop that ended at standstill."""
    return one_value(deceleration) if stop.stopped else unavailable("no standstill")


def _of_bogie(number: int) -> Measure:
    of_stop: Callable[[Any], float] = attrgetter(f"deceleration_bogie_{number}")
    return Measure(
        name=f"deceleration_bogie_{number}",
        kind="acceleration",
        unit="m/s2",
        course="settles",
        meaning=f"part of the mean deceleration given by the rail through the {_POSITIONS[number]} bogie: its"
        " work on both wheelsets over the mass of the train and the braking distance",
        read=lambda stop, wheelsets, definition: deceleration_of_bogie(stop, of_stop(stop)),
        decided=Decided(how="span", plot="deceleration", level=True, word=f"{_POSITIONS[number]} bogie"),
        recorded=RecordedData(("speed", "distance", "adhesion_{n}", "wheel_load_{n}"), bounded=False),
        column=StopColumn(
            f"deceleration_bogie_{number}_mps2",
            "m/s2",
            read=lambda stop, definition: of_stop(stop) if stop.stopped else math.nan,
        ),
        finite_field=f"deceleration_bogie_{number}",
    )


MEASURES = tuple(map(_of_bogie, _POSITIONS))

"""Air of the brake: the reservoir's lowest pressure, what the brake takes and what the valves vent."""

from __future__ import annotations

from uictest.core.measures.measure import (
    Decided,
    Measure,
    RecordedData,
    StopColumn,
    WheelsetColumn,
    one_value,
    value_per_wheelset,
)
from uictest.core.units import normal_volume

_FLOW_OF_AIR = RecordedData(("flow of air",), when="never")

MEASURES = (
    Measure(
        name="reservoir_minimum_pressure",
        kind="pressure",
        unit="bar",
        course="falls",
        meaning="lowest gauge pressure of the reservoir",
        read=lambda stop, wheelsets, definition: one_value(stop.reservoir_minimum_pressure),
        decided=Decided(
            how="extreme", plot="pressure", field="reservoir_minimum_pressure", level=True, word="lowest"
        ),
        recorded=RecordedData(("reservoir_pressure",)),
        column=StopColumn(
            "reservoir_minimum_bar", "bar", read=lambda stop, definition: stop.reservoir_minimum_pressure
        ),
        finite_field="reservoir_minimum_pressure",
    ),
    Measure(
        name="air_consumed",
        kind="normal volume",
        unit="NL",
        course="grows",
        meaning="air taken from the reservoir, normal volume (20 degC, 1 bar)",
        read=lambda stop, wheelsets, definition: one_value(normal_volume(stop.air_consumed)),
        decided=Decided(how="end", plot="pressure"),
        recorded=_FLOW_OF_AIR,
        column=StopColumn(
            "air_consumed_nl", "NL", read=lambda stop, definition: normal_volume(stop.air_consumed)
        ),
        finite_field="air_consumed",
    ),
    Measure(
        name="air_vented",
        kind="normal volume",
        unit="NL",
        course="grows",
        meaning="air vented, normal volume (20 degC, 1 bar)",
        read=lambda stop, wheelsets, definition: value_per_wheelset(
            normal_volume(w.air_vented) for w in wheelsets
        ),
        decided=Decided(how="outer", plot="valves", field="venting"),
        of_wheelsets=True,
        recorded=_FLOW_OF_AIR,
        column=WheelsetColumn(
            "air_vented_nl", "NL", read=lambda wheelset: normal_volume(wheelset.air_vented)
        ),
        finite_field="air_vented",
    ),
)

"""How much pressure the reservoir keeps over the brake cylinders."""

from __future__ import annotations

from uictest.core.measures.measure import Decided, Measure, RecordedData, StopColumn, one_value

MEASURES = (
    Measure(
        name="reservoir_margin",
        kind="pressure",
        unit="bar",
        course="falls",
        meaning="lowest difference between the pressure of the reservoir and the highest cylinder pressure",
        read=lambda stop, wheelsets, definition: one_value(stop.reservoir_margin),
        decided=Decided(
            how="extreme",
            plot="pressure",
            field="reservoir_margin",
            channel="reservoir_pressure",
            word="lowest margin",
        ),
        recorded=RecordedData(("reservoir_pressure", "cylinder_pressure_{n}")),
        column=StopColumn("reservoir_margin_bar", "bar", read=lambda stop, definition: stop.reservoir_margin),
        finite_field="reservoir_margin",
    ),
)

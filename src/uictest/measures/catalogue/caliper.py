"""What valves and calipers do: vents of the WSP valve, the largest clamping force."""

from __future__ import annotations

from uictest.measures.measure import Measure, RecordedData, WheelsetColumn, value_per_wheelset

MEASURES = (
    Measure(
        name="valve_actuations",
        kind="number",
        unit="1",
        course="grows",
        meaning="openings and closings of the vent",
        read=lambda stop, wheelsets, definition: value_per_wheelset(w.valve_actuations for w in wheelsets),
        of_wheelsets=True,
        recorded=RecordedData(("valve_command_{n}",)),
        column=WheelsetColumn(
            "valve_actuations", "1", whole=True, read=lambda wheelset: wheelset.valve_actuations
        ),
        finite_field="valve_actuations",
    ),
    Measure(
        name="maximum_clamping_force",
        kind="force",
        unit="kN",
        course="grows",
        meaning="largest clamping force of one caliper",
        read=lambda stop, wheelsets, definition: value_per_wheelset(
            w.maximum_clamping_force for w in wheelsets
        ),
        of_wheelsets=True,
        recorded=RecordedData(("clamping_force_{n}",)),
        column=WheelsetColumn(
            "maximum_clamping_force_n", "N", read=lambda wheelset: wheelset.maximum_clamping_force
        ),
        finite_field="maximum_clamping_force",
    ),
)

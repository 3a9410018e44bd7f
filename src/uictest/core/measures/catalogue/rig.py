"""What the rig itself says of a stop: sensors beyond their range, a compensation of another rig."""

from __future__ import annotations

from uictest.core.measures.measure import Decided, Measure, one_value

MEASURES = (
    Measure(
        name="loadcell_saturation",
        kind="time",
        unit="s",
        course="grows",
        meaning="time for which loadcells are limited by their range, of all calipers together",
        read=lambda stop, wheelsets, definition: one_value(sum(w.loadcell_saturation for w in wheelsets)),
        decided=Decided(how="end", plot="force"),
        of_simulation=True,
    ),
    Measure(
        name="pressure_saturation",
        kind="time",
        unit="s",
        course="grows",
        meaning="time for which pressure sensors are limited by their range, of all of them together",
        read=lambda stop, wheelsets, definition: one_value(
            stop.line_saturation + sum(w.pressure_saturation for w in wheelsets)
        ),
        decided=Decided(how="end", plot="pressure"),
        of_simulation=True,
    ),
    Measure(
        name="compensation_misfit",
        kind="number",
        unit="1",
        course="settles",
        meaning="sum of the differences between the rig and that which its compensation was identified for,"
        " each over its tolerance",
        read=lambda stop, wheelsets, definition: one_value(stop.compensation_misfit),
        of_simulation=True,
    ),
)

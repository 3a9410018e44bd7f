"""What valves, calipers and discs do: vents of the WSP valve, largest clamping force and temperature."""

from __future__ import annotations

import math

from uictest.core.measures.measure import (
    Decided,
    Measure,
    MeasureValue,
    Overview,
    RecordedData,
    WheelsetColumn,
    Wheelsets,
    unavailable,
    value_per_wheelset,
)


def _disc_temperatures(wheelsets: Wheelsets) -> MeasureValue:
    temperatures = tuple(float(wheelset.maximum_disc_temperature) for wheelset in wheelsets)
    if all(map(math.isnan, temperatures)):
        return unavailable("the temperature of the discs is not modelled: brake.disc_temperature")
    return MeasureValue(temperatures)


MEASURES = (
    Measure(
        name="valve_actuations",
        kind="number",
        unit="1",
        course="grows",
        meaning="openings and closings of the vent",
        read=lambda stop, wheelsets, definition: value_per_wheelset(w.valve_actuations for w in wheelsets),
        decided=Decided(how="outer", plot="valves", field="venting"),
        of_wheelsets=True,
        recorded=RecordedData(("valve_command_{n}",)),
        column=WheelsetColumn(
            "valve_actuations",
            "1",
            whole=True,
            overview=Overview("most vents\nof a wheelset", digits=0, rank=8, short="vents\nmax"),
            read=lambda wheelset: wheelset.valve_actuations,
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
        decided=Decided(how="extreme", plot="force", field="maximum_clamping_force", level=True),
        of_wheelsets=True,
        recorded=RecordedData(("clamping_force_{n}",)),
        column=WheelsetColumn(
            "maximum_clamping_force_n", "N", read=lambda wheelset: wheelset.maximum_clamping_force
        ),
        finite_field="maximum_clamping_force",
    ),
    Measure(
        name="maximum_disc_temperature",
        kind="temperature",
        unit="degC",
        course="grows",
        meaning="highest temperature of the friction surface of the discs, where it is modelled",
        read=lambda stop, wheelsets, definition: _disc_temperatures(wheelsets),
        decided=Decided(how="extreme", plot="temperature", field="maximum_disc_temperature", level=True),
        of_wheelsets=True,
        recorded=RecordedData(("disc_surface_temperature_{n}",)),
        column=WheelsetColumn(
            "maximum_disc_temperature_degc", "degC", read=lambda wheelset: wheelset.maximum_disc_temperature
        ),
    ),
)

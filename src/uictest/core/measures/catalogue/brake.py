"""What valves, calipers, discs and sanders do; air taken and vented, and what the reservoir keeps."""

from __future__ import annotations

from uictest.core.measures.measure import (
    Measure,
    Overview,
    RecordedData,
    ShownWhen,
    StopColumn,
    WheelsetColumn,
    one_value,
    value_per_wheelset,
)
from uictest.core.units import normal_volume

_FLOW_OF_AIR = RecordedData(("flow of air",), when="never")


_NO_TRACK_BRAKE = "the car has no track brake: brake.track"
_TRACK_BRAKE = RecordedData(("track_brake_force",))


_NO_SANDERS = "the car has no sanders: sanders"
_SAND = RecordedData(("flow of sand",), when="never")

MEASURES = (
    Measure(
        name="valve_actuations",
        kind="number",
        course="grows",
        better="smaller",
        meaning="openings of the vent",
        decided=ShownWhen(how="outer", plot="valves", field="venting"),
        of_wheelsets=True,
        recorded=RecordedData(("valve_command_{n}",)),
        column=WheelsetColumn(
            "valve_actuations",
            "1",
            whole=True,
            overview=Overview("most vents\nof a wheelset", digits=0, rank=8, short="vents\nmax"),
        ),
        approach="maximum_slide",
        finite_field="valve_actuations",
    ),
    Measure(
        name="maximum_clamping_force",
        kind="force",
        unit="kN",
        course="grows",
        meaning="largest clamping force of one caliper",
        decided=ShownWhen(how="extreme", plot="force", field="maximum_clamping_force", level=True),
        of_wheelsets=True,
        recorded=RecordedData(("clamping_force_{n}",)),
        column=WheelsetColumn("maximum_clamping_force_n", "N"),
        finite_field="maximum_clamping_force",
    ),
    Measure(
        name="maximum_disc_temperature",
        kind="temperature",
        course="grows",
        better="smaller",
        meaning="highest temperature of the friction surface of the discs, where it is modelled",
        absent="the temperature of the discs is not modelled: brake.disc_temperature",
        decided=ShownWhen(how="extreme", plot="temperature", field="maximum_disc_temperature", level=True),
        of_wheelsets=True,
        recorded=RecordedData(("disc_surface_temperature_{n}",)),
        column=WheelsetColumn("maximum_disc_temperature_degc", "degC"),
    ),
    Measure(
        name="dynamic_energy",
        kind="energy",
        course="grows",
        meaning="energy that the dynamic brake took, where there is one",
        absent="the car has no dynamic brake: brake.dynamic",
        decided=ShownWhen(how="end", plot="torque"),
        of_wheelsets=True,
        recorded=RecordedData(("torque of the motors",), when="never"),
        column=WheelsetColumn("dynamic_energy_kj", "kJ"),
    ),
    Measure(
        name="track_brake_energy",
        kind="energy",
        course="grows",
        meaning="energy that the track brake turned into heat, where there is one",
        absent=_NO_TRACK_BRAKE,
        decided=ShownWhen(how="end", plot="track"),
        recorded=_TRACK_BRAKE,
        column=StopColumn("track_brake_energy_kj", "kJ"),
    ),
    Measure(
        name="track_brake_time",
        kind="time",
        course="grows",
        meaning="time for which the track brake acted, where there is one",
        absent=_NO_TRACK_BRAKE,
        decided=ShownWhen(how="end", plot="track"),
        recorded=_TRACK_BRAKE,
        column=StopColumn("track_brake_time_s", "s"),
    ),
    Measure(
        name="sand_laid",
        kind="mass",
        course="grows",
        better="smaller",
        meaning="sand that the sander of a wheelset laid on one rail",
        absent=_NO_SANDERS,
        decided=ShownWhen(how="end", plot="sand"),
        of_wheelsets=True,
        recorded=_SAND,
        column=WheelsetColumn("sand_laid_kg", "kg"),
    ),
    Measure(
        name="sand_in_30_s",
        kind="mass",
        course="grows",
        better="smaller",
        meaning="most sand that the sander of a wheelset laid on one rail within 30 s",
        absent=_NO_SANDERS,
        decided=ShownWhen(how="end", plot="sand"),
        of_wheelsets=True,
        recorded=_SAND,
        column=WheelsetColumn("sand_in_30_s_kg", "kg"),
    ),
    Measure(
        name="longest_sanding",
        kind="time",
        course="grows",
        better="smaller",
        meaning="longest time for which the sander of a wheelset laid sand without a break",
        absent=_NO_SANDERS,
        decided=ShownWhen(how="end", plot="sand"),
        of_wheelsets=True,
        recorded=_SAND,
        column=WheelsetColumn("longest_sanding_s", "s"),
    ),
    Measure(
        name="reservoir_minimum_pressure",
        kind="pressure",
        course="falls",
        better="larger",
        meaning="lowest gauge pressure of the reservoir",
        decided=ShownWhen(
            how="extreme", plot="pressure", field="reservoir_minimum_pressure", level=True, word="lowest"
        ),
        recorded=RecordedData(("reservoir_pressure",)),
        column=StopColumn("reservoir_minimum_bar", "bar"),
        finite_field="reservoir_minimum_pressure",
    ),
    Measure(
        name="air_consumed",
        kind="normal volume",
        course="grows",
        better="smaller",
        meaning="air taken from the reservoir, normal volume (20 degC, 1 bar)",
        read=lambda stop, wheelsets, definition: one_value(normal_volume(stop.air_consumed)),
        decided=ShownWhen(how="end", plot="pressure"),
        recorded=_FLOW_OF_AIR,
        column=StopColumn(
            "air_consumed_nl", "NL", read=lambda stop, definition: normal_volume(stop.air_consumed)
        ),
        finite_field="air_consumed",
    ),
    Measure(
        name="air_vented",
        kind="normal volume",
        course="grows",
        better="smaller",
        meaning="air vented, normal volume (20 degC, 1 bar)",
        read=lambda stop, wheelsets, definition: value_per_wheelset(
            normal_volume(w.air_vented) for w in wheelsets
        ),
        decided=ShownWhen(how="outer", plot="valves", field="venting"),
        of_wheelsets=True,
        recorded=_FLOW_OF_AIR,
        column=WheelsetColumn(
            "air_vented_nl", "NL", read=lambda wheelset: normal_volume(wheelset.air_vented)
        ),
        finite_field="air_vented",
    ),
    Measure(
        name="reservoir_margin",
        kind="pressure",
        course="falls",
        better="larger",
        meaning="lowest difference between the pressure of the reservoir and the highest cylinder pressure",
        decided=ShownWhen(
            how="extreme",
            plot="pressure",
            field="reservoir_margin",
            channel="reservoir_pressure",
            word="lowest margin",
        ),
        recorded=RecordedData(("reservoir_pressure", "cylinder_pressure_{n}")),
        column=StopColumn("reservoir_margin_bar", "bar"),
        finite_field="reservoir_margin",
    ),
)

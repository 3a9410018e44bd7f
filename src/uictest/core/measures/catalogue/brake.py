"""What valves, calipers, discs and sanders do; air taken and vented, and what the reservoir keeps."""

from __future__ import annotations

import math
from collections.abc import Iterable

from uictest.core.measures.measure import (
    Measure,
    MeasureValue,
    Overview,
    RecordedData,
    ShownWhen,
    StopColumn,
    WheelsetColumn,
    Wheelsets,
    one_value,
    unavailable,
    value_per_wheelset,
)
from uictest.core.measures.records import StopMeasures
from uictest.core.units import normal_volume

_FLOW_OF_AIR = RecordedData(("flow of air",), when="never")


def _disc_temperatures(wheelsets: Wheelsets) -> MeasureValue:
    temperatures = tuple(float(wheelset.maximum_disc_temperature) for wheelset in wheelsets)
    if all(map(math.isnan, temperatures)):
        return unavailable("the temperature of the discs is not modelled: brake.disc_temperature")
    return MeasureValue(temperatures)


def _dynamic_energies(wheelsets: Wheelsets) -> MeasureValue:
    energies = tuple(float(wheelset.dynamic_energy) for wheelset in wheelsets)
    if all(map(math.isnan, energies)):
        return unavailable("the car has no dynamic brake: brake.dynamic")
    return MeasureValue(energies)


def _of_track_brake(stop: StopMeasures, value: float) -> MeasureValue:
    if math.isnan(stop.track_brake_energy):
        return unavailable("the car has no track brake: brake.track")
    return one_value(value)


_TRACK_BRAKE = RecordedData(("track_brake_force",))


def _of_sanders(numbers: Iterable[float]) -> MeasureValue:
    values = tuple(map(float, numbers))
    if all(map(math.isnan, values)):
        return unavailable("the car has no sanders: sanders")
    return MeasureValue(values)


_SAND = RecordedData(("flow of sand",), when="never")

MEASURES = (
    Measure(
        name="valve_actuations",
        kind="number",
        unit="1",
        course="grows",
        meaning="openings and closings of the vent",
        read=lambda stop, wheelsets, definition: value_per_wheelset(w.valve_actuations for w in wheelsets),
        decided=ShownWhen(how="outer", plot="valves", field="venting"),
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
        decided=ShownWhen(how="extreme", plot="force", field="maximum_clamping_force", level=True),
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
        decided=ShownWhen(how="extreme", plot="temperature", field="maximum_disc_temperature", level=True),
        of_wheelsets=True,
        recorded=RecordedData(("disc_surface_temperature_{n}",)),
        column=WheelsetColumn(
            "maximum_disc_temperature_degc", "degC", read=lambda wheelset: wheelset.maximum_disc_temperature
        ),
    ),
    Measure(
        name="dynamic_energy",
        kind="energy",
        unit="kJ",
        course="grows",
        meaning="energy that the dynamic brake took, where there is one",
        read=lambda stop, wheelsets, definition: _dynamic_energies(wheelsets),
        decided=ShownWhen(how="end", plot="torque"),
        of_wheelsets=True,
        recorded=RecordedData(("torque of the motors",), when="never"),
        column=WheelsetColumn("dynamic_energy_kj", "kJ", read=lambda wheelset: wheelset.dynamic_energy),
    ),
    Measure(
        name="track_brake_energy",
        kind="energy",
        unit="kJ",
        course="grows",
        meaning="energy that the track brake turned into heat, where there is one",
        read=lambda stop, wheelsets, definition: _of_track_brake(stop, stop.track_brake_energy),
        decided=ShownWhen(how="end", plot="track"),
        recorded=_TRACK_BRAKE,
        column=StopColumn(
            "track_brake_energy_kj", "kJ", read=lambda stop, definition: stop.track_brake_energy
        ),
    ),
    Measure(
        name="track_brake_time",
        kind="time",
        unit="s",
        course="grows",
        meaning="time for which the track brake acted, where there is one",
        read=lambda stop, wheelsets, definition: _of_track_brake(stop, stop.track_brake_time),
        decided=ShownWhen(how="end", plot="track"),
        recorded=_TRACK_BRAKE,
        column=StopColumn("track_brake_time_s", "s", read=lambda stop, definition: stop.track_brake_time),
    ),
    Measure(
        name="sand_laid",
        kind="mass",
        unit="kg",
        course="grows",
        meaning="sand that the sander of a wheelset laid on one rail",
        read=lambda stop, wheelsets, definition: _of_sanders(w.sand_laid for w in wheelsets),
        decided=ShownWhen(how="end", plot="sand"),
        of_wheelsets=True,
        recorded=_SAND,
        column=WheelsetColumn("sand_laid_kg", "kg", read=lambda wheelset: wheelset.sand_laid),
    ),
    Measure(
        name="sand_in_30_s",
        kind="mass",
        unit="kg",
        course="grows",
        meaning="most sand that the sander of a wheelset laid on one rail within 30 s",
        read=lambda stop, wheelsets, definition: _of_sanders(w.sand_in_30_s for w in wheelsets),
        decided=ShownWhen(how="end", plot="sand"),
        of_wheelsets=True,
        recorded=_SAND,
        column=WheelsetColumn("sand_in_30_s_kg", "kg", read=lambda wheelset: wheelset.sand_in_30_s),
    ),
    Measure(
        name="longest_sanding",
        kind="time",
        unit="s",
        course="grows",
        meaning="longest time for which the sander of a wheelset laid sand without a break",
        read=lambda stop, wheelsets, definition: _of_sanders(w.longest_sanding for w in wheelsets),
        decided=ShownWhen(how="end", plot="sand"),
        of_wheelsets=True,
        recorded=_SAND,
        column=WheelsetColumn("longest_sanding_s", "s", read=lambda wheelset: wheelset.longest_sanding),
    ),
    Measure(
        name="reservoir_minimum_pressure",
        kind="pressure",
        unit="bar",
        course="falls",
        meaning="lowest gauge pressure of the reservoir",
        read=lambda stop, wheelsets, definition: one_value(stop.reservoir_minimum_pressure),
        decided=ShownWhen(
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
        unit="NL",
        course="grows",
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
        unit="bar",
        course="falls",
        meaning="lowest difference between the pressure of the reservoir and the highest cylinder pressure",
        read=lambda stop, wheelsets, definition: one_value(stop.reservoir_margin),
        decided=ShownWhen(
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

"""What only a simulated stop has: balances of the simulation, the reaction to faults, limits of the rig."""

from __future__ import annotations

import math

from uictest.core.measures.measure import (
    Measure,
    MeasureValue,
    RecordedData,
    ShownWhen,
    StopColumn,
    Wheelsets,
    one_value,
    unavailable,
)
from uictest.core.measures.records import StopMeasures

# A residual is as bad below zero as above it: criteria bound its magnitude, results report its sign.
_NO_FAULT = "no fault began while the train moved"
_FAULTS = RecordedData(("faults of the brake",), when="never")


def longest_lock_of_sound_wheelsets(stop: StopMeasures, wheelsets: Wheelsets) -> MeasureValue:
    """Return the longest lock (s) of any wheelset that has had no fault of its own."""
    if math.isnan(stop.fault_time):
        return unavailable(_NO_FAULT)
    locks = [float(wheelset.longest_lock) for wheelset in wheelsets if not wheelset.faulty]
    return one_value(max(locks)) if locks else unavailable("every wheelset has had a fault")


def longest_release(stop: StopMeasures, wheelsets: Wheelsets) -> MeasureValue:
    """Return the longest time (s) for which a wheelset with a faulty speed sensor was without brake force."""
    releases = [float(wheelset.longest_release) for wheelset in wheelsets]
    known = [release for release in releases if not math.isnan(release)]
    return one_value(max(known)) if known else unavailable("no speed sensor was faulty while the train moved")


def reference_excess(stop: StopMeasures) -> MeasureValue:
    """Return by how much (m/s) the estimate of the train's speed was too high since the first fault."""
    if math.isnan(stop.fault_time):
        return unavailable(_NO_FAULT)
    if math.isnan(stop.reference_excess):
        return unavailable("the controller gives no reference speed")
    return one_value(stop.reference_excess)


MEASURES = (
    Measure(
        name="energy_residual",
        kind="share",
        course="settles",
        meaning="magnitude of the energy balance's error over the initial kinetic energy",
        read=lambda stop, wheelsets, definition: one_value(abs(stop.energy_residual)),
        decided=ShownWhen(how="end", plot="speed"),
        of_simulation=True,
        column=StopColumn(
            "energy_residual",
            "1",
            meaning="error of the energy balance over the initial kinetic energy, with its sign",
        ),
        finite_field="energy_residual",
    ),
    Measure(
        name="air_residual",
        kind="number",
        course="settles",
        meaning="magnitude of the air balance's error over the mass taken",
        read=lambda stop, wheelsets, definition: one_value(abs(stop.air_residual)),
        decided=ShownWhen(how="end", plot="pressure"),
        of_simulation=True,
        column=StopColumn(
            "air_residual", "1", meaning="error of the air balance over the mass taken, with its sign"
        ),
        finite_field="air_residual",
    ),
    Measure(
        name="air_energy_residual",
        kind="number",
        course="settles",
        meaning="magnitude of the error of the air's energy balance over the enthalpy taken",
        read=lambda stop, wheelsets, definition: one_value(abs(stop.air_energy_residual)),
        decided=ShownWhen(how="end", plot="pressure"),
        of_simulation=True,
        column=StopColumn(
            "air_energy_residual",
            "1",
            meaning="error of the air's energy balance over the enthalpy taken, with its sign",
        ),
        finite_field="air_energy_residual",
    ),
    Measure(
        name="longest_lock_of_sound_wheelsets",
        kind="time",
        course="grows",
        better="smaller",
        meaning="longest time at a stretch that a wheelset without a fault of its own is locked",
        read=lambda stop, wheelsets, definition: longest_lock_of_sound_wheelsets(stop, wheelsets),
        decided=ShownWhen(
            how="longest", plot="locked", field="lock", among=lambda wheelset: not wheelset.faulty
        ),
        observed_by=("locked_speed", "moving_speed"),
        of_faults=True,
        recorded=_FAULTS,
        approach="maximum_slide",
    ),
    Measure(
        name="longest_release",
        kind="time",
        course="grows",
        better="smaller",
        meaning="longest time at a stretch that a wheelset with a faulty speed sensor is without brake force,"
        " once the brake is developed",
        read=lambda stop, wheelsets, definition: longest_release(stop, wheelsets),
        decided=ShownWhen(how="longest", plot="force", field="release"),
        observed_by=("moving_speed", "developed_time", "released_share"),
        of_faults=True,
        recorded=_FAULTS,
    ),
    Measure(
        name="reference_excess",
        kind="speed",
        course="grows",
        better="smaller",
        meaning="largest excess of the controller's reference speed over the train's since the first fault",
        read=lambda stop, wheelsets, definition: reference_excess(stop),
        decided=ShownWhen(
            how="extreme", plot="speed", field="reference_excess", channel="reference_speed", word="excess"
        ),
        observed_by=("moving_speed",),
        of_faults=True,
        recorded=_FAULTS,
    ),
    Measure(
        name="loadcell_saturation",
        kind="time",
        course="grows",
        meaning="time for which loadcells are limited by their range, of all calipers together",
        read=lambda stop, wheelsets, definition: one_value(sum(w.loadcell_saturation for w in wheelsets)),
        decided=ShownWhen(how="end", plot="force"),
        of_simulation=True,
    ),
    Measure(
        name="pressure_saturation",
        kind="time",
        course="grows",
        meaning="time for which pressure sensors are limited by their range, of all of them together",
        read=lambda stop, wheelsets, definition: one_value(
            stop.line_saturation + sum(w.pressure_saturation for w in wheelsets)
        ),
        decided=ShownWhen(how="end", plot="pressure"),
        of_simulation=True,
    ),
    Measure(
        name="compensation_misfit",
        kind="number",
        course="settles",
        meaning="sum of the differences between the rig and that which its compensation was identified for,"
        " each over its tolerance",
        of_simulation=True,
    ),
)

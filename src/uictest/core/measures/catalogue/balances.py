"""Balances of the simulation itself: how much energy and air it loses or makes."""

from __future__ import annotations

from uictest.core.measures.measure import Decided, Measure, StopColumn, one_value

# A residual is as bad below zero as above it: criteria bound its magnitude, results report its sign.
MEASURES = (
    Measure(
        name="energy_residual",
        kind="share",
        unit="%",
        course="settles",
        meaning="magnitude of the energy balance's error over the initial kinetic energy",
        read=lambda stop, wheelsets, definition: one_value(abs(stop.energy_residual)),
        decided=Decided(how="end", plot="speed"),
        of_simulation=True,
        column=StopColumn(
            "energy_residual",
            "1",
            meaning="error of the energy balance over the initial kinetic energy, with its sign",
            read=lambda stop, definition: stop.energy_residual,
        ),
        finite_field="energy_residual",
    ),
    Measure(
        name="air_residual",
        kind="number",
        unit="1",
        course="settles",
        meaning="magnitude of the air balance's error over the mass taken",
        read=lambda stop, wheelsets, definition: one_value(abs(stop.air_residual)),
        decided=Decided(how="end", plot="pressure"),
        of_simulation=True,
        column=StopColumn(
            "air_residual",
            "1",
            meaning="error of the air balance over the mass taken, with its sign",
            read=lambda stop, definition: stop.air_residual,
        ),
        finite_field="air_residual",
    ),
    Measure(
        name="air_energy_residual",
        kind="number",
        unit="1",
        course="settles",
        meaning="magnitude of the error of the air's energy balance over the enthalpy taken",
        read=lambda stop, wheelsets, definition: one_value(abs(stop.air_energy_residual)),
        decided=Decided(how="end", plot="pressure"),
        of_simulation=True,
        column=StopColumn(
            "air_energy_residual",
            "1",
            meaning="error of the air's energy balance over the enthalpy taken, with its sign",
            read=lambda stop, definition: stop.air_energy_residual,
        ),
        finite_field="air_energy_residual",
    ),
)

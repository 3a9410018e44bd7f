"""What is drawn of stops that are laid over each other: one quantity, or two, to a panel."""

from __future__ import annotations

from uictest.report.traces.quantities import ORDINARY_CREEP, Panel

COMPARED = (
    Panel("speed", "Speed of train (bold) and wheelset", "km/h", ("wheel_speed", "speed"), 1.5),
    Panel("slide", "Slide", "%", ("slide",), include=(0.0, ORDINARY_CREEP)),
    Panel("pressure", "Tank pressure", "bar", ("tank_pressure",)),
    Panel("force", "Clamping force of one caliper", "kN", ("clamping_force",)),
    Panel("deceleration", "Deceleration", "g", ("deceleration",)),
    Panel("adhesion", "Adhesion", "dimensionless", ("adhesion",)),
)
"""Panels over time from top to bottom; the valves stand below the first."""

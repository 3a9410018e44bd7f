"""Pressure over time and force over pressure, a column for each kind of pressure."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from studies.figures.style import BLUE, INK, MUTED, WIDTH, from_zero
from uictest import Recording
from uictest.rig import identification
from uictest.units import BAR, KILONEWTON

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(tests: Mapping[str, Recording], hysteresis: identification.HysteresisResult, figure: Figure) -> None:
    """Draw the bench tests, and the identified lines over the loop of triangular pressure."""
    figure.set_size_inches(WIDTH, 4.3)
    axes = figure.subplots(
        2, len(tests), squeeze=False, height_ratios=(1.0, 2.4), sharey="row", sharex="none"
    )
    for column, (name, recording) in enumerate(tests.items()):
        over_time, over_pressure = axes[0][column], axes[1][column]
        pressure = recording["measured_pressure_1"] / BAR
        over_time.plot(recording["time"], pressure, color=INK, linewidth=0.9)
        over_time.set(title=name, xlabel="time, s")
        over_pressure.plot(pressure, recording["clamping_force_1"] / KILONEWTON, color=BLUE, linewidth=0.8)
        over_pressure.set(xlabel="cylinder pressure, bar")
    for panel in axes.flat:
        from_zero(panel)
    axes[0][0].set_ylabel("pressure, bar")
    axes[1][0].set_ylabel("clamping force, kN")
    if "triangular" in tests:
        _mark_width(axes[1][list(tests).index("triangular")], hysteresis)


def _mark_width(axes: Axes, hysteresis: identification.HysteresisResult) -> None:
    force = hysteresis.high_force
    left, right = (
        hysteresis.lines[phase].pressure(force) / BAR for phase in ("bc_releasing", "bc_squeezing")
    )
    up = force / KILONEWTON
    axes.annotate("", (left, up), (right, up), arrowprops={"arrowstyle": "<->", "color": INK, "lw": 0.8})
    axes.annotate(
        f"{right - left:.2f} bar",
        (left, up),
        (-5.0, 0.0),
        textcoords="offset points",
        ha="right",
        va="center",
        color=INK,
        fontweight="bold",
    )
    axes.annotate(
        "paper: about 0.5 bar",
        (left, up),
        (-5.0, 10.0),
        textcoords="offset points",
        ha="right",
        va="center",
        color=MUTED,
        fontsize=7.0,
    )

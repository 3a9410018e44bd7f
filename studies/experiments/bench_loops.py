"""The caliper alone, the WSP bypassed, under stepwise, triangular and random pressure."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

from studies.drawing import BLUE, INK, MUTED, WIDTH, from_zero
from studies.quantity import OwnBand, StudyQuantity, StudyValue
from studies.replay import identified_lines
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings, Table, samples
from uictest import Recording
from uictest.rig import bench, identification
from uictest.units import BAR, KILONEWTON

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TESTS = ("stepwise", "triangular", "random")
"""Bench recipes of the library. The kinds of pressure are the paper's; levels, rates and times are ours."""
_EVERY = 20
"""Steps between two samples in the table."""

QUANTITIES = (
    StudyQuantity(
        "loop_width",
        "width of the loop at high force, triangular pressure",
        "bar",
        "about 0.5 bar",
        status="calibrated",
        band=OwnBand(lower=0.45, upper=0.55, reason="ours, about the paper's"),
        digits=3,
    ),
    StudyQuantity("loop_width_stepwise", "the same, stepwise pressure", "bar", status="calibrated", digits=3),
    StudyQuantity("loop_width_random", "the same, random pressure", "bar", status="calibrated", digits=3),
    StudyQuantity("largest_force", "largest clamping force", "kN", status="by construction", digits=2),
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Apply the three pressures to the caliper and identify its hysteresis loop in each."""
    recipes = [bench.load_bench(bench.recipe_path(name)) for name in TESTS]
    tests = dict(zip(TESTS, stop_runner.map(bench.run_test, recipes), strict=True))
    lines_by_test = {name: identified_lines(recording) for name, recording in tests.items()}
    widths = {name: lines.loop_widths["bc"] / BAR for name, lines in lines_by_test.items()}
    return StudyFindings(
        {
            "loop_width": StudyValue(widths["triangular"]),
            "loop_width_stepwise": StudyValue(widths["stepwise"]),
            "loop_width_random": StudyValue(widths["random"]),
            "largest_force": StudyValue(lines_by_test["triangular"].largest_force / KILONEWTON),
        },
        tables={name: _table(recording) for name, recording in tests.items()},
        drawings={"bench-loops": partial(draw, tests, lines_by_test["triangular"])},
        notes=("The width is that between the two lines of the loop at nine tenths of the largest force.",),
    )


def _table(recording: Recording) -> Table:
    channels = ("demanded_pressure_bar", "measured_pressure_1_bar", "clamping_force_1_kn")
    return samples(recording, "time_s", *channels, every=_EVERY)


def draw(tests: Mapping[str, Recording], hysteresis: identification.HysteresisResult, figure: Figure) -> None:
    """Draw the bench tests, and the identified lines over the loop of triangular pressure."""
    figure.set_size_inches(WIDTH, 4.3)
    axes = figure.subplots(
        2, len(tests), squeeze=False, height_ratios=(1.0, 2.4), sharey="row", sharex="none"
    )
    for (name, recording), over_time, over_pressure in zip(tests.items(), *axes, strict=True):
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


STUDY = Study(
    "bench-loops",
    "Clamping force against pressure on the bench, three kinds of pressure",
    "WSP bypassed, no vehicle: force against pressure shows hysteresis, about 0.5 bar wide at high force",
    QUANTITIES,
    run,
    position=10,
)

"""The caliper alone, the WSP bypassed, under stepwise, triangular and random pressure."""

from __future__ import annotations

from functools import partial

from studies.figures.bench_loops import draw
from studies.phases import identified_lines
from studies.quantity import OwnBand, StudyQuantity, StudyValue
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings, Table, column
from uictest import Recording
from uictest.rig import bench
from uictest.units import BAR, KILONEWTON

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
    shown_samples = slice(None, None, _EVERY)
    return {
        "time_s": column(recording["time"][shown_samples], 1.0, 3),
        "demanded_pressure_bar": column(recording["demanded_pressure"][shown_samples], BAR, 4),
        "measured_pressure_1_bar": column(recording["measured_pressure_1"][shown_samples], BAR, 4),
        "clamping_force_1_kn": column(recording["clamping_force_1"][shown_samples], KILONEWTON, 4),
    }


STUDY = Study(
    "bench-loops",
    "Clamping force against pressure on the bench, three kinds of pressure",
    "WSP bypassed, no vehicle: force against pressure shows hysteresis, about 0.5 bar wide at high force",
    QUANTITIES,
    run,
    position=10,
)

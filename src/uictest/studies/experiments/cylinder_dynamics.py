"""Pressure of tank 2 against that of cylinder 1 under the same valve commands, filtered and not."""

from __future__ import annotations

from functools import partial

import numpy as np

from uictest.recording import Recording
from uictest.studies.figures.cylinder_dynamics import draw
from uictest.studies.quantity import StudyQuantity, repeats_note, spread
from uictest.studies.replay import CYCLE, maximum_pressure, replayed
from uictest.studies.stop_runner import StopRunner, seeded
from uictest.studies.study import Study, StudyFindings, Table, column
from uictest.units import BAR, PERCENT

SEEDS = range(5)
_EVERY = 20

AFTER = 2.0
"""The paper's bound on the error after the cylinder dynamics, % of maximum pressure."""

QUANTITIES = (
    StudyQuantity(
        "before",
        "largest difference of tank 2 from cylinder 1",
        "% of maximum pressure",
        "7 %",
        lower=4.0,
        upper=8.0,
        digits=2,
        reason="ours, about the paper's figure",
    ),
    StudyQuantity(
        "after",
        "largest difference behind the cylinder dynamics",
        "% of maximum pressure",
        "below 2 %",
        upper=AFTER,
        below=True,
        digits=2,
        reason="paper",
    ),
    StudyQuantity(
        "ratio",
        "after over before",
        "",
        "below 0.29 (2 % of 7 %)",
        upper=0.45,
        digits=3,
        reason="ours",
    ),
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Replay the commands of module 1 in the slide test to both modules."""
    case = stop_runner.cases("slide-80")[0]
    cases = [seeded(case, seed) for seed in SEEDS]
    stops = stop_runner.recordings(cases, CYCLE)
    replays = stop_runner.map(lambda pair: replayed(*pair, 1), list(zip(cases, stops, strict=True)))
    top = maximum_pressure(case)
    errors = [largest_errors(recording, top) for recording in replays]
    return StudyFindings(
        {
            "before": spread([before / PERCENT for before, _ in errors]),
            "after": spread([after / PERCENT for _, after in errors]),
            "ratio": spread([after / before for before, after in errors]),
        },
        tables={"pressures": _table(replays[0])},
        drawings={"cylinder-dynamics": partial(draw, replays[0], top, AFTER)},
        notes=(repeats_note(len(SEEDS)),),
    )


def largest_errors(recording: Recording, top: float) -> tuple[float, float]:
    """Return the largest differences of tank 2 from cylinder 1, unfiltered and filtered, over `top` Pa."""
    cylinder = recording["tank_pressure_1"]
    before = np.abs(recording["tank_pressure_2"] - cylinder).max() / top
    after = np.abs(recording["cylinder_pressure_2"] - cylinder).max() / top
    return float(before), float(after)


def _table(recording: Recording) -> Table:
    shown_samples = slice(None, None, _EVERY)
    return {
        "time_s": column(recording["time"][shown_samples], 1.0, 3),
        "cylinder_pressure_1_bar": column(recording["tank_pressure_1"][shown_samples], BAR, 4),
        "tank_pressure_2_bar": column(recording["tank_pressure_2"][shown_samples], BAR, 4),
        "compensated_pressure_2_bar": column(recording["cylinder_pressure_2"][shown_samples], BAR, 4),
    }


STUDY = Study(
    "cylinder-dynamics",
    "Pressure of tank 2 against cylinder 1 before and after the cylinder dynamics",
    "the third-order transfer function cuts the largest pressure error from 7 % to below 2 %",
    QUANTITIES,
    run,
    position=30,
)

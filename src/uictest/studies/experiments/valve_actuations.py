"""Valve actuations of the WSP in one slide test, by the origin of the module's clamping force."""

from __future__ import annotations

from functools import partial

from uictest import rig
from uictest.studies.figures.valve_actuations import ActuationPanel, draw
from uictest.studies.quantity import NOT_ASKED, StudyQuantity, repeats_note, spread
from uictest.studies.replay import CYCLE
from uictest.studies.stop_runner import StopRunner
from uictest.studies.study import Study, StudyFindings

SEEDS = range(10)
_OURS = "ours, about the paper's"

QUANTITIES = (
    StudyQuantity("caliper", "module 1, real caliper", "", "11", 10.0, 12.0, reason=_OURS),
    StudyQuantity(
        "none", "module 2 without hysteresis and cylinder models", "", "21", 19.0, 23.0, reason=_OURS
    ),
    StudyQuantity("full", "module 2 with both models", "", "11", 10.0, 12.0, reason=_OURS),
    StudyQuantity("reference", "module 2 with a caliper of its own (four-caliper rig)", "", NOT_ASKED),
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Count the openings of the vent in repeats of the slide test, with one caliper and with four."""
    none, full = stop_runner.cases("slide-80", "rig.compensation=none,full")
    (four,) = stop_runner.cases("slide-80-four-caliper")
    of_none, of_full, of_four = (repeats.stops for repeats in stop_runner.repeated([none, full, four], SEEDS))
    counts = {
        "caliper": [_actuations(stop, 1) for stop in of_full],
        "none": [_actuations(stop, 2) for stop in of_none],
        "full": [_actuations(stop, 2) for stop in of_full],
        "reference": [_actuations(stop, 2) for stop in of_four],
    }
    recorded_none, recorded_full = stop_runner.recordings([none, full], CYCLE)
    panels = [
        ActuationPanel("module 1, real caliper", recorded_full, 1),
        ActuationPanel("module 2, no model", recorded_none, 2),
        ActuationPanel("module 2, hysteresis and cylinder dynamics", recorded_full, 2),
    ]
    return StudyFindings(
        {name: spread(values) for name, values in counts.items()},
        tables={"actuations": {"seed": list(SEEDS), **counts}},
        drawings={"valve-actuations": partial(draw, panels)},
        notes=(
            f"{repeats_note(len(SEEDS))} The figure shows the first.",
            "Cycling amplifies small differences: one stop says little.",
        ),
    )


def _actuations(stop: rig.SimulatedStop, wheelset: int) -> float:
    return float(stop.wheelset_measures[wheelset - 1].valve_actuations)


STUDY = Study(
    "valve-actuations",
    "WSP valve actuations in one slide test from 80 km/h",
    "11 (module 1, real caliper), 21 (module 2 without both models), 11 (module 2 with both)",
    QUANTITIES,
    run,
    position=80,
)

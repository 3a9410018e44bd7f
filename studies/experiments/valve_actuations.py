"""Valve actuations of the WSP in one slide test, by the origin of the module's clamping force."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from studies.figures.valve_actuations import ActuationPanel, draw
from studies.neighbourhood import BANDS, COUNTED, FOUR_CALIPER, PAPER, counts
from studies.quantity import NOT_ASKED, OwnBand, Status, StudyQuantity, repeats_note, spread
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings

SEEDS = range(10)
TITLES = {
    "caliper": "module 1, real caliper",
    "none": "module 2 without hysteresis and cylinder models",
    "full": "module 2 with both models",
    "thermal": "module 2 with hysteresis and modelled air",
    "reference": "module 2 with a caliper of its own (four-caliper rig)",
}
_DRAWN = {"caliper": FOUR_CALIPER, "none": "none", "full": "full", "thermal": "thermal"}
"""Counts that have a panel, and whose colour each has."""


def _quantities() -> Iterator[StudyQuantity]:
    for key, title in TITLES.items():
        paper, band = NOT_ASKED, None
        if key in BANDS:
            lower, upper = BANDS[key]
            paper, band = str(PAPER[key]), OwnBand(lower=lower, upper=upper, reason="ours, about the paper's")
        # The calibration asked for all of these counts but that with the modelled air.
        status: Status = "predicted" if key == "thermal" else "calibrated"
        yield StudyQuantity(key, title, "", paper, status=status, band=band)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Count the openings of the vent in repeats of the slide test, with one caliper and with four."""
    settings = ("none", "full", "thermal")
    cases = {name: stop_runner.cases("slide-80", {"rig.compensation": name})[0] for name in settings}
    cases[FOUR_CALIPER] = stop_runner.cases("slide-80-four-caliper")[0]
    repeats = stop_runner.repeated(list(cases.values()), SEEDS)
    counted = counts({name: each.stops for name, each in zip(cases, repeats, strict=True)})
    recordings = dict(zip(cases, stop_runner.recordings(list(cases.values())), strict=True))
    panels = [
        ActuationPanel(TITLES[key], recordings[COUNTED[key][0]], COUNTED[key][1], colour)
        for key, colour in _DRAWN.items()
    ]
    columns = {key: values.tolist() for key, values in counted.items()}
    return StudyFindings(
        {key: spread(values) for key, values in columns.items()},
        tables={"actuations": {"seed": list(SEEDS), **columns}},
        drawings={"valve-actuations": partial(draw, panels)},
        notes=(
            f"{repeats_note(len(SEEDS))} The figure shows the first.",
            "Cycling amplifies small differences: one stop says little.",
        ),
    )


STUDY = Study(
    "valve-actuations",
    "WSP valve actuations in one slide test from 80 km/h",
    "11 (module 1, real caliper), 21 (module 2 without both models), 11 (module 2 with both)",
    tuple(_quantities()),
    run,
    position=80,
)

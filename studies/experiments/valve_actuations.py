"""Valve actuations of the WSP in one slide test, by the origin of the module's clamping force."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from studies.drawing import SETTING_COLOURS, WIDTH, from_zero
from studies.neighbourhood import BANDS, COUNTED, FOUR_CALIPER, PAPER, counts
from studies.quantity import NOT_ASKED, OwnBand, Status, StudyQuantity, repeats_note, spread
from studies.replay import VENT
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings
from uictest import Recording
from uictest.units import BAR

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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


@dataclass(frozen=True, slots=True)
class ActuationPanel:
    """One module of one stop, in the colour of a setting of the compensation."""

    title: str
    recording: Recording
    module: int
    setting: str


def draw(panels: Sequence[ActuationPanel], figure: Figure) -> None:
    """Draw the panels one below the other; a tick below the pressure marks each opening of the vent."""
    figure.set_size_inches(WIDTH, 1.55 * len(panels) + 0.3)
    all_axes = figure.subplots(len(panels), 1, sharex=True, sharey=True)
    for axes, panel in zip(all_axes, panels, strict=True):
        time, colour = panel.recording["time"], SETTING_COLOURS[panel.setting]
        axes.plot(time, panel.recording[f"tank_pressure_{panel.module}"] / BAR, color=colour)
        opened = openings(panel)
        axes.plot(
            time[opened], np.full(len(opened), 0.18), "|", color=colour, markersize=8, markeredgewidth=1.4
        )
        axes.set(title=f"{panel.title}: {len(opened)} actuations", ylabel="pressure, bar")
        from_zero(axes)
    all_axes[-1].set_xlabel("time, s")


def openings(panel: ActuationPanel) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return the samples at which the module is commanded to open its vent."""
    venting = panel.recording[f"valve_command_{panel.module}"] == VENT
    return np.flatnonzero(venting[1:] & ~venting[:-1]) + 1


STUDY = Study(
    "valve-actuations",
    "WSP valve actuations in one slide test from 80 km/h",
    "11 (module 1, real caliper), 21 (module 2 without both models), 11 (module 2 with both)",
    tuple(_quantities()),
    run,
    position=80,
)

"""The computed clamping force against that of the loadcells."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from studies.drawing import BAND, INK, SETTING_COLOURS, WIDTH, from_zero, title_and_legend
from studies.model_errors import force_channel, force_error, slide_replays
from studies.neighbourhood import SETTINGS
from studies.quantity import OwnBand, SourceBand, StudyQuantity, repeats_note, spread
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings, Table, samples
from uictest import Recording
from uictest.units import KILONEWTON, PERCENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SEEDS = range(5)
_EVERY = 20
_UNIT = "% of largest force"

LIMIT = 8.0
"""The paper's bound on the error of the computed force, % of the largest force."""

QUANTITIES = (
    StudyQuantity(
        "module_1",
        "largest error, from the pressure of module 1",
        _UNIT,
        "within +-8 % of the measured force",
        # The bench test of its lines was chosen while the errors of `thermal` were watched.
        status="selected",
        band=SourceBand(upper=LIMIT),
    ),
    StudyQuantity(
        "full",
        "largest error, from tank 2 by both models",
        _UNIT,
        "within +-8 % of the measured force",
        status="predicted",
        band=SourceBand(upper=LIMIT),
    ),
    StudyQuantity(
        "thermal",
        "largest error, from tank 2 by hysteresis and modelled air",
        _UNIT,
        "within +-8 % by both models",
        status="selected",
        band=OwnBand(upper=LIMIT, reason="ours, of the paper's claim"),
    ),
    *(
        StudyQuantity(setting, f"largest error, from tank 2 by {words}", _UNIT, status="predicted")
        for setting, words in (
            ("hysteresis", "the hysteresis alone"),
            ("cylinder", "the cylinder dynamics alone"),
            ("none", "a straight line"),
        )
    ),
)
CHANNELS = {"module_1": "computed_force_1"} | {setting: force_channel(setting) for setting in SETTINGS}
"""Channel of the bench that holds the computed force."""


def run(stop_runner: StopRunner) -> StudyFindings:
    """Replay the commands of module 1 in the slide test, and compute its force with each setting."""
    _, replays = slide_replays(stop_runner, SEEDS)
    return StudyFindings(
        {
            key: spread([force_error(recording, channel) for recording in replays])
            for key, channel in CHANNELS.items()
        },
        tables={"forces": _table(replays[0])},
        drawings={"force-accuracy": partial(draw, replays[0], LIMIT)},
        notes=(
            repeats_note(len(SEEDS)),
            "All forces are held against those of the loadcells under the same valve commands.",
        ),
    )


def _table(recording: Recording) -> Table:
    forces = (f"{channel}_kn" for channel in ("clamping_force_1", *CHANNELS.values()))
    return samples(recording, "time_s", *forces, every=_EVERY)


_CURVES = {"none": ("straight line", "-"), "full": ("both models", "--"), "thermal": ("modelled air", "-")}
"""Label and dashes of the force under each setting."""


def draw(recording: Recording, limit: float, figure: Figure) -> None:
    """Draw the force of the loadcells, and those computed from tank 2; `limit` is in % of the largest."""
    figure.set_size_inches(WIDTH, 4.4)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(1.3, 1.0))
    time, measured = recording["time"], recording["clamping_force_1"]
    above.plot(time, measured / KILONEWTON, color=INK, linewidth=1.6, label="measured")
    below.axhspan(-limit, limit, color=BAND, zorder=0)
    for setting, (label, dashes) in _CURVES.items():
        force, colour = recording[force_channel(setting)], SETTING_COLOURS[setting]
        above.plot(time, force / KILONEWTON, dashes, color=colour, linewidth=0.9, label=label)
        below.plot(time, (force - measured) / measured.max() / PERCENT, color=colour, linewidth=0.9)
    above.set(ylabel="clamping force, kN")
    below.set(
        title=f"Computed less measured (paper: within \N{PLUS-MINUS SIGN}{limit:g} %)",
        xlabel="time, s",
        ylabel="% of largest force",
    )
    title_and_legend(above, "Clamping force under the same valve commands", 4)
    from_zero(above)


STUDY = Study(
    "force-accuracy",
    "Computed against measured clamping force",
    "the force computed with both models lies within +-8 % of the measured one",
    QUANTITIES,
    run,
    position=40,
)

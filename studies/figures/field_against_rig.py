"""The closest stop of each family beside the four figures of the real train, and one stop over time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from studies.field.real_train import REAL_TRAIN, TOLERANCES, FieldStop
from studies.figures.style import BAND, BLUE, INK, MUTED, ORANGE, WHEELSETS, WIDTH, from_zero
from uictest import Recording
from uictest.units import KILOMETRE_PER_HOUR

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_TITLES = {
    "braking_time": "time, s",
    "braking_distance": "distance, m",
    "minimum_deceleration": "least\ndeceleration, m/s²",
    "maximum_deceleration": "greatest\ndeceleration, m/s²",
}


def draw(closest: Mapping[str, FieldStop], shown: str, recording: Recording, figure: Figure) -> None:
    """Draw four figures for each family, and the speeds of one stop.

    Args:
        closest: the stop of each family, by its title.
        shown: the title of the family whose stop was recorded.
        recording: that stop.
        figure: an empty figure.
    """
    figure.set_size_inches(WIDTH, 5.6)
    halves: Any = figure.subfigures(2, 1, height_ratios=(1.15, 1.0))
    above, below = halves
    panels: Any = above.subplots(1, len(REAL_TRAIN), sharey=True)
    for axes, name in zip(panels, REAL_TRAIN, strict=True):
        _draw_figure(axes, name, list(closest.values()))
    panels[0].set_yticks(range(len(closest)), list(closest))
    panels[0].invert_yaxis()
    above.suptitle(
        "Closest stop of each family (blue: agrees in all four); line and band: real train and tolerance",
        x=0.0,
        ha="left",
        fontsize=8.5,
        fontweight="bold",
    )
    _draw_stop(below.subplots(), shown, recording)


def _draw_figure(axes: Axes, name: str, stops: list[FieldStop]) -> None:
    real, tolerance = REAL_TRAIN[name], TOLERANCES[name]
    axes.axvspan(real - tolerance, real + tolerance, color=BAND, linewidth=0.0)
    axes.axvline(real, color=MUTED, linewidth=0.9)
    colours = [BLUE if stop.agrees else ORANGE for stop in stops]
    axes.scatter([stop.figures[name] for stop in stops], range(len(stops)), s=20.0, c=colours, zorder=3)
    axes.set_xlabel(_TITLES[name])
    axes.margins(x=0.15)


def _draw_stop(axes: Axes, shown: str, recording: Recording) -> None:
    time = recording["time"]
    for n, colour in WHEELSETS.items():
        speed = recording[f"wheel_speed_{n}"] / KILOMETRE_PER_HOUR
        axes.plot(time, speed, color=colour, linewidth=0.8, label=f"wheelset {n}")
    axes.plot(time, recording["speed"] / KILOMETRE_PER_HOUR, color=INK, linewidth=1.5, label="train")
    stand = REAL_TRAIN["braking_time"]
    axes.axvspan(stand - TOLERANCES["braking_time"], stand + TOLERANCES["braking_time"], color=BAND)
    axes.axvline(stand, color=MUTED, linewidth=0.9, label="standstill of the real train")
    axes.set(
        title=f"Simplest stop that agrees: {shown}", xlabel="time since the command, s", ylabel="speed, km/h"
    )
    axes.legend(loc="lower left")
    from_zero(axes)

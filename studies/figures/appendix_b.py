"""The dry stop over distance, and the slip-brake test over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studies.figures.style import BAND, INK, MUTED, WHEELSETS, WIDTH, from_zero, title_and_legend
from uictest import Recording
from uictest.units import KILOMETRE_PER_HOUR, PERCENT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_END_SPEED = 60.0 * KILOMETRE_PER_HOUR
"""Train speed down to which sliding counts for the minimum slide; slides below it are not drawn."""
_SLIDES = 10.0
"""%: slide above which a wheelset counts as sliding; both are definitions of the profile."""


def draw(
    dry: Recording,
    slip: Recording,
    distances: tuple[float, float],
    figure: Figure,
) -> None:
    """Draw both stops with the limits of Appendix B for the distance, m."""
    figure.set_size_inches(WIDTH, 4.8)
    halves: Any = figure.subfigures(2, 1, height_ratios=(1.0, 1.9))
    _draw_dry(halves[0].subplots(), dry, distances)
    speeds, slides = halves[1].subplots(2, 1, sharex=True)
    _draw_slip(speeds, slides, slip)


def _draw_dry(axes: Axes, dry: Recording, distances: tuple[float, float]) -> None:
    axes.axvspan(*distances, color=BAND, zorder=0)
    axes.plot(dry["distance"], dry["speed"] / KILOMETRE_PER_HOUR, color=INK, linewidth=1.5)
    stop = float(dry["distance"][-1])
    axes.annotate(
        f"{stop:.0f} m",
        (stop, 0.0),
        (5.0, 9.0),
        textcoords="offset points",
        fontweight="bold",
    )
    axes.annotate(
        f"{distances[0]:g}\N{EN DASH}{distances[1]:g} m",
        (sum(distances) / 2.0, 0.97),
        xycoords=("data", "axes fraction"),
        ha="center",
        va="top",
        color=MUTED,
        fontsize=7.0,
    )
    axes.set(title="Dry stop, brake position R", xlabel="distance, m", ylabel="speed, km/h")
    axes.set_xlim(0.0, 520.0)
    from_zero(axes)


def _draw_slip(speeds: Axes, slides: Axes, slip: Recording) -> None:
    time = slip["time"]
    counted = slip["speed"] > _END_SPEED
    for n, colour in WHEELSETS.items():
        speed = slip[f"wheel_speed_{n}"] / KILOMETRE_PER_HOUR
        speeds.plot(time, speed, color=colour, linewidth=0.7, label=f"wheelset {n}")
        slide = slip[f"slide_{n}"][counted] / PERCENT
        slides.plot(time[counted], slide, color=colour, linewidth=0.7)
    speeds.plot(time, slip["speed"] / KILOMETRE_PER_HOUR, color=INK, linewidth=1.5, label="train")
    slides.axhline(_SLIDES, color=MUTED, linewidth=0.9, linestyle=(0, (4, 2)))
    slides.annotate(
        f"{_SLIDES:g} %",
        (1.0, _SLIDES),
        (2.0, 0.0),
        xycoords=("axes fraction", "data"),
        textcoords="offset points",
        va="center",
        color=MUTED,
        fontsize=7.0,
        annotation_clip=False,
    )
    speeds.set(ylabel="speed, km/h")
    slides.set(
        title="Slide down to 60 km/h; above the line a wheelset counts as sliding",
        xlabel="time, s",
        ylabel="slide, %",
    )
    title_and_legend(speeds, "Slip-brake test", 5)
    from_zero(speeds)
    from_zero(slides)

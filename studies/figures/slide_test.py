"""Speeds of train and wheelsets, and the pressures of the four modules, over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studies.figures.style import INK, MUTED, WHEELSETS, WIDTH, from_zero, title_and_legend
from uictest import Recording
from uictest.units import BAR, KILOMETRE_PER_HOUR

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw(recording: Recording, real_train: float, figure: Figure) -> None:
    """Draw one stop, and a mark at the braking time of the real train, s."""
    figure.set_size_inches(WIDTH, 4.6)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(1.5, 1.0))
    time = recording["time"]
    for n, colour in WHEELSETS.items():
        speed = recording[f"wheel_speed_{n}"] / KILOMETRE_PER_HOUR
        above.plot(time, speed, color=colour, linewidth=0.9, label=f"wheelset {n}")
        below.plot(time, recording[f"tank_pressure_{n}"] / BAR, color=colour, linewidth=0.9)
    above.plot(time, recording["speed"] / KILOMETRE_PER_HOUR, color=INK, linewidth=1.5, label="train")
    above.plot([real_train] * 2, [0.0, 30.0], color=MUTED, linewidth=0.9, linestyle=(0, (2, 2)))
    above.text(real_train, 31.5, f"real train: {real_train:g} s", ha="center", color=MUTED, fontsize=7.0)
    above.set(ylabel="speed, km/h")
    below.set(title="Pressure of the four modules", xlabel="time, s", ylabel="pressure, bar")
    title_and_legend(above, "Speed of train and wheelsets", 5)
    from_zero(above)
    from_zero(below)

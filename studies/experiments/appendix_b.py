"""The limits of UIC 541-05 Appendix B: a dry stop and a slip-brake test from 120 km/h."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from studies.drawing import BAND, INK, MUTED, WHEELSET_COLOURS, WIDTH, from_zero, title_and_legend
from studies.quantity import NOT_ASKED, OwnBand, SourceBand, StudyQuantity, StudyValue, spread
from studies.stop_runner import StopRunner, verdict_value
from studies.study import Study, StudyFindings, Table, samples
from uictest import Recording
from uictest.units import KILOMETRE_PER_HOUR, PERCENT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SEEDS = range(5)

DISTANCES = (440.0, 490.0)
SLIDE = 35.0

QUANTITIES = (
    StudyQuantity(
        "braking_distance",
        "braking distance, position R, dry",
        "m",
        "440-490 m",
        status="calibrated",
        band=SourceBand(lower=DISTANCES[0], upper=DISTANCES[1]),
    ),
    StudyQuantity(
        "off_the_middle",
        "its distance from the middle of the band",
        "m",
        NOT_ASKED,
        status="calibrated",
        band=OwnBand(upper=15.0, reason="ours: near the middle"),
    ),
    StudyQuantity(
        "initial_adhesion",
        "deceleration in the first phase of the slip-brake test",
        "g",
        "below 0.08 g",
        status="calibrated",
        band=SourceBand(upper=0.08, below=True),
        digits=4,
    ),
    StudyQuantity(
        "minimum_slide",
        "minimum slide: time down to 60 km/h in which half of the wheelsets slide",
        "%",
        "above 35 %",
        # The depth of the same slides was a target of the calibration.
        status="calibrated",
        band=SourceBand(lower=SLIDE, above=True),
    ),
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Judge both stops with the shipped profile of Appendix B."""
    (dry,) = stop_runner.cases("dry-120")
    (slip,) = stop_runner.cases("slip-120")
    (once,) = stop_runner.repeated([dry], [0])
    (repeats,) = stop_runner.repeated([slip], SEEDS)
    distance = verdict_value(once.stops[0], "braking-distance")
    adhesion, slide = (
        spread([verdict_value(stop, criterion) for stop in repeats.stops])
        for criterion in ("initial-adhesion", "minimum-slide")
    )
    dry_stop, slip_stop = stop_runner.recordings([dry, slip])
    return StudyFindings(
        {
            "braking_distance": StudyValue(distance),
            "off_the_middle": StudyValue(abs(distance - sum(DISTANCES) / 2.0)),
            "initial_adhesion": adhesion,
            "minimum_slide": slide,
        },
        tables={"dry-stop": _table(dry_stop), "slip-brake-test": _table(slip_stop)},
        drawings={"appendix-b": partial(draw, dry_stop, slip_stop, DISTANCES)},
        notes=(
            (
                "The leaflet itself was not available: what the first phase is, and that the minimum slide "
                "is a share of time (inferred from TB/T 3009-2019), are readings of the profile "
                "uic-541-05-appendix-b."
            ),
            (
                "The calibration asked for the depth of the slides of this stop, with which their share of "
                "time grows: no prediction."
            ),
            f"Slip-brake test: {len(SEEDS)} stops that differ in the noise of the sensors, median and range.",
        ),
    )


def _table(recording: Recording) -> Table:
    of_wheelsets = (name for n in (1, 2, 3, 4) for name in (f"wheel_speed_{n}_kmh", f"slide_{n}"))
    return samples(recording, "time_s", "distance_m", "speed_kmh", *of_wheelsets)


_END_SPEED = 60.0 * KILOMETRE_PER_HOUR
"""Train speed down to which sliding counts for the minimum slide; slides below it are not drawn."""
_SLIDING = 10.0
"""%: slide above which a wheelset counts as sliding; both are definitions of the profile."""


def draw(dry: Recording, slip: Recording, distances: tuple[float, float], figure: Figure) -> None:
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
    axes.annotate(f"{stop:.0f} m", (stop, 0.0), (5.0, 9.0), textcoords="offset points", fontweight="bold")
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
    for n, colour in WHEELSET_COLOURS.items():
        speed = slip[f"wheel_speed_{n}"] / KILOMETRE_PER_HOUR
        speeds.plot(time, speed, color=colour, linewidth=0.7, label=f"wheelset {n}")
        slide = slip[f"slide_{n}"][counted] / PERCENT
        slides.plot(time[counted], slide, color=colour, linewidth=0.7)
    speeds.plot(time, slip["speed"] / KILOMETRE_PER_HOUR, color=INK, linewidth=1.5, label="train")
    slides.axhline(_SLIDING, color=MUTED, linewidth=0.9, linestyle=(0, (4, 2)))
    slides.annotate(
        f"{_SLIDING:g} %",
        (1.0, _SLIDING),
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


STUDY = Study(
    "appendix-b",
    "UIC 541-05 Appendix B: dry stop and slip-brake test from 120 km/h",
    "below 0.08 g in the first phase, minimum slide above 35 % on at least half of the wheelsets, 440-490 m",
    QUANTITIES,
    run,
    position=90,
)

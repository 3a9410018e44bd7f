"""Repeat the real train's stop under what the paper leaves open: rail, cleaning, brake, start of clock."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from studies.drawing import BAND, BLUE, INK, MUTED, ORANGE, WHEELSET_COLOURS, WIDTH, from_zero, heading
from studies.field.assumptions import FAMILIES, REAL_TRAIN, TOLERANCES, FieldStop
from studies.field.field_rig import FieldRig
from studies.field.search import Trial, closest, one_at_a_time, search
from studies.field.tables import families_table, notes, simplest, singles_table, stop_table, trials_table
from studies.quantity import NOT_ASKED, OwnBand, Status, StudyQuantity, StudyValue
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings
from uictest import Recording
from uictest.units import KILOMETRE_PER_HOUR

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SEEDS = range(10)
"""Under which the closest stop of each family is repeated."""
_SHOWN = (
    ("braking_time", "braking time of the simplest stop that agrees", "s", "17.6 s", 1),
    ("braking_distance", "its braking distance", "m", "197 m", 1),
    ("minimum_deceleration", "its least deceleration", "m/s2", "0.98 m/s2", 2),
    ("maximum_deceleration", "its greatest deceleration", "m/s2", "1.52 m/s2", 2),
)
_COUNTED: tuple[tuple[str, str, Status], ...] = (
    ("tried", "stops tried", "by construction"),
    ("agreeing", "stops that agree in all four figures", "selected"),
    ("agreeing_in_run", "stops that agree in time and distance", "selected"),
)
"""The search tries more stops near those that agree: how many do is its own doing."""

QUANTITIES = (
    *(
        StudyQuantity(
            name,
            title,
            unit,
            paper,
            status="selected",
            band=OwnBand(
                lower=round(REAL_TRAIN[name] - TOLERANCES[name], 3),
                upper=round(REAL_TRAIN[name] + TOLERANCES[name], 3),
                reason="ours: the tolerance of the search",
            ),
            digits=digits,
        )
        for name, title, unit, paper, digits in _SHOWN
    ),
    StudyQuantity(
        "actuations",
        "its actuations of a WSP valve, median",
        paper="11, 21, 11 on its rig",
        status="selected",
        digits=0,
    ),
    *(
        StudyQuantity(
            f"misfit_{family.name}",
            f"least misfit, {family.title}",
            "tolerances",
            NOT_ASKED,
            status="selected",
            digits=2,
        )
        for family in FAMILIES
    ),
    *(
        StudyQuantity(name, title, paper=NOT_ASKED, status=status, digits=0)
        for name, title, status in _COUNTED
    ),
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Search every family of assumptions, and add single assumptions to the plainest ones."""
    field_rig = FieldRig(stop_runner)
    trials = search(field_rig)
    best = [closest([trial for trial in trials if trial.family is family]) for family in FAMILIES]
    base, singles = one_at_a_time(field_rig)
    shown = simplest(best)
    recording = field_rig.recording(shown.assumptions)
    return StudyFindings(
        _values(trials, best, shown.stop),
        tables={
            "stops": trials_table(trials),
            "families": families_table(trials, best, _agreements(field_rig, best)),
            "single-assumptions": singles_table(base, singles),
            "simplest-stop": stop_table(recording),
        },
        drawings={
            "field-against-rig": partial(
                draw, {trial.family.title: trial.stop for trial in best}, shown.family.title, recording
            )
        },
        notes=tuple(notes(trials, best, base, singles)),
    )


def _agreements(field_rig: FieldRig, trials: Sequence[Trial]) -> list[int]:
    """Return how many repeats of each stop agree, which differ in the noise of the sensors."""
    assumed = [trial.assumptions for trial in trials]
    repeats = [field_rig.stops(assumed, seed) for seed in SEEDS]
    return [sum(stop.agrees for stop in stops) for stops in zip(*repeats, strict=True)]


def _values(trials: Sequence[Trial], best: Sequence[Trial], shown: FieldStop) -> dict[str, StudyValue]:
    counts = sorted(shown.actuations)
    numbers = {
        "tried": len(trials),
        "agreeing": sum(trial.stop.agrees for trial in trials),
        "agreeing_in_run": sum(trial.stop.agrees_in_run for trial in trials),
    }
    return {
        **{name: StudyValue(figure) for name, figure in shown.figures.items()},
        "actuations": StudyValue((counts[1] + counts[2]) / 2.0, counts[0], counts[-1]),
        **{f"misfit_{trial.family.name}": StudyValue(trial.stop.misfit) for trial in best},
        **{name: StudyValue(float(number)) for name, number in numbers.items()},
    }


_AXES = {
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
    heading(
        above,
        "Closest stop of each family (blue: agrees in all four); line and band: real train and tolerance",
    )
    _draw_stop(below.subplots(), shown, recording)


def _draw_figure(axes: Axes, name: str, stops: list[FieldStop]) -> None:
    real, tolerance = REAL_TRAIN[name], TOLERANCES[name]
    axes.axvspan(real - tolerance, real + tolerance, color=BAND, linewidth=0.0)
    axes.axvline(real, color=MUTED, linewidth=0.9)
    colours = [BLUE if stop.agrees else ORANGE for stop in stops]
    axes.scatter([stop.figures[name] for stop in stops], range(len(stops)), s=20.0, c=colours, zorder=3)
    axes.set_xlabel(_AXES[name])
    axes.margins(x=0.15)


def _draw_stop(axes: Axes, shown: str, recording: Recording) -> None:
    time = recording["time"]
    for n, colour in WHEELSET_COLOURS.items():
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


STUDY = Study(
    "field-against-rig",
    "Field against rig: what must be assumed for a stop like the real train's from 80 km/h",
    "the real train took 17.6 s and 197 m at 0.98-1.52 m/s2; its rail is not described",
    QUANTITIES,
    run,
    position=120,
)

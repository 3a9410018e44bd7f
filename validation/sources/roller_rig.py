"""What a full-scale roller rig found of wet adhesion, beside what a law of the cleaned rail gives."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from studies.stop_runner import StopRunner
from uictest.core.physics import share_left_behind
from uictest.units import KILOMETRE_PER_HOUR
from validation.cleaned_rail import Adhesion, adhesion_of
from validation.half_space import Array
from validation.source import Comparison, Findings, Source

LAWS: Final = ("wet-cleaning", "wet-curves")
"""Rails of the library that change as wheels slide."""
FITTED: Final = ("wet-curves",)
"""Those whose numbers were set by the creepages of these peaks and by the height of the second."""


@dataclass(frozen=True, slots=True)
class Point:
    """Friction of the contaminated rail before anything slid, and speed in km/h."""

    friction: float
    speed: int


SET_AT: Final = Point(0.08, 120)
"""Those of the slip-brake test of the library, at which `wet-curves` was set."""
HELD_OUT: Final = (Point(0.05, 60), Point(0.12, 200))
"""Of `wet-curves` alone: chosen on both sides, as the abstracts name neither."""
PASSES = (1, 20)
"""Wheels that pass a place at one creepage: a roller meets the same place again and again."""
CREEPAGES: Final = np.geomspace(0.001, 0.5, 250)
_SETTLED = 1e-9
"""Change of the cleaned share between two rounds that ends them."""


@dataclass(frozen=True, slots=True)
class CreepCurve:
    """Adhesion F/Q at every creepage, while creepage rises and while it falls again."""

    loading: Array
    unloading: Array

    @property
    def first_peak(self) -> int:
        """Index of the first peak; the last one where adhesion only rises."""
        falls = np.flatnonzero(np.diff(self.loading) < 0.0)
        return int(falls[0]) if falls.size else len(CREEPAGES) - 1

    @property
    def turn(self) -> int | None:
        """Index at which adhesion rises again behind the first peak; None where it does not."""
        rises = np.flatnonzero(np.diff(self.loading[self.first_peak :]) > 0.0)
        return self.first_peak + int(rises[0]) if rises.size else None


def creep_curve(rail: Any, point: Point, passes: int) -> CreepCurve:
    """Return the creep curve of a rail that sliding changes and that has settled at each creepage."""
    load, cleaning = float(rail.contact.reference_wheel_load), rail.cleaning
    adhesion = adhesion_of(rail, point.speed * KILOMETRE_PER_HOUR, load, point.friction)
    # Both wheels of the wheelset clean, and the loss per metre is force times creepage.
    response, carry_over = 2.0 * load * cleaning.response, float(cleaning.carry_over)
    found, share = [], 0.0
    for creepage in (*CREEPAGES.tolist(), *CREEPAGES[::-1].tolist()):
        force, share = _settled(adhesion, creepage, response, (carry_over, passes), share)
        found.append(force)
    rising, falling = np.split(np.array(found), 2)
    return CreepCurve(rising, falling[::-1])


def _settled(
    adhesion: Adhesion, creepage: float, response: float, behind: tuple[float, int], share: float
) -> tuple[float, float]:
    """Return F/Q and the cleaned share of the rail, from the share at the creepage before."""
    carry_over, passes = behind
    while True:
        found = adhesion(creepage, share)
        own, share_now = 1.0 - math.exp(-found * creepage * response), 0.0
        for _ in range(passes):
            share_now = share_left_behind(own, share_now, carry_over)
        if abs(share_now - share) < _SETTLED:
            return found, share_now
        share = share_now


def run(stop_runner: StopRunner) -> Findings:
    """Compare every law after one pass and after many; what no law holds is a row of its own."""
    points = [(name, SET_AT) for name in LAWS] + [(name, point) for name in FITTED for point in HELD_OUT]
    return Findings(
        [*(each for point in points for each in _of_law(stop_runner, *point)), *_not_modelled()],
        notes=(
            (
                f"Friction as found {SET_AT.friction:g}, {SET_AT.speed} km/h where nothing else is said; the "
                "contact and the load of the library; each creepage is held until the rail under the wheel "
                "has settled. Speed, load and friction of the rig are not in the abstracts."
            ),
        ),
    )


def _of_law(stop_runner: StopRunner, name: str, point: Point) -> Iterator[Comparison]:
    changes = {"rail.condition": name, "rail.friction": f"{point.friction}"}
    rail = stop_runner.cases("slip-120", changes)[0].scenario.rail.condition
    fitted = name in FITTED and point == SET_AT
    at = "" if point == SET_AT else f" at {point.friction:g} and {point.speed} km/h"
    for passes in PASSES:
        curve = creep_curve(rail, point, passes)
        turn, label = curve.turn, f"{name}{at}, {passes} {'pass' if passes == 1 else 'passes'}"
        second = None if turn is None else float(curve.loading[turn:].max())
        first = float(curve.loading[curve.first_peak])
        yield Comparison(
            f"creepage from which adhesion falls, {label}",
            "%",
            0.5,
            100.0 * float(CREEPAGES[curve.first_peak]),
            fitted=fitted,
            digits=1,
        )
        yield Comparison(
            f"creepage of least adhesion, {label}",
            "%",
            (5.0, 8.0),
            None if turn is None else 100.0 * float(CREEPAGES[turn]),
            fitted=fitted,
            digits=1,
        )
        yield Comparison(
            f"second peak over the first, {label}",
            "",
            (2.0, 3.0),
            None if second is None else second / first,
            fitted=fitted,
            digits=2,
        )
        yield Comparison(
            f"peak on unloading over the second, {label}",
            "",
            2.0,
            None if second is None else float(curve.unloading.max()) / second,
            digits=2,
        )


def _not_modelled() -> Iterator[Comparison]:
    yield Comparison("fall of adhesion with water at 0 °C", "%", (11.0, 15.0), None)
    yield Comparison("water above which adhesion falls no further", "mL/min", 200.0, None)


SOURCE = Source(
    name="roller-rig",
    title="Wet adhesion on a full-scale roller rig",
    place="China Railway Science 2019(2), 2022(2) and 2024(6): abstracts alone, read second-hand",
    kind="second-hand",
    fitted=(
        "Of `wet-cleaning` nothing: its numbers are chosen. Of `wet-curves` all numbers of both curves, the"
        " energy and the friction of the clean rail, together, by both creepages and the second peak, at 0.08"
        " and 120 km/h"
    ),
    shows="Which of the found effects a law of the cleaned rail has at all, and where it lies.",
    does_not_show=(
        "How well a law fits the rig: curves, water, speed and load of the rig are not in the abstracts."
    ),
    run=run,
)

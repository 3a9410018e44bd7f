"""The stops of RSSB T1107 on the rig: four coupled cars with WSP, on sand by the law of the point train.

Nothing is fitted here: the law is handed over, and so are the sanders. What differs is the train: brakes that
build up, wheels that slide, a WSP, and the creep curve of a wet rail.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from studies.quantity import SourceBand, StudyQuantity, StudyValue, spread
from studies.sanded_train import Sander, SandLaw
from studies.stop_runner import StopRunner, seeded
from studies.study import Table
from uictest.rig import Coupling, run_coupled

SEEDS = range(2)
"""Of the sensors' noise; it moves a distance by less than 1 %."""
_CARS: Final = 4
_COUPLED: Final = Coupling(26.4)
"""The usual length of a coach over its buffers; chosen, as in the study `train`."""
_COMMAND: Final = "76.5 %"
"""Share of full service with which the car brakes by 0.9 m/s2 on a dry rail."""
CURVES: Final[Mapping[str, Mapping[str, str]]] = {
    "flat": {"rail.condition.friction_decay": "0 s/m"},
    "wet": {},
}
"""Friction that does not fall with slip, as in the point train; the wet rail that ships."""
TITLES: Final = {"flat": "friction that slip does not lower", "wet": "the shipped wet rail"}
_DENSITIES: Final = (0, 0.5, 1, 1.5, 2, 3, 4, 5, 6, 7, 8, 10, 12, 16, 24, 40)
"""g/m, of the points of the law."""
_OFF: Final = "when: always, delay: 0 s, off_below: 0 km/h"
"""All sanders work from the brake command to standstill, as in the point train."""


@dataclass(frozen=True, slots=True)
class RigStops:
    """Distances in m of the train, one per seed, by curve and arrangement of sanders."""

    distances: Mapping[tuple[str, str], Sequence[float]]

    def value(self, curve: str, name: str) -> StudyValue:
        """Return the mean distance with its range."""
        return spread(list(self.distances[curve, name]))


def rig_quantities(published: Mapping[str, float], bound: float) -> Iterator[StudyQuantity]:
    """Yield a distance for every curve and arrangement; `bound` is that of the untreated stop, m."""
    for curve, title in TITLES.items():
        yield StudyQuantity(
            f"rig_{curve}_untreated",
            f"distance on the rig without sand, {title}",
            "m",
            f"not asked; RSSB T1107: more than {bound:.0f} m",
            status="by construction",
            band=SourceBand(lower=bound, above=True, reason="RSSB T1107"),
            digits=0,
        )
        for name, distance in published.items():
            yield StudyQuantity(
                f"rig_{curve}_{name}",
                f"distance on the rig, {name.replace('_', ' ')}, {title}",
                "m",
                f"not asked; RSSB T1107: {distance:.0f} m",
                status="selected",
                digits=0,
            )


def stops_on_rig(
    stop_runner: StopRunner,
    speed: float,
    law: SandLaw,
    kept: float,
    arrangements: Mapping[str, Sequence[Sander]],
) -> RigStops:
    """Stop the train with every arrangement of sanders on both curves.

    Args:
        stop_runner: loads the cases and maps over threads.
        speed: initial, m/s.
        law: adhesion over density.
        kept: kappa.
        arrangements: sanders by name, axles counted from 1 through the train.
    """
    common = {
        "initial_speed": f"{speed:.6g} m/s",
        "brake.command": _COMMAND,
        "rail.friction": str(law.untreated),
        "rail.sand": _sand(law, kept),
        "rig.compensation": "thermal",
    }
    distances = {}
    for curve, changes in CURVES.items():
        for name, sanders in {"untreated": (), **arrangements}.items():
            cars = [
                stop_runner.cases("slip-120", {**common, **changes, "sanders": _of_car(sanders, car)})[0]
                for car in range(_CARS)
            ]
            trains = [[seeded(car, seed) for car in cars] for seed in SEEDS]
            stops = stop_runner.map(partial(run_coupled, coupling=_COUPLED), trains)
            distances[curve, name] = [float(stop.cars[0].measures.end_distance) for stop in stops]
    return RigStops(distances)


def _sand(law: SandLaw, kept: float) -> str:
    shares = (law.adhesion(np.array(_DENSITIES)) - law.untreated) / (law.end - law.untreated)
    points = ", ".join(
        f"{{density: {density} g/m, share: {share:.6f}}}"
        for density, share in zip(_DENSITIES, shares, strict=True)
    )
    return f"{{friction: {law.end:.6f}, kept: {kept}, points: [{points}]}}"


def _of_car(sanders: Sequence[Sander], car: int) -> str:
    own = [sander for sander in sanders if (sander.axle - 1) // 4 == car]
    return f"[{', '.join(map(_written, own))}]"


def _written(sander: Sander) -> str:
    aim = "" if np.isinf(sander.density) else f"density: {sander.density} g/m, "
    wheelset, rate = (sander.axle - 1) % 4 + 1, sander.rate * 60 / 1000
    return f"{{wheelset: {wheelset}, {aim}rate: {rate:.6g} kg/min, {_OFF}}}"


def rig_table(stops: RigStops, of_points: Mapping[str, float]) -> Table:
    """Return every stop beside that of the point train."""
    rows = [
        (curve, name, seed, distance)
        for (curve, name), distances in stops.distances.items()
        for seed, distance in zip(SEEDS, distances, strict=True)
    ]
    return {
        "curve": [curve for curve, *_ in rows],
        "sanders": [name for _, name, *_ in rows],
        "seed": [seed for *_, seed, _ in rows],
        "distance_m": [round(distance, 1) for *_, distance in rows],
        "point_train_m": [round(of_points[name], 1) for _, name, *_ in rows],
    }


def rig_notes(stops: RigStops, published: Mapping[str, float]) -> Iterator[str]:
    """Yield how far the rig is from the published distances."""
    for curve, title in TITLES.items():
        errors = ", ".join(
            f"{name.replace('_', ' ')} {100.0 * (stops.value(curve, name).value / distance - 1.0):+.0f} %"
            for name, distance in published.items()
        )
        yield f"On the rig (four coupled cars, WSP, {_COMMAND} of full service), {title}: {errors}."

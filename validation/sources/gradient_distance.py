"""Design distances of two passenger trains and a freight train over speed and gradient."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from studies.stop_runner import StopRunner, measured
from validation.source import Comparison, Findings, Source, agreement

LEVEL: Final = 0
"""Stands for a level track; other gradients are one in so many, falling below zero."""


@dataclass(frozen=True, slots=True)
class TabulatedTrain:
    """Distances of a train, m, by speed in km/h and gradient, and the brake that stands for its own."""

    title: str
    brake: str
    position: str
    fitted_at: int
    distances: Mapping[int, Mapping[int, float]]


TRAINS: Final = (
    TabulatedTrain(
        "MSP 120",
        "ep-disc",
        "R",
        120,
        {
            120: {-33: 1685, -60: 1211, -100: 1066, LEVEL: 904, 100: 786, 60: 723, 33: 623},
            80: {-33: 730, -60: 531, LEVEL: 400, 60: 323, 33: 279},
            40: {-33: 166, -60: 126, LEVEL: 98, 60: 81, 33: 71},
        },
    ),
    TabulatedTrain(
        "HSP 160",
        "ep-disc",
        "R",
        150,
        {
            150: {-33: 2378, -60: 1774, -100: 1580, LEVEL: 1361, 100: 1197, 60: 1110, 33: 967},
            80: {-33: 579, -60: 456, LEVEL: 366, 60: 308, 33: 274},
            40: {-33: 147, -60: 120, LEVEL: 99, 60: 85, 33: 77},
        },
    ),
    TabulatedTrain(
        "GW 16",
        "distributor",
        "G",
        110,
        {
            110: {-33: 3414, -60: 2124, -100: 1792, LEVEL: 1449, 100: 1214, 60: 1095, 33: 910},
            80: {-33: 1802, -60: 1181, LEVEL: 823, 60: 624, 33: 516},
            40: {-33: 592, -60: 394, LEVEL: 268, 60: 193, 33: 153},
        },
    ),
)
_PAD_LAW = "composite-block"
"""A pad of the library whose friction rises as speed falls; its numbers are recalled, none is fitted."""
_PRECISION = 0.05
"""Of the fitted distance, m."""
_FRICTIONS = (0.10, 0.38)
"""Pad friction between which the level distance is searched; the upper end is the library's."""


class _BrakedCar:
    """The car of the library on a dry rail, with the brake that stands for a train and one of the pads."""

    def __init__(self, stop_runner: StopRunner, train: TabulatedTrain, pad: str = "constant") -> None:
        self._runner = stop_runner
        self._brake = {"brake.system": train.brake, "brake.position": train.position, "brake.pad": pad}

    def distances(self, friction: float, speed: int, gradients: Sequence[int]) -> list[float]:
        """Return the distance of a stop, m, on every gradient."""
        changes = {
            "initial_speed": f"{speed} km/h",
            "rail.gradient": [f"{1000.0 / each if each else 0.0:.6f} permille" for each in gradients],
            "rig.topology": "four-caliper",
            "simulation.maximum_duration": "600 s",
            **self._brake,
            "brake.system.disc.pad_friction": f"{friction:.9f}",
        }
        cases = self._runner.cases("dry-120", changes)
        repeats = self._runner.repeated(cases, range(1))
        return [measured(each.stops[0], "braking_distance_m") for each in repeats]

    def friction_for(self, distance: float, speed: int) -> float:
        """Return the pad friction with which a stop on level track takes a distance, by regula falsi."""
        low, high = _FRICTIONS
        errors = {each: self.distances(each, speed, [LEVEL])[0] - distance for each in _FRICTIONS}
        while True:
            # In 1/friction, in which the distance is nearly a straight line.
            share = errors[low] / (errors[low] - errors[high])
            friction = 1.0 / (1.0 / low + share * (1.0 / high - 1.0 / low))
            error = self.distances(friction, speed, [LEVEL])[0] - distance
            if abs(error) <= _PRECISION:
                return friction
            low, high = (friction, high) if error > 0.0 else (low, friction)
            errors[friction] = error


def run(stop_runner: StopRunner) -> Findings:
    """Fit the pad friction of each train to one level distance, and compare all its distances."""
    comparisons: list[Comparison] = []
    notes = []
    for train in TRAINS:
        friction, of_speed = _fitted(_BrakedCar(stop_runner, train), train)
        _, with_law = _fitted(_BrakedCar(stop_runner, train, _PAD_LAW), train)
        comparisons += (each for of_one in of_speed.values() for each in of_one)
        notes.append(
            f"{train.title}: pad friction {friction:.3f}, position {train.position} of `{train.brake}`. "
            f"Bias {_biases(of_speed)}; with the pad `{_PAD_LAW}`, fitted in the same way, "
            f"{_biases(with_law)}."
        )
    return Findings(comparisons, notes)


def _fitted(car: _BrakedCar, train: TabulatedTrain) -> tuple[float, dict[int, list[Comparison]]]:
    """Return the friction that meets the level distance, and the comparisons of every speed."""
    friction = car.friction_for(train.distances[train.fitted_at][LEVEL], train.fitted_at)
    return friction, {speed: list(_comparisons(car, train, friction, speed)) for speed in train.distances}


def _biases(of_speed: Mapping[int, Sequence[Comparison]]) -> str:
    return ", ".join(f"{_bias(of_one):+.1f} % from {speed} km/h" for speed, of_one in of_speed.items())


def _bias(comparisons: Sequence[Comparison]) -> float:
    bias = agreement([each for each in comparisons if not each.fitted]).bias
    assert bias is not None  # every distance has a number
    return bias


def _comparisons(car: _BrakedCar, train: TabulatedTrain, friction: float, speed: int) -> Iterator[Comparison]:
    distances = train.distances[speed]
    ours = car.distances(friction, speed, list(distances))
    for (gradient, distance), here in zip(distances.items(), ours, strict=True):
        place = f"{'falling' if gradient < 0 else 'rising'} 1:{abs(gradient)}" if gradient else "level"
        fitted = (gradient, speed) == (LEVEL, train.fitted_at)
        yield Comparison(f"{train.title}, {speed} km/h, {place}", "m", distance, here, fitted)


SOURCE = Source(
    name="gradient-distance",
    title="Stopping distances over speed and gradient",
    place=(
        "ARTC, Train Braking Application Design ESD-05-03, brake tables, as digitised in "
        "github.com/rafidmorshedi/train-brake-curves, revision 98a22cf8, `ESD-05-03_brake_tables.xlsx`: "
        "MSP 120, a self-propelled passenger train, HSP 160, the XPT, and GW 16, a freight train of 680 "
        "m; 51 of 2 250 distances"
    ),
    kind="tabulated",
    fitted=(
        "Pad friction, one number a train, to the level distance from 120, 150 and 110 km/h. Everything "
        "else is the car of the library: position R of `ep-disc`, which fills in 0.8 s, for the passenger "
        "trains, position G of `distributor`, 24 s, for the freight train; both chosen"
    ),
    shows=(
        "That gradient, running resistance and rotating masses enter a stop as they should: from the "
        "speed of the fit, and but for the freight train on steep falls, distances come out. And that one "
        "constant pad friction does not do at other speeds: the trains of the table brake harder when "
        "slow. A pad whose friction rises as speed falls comes nearer at most of them and goes too far at "
        "some."
    ),
    does_not_show=(
        "That a real train stops so: the table is for the design of signals, its margins and the friction "
        "behind it are not in the digitised copy. One car stands for each train, in which a command "
        "arrives everywhere at once; along 680 m it does not."
    ),
    run=run,
)

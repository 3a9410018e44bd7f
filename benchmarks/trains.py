"""Stops of coupled cars beside stops of as many single cars: `python benchmarks/trains.py [--cars 4]`.

Scalar, one train and its cars one by one, assembling included; and in lanes, many of both, assembled before.
The ratio is that of the times per simulated second of a car, since a train on a cleaned rail stops sooner
than its first car alone.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import machine
from timing import side_by_side

from uictest import rig
from uictest.plans.scenario import Case, load
from uictest.rig.train_stop import compiled_rig, run_to_end

SCENARIO = Path(__file__).parent.parent / "scenarios" / "cleaned-rail-120.yaml"
DISTANCE = 26.4
"""Between the centres of the cars, m; chosen."""
TRAINS = 16
"""In lanes; chosen: twice what the widest registers hold."""


def scalar(case: Case, cars: int, turns: int) -> None:
    """Time one train and its cars as single ones, and print the ratios."""
    cases, coupling = [case] * cars, rig.Coupling(DISTANCE)
    run = compiled_rig()

    def train() -> float:
        return sum(float(car.measures.end_time) for car in rig.run_coupled(cases, coupling).cars)

    def single() -> float:
        return sum(float(run_to_end(run, rig.assemble(each)).measures.end_time) for each in cases)

    compared = side_by_side(train, single, turns)
    print(f"scalar, per stop                        {compared.ratio:.2f}")
    print(f"scalar, per simulated second of a car   {compared.ratio * single() / train():.2f}")


def in_lanes(seeded: Sequence[Case], cars: int, turns: int) -> None:
    """Time trains and their cars as single ones in lanes; print the ratio and ns per wheelset and step."""
    trains = [rig.assemble_train([case] * cars, rig.Coupling(DISTANCE)) for case in seeded]
    inputs = [rig.assemble(case) for case in seeded for _ in range(cars)]
    singles = rig.stacked(inputs)

    def together() -> Any:
        return rig.run_trains_in_lanes(trains)

    def alone() -> Any:
        return rig.run_in_lanes(*singles)

    compared = side_by_side(together, alone, turns)
    step = float(singles[0]["step"][0])
    coupled = sum(4 * cars * float(stop.measures["end_time"].max()) for stop in together()) / step
    single = 4 * float(alone().measures["end_time"].sum()) / step
    print(f"lanes, per simulated second of a car    {compared.ratio * single / coupled:.3f}")
    ours, theirs = (1e9 * min(times) for times in (compared.ours, compared.theirs))
    print(f"lanes, ns per wheelset and step         {ours / coupled:.1f}; single cars {theirs / single:.1f}")


def main() -> None:
    """Time trains against single cars and print the ratios."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cars", type=int, default=4)
    parser.add_argument("--turns", type=int, default=15)
    arguments = parser.parse_args()
    (case, *_) = load([SCENARIO])
    print(machine.description("numpy"))
    print(f"{arguments.cars} coupled cars over as many single ones")
    scalar(case, arguments.cars, arguments.turns)
    seeded = [load([SCENARIO], [f"seed={seed}"])[0] for seed in range(TRAINS)]
    in_lanes(seeded, arguments.cars, arguments.turns)


if __name__ == "__main__":
    main()

"""A stop of coupled cars beside stops of as many single cars: `python benchmarks/trains.py [--cars 4]`.

Both step compiled scalar code, without traces. The ratio is that of the times per simulated second of a car,
since a train on a cleaned rail stops sooner than its first car alone.
"""

import argparse
from pathlib import Path

import machine
from timing import side_by_side

from uictest import rig
from uictest.plans.scenario import load
from uictest.rig.single_stop import run_to_end

SCENARIO = Path(__file__).parent.parent / "scenarios" / "cleaned-rail-120.yaml"
DISTANCE = 26.4
"""Between the centres of the cars, m; chosen."""


def main() -> None:
    """Time both and print the ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cars", type=int, default=4)
    parser.add_argument("--turns", type=int, default=15)
    arguments = parser.parse_args()
    (case, *_) = load([SCENARIO])
    cases, coupling = [case] * arguments.cars, rig.Coupling(DISTANCE)
    run = rig.compiled_stop()

    def train() -> float:
        return sum(float(car.measures.end_time) for car in rig.run_coupled(cases, coupling).cars)

    def single() -> float:
        return sum(float(run_to_end(run, rig.assemble(each)).measures.end_time) for each in cases)

    compared = side_by_side(train, single, arguments.turns)
    print(machine.description("numba", "llvmlite", "numpy"))
    print(f"{arguments.cars} coupled cars over as many single ones, assembling included")
    print(f"per stop                      {compared.ratio:.2f}")
    print(f"per simulated second of a car {compared.ratio * single() / train():.2f}")


if __name__ == "__main__":
    main()

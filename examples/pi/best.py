"""Print the best draws of tuning.sweep.yaml: the shortest stops that meet all criteria on all rails.

python best.py reports/pi-tuning/summary.csv
"""

import csv
import sys
from collections import defaultdict
from pathlib import Path
from statistics import mean, median

SWEPT = "parameters.controller.parameters."
Row = dict[str, str]


def main(path: str) -> None:
    with Path(path).open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    usual = medians(rows)
    draws = defaultdict(list)
    for row in rows:
        draws[tuple((key, value) for key, value in row.items() if key.startswith(SWEPT))].append(row)
    kept = {draw: own for draw, own in draws.items() if all(row["met"] == "true" for row in own)}
    print(f"{len(kept)} of {len(draws)} draws meet all criteria; distances relative to the usual ones:")
    for draw, own in sorted(kept.items(), key=lambda each: relative_distance(each[1], usual))[:5]:
        values = ", ".join(f"{key.removeprefix(SWEPT)}: {float(value):.3g}" for key, value in draw)
        print(f"{relative_distance(own, usual):.3f}  {values}")


def medians(rows: list[Row]) -> dict[str, float]:
    """Return the median of all distances on each rail."""
    distances = defaultdict(list)
    for row in rows:
        distances[row["parameters.rail.friction"]].append(float(row["braking_distance_m"]))
    return {friction: median(values) for friction, values in distances.items()}


def relative_distance(rows: list[Row], usual: dict[str, float]) -> float:
    """Return the mean distance of a draw over all rails, each relative to the usual one there."""
    ratios = [float(row["braking_distance_m"]) / usual[row["parameters.rail.friction"]] for row in rows]
    return mean(ratios)


if __name__ == "__main__":
    main(sys.argv[1])

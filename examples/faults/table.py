"""Print what faults do to a stop, from the summary of a sweep.

python table.py reports/faults/summary.csv
"""

import csv
import math
import re
import sys
from collections import defaultdict
from pathlib import Path
from statistics import median

from uictest.core.statistics import proportion_interval

Row = dict[str, str]
LOCKED = 1.0
"""Time for which a sound wheelset must have been locked in all to count, s; chosen."""
NONE = "none"
HEADER = (
    *("controller", "fault", "friction", "stops", "with a sound wheelset locked for 1 s in all"),
    *("share, 95 % confidence", "meet the criteria", "added distance, m: median (range)"),
)


def fault_of(row: Row) -> str:
    """Return part and kind of the fault; `none` for a stop without one."""
    text = row["parameters.faults"]
    part, kind = (re.search(rf"{key}: ([a-z-]+)", text) for key in ("part", "kind"))
    return f"{part[1]} {kind[1]}" if part and kind else NONE


def sound_wheelset_locked(row: Row) -> bool:
    faulty = re.search(r"wheelset: ([1-4])", row["parameters.faults"])
    sound = set("1234") - ({faulty[1]} if faulty else set())
    return any(float(row[f"locked_time_s_{number}"]) > LOCKED for number in sound)


def conditions(row: Row) -> tuple[str, str, str]:
    """Return what the stop with a fault and the one without share."""
    return tuple(row[f"parameters.{key}"] for key in ("controller", "rail.friction", "seed"))  # type: ignore[return-value]


def distance(row: Row) -> float:
    """Return the braking distance, m; infinite for a train that did not stop."""
    return float(row["braking_distance_m"] or math.inf)


def metres(added: float) -> str:
    return "never stops" if math.isinf(added) else f"{added:.0f}"


def line(key: tuple[str, str, str], rows: list[Row], without: dict[tuple[str, str, str], float]) -> list[str]:
    locked = sum(map(sound_wheelset_locked, rows))
    low, high = proportion_interval(locked, len(rows))
    added = sorted(distance(row) - without[conditions(row)] for row in rows)
    met = sum(row["outcome"] == "pass" for row in rows)
    return [
        *(*key, str(len(rows)), f"{locked}", f"{100 * low:.0f} to {100 * high:.0f} %"),
        *(str(met), f"{metres(median(added))} ({metres(added[0])} to {metres(added[-1])})"),
    ]


def main(summary: Path) -> None:
    with summary.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    without = {conditions(row): distance(row) for row in rows if fault_of(row) == NONE}
    groups: dict[tuple[str, str, str], list[Row]] = defaultdict(list)
    for row in rows:
        key = row["parameters.controller"], fault_of(row), row["parameters.rail.friction"]
        groups[key].append(row)
    print(f"| {' | '.join(HEADER)} |")
    print(f"|{'---|' * len(HEADER)}")
    for key, own in groups.items():
        print(f"| {' | '.join(line(key, own, without))} |")


if __name__ == "__main__":
    main(Path(sys.argv[1]))

"""Print two controllers side by side, from the folders of two runs of the same cases.

python table.py reports/threshold/latest reports/pi/latest
"""

import json
import sys
from collections import defaultdict
from pathlib import Path
from statistics import median
from typing import Any

Case = dict[str, Any]
HEADER = (
    *("friction", "controller", "distance, m", "against A", "actuations", "air, NL", "largest slide"),
    *("locked, s", "stops that count"),
)


def cases_by_friction(folder: Path) -> dict[str, list[Case]]:
    """Return the cases of a run by rail friction, those of one friction in the order of their ids."""
    cases = defaultdict(list)
    for case in sorted(
        json.loads((folder / "results.json").read_bytes())["cases"], key=lambda each: each["id"]
    ):
        cases[case["parameters"]["rail.friction"]].append(case)
    return cases


def row(friction: str, name: str, cases: list[Case], others: list[Case]) -> list[str]:
    """Return a row of the table; `others` are the same cases with controller A."""
    assert [case["id"] for case in cases] == [case["id"] for case in others]
    distances = values(cases, "braking_distance_m")
    ratios = [b / a for a, b in zip(values(others, "braking_distance_m"), distances, strict=True)]
    wheelsets = [case["wheelsets"] for case in cases]
    actuations = [sum(each["valve_actuations"] for each in train) for train in wheelsets]
    return [
        *(friction, name, f"{median(distances):.0f} ({min(distances):.0f} to {max(distances):.0f})"),
        *(f"{100 * (median(ratios) - 1):+.1f} %", f"{median(actuations):.0f}"),
        f"{median(values(cases, 'air_consumed_nl')):.0f}",
        f"{max(slide_of(case) for case in cases):.0f} %",
        f"{max(each['locked_time_s'] for train in wheelsets for each in train):.2f}",
        f"{sum(case['test_validity'] == 'valid' for case in cases)} of {len(cases)}",
    ]


def slide_of(case: Case) -> float:
    """Return the largest slide above 30 km/h of any wheelset, %."""
    [criterion] = (each for each in case["criteria"] if each["id"] == "shallow-slide")
    return float(criterion["value"])


def values(cases: list[Case], measure: str) -> list[float]:
    return [case["measures"][measure] for case in cases]


def main(first: Path, second: Path) -> None:
    runs = [(folder.parent.name, cases_by_friction(folder)) for folder in (first, second)]
    print(f"| {' | '.join(HEADER)} |")
    print(f"|{'---|' * len(HEADER)}")
    for friction in sorted(runs[0][1]):
        for name, cases in runs:
            print(f"| {' | '.join(row(friction, name, cases[friction], runs[0][1][friction]))} |")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))

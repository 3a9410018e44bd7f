"""Print the criteria of the series of a run side by side, as docs/series.md shows them.

python table.py reports/latest
"""

import csv
import sys
from pathlib import Path

Row = dict[str, str]


SHOWN = (
    *("k_wet", "stopping_distance_extension", "worst_stopping_distance_extension"),
    "median_adhesion_utilisation",
)
"""Measures that are shown where a series does not judge them."""


def read(path: Path, key: str) -> dict[str, dict[str, Row]]:
    """Return the rows of a file of a run, over all speeds, by criterion or measure and by series."""
    table: dict[str, dict[str, Row]] = {}
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if key == "criterion" or row["speed_kmh"] == "all":
                table.setdefault(row[key], {})[row["series"]] = row
    return table


def cell(row: Row) -> str:
    """Return a value with its interval, in bold where it misses its limit."""
    text = short(row["value"])
    if row["low"]:
        text += f" ({short(row['low'])} .. {short(row['high'])})"
    return f"**{text}**" if row.get("verdict") in ("fail", "inconclusive") else text


def short(number: str) -> str:
    """Return a number with four significant digits."""
    return f"{float(number):.4g}"


def title(criterion: str, row: Row) -> str:
    """Return a criterion with its unit and its limit."""
    unit = "" if row["unit"] == "1" else f" {row['unit']}"
    limit = f"≥ {short(row['lower'])}" if row["lower"] else f"≤ {short(row['upper'])}"
    return f"`{criterion}` {limit}{unit}"


def main(folder: Path) -> None:
    criteria = read(folder / "tables/series-criteria.csv", "criterion")
    table = {
        name: rows
        for name, rows in criteria.items()
        if any(row["verdict"] != "not_applicable" for row in rows.values())
    }
    series = list(dict.fromkeys(name for rows in table.values() for name in rows))
    print(f"| criterion | {' | '.join(name.partition('[')[2].rstrip(']') for name in series)} |")
    print(f"|---|{'--:|' * len(series)}")
    for criterion, rows in table.items():
        cells = [cell(rows[name]) for name in series]
        print(f"| {title(criterion, rows[series[0]])} | {' | '.join(cells)} |")
    measures = read(folder / "tables/series.csv", "measure")
    for name in SHOWN if len(table) < len(criteria) else ():
        unit = measures[name][series[0]]["unit"]
        cells = [cell(measures[name][each]) for each in series]
        print(f"| `{name}` ○{'' if unit == '1' else f', {unit}'} | {' | '.join(cells)} |")
    missed = [sum(rows[name]["verdict"] != "pass" for rows in table.values()) for name in series]
    print(f"| criteria missed, of {len(table)} | {' | '.join(map(str, missed))} |")


if __name__ == "__main__":
    main(Path(sys.argv[1]))

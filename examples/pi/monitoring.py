"""Print what three controllers report of every kind of fault, by the verdicts of the program.

python monitoring.py [SCENARIO...]        [default: monitoring-sound.yaml monitoring.yaml]

The profile `uictest-wsp-monitoring` judges each stop; a row is a fault, its cells count stops.
"""

import sys
from collections import defaultdict
from pathlib import Path
from statistics import median

import yaml

import uictest

SCENARIOS = "monitoring-sound.yaml", "monitoring.yaml"
DUE = "rotation-reported", "fault-reported"
STANDS = "standstill"
WATCHER, BUILT_IN = "MonitoredPi", ("threshold", "slip-band")
"""The controller that has a diagnosis, and those that have none."""
HEADER = (
    *("fault of wheelset 2", "stops", "reported, after s: median (longest)", "report missing"),
    *("false report", "timer over 10 s", "no standstill", "`threshold`: missing", "`slip-band`: missing"),
)
Stop = dict[str, tuple[str, float | None]]
"""Criterion -> status and value."""


def fault_of(text: str) -> str:
    """Return part, kind and value of a fault; `none` without one."""
    if not text:
        return "none"
    (fault,) = yaml.safe_load(text)
    value = f" {fault['value']}" if "value" in fault else ""
    return f"`{fault['part']}` `{fault['kind']}`{value}"


def missing(stops: list[Stop]) -> int:
    """Return in how many stops a report that was due did not come in time."""
    return failed(stops, *DUE)


def failed(stops: list[Stop], *criteria: str) -> int:
    return sum(any(stop[name][0] == "fail" for name in criteria) for stop in stops)


def times(stops: list[Stop]) -> str:
    """Return how many stops have a report of the wheelset with the fault, and after what time."""
    known = sorted(
        value
        for status, value in (stop["report-time"] for stop in stops)
        if status == "pass" and value is not None
    )
    return f"{len(known)}, {median(known):.1f} ({known[-1]:.1f})" if known else "-"


def row(fault: str, stops: dict[str, list[Stop]]) -> list[str]:
    own = stops[WATCHER]
    counts = [missing(own), *(failed(own, name) for name in ("no-false-report", "safety-timer", STANDS))]
    shown = [
        str(count) if count else "-" for count in [*counts, *(missing(stops[name]) for name in BUILT_IN)]
    ]
    if fault == "none":
        shown[-len(BUILT_IN) :] = [""] * len(BUILT_IN)  # they are not watched there
    return [fault, str(len(own)), times(own), *shown]


def main(*paths: Path) -> None:
    table: dict[str, dict[str, list[Stop]]] = defaultdict(lambda: defaultdict(list))
    for result in uictest.run(list(paths), record="none"):
        controller = result.parameters["controller"]
        name = WATCHER if WATCHER in controller else controller
        verdicts: Stop = {verdict.id: (verdict.status, verdict.value) for verdict in result.criteria}
        stands = result.measures is not None and result.measures["braking_time_s"] > 0.0
        verdicts[STANDS] = "pass" if stands else "fail", None
        table[fault_of(result.parameters.get("faults", ""))][name].append(verdicts)
    print(f"| {' | '.join(HEADER)} |")
    print(f"|{'---|' * len(HEADER)}")
    for fault, stops in table.items():
        print(f"| {' | '.join(row(fault, stops))} |")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:] or (Path(__file__).with_name(name) for name in SCENARIOS)))

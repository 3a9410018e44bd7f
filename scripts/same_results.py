"""Whether every number and verdict over the shipped files is the one that was kept, bit for bit.

    python scripts/same_results.py              # after a change that is to change no result
    python scripts/same_results.py -k fit       # only groups whose name has this word
    python scripts/same_results.py --accept     # keep today's; `git diff` of the file shows what moved

Runs the shipped scenarios, sweeps, series and bench tests, and what is done with recordings of them: they are
judged again, found in a long log, fitted, identified. Every measure, status, limit and count goes into
`same_results.txt` beside this file: one line for each record (a stop, a wheelset, a criterion, a column of a
sweep), numbers in hexadecimal, which is exact. Sentences, versions and the files that a command writes do not
count: they may change where numbers may not (`same_outputs.py` compares those). Takes some two minutes of a
processor. Exit code 1 if anything differs, is missing or is new.

Numbers that a solver of SciPy finds depend in their last digits on the processor's linear algebra: the groups
`fit`, `identify` and `log-friction` are compared to 1e-6 of the number.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd
import yaml

import uictest

REPOSITORY: Final = Path(__file__).resolve().parents[1]
KEPT: Final = Path(__file__).with_suffix(".txt")
Records = Iterator[tuple[str, Mapping[str, Any]]]
"""The name of a record and what is in it: numbers, words, or None."""

_TOLERANCES: Final = {"fit": 1e-6, "identify": 1e-6, "log-friction": 1e-6}
"""Group -> share of a number by which it may differ; 0 for the others."""
_SWEEPS: Final = (
    "scenarios/slide-80-friction-command.sweep.yaml",
    "scenarios/slide-80-sensitivity.sweep.yaml",
    "examples/faults/faults.sweep.yaml",
)
_FIRM: Final = ("dry-120", "slip-120")
_FITTED: Final = ("slip-120", "cleaned-rail-120", "wsp-bypassed-80", "dry-120")
_WEAKER: Final = "weaker"
_LOGGED: Final = ("dry-120", _WEAKER, "slip-120", "wet-80-command[command=90]", "wsp-bypassed-80", "slip-120")
_BENCHES: Final = ("stepwise", "triangular", "random", "wsp-cycling")
_IDENTIFIED: Final = {
    "hysteresis": "six-inch-hysteresis",
    "cylinder": "six-inch-cylinder",
    "air": "six-inch-cylinder",
}
"""What is identified -> the bench test whose record it is identified from."""


def case_records(result: Any) -> Records:
    """Yield what a judged case, its wheelsets and its criteria hold."""
    yield (
        result.id,
        {
            "outcome": result.outcome,
            "test_validity": result.test_validity,
            "requirement_status": result.requirement_status,
            "expect": str(result.expect),
            "as_expected": result.as_expected,
        },
    )
    yield f"{result.id} train", result.measures or {}
    for number, wheelset in enumerate(result.wheelsets, start=1):
        yield f"{result.id} wheelset {number}", wheelset
    for verdict in result.criteria:
        yield f"{result.id} criterion {verdict.id}", _verdict(verdict)
    if result.repeats is not None:
        for stop in result.repeats.stops:
            yield f"{result.id} seed {stop.seed}", {"outcome": stop.outcome, **stop.measures}


def _verdict(verdict: Any) -> dict[str, Any]:
    if verdict.status == "not_applicable":
        return {"status": verdict.status}
    numbers = {name: getattr(verdict, name) for name in ("value", "lower", "upper", "margin")}
    turned_by = [each.definition for each in verdict.sensitivity if each.flips]
    return {"status": verdict.status, **numbers, "turned_by": ",".join(turned_by)}


def series_records(series: Any) -> Records:
    """Yield what a judged series says: its outcome, criteria, counts and measures, but no stops."""
    yield series.id, {"outcome": series.outcome, "expect": str(series.expect)}
    for each in series.criteria:
        where = " ".join(filter(None, (f"{each.speed_kmh or ''}", each.rail)))
        verdict = {**_verdict(each.verdict), "confident": each.confident, **_estimate(each.estimate)}
        yield f"{series.id} {where} criterion {each.verdict.id}", verdict
    for speed in series.speeds:
        name = f"{series.id} {speed.speed_kmh} {speed.rail}"
        counts = {"dry": speed.dry, "wet": speed.wet}
        yield (
            f"{name} stops",
            {
                f"{rail}_{kind}": getattr(each, kind)
                for rail, each in counts.items()
                for kind in ("run", "counted")
            },
        )
        for measure, value in speed.measures.items():
            yield f"{name} {measure}", _estimate(value.estimate)


def _estimate(estimate: Any) -> dict[str, Any]:
    if estimate is None:
        return {"estimate": None}
    return {
        name: getattr(estimate, name)
        for name in ("value", "low", "high", "stops", "smallest", "largest", "covered")
    }


def column_records(name: str, frame: pd.DataFrame) -> Records:
    """Yield the columns of a table that hold numbers or words, not sentences: a digest of each."""
    for column in frame.columns:
        values = frame[column]
        if pd.api.types.is_numeric_dtype(values):
            ends = {"smallest": float(values.min()), "largest": float(values.max())}
            yield f"{name} column {column}", {**ends, **_digest(values.astype(float))}
        elif column in _WORDS or column.startswith("parameters."):
            yield f"{name} column {column}", _digest(values)


_WORDS: Final = ("expect", "outcome", "narrowest_criterion")
"""Columns of a sweep that hold words."""


def _digest(values: Iterable[Any]) -> dict[str, Any]:
    texts = [_text(value) for value in values]
    return {"rows": len(texts), "sha256": hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]}


def row_records(name: str, frame: pd.DataFrame, keys: Sequence[str], words: Sequence[str] = ()) -> Records:
    """Yield the numbers in each row of a table, and the named columns of words; `keys` tell rows apart."""
    for row in frame.to_dict("records"):
        numbers = {column: row[column] for column in frame.select_dtypes("number")}
        yield (
            " ".join([name, *(str(row[key]) for key in keys)]),
            numbers | {word: row[word] for word in words},
        )


def leaves(content: object, name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield every number, truth value and standing in a document by the keys that lead to it."""
    if isinstance(content, Mapping):
        for key, value in content.items():
            yield from leaves(value, f"{name}.{key}" if name else str(key))
    elif isinstance(content, list):
        for index, value in enumerate(content):
            yield from leaves(value, f"{name}[{index}]")
    elif not isinstance(content, str) or name.endswith(".standing"):
        yield name, content


def run_group() -> Records:
    """All shipped scenarios with the controllers that they name."""
    for result in recorded_run():
        yield from case_records(result)


def other_controller_group() -> Records:
    """All shipped scenarios and the shipped series with a controller that they do not name, `slip-band`."""
    results = uictest.run("scenarios", set={"controller": "slip-band"}, record="none")
    for result in results:
        yield from case_records(result)
    for series in results.series:
        yield from series_records(series)


def repeat_group() -> Records:
    """One stop under several seeds."""
    for result in uictest.run("scenarios/slip-120.yaml", repeat=6, record="none"):
        yield from case_records(result)


def series_group() -> Records:
    """The shipped series."""
    for series in recorded_run().series:
        yield from series_records(series)


def firm_group() -> Records:
    """Whether numbers that nobody measured turn the verdicts."""
    for name in _FIRM:
        command("run", f"scenarios/{name}.yaml", "--firm", "-q", "--report", "csv", "-o", f"firm-{name}")
        [result] = uictest.read_results(Path(f"firm-{name}/latest"))
        firmness = result.firmness
        counts = {
            key: getattr(firmness, key)
            for key in ("nominal", "status", "counted", "turned", "share", "draws", "infeasible")
        }
        yield name, {**counts, **firmness.outcomes}
        for verdict in firmness.criteria:
            yield (
                f"{name} criterion {verdict.criterion}",
                {key: getattr(verdict, key) for key in ("status", "counted", "turned", "share", "margin")},
            )


def sweep_group() -> Records:
    """The shipped sweeps of built-in controllers: cases, maps, sensitivities, and one frontier."""
    for file in _SWEEPS:
        swept = uictest.sweep(file, frontier="rail.friction" if file == _SWEEPS[0] else None)
        result = swept.result
        yield result.name, {"cases": result.cases, "met": result.met, **result.outcomes}
        yield from column_records(result.name, swept.frame().sort_index())
        for each in result.maps:
            yield f"{result.name} map {each.measure}", _digest(np.ravel(each.means).tolist())
        for index in result.sensitivities:
            ends = {order: getattr(index, order) for order in ("first", "total")}
            numbers = {
                f"{order}_{end}": getattr(own, end)
                for order, own in ends.items()
                for end in ("value", "low", "high")
            }
            yield f"{result.name} sensitivity of {index.measure} to {index.key}", numbers
        for scan in result.frontier.scans if result.frontier else ():
            where = " ".join(f"{key}={value.text}" for key, value in scan.circumstances.items())
            for number, flip in enumerate(scan.flips, start=1):
                ends = {"low": flip.low.text, "high": flip.high.text, "met_at_low": flip.met_at_low}
                yield f"{result.name} frontier at {where} flip {number}", ends


def evaluate_group() -> Records:
    """The recordings of all shipped scenarios, judged as recorded stops."""
    for case in uictest.load("scenarios"):
        file = recording_file(case.id)
        if file.is_file() and case.scenario.train is None:
            [result] = uictest.evaluate(file, scenario=case)
            yield from case_records(result)


def log_group() -> Records:
    """The stops found in a long log, each judged, the wet ones also over the dry ones."""
    folder = log_folder()
    for result in uictest.read_results(folder):
        yield from case_records(result)
    yield "stops", {"found": len(pd.read_csv(folder / "tables/campaign_stops.csv"))}
    tables = {
        name: pd.read_csv(folder / f"tables/campaign_{name}.csv")
        for name in ("dry_stops", "wet_stops", "wet_series")
    }
    yield from row_records("dry stops", tables["dry_stops"], ["speed_kmh"], ["accepted"])
    yield from row_records("wet stop", tables["wet_stops"], ["stops"], ["outcome", "counts"])
    yield from row_records("wet series", tables["wet_series"], ["speed_kmh", "measure"])


def log_friction_group() -> Records:
    """The friction that is fitted to each stop of the log."""
    table = pd.read_csv(log_folder() / "tables/campaign_friction.csv")
    yield from row_records("stop", table, ["stops"], ["standing"])


def fit_group() -> Records:
    """The friction that recordings of known friction are fitted with."""
    for name in _FITTED:
        command("fit", str(recording_file(name)), "--scenario", f"scenarios/{name}.yaml", "-o", f"fit-{name}")
        [document] = Path(f"fit-{name}").glob("*/fit.json")
        yield name, dict(leaves(json.loads(document.read_text("utf-8"))))


def bench_group() -> Records:
    """Every channel of the bench tests of the caliper."""
    for name in _BENCHES:
        yield from column_records(name, uictest.read_recording(bench_record(name)).frame().reset_index())


def identify_group() -> Records:
    """What is identified from records of the bench."""
    base: list[str] = []
    for what, record in _IDENTIFIED.items():
        command("identify", what, str(bench_record(record)), *base, "-o", f"{what}.yaml")
        base = ["--base", f"{what}.yaml"]
        yield (
            what,
            {
                key: _number(value)
                for key, value in _texts(yaml.safe_load(Path(f"{what}.yaml").read_text("utf-8")))
            },
        )


def _texts(content: object, name: str = "") -> Iterator[tuple[str, str]]:
    if isinstance(content, Mapping):
        for key, value in content.items():
            yield from _texts(value, f"{name}.{key}" if name else str(key))
    elif isinstance(content, list):
        for index, value in enumerate(content):
            yield from _texts(value, f"{name}[{index}]")
    else:
        yield name, str(content)


def _number(text: str) -> float | None:
    try:
        return float(text.partition(" ")[0])
    except ValueError:
        return None


GROUPS: Final[dict[str, Callable[[], Records]]] = {
    "run": run_group,
    "other-controller": other_controller_group,
    "repeat": repeat_group,
    "series": series_group,
    "firm": firm_group,
    "sweep": sweep_group,
    "evaluate": evaluate_group,
    "log": log_group,
    "log-friction": log_friction_group,
    "fit": fit_group,
    "bench": bench_group,
    "identify": identify_group,
}


@cache
def recorded_run() -> uictest.Results:
    """Run all shipped scenarios once for all groups; their recordings stay in the working folder."""
    return uictest.run("scenarios", record="all", output="recorded")


@cache
def weaker_dry_run() -> uictest.Results:
    """Run a dry stop that takes longer, so that dry stops differ."""
    command = {"brake.command": "97 %"}
    return uictest.run("scenarios/dry-120.yaml", set=command, record="all", output="recorded-weaker")


def recording_file(case: str) -> Path:
    """Return the recording of a case of the shipped scenarios, or of the weaker dry stop."""
    folder = (weaker_dry_run() if case == _WEAKER else recorded_run()).folder
    assert folder is not None
    return folder / "recordings" / f"{'dry-120' if case == _WEAKER else case}.parquet"


@cache
def log_folder() -> Path:
    """Find the stops of a log once; return the folder of the run."""
    day().to_csv("day.csv", index=False)
    stops = "stop-0001 or stop-0002"
    command("log", "day.csv", "--scenario", "scenarios/slip-120.yaml", "--dry", stops, "-q", "-o", "log")
    return Path("log/latest")


@cache
def bench_record(name: str) -> Path:
    """Return the record of a shipped bench test, made once for all groups."""
    command("bench", name)
    return Path(f"{name}.parquet")


def day() -> pd.DataFrame:
    """Return a log of several stops: before each the train gathers speed, after each it stands braked."""
    parts, clock, units = [], 0.0, {}
    for name in _LOGGED:
        recording = uictest.read_recording(recording_file(name)).frame()
        units = {"time": "s", **recording.attrs["units"]}
        stop = recording.reset_index()[list(_LOG_CHANNELS)]
        released = pd.DataFrame(0.0, index=range(3000), columns=stop.columns)
        faster = np.linspace(0.0, float(stop["speed"].iloc[0]), len(released))
        for column in stop.columns:
            if "speed" in column:
                released[column] = faster
        standing = pd.DataFrame([stop.iloc[-1]] * 500, columns=stop.columns)
        for part in (released, stop, standing):
            rows = part.copy()
            rows["time"] = clock + 0.01 * np.arange(len(rows))
            clock += 0.01 * len(rows)
            parts.append(rows)
    return pd.concat(parts, ignore_index=True).rename(columns=lambda name: f"{name} [{units[name]}]")


_LOG_CHANNELS: Final = (
    *("time", "speed", "brake_line_pressure"),
    *(
        f"{name}_{wheelset}"
        for name in ("wheel_speed", "cylinder_pressure", "clamping_force")
        for wheelset in range(1, 5)
    ),
)


def command(*words: str) -> None:
    """Run a command of the program; one that fails to run ends the script."""
    done = subprocess.run(
        [sys.executable, "-m", "uictest", *words], capture_output=True, text=True, check=False
    )
    if done.returncode not in (0, 1):  # 1: not as expected, which is a result
        raise SystemExit(f"uictest {' '.join(words)}: exit code {done.returncode}\n{done.stderr}")


def lines_of(groups: Sequence[str]) -> dict[str, str]:
    """Run groups in a new folder with the shipped files; return their records as name -> content."""
    found: dict[str, str] = {}
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        for name in ("scenarios", "examples"):
            shutil.copytree(REPOSITORY / name, Path(folder, name))
        os.chdir(folder)
        for cached in (recorded_run, weaker_dry_run, log_folder, bench_record):
            cached.cache_clear()  # what they return lies in the folder
        try:
            for group in groups:
                for name, content in GROUPS[group]():
                    key = f"{group} {name}"
                    if key in found:
                        raise SystemExit(f"two records are called {key!r}")
                    found[key] = " ".join(
                        f"{_name(field)}={_text(value)}" for field, value in content.items()
                    )
                print(f"{group}: done", file=sys.stderr)
        finally:
            os.chdir(before)
    return found


def _name(field: str) -> str:
    return field.replace(" ", "_").replace("=", ":")


def _text(value: object) -> str:
    if isinstance(value, float | np.floating):
        return float(value).hex()
    return "-" if value is None or value == "" else str(value).replace(" ", "_")


def difference(name: str, before: str | None, now: str | None) -> list[str]:
    """Return a line for each field of a record that differs by more than its group allows."""
    if before is None or now is None:
        return [f"{name}: {'new' if before is None else 'missing'}"]
    old, new = (dict(field.split("=", 1) for field in text.split()) for text in (before, now))
    tolerance = _TOLERANCES.get(name.partition(" ")[0], 0.0)
    return [
        f"{name}: {field} {_readable(old.get(field))} -> {_readable(new.get(field))}"
        for field in {**old, **new}
        if not _same(old.get(field), new.get(field), tolerance)
    ]


def _same(before: str | None, now: str | None, tolerance: float) -> bool:
    if before == now:
        return True
    numbers = [_float(text) for text in (before, now)]
    if tolerance == 0.0 or None in numbers:
        return False
    return math.isclose(*numbers, rel_tol=tolerance)


def _float(text: str | None) -> float | None:
    """Return a number that was kept in hexadecimal; None for all else, of which counts are."""
    return float.fromhex(text) if text and re.fullmatch(r"-?0x[0-9a-f.]+p[+-]\d+", text) else None


def _readable(text: str | None) -> str:
    number = _float(text)
    return "missing" if text is None else text if number is None else f"{number!r}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if all results are those that were kept, 1 if not."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("-k", metavar="WORD", default="", help="only groups with WORD in their name")
    parser.add_argument("--accept", action="store_true", help="keep today's results in place of those kept")
    options = parser.parse_args(arguments)
    groups = [name for name in GROUPS if options.k in name]
    if not groups:
        raise SystemExit(f"no group has {options.k!r} in its name: {', '.join(GROUPS)}")
    kept = dict(line.split(": ", 1) for line in KEPT.read_text("utf-8").splitlines()) if KEPT.exists() else {}
    before = {name: text for name, text in kept.items() if name.partition(" ")[0] in groups}
    now = lines_of(groups)
    if options.accept:
        others = {name: text for name, text in kept.items() if name not in before}
        lines = (f"{name}: {text}\n" for name, text in sorted({**others, **now}.items()))
        KEPT.write_text("".join(lines), "utf-8")
    names = sorted({**before, **now})
    different = [line for name in names for line in difference(name, before.get(name), now.get(name))]
    for line in different:
        print(line)
    print(f"{len(now)} records, {f'differences: {len(different)}' if different else 'all the same'}")
    return 1 if different and not options.accept else 0


if __name__ == "__main__":
    sys.exit(main())

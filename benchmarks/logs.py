"""Stops found in a log, by its format and size: `python benchmarks/logs.py [--megabytes 100,1000]`.

A log is one simulated stop over and over, between coasting and standing, with noise of its own on every
speed. Finding and cutting out run as a process of their own, judging does not. Files are written one at a
time to a temporary folder, and removed.
"""

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import machine
import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from pyarrow import csv, parquet

import uictest

SCENARIO: Final = Path(__file__).parent.parent / "scenarios" / "slide-80.yaml"
FORMATS: Final = ("csv", "parquet", "mf4", "tdms")
_STEP = 0.01
_COASTS, _STANDS = 60.0, 60.0
"""s before and after each stop; chosen."""
_FIND: Final = """\
import resource
import sys
from pathlib import Path
from uictest.recorded.field_data import load_map
from uictest.recorded.service_log import find_stops, write_stops
path, folder = map(Path, sys.argv[1:])
mapped = load_map("uictest")[0]
log = find_stops([path], mapped)
cut = len(write_stops(log, mapped, folder))
highest = next(line for line in Path("/proc/self/status").read_text().splitlines() if "VmHWM" in line)
reader = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
print(cut, log.first_rows[-1], int(highest.split()[1]) + reader)
"""
"""Finds and cuts out; says how many stops and rows there were, and the highest resident size, kB, with that
of the process that reads MDF and TDMS: the system counts that of a child from before it was begun."""
Columns = dict[str, NDArray[np.float64]]


def one_stop() -> tuple[Columns, dict[str, str]]:
    """Return the channels of a stop with what lies before and after it, and their units."""
    (case, *_) = uictest.load(SCENARIO)
    recording = uictest.simulate(case)
    names = ["speed", "brake_line_pressure", "distance"]
    names += [
        f"{name}_{n}" for name in ("wheel_speed", "cylinder_pressure", "valve_command") for n in range(1, 5)
    ]
    before, after = round(_COASTS / _STEP), round(_STANDS / _STEP)
    columns = {name: np.pad(recording[name], (before, after), "edge") for name in names}
    columns["brake_line_pressure"][-after // 2 :] = 0.0
    for n in range(1, 5):
        columns[f"cylinder_pressure_{n}"][-after // 2 :] = 0.0
    return columns, {name: recording.units[name] for name in names}


def blocks(stops: int, stop: Columns) -> Iterator[Columns]:
    """Yield stop after stop over one clock."""
    random, rows = np.random.default_rng(1), len(stop["speed"])
    for k in range(stops):
        noisy = {
            name: values + (1e-3 * random.standard_normal(rows) if "speed" in name else 0.0)
            for name, values in stop.items()
        }
        yield {"time": _STEP * (k * rows + np.arange(rows)), **noisy}


def write(path: Path, stops: int, stop: Columns, units: dict[str, str]) -> None:
    """Write a log of so many stops in the format of the file's ending, block by block."""
    units = {"time": "s", **units}
    if path.suffix == ".mf4":
        _write_mdf(path, stops, stop, units)
    elif path.suffix == ".tdms":
        _write_tdms(path, stops, stop, units)
    else:
        _write_table(path, stops, stop, units)


def _write_table(path: Path, stops: int, stop: Columns, units: dict[str, str]) -> None:
    named = {name: f"{name} [{unit}]" if path.suffix == ".csv" else name for name, unit in units.items()}
    fields = [pa.field(named[name], pa.float64(), metadata={"unit": unit}) for name, unit in units.items()]
    schema = pa.schema(fields)
    opened = csv.CSVWriter if path.suffix == ".csv" else parquet.ParquetWriter
    with opened(path, schema) as writer:
        for block in blocks(stops, stop):
            writer.write_table(pa.table([block[name] for name in units], schema=schema))


def _write_mdf(path: Path, stops: int, stop: Columns, units: dict[str, str]) -> None:
    import asammdf

    names = [name for name in units if name != "time"]
    with asammdf.MDF(version="4.10") as mdf:
        for k, block in enumerate(blocks(stops, stop)):
            time_axis = block["time"]
            signals = [asammdf.Signal(block[name], time_axis, name=name, unit=units[name]) for name in names]
            if k == 0:
                mdf.append(signals, common_timebase=True)
            else:
                mdf.extend(0, [(time_axis, None), *((each.samples, None) for each in signals)])
        mdf.save(path, overwrite=True)


def _write_tdms(path: Path, stops: int, stop: Columns, units: dict[str, str]) -> None:
    import nptdms

    with nptdms.TdmsWriter(path) as writer:
        for block in blocks(stops, stop):
            properties = {name: {"unit_string": unit} for name, unit in units.items()}
            writer.write_segment(
                [nptdms.ChannelObject("log", name, block[name], properties[name]) for name in units]
            )


def timed(path: Path, folder: Path) -> tuple[list[int], float, float]:
    """Return what a process says that finds the stops of a log, wall clock (s) and processor time (s)."""
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [sys.executable, "-c", _FIND, str(path), str(folder)]
    said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    seconds, after = time.perf_counter() - started, resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return list(map(int, said.split())), seconds, processor


def main(arguments: Sequence[str] | None = None) -> None:
    """Write and read logs of each format and size, and print what each took."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", default="100,1000")
    parser.add_argument("--formats", default=",".join(FORMATS))
    chosen = parser.parse_args(arguments)
    stop, units = one_stop()
    print(machine.description("numpy", "pyarrow", "asammdf", "npTDMS"))
    print("format     MB   stops   found    rows     s   processor s   peak MB")
    for suffix in chosen.formats.split(","):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, f"log.{suffix}")
            write(path, 4, stop, units)
            each = path.stat().st_size / 4e6
            for megabytes in map(float, chosen.megabytes.split(",")):
                stops = max(round(megabytes / each), 1)
                write(path, stops, stop, units)
                (cut, rows, highest), seconds, processor = timed(path, Path(folder, "stops"))
                print(
                    f"{suffix:8}{path.stat().st_size / 1e6:6.0f}{stops:8}{cut:8}{rows:10}"
                    f"{seconds:6.1f}{processor:14.1f}{highest / 1024.0:10.0f}"
                )


if __name__ == "__main__":
    main()

"""Results, runs and recordings to report on, with whatever is to be different, and files held together."""

import csv

import numpy as np
import openpyxl
import pytest

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.core.recording import Recording
from uictest.judging.evaluation import CaseResult, Verdict
from uictest.plans.scenario import expectation_of
from uictest.report import RunContent, RunManifest
from uictest.report.words import csv_cell

HOSTILE = "\x1b[31m=cmd|'/c calc'!A1 [bold]x[/bold] <b>&\x00\u202e\n::error::"
"""A text with terminal codes, formula, markup, XML, null, direction override and workflow command."""


def make_result(**changes):
    """A stop at 120 km/h on a dry rail that passed."""
    content = {"id": "dry-120[command=90]", "scenario": "scenarios/dry/120.yaml"}
    content |= {"parameters": {"brake.command": "90 %"}, "expect": "pass", "outcome": "pass"}
    content |= {"criteria": (make_verdict(),), "measures": _FIGURES, "duration": 0.25}
    content |= {"wheelsets": tuple(map(_wheelset, range(1, 5)))} | changes
    return CaseResult(**content | {"expect": expectation_of(content["expect"])})


def make_verdict(**changes):
    """A braking distance inside its limits."""
    numbers = {"value": 465.25, "unit": "m", "lower": 440.0, "upper": 490.0, "margin": 24.75}
    content = {"id": "braking-distance", "layer": "validity", **numbers, "status": "pass", "reason": ""}
    return Verdict(**(content | {"definition": {"low_speed_cutoff": "30 km/h"}} | changes))


def make_content(*results, **changes):
    """A finished run of the given results."""
    manifest = RunManifest(command=("uictest", "run"), versions={"uictest": "0.1.0"})
    return RunContent(**({"name": "a-run", "results": results, "manifest": manifest} | changes))


def make_recording(samples=3401, **metadata):
    """A stop from 120 km/h at 1 m/s2 in which every wheelset slides by 40 % for a while and is vented."""
    time = np.linspace(0.0, 34.0, samples)
    speed = np.clip(120 / 3.6 - time, 0.0, None)
    slide = np.where((time > 5.0) & (time < 15.0), 0.4, 0.0)
    channels = {"time": time, "distance": np.cumsum(speed) * 34.0 / samples, "speed": speed}
    units = {"time": "s", "distance": "m", "speed": "m/s"}
    channels |= {"brake_line_pressure": np.full(samples, 3.8e5), "reservoir_pressure": 8e5 - 1e3 * time}
    units |= {"brake_line_pressure": "Pa", "reservoir_pressure": "Pa"}
    for n in (1, 2, 3, 4):
        own = {
            "wheel_speed": (speed * (1.0 - slide), "m/s"),
            "slide": (slide, "1"),
            "adhesion": (np.full(samples, 0.1), "1"),
            "tank_pressure": (3.8e5 * (1.0 - slide), "Pa"),
            "clamping_force": (14e3 * (1.0 - slide), "N"),
            "valve_command": (np.where(slide > 0.0, 2.0, 0.0), "1"),
        }
        channels |= {f"{name}_{n}": samples_of for name, (samples_of, _) in own.items()}
        units |= {f"{name}_{n}": unit for name, (_, unit) in own.items()}
    return Recording(channels, units, {"case": "dry-120", **metadata})


def _wheelset(n):
    own = {"maximum_slide": 0.02 * n, "valve_actuations": n}
    return (
        dict.fromkeys(WHEELSET_COLUMNS, 0.0) | own | {"maximum_clamping_force_n": 25e3, "air_vented_nl": 1.5}
    )


_FIGURES = dict.fromkeys(STOP_COLUMNS, float("nan")) | {
    "braking_distance_m": 465.25,
    "corrected_distance_m": 465.25,
    "braking_time_s": 27.5,
    "mean_deceleration_mps2": 1.195,
    "minimum_deceleration_mps2": 0.9,
    "maximum_deceleration_mps2": 1.31,
    "reservoir_minimum_bar": 7.2,
    "air_consumed_nl": 180.0,
    "energy_residual": 1e-8,
    "air_residual": 1e-12,
    "air_energy_residual": 1e-12,
}


def assert_as_csv(folder):
    """Hold the sheets of the workbook of a folder to its CSV files: the same tables, cell by cell."""
    files = {path.stem: path for path in folder.rglob("*.csv")}
    book = openpyxl.load_workbook(folder / "report.xlsx")
    assert sorted(book.sheetnames) == sorted(files)
    for name, path in files.items():
        with path.open(newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        cells = [[cell.value for cell in row] for row in book[name].iter_rows()]
        assert [csv_cell(each) for each in cells[0]] == header
        for row, sheet in zip(rows, cells[1:], strict=True):
            assert len(row) == len(sheet)
            for text, cell in zip(row, sheet, strict=True):
                assert_same(text, cell)


def assert_same(text, cell):
    """Hold a cell of a workbook to that of a CSV file: a number is one, a text the same text."""
    if isinstance(cell, bool):
        assert text == str(cell).lower()
    elif isinstance(cell, int | float):
        assert float(text) == pytest.approx(cell, rel=1e-15)
    else:
        assert text == csv_cell(cell or "")

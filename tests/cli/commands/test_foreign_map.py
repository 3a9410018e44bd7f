"""Whatever takes a channel map gives the figures of a canonical file for one as others write it."""

import csv
import json
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import uictest
from tests.service_log import logs

from ..conftest import results_of

WHEELSETS = (1, 2, 3, 4)
CHANNELS = {
    "time": ("s", "Zeit", "s", 1.0),
    "speed": ("m/s", "v_Zug", "km/h", 3.6),
    "brake_line_pressure": ("Pa", "p_HLL", "mbar", 0.01),
    **{f"wheel_speed_{n}": ("m/s", f"v_Rad {n}", "km/h", 3.6) for n in WHEELSETS},
    **{f"cylinder_pressure_{n}": ("Pa", f"p_C {n}", "mbar", 0.01) for n in WHEELSETS},
    **{f"clamping_force_{n}": ("N", f"F_Zange {n}", "kN", 0.001) for n in WHEELSETS},
}
"""Canonical channel -> its unit; name and unit in the foreign file, and how many of these are one of SI."""
STOP = """schema: uictest/scenario/1
name: {rail}
initial_speed: 40 km/h
brake: {{command: 100 %, position: R}}
rail: {{condition: {rail}}}
criteria: [uictest-stop]
"""
SERIES = """schema: uictest/series/1
name: own
criteria: own.yaml
dry: {scenario: dry.yaml, recordings: [dry.csv], map: map.yaml}
wet: {scenario: wet.yaml, recordings: [wet.csv], map: map.yaml}
"""
CRITERIA = """schema: uictest/criteria/1
name: own
criteria:
  - {id: distance, layer: requirement, scope: series, measure: median_braking_distance, upper: 900 m}
"""
VALIDATION = """schema: uictest/validation/1
name: own
stops:
  - {scenario: wet.yaml, recordings: [wet.csv], map: map.yaml}
"""


def write(recorded, folder, name, *, foreign):
    """Write a recording: canonical, or with own names, units, separator and decimal sign."""
    columns = {
        (theirs if foreign else f"{ours} [{unit}]"): recorded[ours] * (factor if foreign else 1.0)
        for ours, (unit, theirs, _, factor) in CHANNELS.items()
    }
    separator, decimal = (";", ",") if foreign else (",", ".")
    pd.DataFrame(columns).to_csv(folder / f"{name}.csv", sep=separator, decimal=decimal, index=False)


CANONICAL = "schema: uictest/channel-map/1\nname: own\nextends: uictest\n"


def foreign_map():
    time, *lines = (
        f"{ours}: {{source: '{name}', unit: {unit}}}" for ours, (_, name, unit, _) in CHANNELS.items()
    )
    head = [
        "schema: uictest/channel-map/1",
        "name: own",
        "csv: {delimiter: ';', decimal: ','}",
        time,
        "channels:",
    ]
    return "\n".join([*head, *(f"  {line}" for line in lines)]) + "\n"


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Two folders with the same stops and files: as this program writes them, and as others do."""
    root = tmp_path_factory.mktemp("foreign")
    stops = {"dry": logs.simulated(logs.DRY, 40.0, 1), "wet": logs.simulated(logs.wet(0.07), 40.0, 2)}
    for name, channel_map in (("canonical", CANONICAL), ("foreign", foreign_map())):
        folder = root / name
        folder.mkdir()
        for rail, stop in stops.items():
            recorded = pd.read_parquet(logs.write_log([stop], root / "log.parquet"))
            write(recorded, folder, rail, foreign=name == "foreign")
            (folder / f"{rail}.yaml").write_text(STOP.format(rail=rail), "utf-8")
        (folder / "map.yaml").write_text(channel_map, "utf-8")
        (folder / "own.yaml").write_text(CRITERIA, "utf-8")
        (folder / "own.series.yaml").write_text(SERIES, "utf-8")
        (folder / "own.validation.yaml").write_text(VALIDATION, "utf-8")
    return root / "canonical", root / "foreign"


def measures_of(results):
    """Return the measures of every case and of its last wheelset."""
    return {
        f"{case['id']} {name}": value
        for case in results["cases"]
        for name, value in {**case["measures"], **case["wheelsets"][3]}.items()
    }


def evaluated(call):
    call("evaluate", "wet.csv", "--map", "map.yaml", "--scenario", "wet.yaml")
    return measures_of(results_of())


def logged(call):
    call("log", "wet.csv", "--map", "map.yaml", "--scenario", "wet.yaml")
    with Path("reports/latest/tables/campaign_friction.csv").open(encoding="utf-8") as file:
        [friction] = csv.DictReader(file)
    return measures_of(results_of()) | {"friction": float(friction["friction"])}


def fitted(call):
    call("fit", "wet.csv", "--map", "map.yaml", "--scenario", "wet.yaml", code=0)
    [document] = Path("reports").glob("fit-*/fit.json")
    [friction] = json.loads(document.read_text("utf-8"))["fit"]["friction"]
    return {name: friction[name] for name in ("value", "half_width", "windows")}


def series(call):
    call("evaluate", "own.series.yaml")
    return measures_of(results_of()["series"])


def validated(call):
    call("validate", "own.validation.yaml")
    [document] = Path("reports").glob("validation-*/tables/stops.csv")
    with document.open(encoding="utf-8") as file:
        return {row["figure"]: row["recorded"] for row in csv.DictReader(file)}


def evaluated_in_python(call):
    [result] = uictest.evaluate("wet.csv", scenario="wet.yaml", channel_map="map.yaml")
    return dict(result.measures)


def series_in_python(call):
    uictest.evaluate("own.series.yaml", output="reports")
    return measures_of(results_of()["series"])


def validated_in_python(call):
    stops = uictest.validate("own.validation.yaml").stops().reset_index()
    return dict(zip(stops["figure"], stops["recorded"], strict=True))


def read_in_python(call):
    recording = uictest.read_recording("wet.csv", "map.yaml")
    return {name: float(np.nansum(samples)) for name, samples in recording.channels.items()}


def finite(figures):
    """Return the figures that are finite numbers; a text of a table may be one."""
    numbers = {name: pd.to_numeric(value, errors="coerce") for name, value in figures.items()}
    return {name: float(value) for name, value in numbers.items() if np.isfinite(value)}


USES = [
    *(evaluated, logged, fitted, series, validated),
    *(evaluated_in_python, series_in_python, validated_in_python, read_in_python),
]


@pytest.mark.parametrize("use", USES, ids=lambda use: use.__name__)
def test_the_figures_are_those_of_the_canonical_file(call, folders, monkeypatch, tmp_path, use):
    found = []
    for folder in folders:
        place = tmp_path / folder.name
        shutil.copytree(folder, place)
        monkeypatch.chdir(place)
        found.append(finite(use(call)))
    canonical, foreign = found
    assert len(canonical) >= 3
    assert foreign == pytest.approx(canonical, rel=1e-6, abs=1e-9)

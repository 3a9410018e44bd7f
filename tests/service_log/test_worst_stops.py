"""Where each stop of a log lies, and which are the worst: a log with known bad stops."""

import csv
import json
import re

import pandas as pd
import pytest

import uictest
from tests.service_log import logs
from uictest.cli.entry import execute
from uictest.recorded.service_log import clock_text

BEGIN = pd.Timestamp("2026-03-01 08:00:00")
PLACE = 100_000.0
MAP = """schema: uictest/channel-map/1
name: dated
extends: uictest
channels: {distance: {source: Weg, unit: km}}
"""
LOCKS, SLIDES_LONGER, SLIDES, DRY = "stop-0003", "stop-0005", "stop-0002", ("stop-0001", "stop-0004")


def bypassed(rail):
    values = {"initial_speed": "80 km/h", "rail": rail, "criteria": "uictest-stop", "rig.wsp": "bypassed"}
    case, *_ = uictest.load(logs.SCENARIO, set=values)
    return uictest.simulate(case)


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A CSV log with dates and a distance on the line: two dry stops, two that slide, one that locks."""
    folder = tmp_path_factory.mktemp("worst")
    dry, slides, locks = logs.simulated(logs.DRY, 80.0, 1), logs.wet(0.09), bypassed(logs.wet(0.06))
    stops = [dry, logs.simulated(slides, 80.0, 2), locks, dry, logs.simulated(logs.wet(0.07), 80.0, 3)]
    recorded = pd.read_parquet(logs.write_log(stops, folder / "log.parquet"))
    table = recorded.rename(columns=lambda name: name if name == "time" else f"{name} [{logs.unit_of(name)}]")
    table["Weg [km]"] = (PLACE + (recorded["speed"] * logs.STEP).cumsum()) / 1000.0
    table["time"] = [
        (BEGIN + pd.Timedelta(seconds=float(each))).isoformat(timespec="milliseconds")
        for each in recorded["time"]
    ]
    table.to_csv(folder / "log.csv", index=False)
    (folder / "map.yaml").write_text(MAP, "utf-8")
    return folder, recorded


def judged(folder, tmp_path, monkeypatch, criteria):
    monkeypatch.chdir(tmp_path)
    conditions = tmp_path / "night.yaml"
    conditions.write_text(logs.CONDITIONS.replace("uictest-stop", criteria), "utf-8")
    arguments = ["--map", str(folder / "map.yaml"), "--scenario", "night.yaml"]
    assert execute(["log", str(folder / "log.csv"), *arguments]) in (0, 1)
    run = tmp_path / "reports" / "latest"
    return run, list(csv.DictReader((run / "tables/campaign_stops.csv").read_text("utf-8").splitlines()))


@pytest.mark.parametrize("criteria", ["uictest-stop", "uictest-wsp"])
def test_the_worst_stop_comes_first_and_the_best_dry_ones_last(log, tmp_path, monkeypatch, criteria):
    """By `uictest-wsp` the dry stops are no slide tests, by which they used to be the worst of all."""
    folder, _ = log
    _, stops = judged(folder, tmp_path, monkeypatch, criteria)
    names = [row["stops"] for row in stops]
    assert names[:3] == [LOCKS, SLIDES_LONGER, SLIDES]
    assert set(names[3:]) == set(DRY)
    assert float(stops[0]["locked_s"]) > 10.0


def test_terminal_page_and_tables_say_when_and_where(log, tmp_path, monkeypatch, capsys):
    folder, recorded = log
    run, stops = judged(folder, tmp_path, monkeypatch, "uictest-stop")
    travelled = (recorded["speed"] * logs.STEP).cumsum()
    shown, page = capsys.readouterr().out, (run / "index.html").read_text("utf-8")
    (table,) = [
        each
        for each in json.loads((run / "results.json").read_text("utf-8"))["campaign"]["tables"]
        if each["name"] == "stops"
    ]
    for row, cells in zip(stops, table["rows"], strict=True):
        sample = int(row["sample"]) - 1
        date = BEGIN + pd.Timedelta(seconds=float(recorded["time"][sample]))
        assert pd.Timestamp(row["clock"]) == date.round("ms")
        assert float(row["distance_m"]) == pytest.approx(travelled[sample], abs=0.5)
        assert float(row["place_m"]) == pytest.approx(PLACE + travelled[sample], abs=0.5)
        assert cells[1] == row["clock"]
        line = next(each for each in shown.splitlines() if each.startswith(f"  {row['stops']} "))
        assert re.search(rf"{row['clock']} +{float(row['distance_m']):.0f} ", line)
        assert row["clock"] in page


@pytest.mark.parametrize(
    ("time", "text"),
    [
        (0.5, "0.5 s"),
        (-3.25, "-3.25 s"),
        (86400.0, "86400 s"),
        (1772352090.04, "2026-03-01 08:01:30.040"),
        (1772352090040.0, "1.77235209004e+12 s"),
        (float("nan"), "nan s"),
    ],
)
def test_a_clock_is_a_date_where_it_shows_one(time, text):
    assert clock_text(time) == text

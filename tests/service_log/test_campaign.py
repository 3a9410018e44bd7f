"""What the stops of a log show together: dry and wet ones, the friction of each, the worst and where."""

import csv
import json
import re
from dataclasses import replace
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pandas as pd
import pytest

import uictest
from tests.service_log import logs
from uictest.analysis.logged_stops import StopsTogether
from uictest.cli.entry import execute
from uictest.core.recording import Recording, read_parquet
from uictest.recorded.field_data import judge_recording, load_map, stop_in
from uictest.recorded.service_log import LoggedEvent, clock_text, find_stops, write_stops

MAP = load_map("uictest")[0]
EVENT = LoggedEvent(Path("log.parquet"), 5, 0.05, 1.0, 20.0, 0.0, (0, 100), begins_braked=False)


def judged(folder, stops, *arguments):
    """Run `uictest log` over a log of stops, and return the folder of the run."""
    logs.write_log(stops, folder / "night.parquet")
    (folder / "night.yaml").write_text(logs.CONDITIONS, "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        code = execute(["log", "night.parquet", "--scenario", "night.yaml", "-q", *arguments])
    assert code in (0, 1)
    return next(folder.glob("reports/2*"))


def rows(run, name):
    path = run / f"tables/campaign_{name}.csv"
    return list(csv.DictReader(path.read_text("utf-8").splitlines())) if path.is_file() else []


@pytest.fixture(name="night", scope="module")
def _night(tmp_path_factory):
    dry = "stop-0001 or stop-0002 or stop-0003"
    return judged(tmp_path_factory.mktemp("night"), logs.night(1), "--dry", dry)


def test_the_friction_of_every_slippery_stop_is_that_of_its_rail(tmp_path):
    stops = [logs.simulated(logs.wet(mu), 80.0, k) for k, mu in enumerate((0.075, 0.09, 0.11))]
    run = judged(tmp_path, [logs.simulated(logs.DRY, 80.0, 9), *stops])
    first, *others = rows(run, "friction")
    assert first["standing"] == "at least"
    assert float(first["friction"]) < 0.3
    for row, truth in zip(others, (0.075, 0.09, 0.11), strict=True):
        assert row["standing"] == "found"
        assert float(row["friction"]) == pytest.approx(truth, rel=0.02)


def test_no_friction_is_found_of_a_rail_that_sliding_cleans(night):
    """Every second slippery stop of the night: one coefficient says twice the friction of its rail."""
    slippery = rows(night, "friction")[3:]
    assert [row["standing"] for row in slippery] == ["found", "not one"] * 5 + ["found"]
    for row in slippery[1::2]:
        assert row["friction"] == ""
        assert "sliding cleans the rail" in row["remark"]
    assert all(0.06 < float(row["friction"]) < 0.09 for row in slippery[::2])


def test_a_rail_that_is_as_good_has_a_k_wet_of_one_from_whatever_speed(tmp_path):
    stops = [logs.simulated(logs.DRY, speed, k) for k, speed in enumerate((78.0, 78.1, 82.0, 82.1))]
    run = judged(tmp_path, stops, "--dry", "stop-0001 or stop-0002")
    (row,) = [each for each in rows(run, "wet_series") if each["measure"] == "stopping_distance_extension"]
    assert float(row["value"]) == pytest.approx(0.0, abs=2.0), "%; 10 % by the squares of the speeds"


def test_every_format_has_the_campaign_and_links_the_stops_that_a_table_names(night):
    results = json.loads((night / "results.json").read_text("utf-8"))
    names = [table["name"] for table in results["campaign"]["tables"]]
    assert names == ["stops", "dry_stops", "friction", "wet_series", "wet_stops"]
    (night / "index.html").unlink()
    assert execute(["report", str(night), "--format", "html,md,xlsx"]) == 0
    page, summary = ((night / name).read_text("utf-8") for name in ("index.html", "summary.md"))
    assert "Friction of the rail, stop by stop" in page
    assert "Friction of the rail, stop by stop" in summary
    assert re.search(r'<td class="why"><a href="#[^"]+">stop-0004</a></td>', page)
    with ZipFile(night / "report.xlsx") as book:
        assert "campaign_wet_series" in book.read("xl/workbook.xml").decode()


def test_stops_named_as_dry_are_judged_on_a_dry_rail_and_make_the_reference_of_k_wet(night):
    results = json.loads((night / "results.json").read_text("utf-8"))
    rails = [each["settings"]["rail"] for each in results["subjects"].values()]
    assert rails == ["dry"] * 3 + ["wet"] * 11
    (dry,) = rows(night, "dry_stops")
    assert (dry["dry_stops"], dry["accepted"]) == ("3", "3 of 3")
    wet = rows(night, "wet_stops")
    assert len(wet) == 11
    assert all(float(row["extension_percent"]) > 0.0 for row in wet)
    measures = {case["id"]: case["measures"] for case in results["cases"]}
    lengths = []
    for name in (f"stop-{k:04d}" for k in range(1, 15)):
        speed = 3.6 * read_parquet(night / "recordings" / f"{name}.parquet")["speed"][0]
        lengths.append(measures[name]["deceleration_distance_m"] * (80.0 / speed) ** 2)
    increase = 100.0 * (np.mean(lengths[3:]) / np.mean(lengths[:3]) - 1.0)
    (row,) = [each for each in rows(night, "wet_series") if each["measure"] == "k_wet"]
    assert float(row["value"]) == pytest.approx(100.0 / (100.0 + increase), rel=1e-9)
    assert float(row["low"]) < float(row["value"]) < float(row["high"])


def test_logs_of_one_name_are_told_apart_by_their_folder(tmp_path, monkeypatch):
    """Two nights, both `a<line feed>b.parquet`: a part of the path says which is dry."""
    monkeypatch.chdir(tmp_path)
    rails = {"mon": logs.DRY, "tue": logs.wet(0.09)}
    for number, (night, rail) in enumerate(rails.items()):
        Path(night).mkdir()
        stop = logs.simulated(rail, 40.0, number)
        logs.write_log([stop], Path(night, "a\nb.parquet"), begin=1000.0 * number)
    Path("night.yaml").write_text(logs.CONDITIONS, "utf-8")
    files = [f"{night}/a\nb.parquet" for night in rails]
    assert execute(["log", *files, "--scenario", "night.yaml", "-q", "--dry", "mon/a"]) in (0, 1)
    subjects = json.loads(Path("reports/latest/results.json").read_text("utf-8"))["subjects"]
    assert [each["settings"]["rail"] for each in subjects.values()] == ["dry", "wet"]


@pytest.mark.parametrize("braked", [True, False])
def test_a_log_without_a_stop_leaves_reports_that_say_so(tmp_path, capsys, monkeypatch, braked):
    monkeypatch.chdir(tmp_path)
    stop = logs.simulated(logs.DRY, 40.0, 1)
    if not braked:
        released = {name: 0.0 * stop[name] for name in stop.channels if "pressure" in name}
        stop = Recording({**stop.channels, **released}, stop.units)
    logs.write_log([stop], tmp_path / "night.parquet")
    (tmp_path / "night.yaml").write_text(logs.CONDITIONS, "utf-8")
    if braked:
        assert execute(["log", "night.parquet", "--scenario", "night.yaml", "--dry", "stop-0007"]) == 4
        assert "stop-0007: selects no stop" in capsys.readouterr().err
    options = ["--scenario", "night.yaml", "--from", "50 km/h", "--dry", "stop-0001", "--junitxml", "j.xml"]
    assert execute(["log", "night.parquet", *options, "-q"]) == 5
    reason = "1 application of the brake passed over" if braked else "the brake is never applied"
    told = capsys.readouterr().err
    assert "no stop found: " in told
    assert reason in told
    results = json.loads(Path("reports/latest/results.json").read_text("utf-8"))
    assert (results["cases"], len(results.get("passed_over", []))) == ([], int(braked))
    assert reason in results["campaign"]["sentences"][0]
    for name in ("index.html", "junit.xml"):
        assert Path("reports/latest", name).is_file()
    assert Path("reports/latest/tables/campaign_passed_over.csv").is_file() == braked
    assert Path("j.xml").read_bytes() == Path("reports/latest/junit.xml").read_bytes()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda table: table["rows"].append(["x"]), "one cell for each column"),
        (lambda table: table["columns"][0].__setitem__(2, 99), "digits of a column"),
        (lambda table: table.__setitem__("place", "nowhere"), "campaign.0.tables.0.place"),
    ],
)
def test_a_document_that_was_changed_by_hand_is_refused_with_its_place(night, tmp_path, capsys, change, told):
    document = json.loads((night / "results.json").read_text("utf-8"))
    change(document["campaign"]["tables"][0])
    (tmp_path / "results.json").write_text(json.dumps(document), "utf-8")
    assert execute(["report", str(tmp_path), "--format", "html"]) == 4
    assert told in capsys.readouterr().err


@pytest.fixture(name="recorded", scope="module")
def _recorded(tmp_path_factory):
    """A recorded stop, and the case that it is judged as."""
    folder = tmp_path_factory.mktemp("recorded")
    log = find_stops([logs.write_log([logs.simulated(logs.wet(0.08), 50.0, 2)], folder / "log.parquet")], MAP)
    case, *_ = uictest.load(logs.SCENARIO, set={"criteria": "uictest-stop"})
    return stop_in(min(write_stops(log, MAP, folder / "stops")), MAP), case


def shown_by(stop, case):
    result, _ = judge_recording(case, stop)
    together = StopsTogether({case.id: EVENT}, (), vehicle_known=True)
    together.add(case, stop, result)
    return {table.name: table.table.rows for table in together.campaign([result]).tables}


@pytest.mark.parametrize(
    "lacking",
    [
        *("wheel_speed", "valve_command", "cylinder_pressure", "clamping_force", "brake_line_pressure"),
        "wheel_speed_3",
    ],
)
def test_whatever_a_record_lacks_the_rest_is_said(recorded, lacking):
    stop, case = recorded
    kept = {name: own for name, own in stop.recording.channels.items() if not name.startswith(lacking)}
    recording = Recording(kept, {name: stop.recording.units[name] for name in kept})
    assert {"friction", "wet_stops"} <= shown_by(replace(stop, recording=recording), case).keys()


def test_the_friction_of_a_stop_stands_beside_its_place_and_a_few_samples_have_none(recorded):
    stop, case = recorded
    (row,) = shown_by(replace(stop, position=12_345.0), case)["friction"]
    assert row["place_m"] == 12_345.0
    for samples in (1, 2, 15, 40):
        kept = {name: own[:samples] for name, own in stop.recording.channels.items()}
        short = replace(stop, recording=Recording(kept, stop.recording.units), standstill=None)
        assert [row["standing"] for row in shown_by(short, case)["friction"]] != ["found"]


BEGIN = pd.Timestamp("2026-03-01 08:00:00")
PLACE = 100_000.0
DATED_MAP = """schema: uictest/channel-map/1
name: dated
extends: uictest
channels: {distance: {source: Weg, unit: km}}
"""
LOCKS, SLIDES_LONGER, SLIDES, DRY = "stop-0003", "stop-0005", "stop-0002", ("stop-0001", "stop-0004")


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A CSV log with dates and a distance on the line: two dry stops, two that slide, one that locks."""
    folder = tmp_path_factory.mktemp("worst")
    dry = logs.simulated(logs.DRY, 80.0, 1)
    slides, slides_longer = (logs.simulated(logs.wet(mu), 80.0, k) for k, mu in ((2, 0.09), (3, 0.07)))
    values = {"initial_speed": "80 km/h", "criteria": "uictest-stop"}
    values |= {"rail": logs.wet(0.06), "rig.wsp": "bypassed"}
    locks = uictest.simulate(uictest.load(logs.SCENARIO, set=values)[0])
    recorded = pd.read_parquet(
        logs.write_log([dry, slides, locks, dry, slides_longer], folder / "log.parquet")
    )
    table = recorded.rename(columns=lambda name: name if name == "time" else f"{name} [{logs.unit_of(name)}]")
    table["Weg [km]"] = (PLACE + (recorded["speed"] * logs.STEP).cumsum()) / 1000.0
    dates = [BEGIN + pd.Timedelta(seconds=float(each)) for each in recorded["time"]]
    table["time"] = [date.isoformat(timespec="milliseconds") for date in dates]
    table.to_csv(folder / "log.csv", index=False)
    (folder / "map.yaml").write_text(DATED_MAP, "utf-8")
    return folder, recorded


def judged_by(folder, tmp_path, monkeypatch, criteria):
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
    _, stops = judged_by(folder, tmp_path, monkeypatch, criteria)
    names = [row["stops"] for row in stops]
    assert names[:3] == [LOCKS, SLIDES_LONGER, SLIDES]
    assert set(names[3:]) == set(DRY)
    assert float(stops[0]["locked_s"]) > 10.0


def test_terminal_page_and_tables_say_when_and_where(log, tmp_path, monkeypatch, capsys):
    folder, recorded = log
    run, stops = judged_by(folder, tmp_path, monkeypatch, "uictest-stop")
    travelled = (recorded["speed"] * logs.STEP).cumsum()
    shown, page = capsys.readouterr().out, (run / "index.html").read_text("utf-8")
    lines = shown.splitlines()
    last = next(k for k, line in enumerate(lines) if line.startswith("FAILED: "))
    [failing] = [line for line in lines[:last] if line.startswith(f"  {LOCKS}: wet rail, ")]
    assert (
        failing
        == f"  {LOCKS}: wet rail, {stops[0]['clock']}, at {float(stops[0]['place_m']):.0f} m on the line"
    )
    assert stops[0]["misses"].startswith("locked-wheels ")
    assert [row["rail"] for row in stops] == ["wet"] * len(stops)
    campaign = json.loads((run / "results.json").read_text("utf-8"))["campaign"]
    (table,) = [each for each in campaign["tables"] if each["name"] == "stops"]
    for row, cells in zip(stops, table["rows"], strict=True):
        sample = int(row["sample"]) - 1
        date = BEGIN + pd.Timedelta(seconds=float(recorded["time"][sample]))
        assert pd.Timestamp(row["clock"]) == date.round("ms")
        assert float(row["distance_m"]) == pytest.approx(travelled[sample], abs=0.5)
        assert float(row["place_m"]) == pytest.approx(PLACE + travelled[sample], abs=0.5)
        assert row["clock"] in cells
        line = next(each for each in lines if each.startswith(f"  {row['stops']} "))
        assert re.search(rf"{row['clock']} +{float(row['place_m']):.0f}\b", line)
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

"""`uictest evaluate`: recordings as they are judged, also those that contradict their scenario."""

import json
from pathlib import Path

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.core.recording.formats import ReadingInterruptedError, writer_of

from ..conftest import STATED, manifest_of, results_of, rolling_train, verdicts_in

OWN_MAP = "schema: uictest/channel-map/1\nname: own\nextends: uictest\n"


@pytest.fixture
def stop(workplace):
    path = workplace / "Stop 1.csv"
    writer_of("csv")(rolling_train(), path)
    return path


def test_a_stop_is_judged_and_reported_as_by_run(call, stop, monkeypatch):
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "step.md")
    answer = call("evaluate", stop, *STATED, "--junitxml", "reports/j.xml", code=0)
    assert verdicts_in(answer.out) == {"stop-1": "pass"}
    assert "trigger: at 0 s, stated by the file; raster: 10 ms" in answer.err
    assert "distance: integrated from speed" in answer.err
    files = {path.name for path in Path("reports/latest/").iterdir()}
    assert {"results.json", "junit.xml", "summary.csv", "manifest.json", "criteria.csv"} <= files
    manifest = manifest_of()
    assert {"Stop 1.csv", "library:channel_maps/uictest.yaml"} <= manifest["inputs"].keys()
    assert 'name="stop-1"' in Path("reports/j.xml").read_text()
    assert "stop-1" in Path("step.md").read_text()


def test_json_is_the_document_with_the_preparation_in_it(call, stop, workplace):
    (workplace / "own.yaml").write_text(OWN_MAP + "preparation: {low_pass: 5 Hz}\n")
    document = json.loads(call("evaluate", stop, *STATED, "--format", "json", "--map", "own.yaml").out)
    [case] = document["cases"] if "cases" in document else document["results"]
    assert case["criteria"][0]["definition"]["filter"].startswith("low-pass 5 Hz")
    assert case["measures"]["energy_residual"] is None
    assert case["wheelsets"][0]["valve_actuations"] is None


def test_the_page_of_a_recorded_stop_draws_the_first_phase_and_says_that_it_is_recorded(call, workplace):
    time = rolling_train()["time"]
    slid = np.where((time > 1.0) & (time < 6.0), 0.8, 1.0) * rolling_train()["speed"]
    writer_of("csv")(rolling_train(wheel_speed_2=slid), workplace / "slid.csv")
    stated = (*STATED[1:-1], "--set=criteria=uictest-slide.yaml", "--set=rail.condition=wet")
    (workplace / "uictest-slide.yaml").write_text(
        "schema: uictest/criteria/1\nname: slide\ncriteria:\n"
        "  - {id: adhesion, layer: validity, measure: initial_adhesion, upper: 0.2 g,"
        " definition: {first_phase_duration: {value: 2 s, range: [1 s, 3 s]}}}\n"
    )
    call("evaluate", "slid.csv", *stated, "--record", "all", code=0)
    call("report", "reports/latest", "--format", "html", "-o", "again")
    for page in (Path("reports/latest/index.html"), Path("again/index.html")):
        html = page.read_text()
        assert "first phase, 2 s" in html
        assert "limit 0.2 g" in html
        assert "Recorded stop" in html
        assert "one-caliper" not in html


def test_one_stop_is_judged_by_a_scenario_or_one_of_its_cases_and_files_of_one_name_get_different_ids(
    call, stop, scenario, workplace
):
    from_36 = ("--set", "initial_speed=36 km/h")
    call("evaluate", stop, "--scenario", scenario("a", "rail: {condition: wet}\n"), *from_36, code=0)
    path = scenario("a", "matrix: {brake.command: [80 %, 90 %]}\n")
    call("evaluate", stop, "--scenario", path, "-k", "command=80", *from_36, code=0)
    (workplace / "other").mkdir()
    (workplace / "other" / "stop-1.csv").write_bytes(stop.read_bytes())
    answer = call("evaluate", stop, "other/stop-1.csv", *STATED)
    assert list(verdicts_in(answer.out)) == ["stop-1", "stop-1-2"]


@pytest.mark.parametrize(("option", "kept"), [((), True), (("--record", "none"), False)])
def test_a_missed_criterion_exits_1_and_keeps_the_samples_unless_none_are_asked_for(call, option, kept):
    locked = np.where(np.arange(1050) < 200, rolling_train()["speed"], 0.0)
    writer_of("parquet")(rolling_train(wheel_speed_3=locked), Path("locked.parquet"))
    answer = call("evaluate", "locked.parquet", *STATED, *option, code=1)
    assert "locked misses requirements\n" in answer.out
    assert "\n  locked-wheels: 5.23 s (limit 1 s), wheelset 3, 1.99 to 7.22 s\n" in answer.out
    # A recorded stop cannot be run again.
    assert "uictest run" not in answer.out
    assert Path("reports/latest/recordings/locked.parquet").exists() == kept


@pytest.mark.parametrize("end", [8.0, 2.0, 0.02])
def test_a_record_that_is_cut_off_is_inconclusive_and_exits_1(call, workplace, end):
    writer_of("csv")(rolling_train(end), workplace / "cut.csv")
    answer = call("evaluate", "cut.csv", *STATED, code=1)
    assert verdicts_in(answer.out) == {"cut": "inconclusive"}
    assert "standstill: no standstill; the record ends after" in answer.out
    assert "locked-wheels: " in answer.out
    assert "FAILED: 1 of 1 case lacks data for a verdict: cut (" in answer.out


def test_a_record_without_wheel_speeds_is_inconclusive_and_an_unusable_one_an_error(call, workplace):
    whole = rolling_train()
    speed_only = {name: whole[name] for name in ("time", "speed")}
    recording = Recording(speed_only, {"time": "s", "speed": "m/s"}, whole.metadata)
    writer_of("csv")(recording, workplace / "speed.csv")
    answer = call("evaluate", "speed.csv", *STATED, code=1)
    assert verdicts_in(answer.out) == {"speed": "inconclusive"}
    assert "locked-wheels: not recorded: wheel_speed_1" in answer.out
    lines = ["time [s],speed [m/s]", "0,10", "1,9", "1,8", "0.5,7"]
    (workplace / "bad.csv").write_text("\n".join(lines) + "\n")
    answer = call("evaluate", "bad.csv", *STATED, code=3)
    assert "time-backwards" in answer.out
    assert "time-duplicate" in answer.err


@pytest.mark.parametrize("preparation", ["raster: 0 ms", "low_pass: nan Hz", "trigger_lead: -1 s"])
def test_a_preparation_that_cannot_be_is_refused_at_its_place(call, stop, workplace, preparation):
    (workplace / "own.yaml").write_text(f"{OWN_MAP}preparation:\n  {preparation}\n")
    key = f"preparation.{preparation.partition(':')[0]}"
    refused = call("evaluate", stop, *STATED, "--map", "own.yaml", code=4, says="own.yaml:5:")
    assert key in refused.err


def test_list_shows_channels_and_the_preset_and_the_trigger_of_the_option_counts(call, stop, workplace):
    answer = call("evaluate", stop, "--list", code=0)
    assert "speed\tm/s\t1050\t0 .. 10" in answer.out
    assert answer.out.splitlines()[-1] == "the preset uictest fits (--map uictest)"
    (workplace / "own.yaml").write_text(OWN_MAP + "preparation: {trigger_time: 2 s}\n")
    command = ("evaluate", stop, *STATED, "--map", "own.yaml")
    assert "trigger: at 2 s, stated by the user" in call(*command).err
    assert "trigger: the record begins with it" in call(*command, "--trigger", "start").err


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("t [s],vZug\n0,10\n1,9\n", ["schema: uictest/channel-map/1"]),
        (
            "t [s];v [km/h]\n0,0;10,5\n1,0;9,5\n",
            ["v\tkm/h\t2\t9.5 .. 10.5", 'csv:\n  delimiter: ";"\n  decimal: ","\ntime: "t"\n'],
        ),
        (
            "Zeit [s],vZug [km/h],Achse1 [km/h],Achse2 [km/h]\n0,10,10,10\n1,9,9,9\n",
            [
                "the preset common-names fits in part",  # it leaves the wheels out
                "not assigned: wheel_speed_{n}; needed for",
                'not used: "Achse1", "Achse2"',
                'speed: "vZug"',
            ],
        ),
    ],
)
def test_list_proposes_a_map_where_no_preset_fits(call, text, lines):
    Path("run.csv").write_text(text)
    listed = call("evaluate", "run.csv", "--list", code=0).out
    for line in lines:
        assert line in listed


def test_a_channel_map_with_a_dialect_as_written_and_as_proposed(call):
    samples = [f"{k / 10:.1f};{max(36.0 - 3.6 * k / 10, 0.0):.2f}".replace(".", ",") for k in range(110)]
    Path("zug.csv").write_bytes("\n".join(["Prüfzug", "Zeit;vZug", "s;km/h", *samples]).encode("cp1252"))
    Path("map.yaml").write_text(
        "schema: uictest/channel-map/1\nname: zug\nextends: common-names\npreparation: {trigger: start}\n"
        'csv: {encoding: cp1252, delimiter: ";", decimal: ",", header_line: 2, unit_line: 3}\n'
    )
    # Without wheel speeds there is no verdict on locked wheels.
    answer = call("evaluate", "zug.csv", "--map", "map.yaml", *STATED, code=1)
    assert results_of()["cases"][0]["measures"]["braking_time_s"] == pytest.approx(10.0)
    assert "the record begins with it; raster: 100 ms" in answer.err
    lines = call("evaluate", "zug.csv", "--map", "map.yaml", "--list").out.splitlines()
    Path("own.yaml").write_text("\n".join(lines[lines.index("schema: uictest/channel-map/1") :]))
    call("evaluate", "zug.csv", "--map", "own.yaml", "--trigger", "start", *STATED, code=1)
    assert results_of()["cases"][0]["measures"]["braking_time_s"] == pytest.approx(10.0)


def test_a_full_temporary_folder_is_an_error_and_no_fault_of_the_file(call, monkeypatch, tmp_path):
    def broken_off(path, dialect=None):
        raise ReadingInterruptedError(28, f"No space left on device to read {path}", "/small")

    monkeypatch.setattr("uictest.recorded.field_data.recorded_stop.read_contents", broken_off)
    (tmp_path / "stop.csv").write_text("time,speed\n0,1\n")
    answer = call("evaluate", "stop.csv", *STATED, code=3)
    assert "/small: No space left on device to read stop.csv" in answer.err
    assert "damaged" not in answer.err


RASTER = 0.1
REASON = "recorded 124 km/h, scenario slip-120 says 120 km/h, tolerance 3 km/h"


def write(name, time, speed, **more):
    """Write the record of a train of rolling wheels."""
    names = ("speed", *(f"wheel_speed_{n}" for n in (1, 2, 3, 4)))
    table = {"time [s]": time, **{f"{channel} [m/s]": speed for channel in names}, **more}
    samples = np.column_stack(list(table.values()))
    np.savetxt(name, samples, "%.6g", ",", header=",".join(table), comments="")


@pytest.fixture
def judge(call):
    """Judge a stop at 1 m/s2 from a speed in km/h, the brake command at 2 s, by a scenario."""

    def run(speed, scenario, *options, **expected):
        time = np.arange(0.0, 60.0, 0.02)
        write("a.csv", time, np.clip(speed / 3.6 - np.clip(time - 2.0, 0.0, None), 0.0, None))
        return call("evaluate", "a.csv", "--scenario", scenario, "--trigger", "2 s", *options, **expected)

    return run


@pytest.mark.parametrize("speed", [124, 100, 116.9])
def test_a_stop_from_another_speed_never_passes_as_the_test(judge, speed):
    answer = judge(speed, "slip-120", code=1)
    assert verdicts_in(answer.out) == {"a": "invalid"}
    assert f"recorded {speed:.4g} km/h, scenario slip-120 says 120 km/h, tolerance 3 km/h" in " ".join(
        answer.out.split()
    )


def test_every_report_has_the_layer_and_both_numbers(call, judge):
    judge(124, "slip-120", code=1)
    call("report", "reports/latest", "--format", "html", "-o", "again")
    folder = Path("reports/latest")
    for path in (
        folder / "criteria.csv",
        folder / "junit.xml",
        folder / "index.html",
        Path("again/index.html"),
    ):
        assert REASON in path.read_text("utf-8"), path
    results = results_of(folder)
    [verdict] = [each for each in results["cases"][0]["criteria"] if each["id"] == "record-initial-speed"]
    assert (verdict["layer"], verdict["upper"]) == ("record", 3.0)
    assert verdict["value"] == pytest.approx(4.0, abs=0.001)
    assert verdict["definition"]["bound"] == "<= 3 km/h (chosen)"
    assert "the record agrees with its scenario (record)" in (folder / "index.html").read_text("utf-8")


def test_the_checks_that_hold_are_one_sentence_with_those_that_were_not_made(judge):
    assert "checks of the record: all hold, 3 not made" in judge(120, "dry-120", "-v").out
    page = Path("reports/latest/index.html").read_text("utf-8")
    assert "Checks of the record: all hold, 3 not made." in page


def test_a_log_of_other_speeds_passes_no_stop_and_says_how_many(call):
    """As a log of public buses, 27 stops from 24 to 57 km/h, judged as a slip test from 120 km/h."""
    speeds = np.linspace(24.0, 57.0, 27) / 3.6
    courses = [(np.full(100, v), np.linspace(v, 0.0, round(v / RASTER)), np.zeros(50)) for v in speeds]
    brake = np.concatenate([np.repeat((0.0, 1.0, 0.0), list(map(len, course))) for course in courses])
    speed = np.concatenate([part for course in courses for part in course])
    write("bus.csv", RASTER * np.arange(len(speed)), speed, brake_command=brake)
    answer = call("log", "bus.csv", "--scenario", "slip-120", code=1)
    assert "FAILED: 27 of 27 cases fail a check of the rig or of the record" in answer.out
    assert "invalid by the record: 27 of 27 stops (record-initial-speed 27)" in answer.out
    wide = ("--set", "record.tolerances.initial_speed=100 km/h")
    assert "by the record" not in call("log", "bus.csv", "--scenario", "slip-120", *wide).out
    assert "PASSED: 27 cases: 27 pass" in call("log", "bus.csv", *STATED, code=0).out

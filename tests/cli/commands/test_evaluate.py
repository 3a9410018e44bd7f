import json
from pathlib import Path

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.core.recording.formats import ReadingInterruptedError, writer_of

from ..conftest import STATED, rolling_train

OWN_MAP = "schema: uictest/channel-map/1\nname: own\nextends: uictest\n"


@pytest.fixture
def stop(workplace):
    path = workplace / "Stop 1.csv"
    writer_of("csv")(rolling_train(), path)
    return path


def test_a_stop_is_judged_and_reported_as_by_run(call, stop):
    answer = call("evaluate", stop, *STATED, code=0)
    assert answer.out.startswith("pass stop-1 outcome=pass")
    assert "trigger: at 0 s, stated by the file; raster: 10 ms" in answer.err
    assert "distance: integrated from speed" in answer.err
    files = {path.name for path in Path("reports/latest/").iterdir()}
    assert {"results.json", "junit.xml", "summary.csv", "manifest.json", "criteria.csv"} <= files
    manifest = json.loads(Path("reports/latest/manifest.json").read_text())
    assert {"Stop 1.csv", "library:channel_maps/uictest.yaml"} <= manifest["inputs"].keys()


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


def test_a_scenario_states_everything_and_a_case_of_several_is_chosen(call, stop, scenario):
    from_36 = ("--set", "initial_speed=36 km/h")
    call("evaluate", stop, "--scenario", scenario("a", "rail: {condition: wet}\n"), *from_36, code=0)
    path = scenario("a", "matrix: {brake.command: [80 %, 90 %]}\n")
    call("evaluate", stop, "--scenario", path, code=4, says="has 2 cases")
    call("evaluate", stop, "--scenario", path, "-k", "command=80", *from_36, code=0)


def test_a_missed_criterion_exits_1_and_keeps_the_samples(call, workplace):
    locked = np.where(np.arange(1050) < 200, rolling_train()["speed"], 0.0)
    writer_of("parquet")(rolling_train(wheel_speed_3=locked), workplace / "locked.parquet")
    answer = call("evaluate", "locked.parquet", *STATED, code=1)
    assert "locked-wheels" in answer.err + answer.out or "fail" in answer.out
    assert Path("reports/latest/recordings/locked.parquet").exists()


def test_samples_of_no_stop_are_kept_where_none_are_asked_for(call, stop):
    call("evaluate", stop, *STATED, "--record", "none", code=0)
    assert not list(Path("reports/latest").glob("recordings/*"))


def test_a_file_of_junitxml_that_cannot_be_written_is_refused_before_anything_is_judged(call, stop):
    refused = call("evaluate", stop, *STATED, "--junitxml", "nowhere/deep/j.xml", code=3)
    assert "cannot write nowhere/deep/j.xml" in refused.err
    assert not Path("reports").exists()
    call("evaluate", stop, *STATED, "--junitxml", "reports/j.xml", code=0)
    assert 'name="stop-1"' in Path("reports/j.xml").read_text()


def test_the_step_summary_has_recorded_stops_as_well(call, stop, monkeypatch):
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "step.md")
    call("evaluate", stop, *STATED, code=0)
    assert "stop-1" in Path("step.md").read_text()


@pytest.mark.parametrize("end", [8.0, 2.0, 0.02])
def test_a_record_that_is_cut_off_is_inconclusive_and_exits_1(call, workplace, end):
    writer_of("csv")(rolling_train(end), workplace / "cut.csv")
    answer = call("evaluate", "cut.csv", *STATED, code=1)
    assert answer.out.startswith("inconclusive cut outcome=inconclusive expect=pass")
    assert "standstill (requirement) inconclusive: no standstill; the record ends after" in answer.out
    assert "locked-wheels (requirement) inconclusive" in answer.out
    assert answer.err.splitlines()[-1].startswith("uictest: 1 case: 1 inconclusive; 1 not as expected in ")


def test_a_record_without_wheel_speeds_is_inconclusive_and_an_unusable_one_an_error(call, workplace):
    whole = rolling_train()
    speed_only = {name: whole[name] for name in ("time", "speed")}
    recording = Recording(speed_only, {"time": "s", "speed": "m/s"}, whole.metadata)
    writer_of("csv")(recording, workplace / "speed.csv")
    answer = call("evaluate", "speed.csv", *STATED, code=1)
    assert "outcome=inconclusive" in answer.out
    assert "locked-wheels (requirement) inconclusive: not recorded: wheel_speed_1" in answer.out
    lines = ["time [s],speed [m/s]", "0,10", "1,9", "1,8", "0.5,7"]
    (workplace / "bad.csv").write_text("\n".join(lines) + "\n")
    answer = call("evaluate", "bad.csv", *STATED, code=3)
    assert "time-backwards" in answer.out
    assert "time-duplicate" in answer.err


def test_files_of_one_name_get_different_ids_and_unstated_circumstances_are_asked_for(call, stop, workplace):
    call(
        "evaluate", stop, STATED[0], code=4, says="--set brake.position=... --set rig.wsp=... --set criteria"
    )
    assert not Path("reports").exists()
    (workplace / "other").mkdir()
    (workplace / "other" / "stop-1.csv").write_bytes(stop.read_bytes())
    answer = call("evaluate", stop, "other/stop-1.csv", *STATED)
    assert [line.split()[1] for line in answer.out.splitlines()] == ["stop-1", "stop-1-2"]


@pytest.mark.parametrize(
    "arguments",
    [
        ["missing.csv", *STATED],
        ["Stop 1.csv", *STATED, "--map", "nothing"],
        ["Stop 1.csv", *STATED, "--map", "missing.yaml"],
        ["Stop 1.csv", *STATED, "--trigger", "sometime"],
        ["Stop 1.csv", *STATED, "--trigger", "12"],
        ["Stop 1.csv", *STATED, "--trigger", "pressure"],
        ["Stop 1.csv", *STATED[1:], "--set=rail.condition=icy"],
        ["Stop 1.csv", *STATED, "--set", "rail.friction=0.1,0.2"],
        ["Stop 1.csv", "--scenario", "missing.yaml"],
        ["."],
    ],
)
def test_what_cannot_be_used_exits_4_with_a_message(call, stop, arguments):
    answer = call("evaluate", *arguments)
    assert (answer.code, answer.out) == (4, "")
    assert answer.err
    assert "Traceback" not in answer.err
    assert not Path("reports").exists()


@pytest.mark.parametrize("preparation", ["raster: 0 ms", "low_pass: nan Hz", "trigger_lead: -1 s"])
def test_a_preparation_that_cannot_be_is_refused_at_its_place(call, stop, workplace, preparation):
    (workplace / "own.yaml").write_text(f"{OWN_MAP}preparation:\n  {preparation}\n")
    key = f"preparation.{preparation.partition(':')[0]}"
    refused = call("evaluate", stop, *STATED, "--map", "own.yaml", code=4, says="own.yaml:5:")
    assert key in refused.err


def test_the_trigger_of_the_option_counts_where_the_map_states_a_time(call, stop, workplace):
    (workplace / "own.yaml").write_text(OWN_MAP + "preparation: {trigger_time: 2 s}\n")
    command = ("evaluate", stop, *STATED, "--map", "own.yaml")
    assert "trigger: at 2 s, stated by the user" in call(*command).err
    assert "trigger: the record begins with it" in call(*command, "--trigger", "start").err


def test_list_shows_channels_and_the_preset_that_fits_or_proposes_a_map(call, stop, workplace):
    answer = call("evaluate", stop, "--list", code=0)
    assert "speed\tm/s\t1050\t0 .. 10" in answer.out
    assert answer.out.splitlines()[-1] == "the preset uictest fits (--map uictest)"
    (workplace / "run.csv").write_text("t [s],vZug\n0,10\n1,9\n")
    assert "schema: uictest/channel-map/1" in call("evaluate", "run.csv", "--list").out


def test_list_calls_no_preset_fitting_that_leaves_the_wheels_out(call, workplace):
    header = "Zeit [s],vZug [km/h],Achse1 [km/h],Achse2 [km/h],Achse3 [km/h],Achse4 [km/h]"
    (workplace / "run.csv").write_text(f"{header}\n0,10,10,10,10,10\n1,9,9,9,9,9\n")
    out = call("evaluate", "run.csv", "--list").out
    assert "the preset common-names fits in part" in out
    assert "not assigned: wheel_speed_{n}; needed for" in out
    assert 'not used: "Achse1", "Achse2", "Achse3", "Achse4"' in out
    assert 'speed: "vZug"' in out


def test_a_proposed_map_reads_the_file_it_was_proposed_for(call, workplace):
    units = ";".join(["s", *["km/h"] * 5, "°C"])
    rows = [";".join([f"{k / 10:.1f}", *[f"{36 - 3.6 * k / 10:.2f}"] * 5, "20"]) for k in range(101)]
    names = "Zeit;vZug;v1;v2;v3;v4;T"
    text = "\n".join(["Prüfzug", names, units, *rows]).replace(".", ",")
    (workplace / "zug.csv").write_bytes(text.encode("cp1252"))
    (workplace / "table.yaml").write_text(
        "schema: uictest/channel-map/1\nname: table\nextends: common-names\n"
        'csv: {encoding: cp1252, delimiter: ";", decimal: ",", header_line: 2}\n'
    )
    lines = call("evaluate", "zug.csv", "--map", "table.yaml", "--list").out.splitlines()
    (workplace / "own.yaml").write_text("\n".join(lines[lines.index("schema: uictest/channel-map/1") :]))
    answer = call("evaluate", "zug.csv", "--map", "own.yaml", "--trigger", "start", *STATED)
    assert (answer.code, "braking_time_s=10 " in answer.out) == (0, True), answer.err


def test_a_table_of_another_dialect_is_listed_and_refused_with_what_to_declare(call, workplace):
    (workplace / "run.csv").write_text("t [s];v [km/h]\n0,0;10,5\n1,0;9,5\n")
    listed = call("evaluate", "run.csv", "--list", code=0).out
    assert "v\tkm/h\t2\t9.5 .. 10.5" in listed
    assert 'csv:\n  delimiter: ";"\n  decimal: ","\ntime: "t"\n' in listed
    answer = call("evaluate", "run.csv", *STATED)
    assert answer.code == 4
    assert 'set csv: {delimiter: ";", decimal: ","} in a channel map' in answer.err


def test_a_channel_map_with_a_dialect(call, workplace):
    lines = [
        "Zeit;vZug",
        "s;km/h",
        *(f"{k / 10:.1f};{max(36.0 - 3.6 * k / 10, 0.0):.2f}" for k in range(110)),
    ]
    (workplace / "zug.csv").write_text("\n".join(line.replace(".", ",") for line in lines) + "\n")
    (workplace / "map.yaml").write_text(
        "schema: uictest/channel-map/1\nname: zug\nextends: common-names\n"
        'csv: {delimiter: ";", decimal: ",", header_line: 1, unit_line: 2}\npreparation: {trigger: start}\n'
    )
    answer = call(
        "evaluate", "zug.csv", "--map", "map.yaml", *STATED, code=1
    )  # without wheel speeds there is no verdict on locked wheels
    assert "braking_time_s=10" in answer.out
    assert "the record begins with it; raster: 100 ms" in answer.err


def test_a_full_temporary_folder_is_an_error_and_no_fault_of_the_file(call, monkeypatch, tmp_path):
    def broken_off(path, dialect=None):
        raise ReadingInterruptedError(28, f"No space left on device to read {path}", "/small")

    monkeypatch.setattr("uictest.recorded.field_data.recorded_stop.read_contents", broken_off)
    (tmp_path / "stop.csv").write_text("time,speed\n0,1\n")
    answer = call("evaluate", "stop.csv", *STATED, code=3)
    assert "/small: No space left on device to read stop.csv" in answer.err
    assert "damaged" not in answer.err

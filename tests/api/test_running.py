"""Runs in Python are those of the command: the same digits, the same files, no output."""

import json
import math
import signal
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import uictest
from uictest.controllers import ControllerError
from uictest.core.files import latest_run
from uictest.judging import evaluation
from uictest.report import read_run
from uictest.running import campaign
from uictest.running.campaign import stop as stop_module

AXIS = {"rail.friction": [0.06, 0.1]}
FAILING = "expect: fail\n"


def contents(run):
    """The files of a run, with one name for all runs; not JUnit's, which have durations, nor the digests."""
    files = {path.relative_to(run).as_posix(): path for path in run.rglob("*") if path.is_file()}
    in_css = run.name.replace("-", r"\2d ")
    return {
        name: path.read_bytes().replace(run.name.encode(), b"RUN").replace(in_css.encode(), b"RUN")
        for name, path in files.items()
        if not name.startswith("junit") and name != "SHA256SUMS"
    }


def figures(results):
    """Every digit of results; NaN, which equals nothing, as text."""
    return evaluation.to_json(evaluation.cases_document(results))


def test_digits_and_files_are_those_of_the_command(write, command):
    path = write(text=f"tags: [wet]\n{FAILING}")
    words = "run scenarios/stop.yaml --set rail.friction=0.06,0.1 --seed 5 -m wet -o out"
    assert command(*words.split()) == 1
    there = latest_run(Path("out").rename("there"))
    results = uictest.run(path, set=AXIS, seed=5, tag="wet", output="out")
    ours = contents(results.folder)
    assert ours == contents(there)
    manifest = json.loads((results.folder / "manifest.json").read_text())
    assert manifest["command"] == ["uictest", *words.split()]
    assert {"recordings/stop[friction=0.06].parquet", "summary.csv", "index.html"} <= set(ours)


def test_cases_run_as_their_files_do_and_threads_may_run_side_by_side(write):
    path = write()
    cases = uictest.load(path, set=AXIS, seed=2)
    results = uictest.run(cases, jobs=1)
    assert figures(results) == figures(uictest.run(path, set=AXIS, seed=2, jobs=3))
    assert figures(uictest.run(cases[1])) == figures([results[1]])
    assert figures(uictest.run(cases, select="0.1")) == figures([results[1]])
    with ThreadPoolExecutor(2) as threads:
        found = list(threads.map(lambda _: figures(uictest.run(path, set=AXIS, seed=2)), range(2)))
    assert found == [figures(results)] * 2


def test_nothing_is_written_or_printed(write, workplace, capfd):
    path = write()
    before = sorted(workplace.rglob("*"))
    results = uictest.run(path, set=AXIS)
    uictest.simulate(path)
    assert [result.id for result in results] == ["stop[friction=0.06]", "stop[friction=0.1]"]
    assert sorted(workplace.rglob("*")) == before
    assert capfd.readouterr() == ("", "")


def test_the_page_of_loaded_cases_offers_no_command_that_would_run_others(write):
    path = write()
    by_file, loaded = (
        (uictest.run(what, record="all", output="out", **seed).folder / "index.html").read_text()
        for what, seed in ((path, {"seed": 2}), (uictest.load(path, seed=2), {}))
    )
    assert "--seed 2 -k stop" in by_file
    assert "Copy command" not in loaded


def test_recordings_are_those_of_memory_and_found_from_another_working_folder(write, tmp_path, monkeypatch):
    path = write()
    kept = uictest.run(path, record="all").recording("stop")
    results = uictest.run(path, record="all", output="out")
    again = uictest.read_results("out/latest")
    for other in (results.recording("stop"), uictest.simulate(path)):
        assert other.metadata == kept.metadata
        assert isinstance(other, uictest.Recording)
        assert other.frame().equals(kept.frame())
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    for each in (results, again):
        assert each.recording("stop")["time"].size > 100
        assert (each.save() / "recordings" / "stop.parquet").is_file()


def test_reports_are_read_back_and_saving_later_writes_what_output_writes(write, monkeypatch):
    monkeypatch.setattr("uictest.api.running.command_words", lambda *_, **__: ["run"])
    path = write(text=FAILING)
    results = uictest.run(path, set=AXIS, output="out")
    later = uictest.run(path, set=AXIS).save("out")
    assert contents(results.folder) == contents(later)
    assert contents(uictest.read_results(later).save("out")) == contents(later)
    for location in (results.folder, results.folder / "results.json", Path("out/latest")):
        again = uictest.read_results(location)
        assert figures(again) == figures(results)
        assert again.frame().equals(results.frame())
        name = results[0].id
        assert again.recording(name).units == results.recording(name).units
    assert figures(read_run(results.folder).results) == figures(results)
    Path("out/results.json").write_text("[]")
    with pytest.raises(ValueError, match="not the results of a run"):
        uictest.read_results("out/results.json")
    with pytest.raises(FileNotFoundError):
        uictest.read_results("nowhere")


@pytest.mark.parametrize(
    ("record", "recorded"), [("all", ["fails", "passes"]), ("failed", ["fails"]), ("none", [])]
)
def test_what_is_recorded(write, record, recorded):
    write("passes"), write("fails", FAILING)
    results = uictest.run(record=record, rate=50.0)
    for name in ("fails", "passes"):
        if name in recorded:
            assert results.recording(name)["time"][1] == pytest.approx(0.02)
        else:
            with pytest.raises(KeyError, match="was not recorded"):
                results.recording(name)
    folder = uictest.run(record=record, output="out").folder
    assert sorted(path.stem for path in folder.glob("recordings/*")) == recorded


def test_a_repeated_stop_has_its_seeds(write):
    results = uictest.run(write(), repeat=3, seed=4)
    assert list(results.repeats().index) == [("stop", 4), ("stop", 5), ("stop", 6)]
    assert results.frame().loc["stop", "stops"] == 3


def test_a_series_is_judged(write):
    write("dry", rail="{condition: dry}"), write("wet")
    text = "schema: uictest/series/1\nname: both\ndry: dry.yaml\nwet: wet.yaml\ncriteria: uictest-wsp\n"
    path = Path("scenarios/both.series.yaml")
    path.write_text(text)
    results = uictest.run(path)
    assert (len(results), [each.id for each in results.series]) == (0, ["both"])
    assert results["both.wet"].id == "both.wet"
    assert {"k_wet"} <= set(results.table("series").index.get_level_values("measure"))
    assert results.met is results.series[0].met
    for name in ("series", "series-criteria", "series-stops"):
        table = results.table(name)
        assert len(table) > 0
        assert table.index.is_unique
    assert "both" in repr(results)
    assert "both" in results._repr_html_()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"jobs": 0}, "jobs is 0, expected a number of threads from 1 or 'auto'"),
        ({"jobs": "two"}, "jobs is 'two', expected a number of threads from 1 or 'auto'"),
        ({"record": "al"}, "record is 'al'; did you mean 'all'?"),
        ({"rate": math.nan}, "rate is nan, expected 1 to 100000 samples per second"),
        ({"select": "x"}, "nothing selected among 1 case; their tags: none"),
    ],
)
def test_an_argument_that_cannot_be_used_is_named(write, arguments, message):
    path = write()
    with pytest.raises(ValueError) as raised:
        uictest.run(path, **arguments)
    assert str(raised.value) == message


def test_cases_are_not_changed_nor_mixed_with_files(write):
    path = write()
    cases = uictest.load(path)
    for arguments in ({"set": AXIS}, {"seed": 1}, {"repeat": 2}, {"trust": ["."]}):
        with pytest.raises(ValueError, match=r"apply to files: pass them to uictest\.load"):
            uictest.run(cases, **arguments)
    with pytest.raises(ValueError, match="nothing to run: name files or give cases"):
        uictest.run([])
    with pytest.raises(ValueError, match="name files or give cases, not both"):
        uictest.run([path, *cases])
    with pytest.raises(ValueError, match="two cases are called 'stop'"):
        uictest.run([*cases, *cases])


def test_an_interrupt_is_raised_and_what_is_finished_then_is_reported(write, monkeypatch):
    path, run_cases = write(), campaign.run_cases

    def cut_short(cases, *settings, **options):
        done = run_cases(cases[:finished], *settings, **options)
        done.interrupted = True
        return done

    monkeypatch.setattr(campaign, "run_cases", cut_short)
    finished = 0
    with pytest.raises(KeyboardInterrupt):
        uictest.run(path)
    with pytest.raises(KeyboardInterrupt):
        uictest.run(path, output="reports")
    assert not Path("reports").exists()
    finished = 1
    with pytest.raises(KeyboardInterrupt):
        uictest.run(path, set=AXIS, output="out")
    assert [result.id for result in uictest.read_results("out/latest")] == ["stop[friction=0.06]"]


def test_ctrl_c_ends_a_run_and_leaves_the_handler_alone(write, monkeypatch):
    path, run_stop = write(), stop_module.run_stop
    before = signal.signal(signal.SIGINT, signal.default_int_handler)

    def interrupted(stop, *arguments):
        if stop.seed == 0:  # a second interrupt would meet what follows the run
            signal.raise_signal(signal.SIGINT)
        return run_stop(stop, *arguments)

    try:
        with monkeypatch.context() as patched, pytest.raises(KeyboardInterrupt):
            patched.setattr(stop_module, "run_stop", interrupted)
            uictest.run(path, set={"seed": list(range(20))}, jobs=1)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
    assert uictest.run(path).met


def test_a_stop_that_crashes_is_a_result(write, monkeypatch):
    def crash(stop, *_):
        result = evaluation.error_result(stop.case, "ZeroDivisionError: no wheel load")
        return campaign.StopRun(stop, campaign.CaseRun(result))

    monkeypatch.setattr(stop_module, "run_stop", crash)
    results = uictest.run(write())
    assert (results.met, results[0].outcome) == (False, "error")
    assert math.isnan(results.frame().loc["stop", "braking_distance_m"])


def test_a_recording_is_a_frame_and_a_figure_with_a_panel_for_each_unit(write):
    recording = uictest.simulate(write(), record=200)
    assert np.diff(recording["time"])[:100] == pytest.approx(0.005)
    frame = recording.frame()
    assert frame.index.name == "time"
    assert [frame.index.name, *frame.columns] == list(recording.channels)
    for name in frame.columns:
        assert np.array_equal(frame[name], recording[name], equal_nan=True)
    assert frame.attrs["units"] == recording.units
    assert frame.attrs["metadata"]["case"] == "stop"
    figure = recording.plot(["speed", "wheel_speed_*", "tank_pressure_1"])
    wheels = [f"wheel_speed_{n}" for n in range(1, 5)]
    assert [each.name for each in figure.data] == ["speed", *wheels, "tank_pressure_1"]
    assert (figure.layout.yaxis.title.text, figure.layout.yaxis2.title.text) == ("m/s", "Pa")
    assert figure.layout.xaxis2.title.text == "time, s"
    assert np.array_equal(figure.data[0].y, recording["speed"])
    looks = {(each.line.color, each.line.dash) for each in figure.data[:5]}
    assert len(looks) == len({dash for _, dash in looks}) + 1 == 5  # train and wheelset 1 differ by colour
    with pytest.raises(KeyError, match=r"no channel 'wheel_sped_\*' in this recording of distance, speed"):
        recording.plot(["wheel_sped_*"])


def test_set_seed_and_case_choose_the_stop(write):
    path = write(text="matrix: {rail.friction: [0.06, 0.1]}\n")
    told = r"the scenario has 2 cases: pass case= one of stop\[friction=0\.06\]"
    with pytest.raises(ValueError, match=told):
        uictest.simulate(path)
    first = uictest.simulate(path, case="stop[friction=0.1]", seed=3)
    same = uictest.simulate(uictest.load(path, select="0.1")[0], seed=3)
    other = uictest.simulate(path, set={"rail.friction": 0.1}, seed=4)
    assert first.frame().equals(same.frame())
    assert not np.array_equal(first["measured_speed_1"], other["measured_speed_1"])


def test_what_applies_to_files_is_rejected_for_a_case_and_a_rate_is_one_that_a_run_can_have(write):
    (case,) = uictest.load(write())
    for arguments in ({"set": {"seed": 1}}, {"case": "stop"}, {"trust": ["."]}):
        with pytest.raises(ValueError, match="apply to files"):
            uictest.simulate(case, **arguments)
    for rate in (0, -1, 0.5, 100_001, float("nan"), float("inf")):
        with pytest.raises(ValueError, match=r"record is .*, expected 1 to 100000 samples per second"):
            uictest.simulate(case, record=rate)


def test_a_controller_that_fails_is_an_error(write):
    path = write(text="controller: {python: wsp.py, class: Wsp}\n")
    methods = ("__init__(self, config): pass", "reset(self): pass", "step(self, i): 1 / 0")
    text = "".join(f"    def {method}\n" for method in methods)
    Path("scenarios/wsp.py").write_text(f"class Wsp:\n{text}")
    with pytest.raises(ControllerError, match="ZeroDivisionError"):
        uictest.simulate(path)


def test_a_figure_of_a_train_shows_what_was_recorded():
    time = np.arange(3.0)
    channels = {"time": time, "speed": 3.0 - time, "slide_1": np.full(3, np.nan)}
    recording = uictest.Recording(channels, {"time": "s", "speed": "m/s", "slide_1": "1"})
    assert [each.name for each in recording.plot().data] == ["speed"]
    other = uictest.Recording({"time": time, "voltage": time}, {"time": "s", "voltage": "V"})
    assert [each.name for each in other.plot().data] == ["voltage"]

"""Recorded stops, judged in Python as the command judges them."""

import json
from pathlib import Path

import numpy as np
import pytest

import uictest
from uictest.core.files import latest_run
from uictest.core.recording import parquet_bytes
from uictest.core.recording.formats import writer_of
from uictest.judging import evaluation

from ..cli.conftest import STATED as OPTIONS, rolling_train

STATED = {"rail": "dry", "position": "R", "wsp": "active", "criteria": "uictest-stop"}


@pytest.fixture
def train(workplace):
    """The record of a train of rolling wheels that stops from 10 m/s within ten seconds."""
    path = workplace / "Stop 1.csv"
    writer_of("csv")(rolling_train(), path)
    return path


def test_digits_are_those_of_the_command(train, command):
    assert command("evaluate", train, *OPTIONS, "-o", "out") == 0
    folder = latest_run(Path("out"))
    results = uictest.evaluate(train, **STATED)
    written = json.loads((folder / "results.json").read_text())["cases"]
    assert json.loads(evaluation.to_json(evaluation.cases_document(results))) == written
    assert results.recording("stop-1")["speed"][0] == 10.0
    assert {path.name for path in Path().iterdir()} == {train.name, "out"}


def test_output_gets_the_reports(train):
    results = uictest.evaluate([train], **STATED, output="out", record="all")
    files = {path.relative_to(results.folder).as_posix() for path in results.folder.rglob("*")}
    assert {"index.html", "results.json", "recordings/stop-1.parquet"} <= files
    assert uictest.read_results("out/latest")[0].outcome == results[0].outcome


def test_a_scenario_or_a_case_states_the_conditions(train, write):
    path = write(rail="{condition: dry}")
    one = uictest.evaluate(train, scenario=path)
    other = uictest.evaluate(train, scenario=uictest.load(path)[0])
    assert one[0].criteria == other[0].criteria
    with pytest.raises(ValueError, match="a case is judged as it is"):
        uictest.evaluate(train, scenario=uictest.load(path)[0], rail="wet")


def test_missing_statements_are_named_as_arguments(train):
    with pytest.raises(
        ValueError, match="state it with scenario=, or with position=, wsp=, criteria="
    ) as raised:
        uictest.evaluate(train, rail="dry")
    assert "--" not in str(raised.value)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"channel_map": "uictes"}, "no channel map 'uictes': name a preset"),
        ({"trigger": "now"}, "trigger 'now': "),
        ({"record": "every"}, "record is 'every'; accepted: all, failed, none"),
    ],
)
def test_an_argument_that_cannot_be_used_is_named(train, arguments, message):
    with pytest.raises(ValueError, match=message):
        uictest.evaluate(train, **STATED, **arguments)


def test_every_file_that_cannot_be_read_is_named(workplace):
    Path("a.csv").write_text("nothing")
    Path("a.parquet").write_bytes(b"PAR1")
    with pytest.raises(ValueError, match="nothing to evaluate: name recordings"):
        uictest.evaluate([], **STATED)
    with pytest.raises(ValueError, match=r"(?s)a\.csv: .*b\.csv: No such file"):
        uictest.evaluate(["a.csv", "b.csv"], **STATED)
    for name, message in (("a.parquet", "a.parquet: "), ("b.csv", "b.csv: No such file")):
        with pytest.raises(ValueError, match=message):
            uictest.read_recording(name)


def test_the_manifest_names_the_command_that_does_the_same(train, write):
    path = write(rail="{condition: dry}")
    folder = uictest.evaluate(train.name, scenario=path, trigger="start", record="all", output="out").folder
    words = ["evaluate", "Stop 1.csv", "--scenario", "scenarios/stop.yaml", "--trigger", "start"]
    command = json.loads((folder / "manifest.json").read_text())["command"]
    assert command == ["uictest", *words, "--record", "all", "-o", "out"]


def test_a_simulated_stop_comes_out_as_it_was_judged(write):
    path = write()
    results = uictest.run(path, record="all", rate=1000)
    Path("recordings").mkdir()
    Path("recordings/stop.parquet").write_bytes(parquet_bytes(results.recording("stop")))
    again = uictest.evaluate("recordings/stop.parquet", scenario=path)
    ours, theirs = (each.frame().loc["stop", "braking_distance_m"] for each in (results, again))
    assert ours == pytest.approx(theirs, rel=1e-3)


@pytest.mark.parametrize(("suffix", "digits"), [("parquet", 0.0), ("csv", 1e-5)])
def test_recordings_are_read_as_they_were_written(write, suffix, digits):
    written = uictest.simulate(write())
    path = Path(f"stop.{suffix}")
    path.write_bytes(parquet_bytes(written)) if suffix == "parquet" else writer_of(suffix)(written, path)
    read = uictest.read_recording(path)
    assert read.units == written.units
    assert read.metadata["case"] == "stop"
    for name, samples in written.channels.items():
        np.testing.assert_allclose(read[name], samples, rtol=digits, atol=digits)


def test_a_channel_map_prepares_the_stop(workplace):
    # 1 s at 36 km/h before the brake command, then 1 m/s2.
    rows = (f"{n / 10:.1f},{36.0 - 3.6 * max(n / 10 - 1.0, 0.0):.3f}\n" for n in range(111))
    Path("train.csv").write_text("time [s],V_ACTUAL [km/h]\n" + "".join(rows))
    head = "schema: uictest/channel-map/1\nname: ours\ntitle: Ours\nextends: common-names\n"
    channels = "channels:\n  speed: {source: V_ACTUAL, unit: km/h}\n"
    Path("map.yaml").write_text(f"{head}{channels}preparation: {{trigger_time: 1 s}}\n")
    recording = uictest.read_recording("train.csv", "map.yaml")
    assert recording.units["speed"] == "m/s"
    assert recording["speed"][[0, -1]] == pytest.approx([10.0, 0.0], abs=0.05)
    assert recording["distance"][-1] == pytest.approx(50.0, rel=0.01)  # v^2 / 2a
    assert "stated" in recording.metadata["trigger"]

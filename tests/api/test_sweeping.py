"""Sweeps in Python are those of the command."""

import csv
from pathlib import Path

import pytest

import uictest
from uictest.running.chunked import ChunkStore

TEXT = """schema: uictest/scenario/1
name: study
extends: scenarios/stop.yaml
vary:
  matrix:
    rail.friction: [0.06, 0.1]
"""


@pytest.fixture
def study(write):
    write()
    path = Path("study.sweep.yaml")
    path.write_text(f"{TEXT}    brake.command: [80 %, 100 %]\n")
    return path


def same(value, text):
    """Return whether a cell of a CSV file is this value."""
    if isinstance(value, str | bool):
        return text.lower() == str(value).lower()
    return text == "" if value != value else float(text) == value


def test_rows_are_those_of_the_command_and_nothing_is_left_behind_without_output(study, workplace, command):
    before = sorted(workplace.rglob("*"))
    results = uictest.sweep(study, jobs=1)
    assert (len(results), results.met, results.folder) == (4, True, None)
    assert sorted(workplace.rglob("*")) == before
    assert repr(results).startswith("study: 4 cases")
    assert command("sweep", study, "-o", "out") == 0
    frame = results.frame()
    with Path("out/study/summary.csv").open(newline="") as file:
        written = list(csv.DictReader(file))
    rows = frame.reset_index().to_dict("records")
    assert len(rows) == len(written) == 4
    assert [set(row) for row in rows] == [set(row) for row in written]
    for row, line in zip(rows, written, strict=True):
        for column, value in row.items():
            assert same(value, line[column]), column
    assert {frame.attrs["units"][f"{name}_distance_m"] for name in ("braking", "deceleration")} == {"m"}
    assert list(frame["values.brake.command"]) == [0.8, 1.0, 0.8, 1.0]
    name = "braking_time_s"
    alone, listed = (uictest.sweep(study, measures=each).result.maps for each in (name, [name]))
    assert alone == listed


def test_a_finished_sweep_is_not_run_again(study, monkeypatch):
    first = uictest.sweep(study, output="out")
    assert first.folder == Path("out/study").absolute()

    def fail(*_):
        raise AssertionError("a chunk was computed again")

    monkeypatch.setattr(ChunkStore, "write", fail)
    assert uictest.sweep(study, output="out").frame().equals(first.frame())
    with pytest.raises(ValueError, match="holds chunks of this sweep with other inputs"):
        uictest.sweep(study, output="out", seed=3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"select": "nothing"}, "nothing selected among 4 cases"),
        ({"measures": ["braking_distanc_m"]}, "did you mean 'braking_distance_m'"),
        ({"frontier": "rail.fric"}, "rail.fric"),
        ({"frontier": "rail.friction", "tolerance": "wide"}, "wide"),
    ],
)
def test_an_argument_that_cannot_be_used_is_named_and_an_error_of_the_file_has_its_place(
    study, arguments, message
):
    with pytest.raises(ValueError, match=message):
        uictest.sweep(study, **arguments)
    study.write_text(f"{TEXT}    brake.comand: [80 %]\n")
    with pytest.raises(uictest.ScenarioErrors, match=r"study\.sweep\.yaml:7:5: .*brake\.comand"):
        uictest.sweep(study)


ENTRY = "{scenario: scenarios/stop.yaml, map: map.yaml, recordings: [run-1.csv, run-2.csv]}"


STUDY = """schema: uictest/scenario/1
name: study
extends: scenarios/stop.yaml
vary: {{matrix: {{{}}}}}
"""


@pytest.fixture
def file(write):
    """A validation of one scenario by two of its own stops under other seeds."""
    scenario = write()
    for seed in (1, 2):
        recording = uictest.simulate(scenario, seed=seed, record=100).frame()
        units = recording.attrs["units"]
        recording = recording[["speed"]].reset_index()
        recording.columns = ["time [s]", f"speed [{units['speed']}]"]
        recording.to_csv(f"run-{seed}.csv", index=False)
    Path("map.yaml").write_text(
        "schema: uictest/channel-map/1\nname: m\nextends: uictest\npreparation: {trigger_time: 0 s}\n"
    )
    path = Path("my.validation.yaml")
    path.write_text(f"schema: uictest/validation/1\nname: my-train\nstops: [{ENTRY}]\n")
    return path


def test_figures_are_those_of_the_command(file, command):
    assert command("validate", file, "-o", "out") == 0
    [written] = Path("out").iterdir()
    validation = uictest.validate(file, jobs=1)
    assert (len(validation), validation.met, validation.folder, validation.file) == (2, True, None, None)
    assert validation.tally == "2 of 2 recorded stops counted"
    frame = validation.frame()
    with (written / "tables" / "figures.csv").open() as lines:
        rows = {row["figure"]: row for row in csv.DictReader(lines)}
    assert list(frame.index) == list(rows)
    assert frame.loc["braking_distance_m", "bias"] == float(rows["braking_distance_m"]["bias"])
    assert frame.loc["braking_distance_m", "unit"] == "m"
    stops = validation.stops()
    assert stops.loc[("my-train.stop.run-2", "braking_distance_m"), "recorded"] > 0.0
    assert "braking_distance_m" in repr(validation)
    assert "my-train: 2 of 2 recorded stops counted" in validation._repr_html_()


def test_what_is_written_flags_runs_and_sweeps(file):
    validation = uictest.validate(file, output="validations")
    assert {path.name for path in validation.folder.rglob("*")} >= {"validation.json", "stops.csv"}
    changes = {"initial_speed": ["30 km/h", "36 km/h"]}
    results = uictest.run("scenarios/stop.yaml", set=changes, validated=validation.file)
    outside = [[each.key for each in result.domain_of_validity.outside] for result in results]
    assert outside == [[], ["initial_speed"]]
    Path("study.sweep.yaml").write_text(STUDY.format("initial_speed: [30 km/h, 36 km/h]"))
    swept = uictest.sweep("study.sweep.yaml", validated=validation.file)
    assert swept.result.domain_of_validity.outside == 1
    assert list(swept.frame()["outside"]) == ["", "initial_speed"]


def test_a_file_of_several_series_is_refused(file, write, command):
    """Each series is a validation of its own: one result, or one JSON document, cannot have them all."""
    assert file.exists()  # its recordings are those of the series
    write("reference", rail="{condition: dry}")
    Path("two.series.yaml").write_text(
        "schema: uictest/series/1\nname: two\ndry: {scenario: scenarios/reference.yaml}\n"
        f"wet: [{ENTRY}]\ninclude: [{{controller: threshold}}, {{controller: slip-band}}]\n"
    )
    with pytest.raises(ValueError, match=r"found two\[controller=threshold\], two\[controller=slip-band\]:"):
        uictest.validate("two.series.yaml")
    assert command("validate", "two.series.yaml", "--format", "json") == 4


def test_a_file_that_is_no_validation_is_refused(write):
    with pytest.raises(uictest.ScenarioErrors, match="expected uictest/validation/1"):
        uictest.validate(write())
    Path("other.json").write_text("{}")
    with pytest.raises(ValueError, match=r"other\.json: not the result of a validation"):
        uictest.run("scenarios/stop.yaml", validated="other.json")


def test_errors_of_a_sweep_name_what_the_caller_can_do_and_no_option(write):
    scenario = write()
    sweep = Path("study.sweep.yaml")
    sweep.write_text(STUDY.format("rail.friction: [0.06]"))
    uictest.sweep(sweep, output="out")
    scenario.write_text(f"{scenario.read_text()}seed: 3\n")
    with pytest.raises(ValueError, match="restart it to discard them") as error:
        uictest.sweep(sweep, output="out")
    assert " -" not in str(error.value)

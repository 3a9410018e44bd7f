"""Validations in Python are those of the command."""

import csv
from pathlib import Path

import pytest

import uictest

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

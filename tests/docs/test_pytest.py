"""The tests that the page on pytest shows are run: as they stand, over what ships."""

import subprocess
import sys
from pathlib import Path

import uictest

PAGE = Path(__file__).parents[2] / "docs" / "pytest.md"
LIMITED = """\
schema: uictest/scenario/1
name: stop
initial_speed: 80 km/h
criteria: short-stops.yaml
zip: {seed: [1, 2], expect: [pass, fail]}
"""
CRITERIA = """\
schema: uictest/criteria/1
name: short-stops
sources: {ours: {mark: chosen, text: A limit that no stop keeps}}
criteria:
  - {id: distance, layer: requirement, measure: braking_distance, source: ours,
     upper: {value: 35 m, source: ours}}
"""
SERIES = """\
schema: uictest/series/1
name: two
dry: {scenario: _dry.yaml, set: {initial_speed: 30 km/h}}
wet: {scenario: _dry.yaml, set: {initial_speed: 30 km/h, rail.condition: wet, rail.friction: 0.1}}
criteria: extension.yaml
"""
EXTENSION = """\
schema: uictest/criteria/1
name: extension
sources: {ours: {mark: chosen, text: A limit that no series keeps}}
criteria:
  - {id: k-wet, scope: series, layer: requirement, measure: k_wet, source: ours,
     lower: {value: 10, source: ours}}
"""


def session_in(folder):
    """Run the tests of the page in a folder; return exit code and lines."""
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout.splitlines()


def test_what_ships_passes(tmp_path):
    from consoles import prepare

    prepare(PAGE.read_text("utf-8"), tmp_path)
    cases = len(uictest.load(tmp_path / "scenarios"))
    files = len(list(tmp_path.glob("scenarios/*.series.yaml")))
    code, lines = session_in(tmp_path)
    assert code == 0, lines
    assert lines[-1].startswith(f"{cases + files} passed in ")
    assert cases >= 34 and files


def test_what_is_not_as_expected_fails_and_names_criterion_and_value(tmp_path):
    """The message of the case is the one that the page shows."""
    from consoles import prepare

    page = PAGE.read_text("utf-8")
    prepare(page, tmp_path)
    folder = tmp_path / "scenarios"
    for path in folder.iterdir():
        path.unlink()
    below = folder / "of-a-project"
    below.mkdir()
    (folder / "stop.yaml").write_text(LIMITED, "utf-8")
    (folder / "short-stops.yaml").write_text(CRITERIA, "utf-8")
    (below / "_dry.yaml").write_text(LIMITED.partition("criteria")[0], "utf-8")
    (below / "two.series.yml").write_text(SERIES, "utf-8")
    (below / "extension.yaml").write_text(EXTENSION, "utf-8")
    code, lines = session_in(tmp_path)
    assert code == 1
    assert lines[-1].startswith("2 failed, 1 passed in ")
    shown = [line.partition("AssertionError: ")[2] for line in lines if "  AssertionError: " in line]
    of_case, of_series = shown
    assert f"`{of_case}`" in page.replace("\n", " ")
    assert of_series.startswith("two: fail, not pass: k-wet: ")
    assert " misses >= 10 by " in of_series

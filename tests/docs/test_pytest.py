"""The tests that the page on pytest shows are run: as they stand, over what ships."""

import subprocess
import sys
from pathlib import Path

import uictest

PAGE = Path(__file__).parents[2] / "docs" / "pytest.md"
DRY = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 80 km/h\n"
LIMITED = f"{DRY}criteria: short-stops.yaml\nzip: {{seed: [1, 2], expect: [pass, fail]}}\n"
CRITERIA = """\
schema: uictest/criteria/1
name: {name}
sources: {{ours: {{mark: chosen, text: A limit that nothing keeps}}}}
criteria: [{{layer: requirement, source: ours, {criterion}}}]
"""
SHORT = "id: distance, measure: braking_distance, upper: {value: 35 m, source: ours}"
SERIES = """\
schema: uictest/series/1
name: two
dry: {scenario: _dry.yaml, set: {initial_speed: 30 km/h}}
wet: {scenario: _dry.yaml, set: {initial_speed: 30 km/h, rail.condition: wet, rail.friction: 0.1}}
criteria: extension.yaml
"""
EXTENSION = "id: k-wet, scope: series, measure: k_wet, lower: {value: 10, source: ours}"


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
    short = CRITERIA.format(name="short-stops", criterion=SHORT)
    extension = CRITERIA.format(name="extension", criterion=EXTENSION)
    for path, text in (
        *((folder / "stop.yaml", LIMITED), (folder / "short-stops.yaml", short), (below / "_dry.yaml", DRY)),
        *((below / "two.series.yml", SERIES), (below / "extension.yaml", extension)),
    ):
        path.write_text(text, "utf-8")
    code, lines = session_in(tmp_path)
    assert code == 1
    assert lines[-1].startswith("2 failed, 1 passed in ")
    shown = [line.partition("AssertionError: ")[2] for line in lines if "  AssertionError: " in line]
    of_case, of_series = shown
    assert f"`{of_case}`" in page.replace("\n", " ")
    assert of_series.startswith("two: fail, not pass: k-wet: ")
    assert " misses >= 10 by " in of_series

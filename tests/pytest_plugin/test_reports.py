"""`--uictest-output`: the reports of a session are those of the command."""

import json
from pathlib import Path

import pytest

import uictest
from uictest.core import files

from .conftest import SCENARIO, SHORT_STOPS


@pytest.fixture
def project(scenario, write):
    write("short-stops.yaml", SHORT_STOPS)
    scenario(
        "weak", "criteria: ../short-stops.yaml\nmatrix: {brake.command: [80 %, 100 %]}\nrequirements: [A]\n"
    )
    write("scenarios/_wet.yaml", SCENARIO.format(name="wet", text="rail: {condition: wet, friction: 0.1}\n"))
    write("scenarios/_dry.yaml", SCENARIO.format(name="dry", text=""))
    write(
        "scenarios/wsp.series.yaml", "schema: uictest/series/1\nname: wsp\ndry: _dry.yaml\nwet: _wet.yaml\n"
    )


def document(folder):
    """Return results.json without what says which command wrote it."""
    content = json.loads((folder / "results.json").read_text("utf-8"))
    del content["manifest"]["command"]
    return content


@pytest.mark.usefixtures("project")
@pytest.mark.parametrize("workers", [[], ["-p", "xdist", "-n", "2"]], ids=["alone", "xdist"])
def test_they_are_those_of_the_command(run, workers):
    done = run("--uictest-output", "out", *workers)
    assert done.code == 1
    [place] = [line.split()[-1] for line in done.lines if line.startswith("uictest: reports in ")]
    folder = uictest.run("scenarios", output="expected").folder
    assert document(Path(place)) == document(folder)
    assert sorted(path.name for path in Path(place).rglob("*")) == sorted(
        path.name for path in folder.rglob("*")
    )
    assert files.latest_run(Path("out")) == Path(place).resolve()


@pytest.mark.usefixtures("project")
def test_a_part_of_the_tests_gives_a_part_of_the_results(run):
    run("--uictest-output", "out", "-x", "-k", "weak")
    content = document(Path("out/latest"))
    assert ([case["id"] for case in content["cases"]], content["complete"]) == (["weak[command=80]"], False)


@pytest.mark.usefixtures("project")
def test_an_interrupt_keeps_what_is_finished(run, write):
    write("test_own.py", "def test_own(): raise KeyboardInterrupt\n")
    assert run("--uictest-output", "out", "scenarios/weak.yaml", "test_own.py").code == 2
    content = document(Path("out/latest"))
    ids = ["weak[command=80]", "weak[command=100]"]
    assert ([case["id"] for case in content["cases"]], content["complete"]) == (ids, False)


def test_two_cases_of_one_id_are_not_reported(run, scenario):
    scenario("stop")
    scenario("stop").rename("scenarios/again.yaml")
    scenario("stop")
    done = run("--uictest-output", "out")
    assert done.code == 3
    assert any("case 'stop' is also in" in line for line in done.lines)
    assert not Path("out").exists()


@pytest.mark.usefixtures("project")
def test_two_series_of_one_id_are_not_reported(run, write):
    write("scenarios/again.series.yaml", Path("scenarios/wsp.series.yaml").read_text("utf-8"))
    done = run("--uictest-output", "out", "-k", "k-wet")
    assert done.code == 3
    assert any("the reports were not written: a second series 'wsp'" in line for line in done.lines)
    assert not any("INTERNALERROR" in line for line in done.lines)

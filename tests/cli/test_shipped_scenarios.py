"""Scenarios that ship with the program, by name: as arguments, as parents, in series, as sweeps."""

from pathlib import Path

import pytest

import uictest
from uictest.plans import library
from uictest.plans.scenario import ScenarioErrors

from .conftest import manifest_of, results_of

SHIPPED = Path(__file__).parents[2] / "scenarios"


def test_every_shipped_file_has_a_name_and_check_counts_names_of_every_kind(call):
    assert sorted(library.scenarios().values()) == sorted(SHIPPED.glob("*.yaml"))
    says = "1 scenario with 1 case and 1 sweep and 1 series"
    call("check", "slip-120", "wsp-120", "slide-80-sensitivity", code=0, says=says)


def test_a_name_stands_for_the_shipped_scenario_which_may_be_extended_until_a_file_has_that_name(workplace):
    (case,) = uictest.load("slip-120")
    assert case.id == "slip-120"
    assert case.path == Path("slip-120")
    assert next(iter(case.inputs)) == "slip-120"
    (workplace / "own.yaml").write_text(
        "schema: uictest/scenario/1\nname: own\nextends: slip-120\nrail: {friction: 0.1}\n"
    )
    (case,) = uictest.load("own.yaml")
    assert case.scenario.rail.friction == pytest.approx(0.1)
    assert case.scenario.tags == uictest.load("slip-120")[0].scenario.tags
    assert "slip-120" in case.inputs
    (workplace / "slip-120").write_text("schema: uictest/scenario/1\nname: own\ninitial_speed: 50 km/h\n")
    assert [case.id for case in uictest.load("slip-120")] == ["own"]


def test_a_sweep_and_its_parent_may_ship(workplace, call):
    (workplace / "own.sweep.yaml").write_text(
        "schema: uictest/scenario/1\nname: own\nextends: slide-80\n"
        "vary: {matrix: {rig.compensation: [none, full]}}\n"
    )
    call("sweep", "own.sweep.yaml", "--dry-run", code=0)
    call("sweep", "slide-80-sensitivity", "--dry-run", code=0)


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("slip-12", "did you mean 'slip-120'?"),
        ("slip-120.yaml", "slip-120 ships with uictest: write `slip-120`"),
        ("scenarios/slip-120.yaml", "write `slip-120`, or copy it with `uictest init --scenarios`"),
        ("nothing", "by name there are"),
    ],
)
def test_a_file_that_is_missing_says_what_ships(workplace, name, hint):
    with pytest.raises(ScenarioErrors, match="no such file") as raised:
        uictest.load(name)
    assert hint in str(raised.value)
    with pytest.raises(ScenarioErrors) as raised:
        uictest.load("own.yaml")
    assert "ship" not in str(raised.value)


def test_copies_are_the_shipped_files_and_a_run_by_name_is_repeated_by_name(workplace, call):
    call("init", "--scenarios", code=0)
    copies = {each.name: each.read_bytes() for each in (workplace / "scenarios").iterdir()}
    assert copies == {each.name: each.read_bytes() for each in SHIPPED.glob("*.yaml")}
    call("check", code=0)
    call("init", "--scenarios", code=4, says="already there")
    call("run", "dry-120", "-q", code=0)
    folder = workplace / "reports" / "latest"
    assert results_of(folder)["cases"][0]["scenario"] == "dry-120"
    command = manifest_of(folder)["command"]
    assert command[1:3] == ["run", "dry-120"]

"""Which files are collected."""

from types import SimpleNamespace

import pytest

from uictest.api.pytest_plugin.collection import Selection
from uictest.plans.scenario import load

SCENARIO = "schema: uictest/scenario/1\nname: {}\ninitial_speed: 30 km/h\n"
FILES = {
    "stop.yaml": SCENARIO.format("stop"),
    "quoted.yml": SCENARIO.format("quoted").replace(
        "schema: uictest/scenario/1", "'schema' : \"uictest/scenario/1\""
    ),
    "flow.yaml": "{schema: uictest/scenario/1, name: flow, initial_speed: 30 km/h}\n",
    "deep/stop.yaml": SCENARIO.format("deep"),
    "deep/_base.yaml": SCENARIO.format("base"),
    ".hidden.yaml": SCENARIO.format("hidden"),
    "train.yaml": "schema: uictest/vehicle/1\nname: train\n",
    "many.sweep.yaml": "schema: uictest/sweep/1\nname: many\n",
    "wsp.series.yaml": "schema: uictest/series/1\nname: wsp\n",
    "notes.txt": "schema: uictest/scenario/1\n",
}
SCENARIOS = {"stop.yaml", "quoted.yml", "flow.yaml", "deep/stop.yaml"}


def project(folder, *, files=(), every=False):
    """Return the selection of a project in a folder, whose settings are as pytest hands them over."""
    config = SimpleNamespace(
        rootpath=folder, getini={"uictest_files": list(files)}.get, getoption={"uictest": every}.get
    )
    return Selection.of(config)


@pytest.fixture
def folder(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
    return tmp_path


def collected(selection, folder, kind="scenario"):
    return {name for name in FILES if selection.kind_of(folder / name) == kind}


@pytest.mark.parametrize("settings", [{"files": (".",)}, {"files": ("**/*",)}, {"every": True}])
def test_the_scenarios_are_those_that_the_command_finds(folder, settings):
    selection = project(folder, **settings)
    of_command = {case.path.relative_to(folder).as_posix() for case in load([folder])}
    assert collected(selection, folder) == of_command == SCENARIOS
    assert collected(selection, folder, "series") == {"wsp.series.yaml"}


def test_a_glob_selects_what_it_matches_and_yaml_of_other_programs_only_if_it_is_named(folder):
    other = folder / "compose.yaml"
    other.write_text("services:\n  schema: uictest/scenario/1\n", "utf-8")
    assert project(folder, every=True).kind_of(other) is None
    assert project(folder, files=("compose.yaml",)).kind_of(other) == "scenario"
    assert collected(project(folder, files=("*.yml", "deep")), folder) == {"quoted.yml", "deep/stop.yaml"}


@pytest.mark.parametrize("pattern", ["scenaros", "none/*.yaml", "/none/*.yaml"])
def test_a_pattern_without_a_match_is_an_error(folder, pattern):
    with pytest.raises(pytest.UsageError, match="matches nothing below"):
        project(folder, files=(pattern,))

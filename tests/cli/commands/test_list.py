import json
import re
from pathlib import Path

import pytest


def test_ids_that_can_be_run_with_titles_and_tags_on_demand_or_as_json(call, scenario, made_up):
    scenario("a", "title: A dry stop\ntags: [dry, quick]\n")
    scenario("b", "matrix:\n  brake.command: [80 %, 90 %]\n")
    answer = call("list")
    assert (answer.code, answer.out, answer.err) == (0, "a\nb[command=80]\nb[command=90]\n", "")
    assert call("list", "-v", "-k", "a and not b").out == "a\tA dry stop\tdry quick\n"
    call("run", "-k", "b[command=90]")
    assert made_up == call("list", "-k", "90").out.split() == ["b[command=90]"]
    Path("scenarios/b.yaml").unlink()
    scenario("a", "expect: fail\nmatrix:\n  brake.command: [80 %]\n")
    (case,) = json.loads(call("list", "--format", "json").out)
    assert case.pop("parameters") == {"brake.command": "80 %"}
    of_file = {"scenario": "scenarios/a.yaml", "title": "", "tags": [], "expect": "fail"}
    assert case == {"id": "a[command=80]", **of_file}


def test_a_sweep_that_ships_is_listed_by_name(call, workplace):
    lines = call("list", "slide-80-friction-command").out.splitlines()
    assert lines[0] == "slide-80-friction-command[command=60,friction=0.02]"
    assert len(lines) == len(set(lines)) > 10


OWN = """\
criteria:
  name: own
  criteria:
    - id: short
      layer: requirement
      measure: braking_distance
      upper: 900 m
      requirements: [BR-2]
"""


def test_requirements_are_listed_with_what_verifies_them_also_as_json(call, scenario):
    scenario("a", "requirements: [BR-10, BR-2]\nmatrix:\n  brake.command: [80 %, 90 %]\n" + OWN)
    scenario("b", OWN)
    answer = call("list", "--requirements")
    assert answer.out == (
        "covered\tBR-2\tscenario a (2 cases); criterion short of own (3 cases)\n"
        "covered\tBR-10\tscenario a (2 cases)\n"
    )
    assert (answer.code, answer.err) == (0, "uictest: 2 requirements: 2 covered\n")
    Path("scenarios/b.yaml").unlink()
    scenario("a", "requirements: [BR-1]\n" + OWN)
    cases = {"cases": ["a"], "series_ids": []}
    verified = {"BR-1": {"scenario": "a"}, "BR-2": {"criterion": "short", "profile": "own"}}
    assert json.loads(call("list", "--requirements", "--format", "json").out) == [
        {"id": name, "status": "covered", "verified_by": [by | cases]} for name, by in verified.items()
    ]


@pytest.mark.parametrize(("listed", "code"), [("BR-1\nBR-2\n", 1), ("BR-1\n", 0)])
def test_a_list_shows_what_is_uncovered_and_what_it_does_not_know_and_can_fail(call, scenario, listed, code):
    scenario("a", "requirements: [BR-1, BR-X]\n")
    Path("all.txt").write_text(listed)
    command = ("list", "--requirements", "--requirement-list", "all.txt")
    answer = call(*command)
    uncovered = ["uncovered\tBR-2\t"] * code
    assert answer.out.splitlines() == [
        "covered\tBR-1\tscenario a (1 case)",
        *uncovered,
        "unknown\tBR-X\tscenario a (1 case)",
    ]
    counts = "3 requirements: 1 covered, 1 uncovered" if code else "2 requirements: 1 covered"
    assert (answer.code, answer.err) == (0, f"uictest: {counts}, 1 unknown\n")
    assert call(*command, "--fail-uncovered").code == code


def test_requirements_of_selected_cases_of_the_scenario_of_a_sweep_or_of_none(call, scenario, workplace):
    scenario("a")
    answer = call("list", "--requirements")
    assert (answer.code, answer.out) == (0, "")
    assert answer.err == "uictest: no scenario, series or criterion names a requirement\n"
    scenario("a", "requirements: [BR-1]\ntags: [wet]\n")
    scenario("b", "requirements: [BR-2]\n")
    assert call("list", "--requirements", "-m", "wet").out == "covered\tBR-1\tscenario a (1 case)\n"
    scenario("a", "requirements: [BR-1]\n")
    text = "schema: uictest/scenario/1\nname: s\nextends: scenarios/a.yaml\nvary: {matrix: {seed: [1, 2]}}\n"
    (workplace / "s.sweep.yaml").write_text(text)
    assert call("list", "s.sweep.yaml", "--requirements").out == "covered\tBR-1\tscenario s (1 case)\n"


@pytest.mark.parametrize("columns", [40, 60, 80, 120])
@pytest.mark.parametrize(("option", "first"), [("-v", "case"), ("--requirements", "status")])
def test_a_table_keeps_to_a_terminal_and_ids_stay_whole(call, scenario, monkeypatch, columns, option, first):
    title = "title: Slide test, a caliper in every module\ntags: [slide]\n"
    scenario("slide-80-four-caliper", f"{title}requirements: [BR-WSP-AUTHORITY-12, BR-1]\n{OWN}")
    monkeypatch.setattr("uictest.cli.commands.list.terminal_width", lambda stream: columns)
    table = [line for line in call("list", option).out.splitlines() if not line.startswith("not shown")]
    assert max(map(len, table)) <= columns
    assert table[0].split()[0] == first
    cells = "".join(re.split("  +", line)[0] for line in table[1:])
    assert option != "-v" or "slide-80-four-caliper" in cells

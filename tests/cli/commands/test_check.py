from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

Call = Callable[..., Any]
Write = Callable[..., Path]


def test_valid_files_exit_0_and_say_how_many(call: Call, scenario: Write) -> None:
    scenario("a")
    scenario("b", "matrix:\n  brake.command: [80 %, 90 %]\n")
    answer = call("check")
    assert (answer.code, answer.out) == (0, "")
    assert answer.err == "uictest: 2 scenarios with 3 cases, no error\n"
    assert call("check", "-q").err == ""


def test_every_error_of_every_file_is_shown_with_its_place(call: Call, scenario: Write) -> None:
    scenario("a", "vehicel: x\n")
    scenario("b", "seed: -1\n")
    answer = call("check")
    assert (answer.code, answer.out) == (4, "")
    assert "scenarios/a.yaml:4:1: " in answer.err
    assert "vehicle" in answer.err
    assert "scenarios/b.yaml:4:" in answer.err
    assert "uictest: 2 errors" in answer.err


def test_only_the_named_files_are_checked(call: Call, scenario: Write) -> None:
    good = scenario("a")
    scenario("b", "vehicel: x\n")
    assert call("check", good).code == 0


def test_json_for_editors(call: Call, scenario: Write) -> None:
    path = scenario("a", "vehicel: x\n")
    (found,) = json.loads(call("check", "--format", "json").out)
    assert (found["file"], found["line"], found["column"]) == (path.as_posix(), 4, 1)
    assert found["message"]
    scenario("a")
    assert json.loads(call("check", "--format", "json").out) == []


def test_github_annotations_point_to_the_line(call: Call, scenario: Write) -> None:
    scenario("a", "vehicel: x\n")
    answer = call("check", "--format", "github")
    assert answer.out.startswith("::error file=scenarios/a.yaml,line=4,col=1,title=")


def test_a_missing_path_is_an_error(call: Call) -> None:
    answer = call("check", "gone")
    assert answer.code == 4
    assert "gone" in answer.err


def test_sensitivities_around_other_values_than_the_scenarios_are_warned_of(
    call: Call, scenario: Write, workplace: Path
) -> None:
    scenario("a", "rail: {condition: wet, friction: 0.1}\n")
    sweep = workplace / "scenarios" / "b.sweep.yaml"
    sweep.write_text(
        "schema: uictest/sweep/1\nname: b\nscenario: a.yaml\nsample:\n  method: saltelli\n  size: 2\n"
        "  parameters:\n    rail.friction: {uniform: [0.11, 0.15]}\n"
    )
    answer = call("check")
    assert answer.code == 0
    assert "warning: rail.friction: the scenario's own 0.1 lies OUTSIDE the range" in answer.err


def test_a_compensation_that_is_not_for_its_rig_is_reported_with_file_key_and_values(call, workplace):
    (workplace / "unfit.yaml").write_text(
        "schema: uictest/scenario/1\nname: unfit\ninitial_speed: 120 km/h\n"
        "rig:\n  caliper: {extends: six-inch, lever_ratio: 3}\n"
    )
    answer = call("check", "unfit.yaml")
    assert answer.code == 4
    told = "unfit.yaml:5:46: rig.caliper.lever_ratio: is 3, the compensation is for 2.45 within 0.5 %"
    assert told in answer.err
    (workplace / "unfit.yaml").write_text((workplace / "unfit.yaml").read_text() + "expect: invalid\n")
    assert call("check", "unfit.yaml").code == 0

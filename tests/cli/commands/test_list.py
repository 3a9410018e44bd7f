from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Call = Callable[..., Any]
Write = Callable[..., Path]


def test_one_id_per_line(call: Call, scenario: Write) -> None:
    scenario("a")
    scenario("b", "matrix:\n  brake.command: [80 %, 90 %]\n")
    answer = call("list")
    assert (answer.code, answer.out, answer.err) == (0, "a\nb[command=80]\nb[command=90]\n", "")


def test_what_is_listed_can_be_run(call: Call, scenario: Write, made_up: list[str]) -> None:
    scenario("a", "matrix:\n  brake.command: [80 %, 90 %]\n")
    listed = call("list", "-k", "90").out.split()
    call("run", "-k", listed[0])
    assert made_up == listed == ["a[command=90]"]


def test_titles_and_tags_on_demand(call: Call, scenario: Write) -> None:
    scenario("a", "title: A dry stop\ntags: [dry, quick]\n")
    assert call("list", "-v").out == "a\tA dry stop\tdry quick\n"


def test_json(call: Call, scenario: Write) -> None:
    scenario("a", "expect: fail\nmatrix:\n  brake.command: [80 %]\n")
    assert json.loads(call("list", "--format", "json").out) == [
        {
            "id": "a[command=80]",
            "scenario": "scenarios/a.yaml",
            "title": "",
            "tags": [],
            "expect": "fail",
            "parameters": {"brake.command": "80 %"},
        }
    ]


def test_nothing_selected_exits_5(call: Call, scenario: Write) -> None:
    scenario("a")
    assert call("list", "-m", "wet").code == 5


@pytest.mark.parametrize("columns", ["40", "60", "80", "120"])
def test_described_cases_keep_to_a_terminal_and_their_ids_stay_whole(
    call: Call, scenario: Write, monkeypatch: pytest.MonkeyPatch, columns: str
) -> None:
    scenario("slide-80-four-caliper", "title: Slide test, a caliper in every module\ntags: [slide]\n")
    monkeypatch.setattr("uictest.cli.commands.list.terminal_width", lambda stream: int(columns))
    table = [line for line in call("list", "-v").out.splitlines() if not line.startswith("not shown")]
    assert max(map(len, table)) <= int(columns)
    assert "slide-80-four-caliper" in "".join(re.split("  +", line)[0] for line in table[1:])

"""`--keep`: what users see of it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Call = Callable[..., Any]


def run_folders(place: str = "reports") -> set[str]:
    folders = (path for path in Path(place).iterdir() if path.is_dir() and not path.is_symlink())
    return {path.name for path in folders}


def test_older_runs_are_removed_and_named(
    call: Call, scenario: Callable[..., Path], made_up: list[str]
) -> None:
    scenario("stop")
    for _ in range(3):
        call("run", "-q")
    before = run_folders()
    answer = call("run", "-q", "--keep", "2")
    gone = before - run_folders()
    assert (answer.code, len(run_folders()), len(gone)) == (0, 2, 2)
    for name in gone:
        assert f"uictest: --keep 2: removed {name}, older than the newest 2\n" in answer.err
        assert f'"./{name}/index.html"' not in Path("reports", "index.html").read_text("utf-8")


def test_a_case_that_is_not_as_expected_is_a_result_too(
    call: Call, scenario: Callable[..., Path], made_up: list[str]
) -> None:
    scenario("stop", "tags: [fail]")
    for _ in range(2):
        assert call("run", "--keep", "1").code == 1
    assert len(run_folders()) == 1


def test_after_an_error_nothing_is_removed(
    call: Call, scenario: Callable[..., Path], made_up: list[str]
) -> None:
    scenario("stop", "tags: [error]")
    call("run")
    answer = call("run", "--keep", "1")
    assert (answer.code, len(run_folders())) == (3, 2)
    assert "nothing is removed" in answer.err


def test_the_baseline_stays(call: Call, scenario: Callable[..., Path], made_up: list[str]) -> None:
    scenario("stop")
    call("run")
    [first] = run_folders()
    call("run")
    answer = call("run", "--baseline", f"reports/{first}", "--keep", "1")
    assert first in run_folders()
    assert f"{first} stays: " in answer.err


def test_the_run_that_was_the_latest_stays_as_the_baseline(
    call: Call, scenario: Callable[..., Path], made_up: list[str]
) -> None:
    scenario("stop")
    call("run")
    [first] = run_folders()
    answer = call("run", "--baseline", "reports/latest", "--keep", "1")
    assert f"{first} stays: " in answer.err
    newest = Path("reports", "latest", "results.json").read_text("utf-8")
    assert f"reports/{first}" in newest


def test_accepted_results_stay(call: Call, scenario: Callable[..., Path], made_up: list[str]) -> None:
    scenario("stop")
    call("run", "--baseline", "reports/baseline", "--accept")
    call("run")
    assert "baseline stays: " in call("run", "--keep", "1").err
    assert Path("reports", "baseline", "results.json").is_file()


@pytest.mark.parametrize("command", ["run", "evaluate"])
@pytest.mark.parametrize("number", ["0", "-1", "all"])
def test_at_least_one_run_is_kept(call: Call, command: str, number: str) -> None:
    answer = call(command, "x", "--keep", number)
    assert answer.code == 4
    assert "--keep" in answer.err


def test_without_the_option_nothing_is_removed(
    call: Call, scenario: Callable[..., Path], made_up: list[str]
) -> None:
    scenario("stop")
    for _ in range(3):
        call("run")
    assert len(run_folders()) == 3

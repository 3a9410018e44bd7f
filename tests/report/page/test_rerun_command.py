from __future__ import annotations

import pytest

from uictest.report import CASES_IN_PYTHON, RunManifest
from uictest.report.page.links import rerun_command


@pytest.mark.parametrize(
    ("typed", "kept"),
    [
        ("run", ""),
        ("run scenarios -k slip -n 2 -o out --record all", ""),
        ("run --set rail.friction=0.09 --seed 3 -x", "--set rail.friction=0.09 --seed 3 "),
        (
            "run --seed=3 --repeat 5 --trust more --in-process -q",
            "--seed=3 --repeat 5 --trust more --in-process ",
        ),
    ],
)
def test_what_changes_a_case_is_kept_and_nothing_else(typed: str, kept: str) -> None:
    manifest = RunManifest(command=("uictest", *typed.split()))
    assert rerun_command(manifest, "a/slip.yaml", "slip") == f"uictest run a/slip.yaml {kept}-k slip"


def test_what_the_shell_would_read_is_quoted() -> None:
    manifest = RunManifest(command=("uictest", "run", "--set", "rail.friction=0.08, 0.09"))
    command = rerun_command(manifest, "my stops.yaml", "slip[friction=0.08]; rm x")
    assert command == (
        "uictest run 'my stops.yaml' --set 'rail.friction=0.08, 0.09' -k 'slip[friction=0.08]; rm x'"
    )


def test_a_file_that_looks_like_an_option_is_still_a_file() -> None:
    manifest = RunManifest(command=("uictest", "run", "--seed", "3", "--", "-x.yaml"))
    assert rerun_command(manifest, "-x.yaml", "x") == "uictest run ./-x.yaml --seed 3 -k x"


def test_a_recorded_stop_has_no_such_command() -> None:
    assert rerun_command(RunManifest(command=("uictest", "evaluate", "a.csv")), "a.csv", "a") == ""
    assert rerun_command(RunManifest(), "a.yaml", "a") == ""


def test_cases_that_a_program_loaded_have_none_as_it_may_have_changed_them() -> None:
    manifest = RunManifest(command=("uictest", "run", CASES_IN_PYTHON, "a.yaml"))
    assert rerun_command(manifest, "a.yaml", "a") == ""

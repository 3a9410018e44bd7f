import pytest

from uictest.report import CASES_IN_PYTHON, RunManifest
from uictest.report.page.links import rerun_command


@pytest.mark.parametrize(
    ("typed", "kept"),
    [
        ("scenarios -k slip -n 2 -o out --record all", ""),
        ("--set rail.friction=0.09 --seed 3 -x", "--set rail.friction=0.09 --seed 3 "),
        (
            "--seed=3 --repeat 5 --trust more -q --in-process",
            "--seed=3 --repeat 5 --trust more --in-process ",
        ),
    ],
)
def test_what_changes_a_case_is_kept_and_nothing_else(typed, kept):
    manifest = RunManifest(command=("uictest", "run", *typed.split()))
    assert rerun_command(manifest, "a/slip.yaml", "slip") == f"uictest run a/slip.yaml {kept}-k slip"


@pytest.mark.parametrize("command", [("evaluate", "a.csv"), (), ("run", CASES_IN_PYTHON, "a.yaml")])
def test_recorded_stops_and_cases_that_a_program_may_have_changed_have_no_such_command(command):
    assert rerun_command(RunManifest(command=("uictest", *command)), "a.yaml", "a") == ""


def test_what_the_shell_would_read_is_quoted_and_a_file_like_an_option_is_still_a_file():
    manifest = RunManifest(command=("uictest", "run", "--seed", "3", "--", "-x.yaml"))
    assert rerun_command(manifest, "-x.yaml", "x") == "uictest run ./-x.yaml --seed 3 -k x"
    manifest = RunManifest(command=("uictest", "run", "--set", "rail.friction=0.08, 0.09"))
    command = rerun_command(manifest, "my stops.yaml", "slip[friction=0.08]; rm x")
    assert command == (
        "uictest run 'my stops.yaml' --set 'rail.friction=0.08, 0.09' -k 'slip[friction=0.08]; rm x'"
    )

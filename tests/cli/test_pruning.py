"""`--keep`: what users see of it."""

from pathlib import Path

import pytest

from uictest.runs import history

pytestmark = pytest.mark.usefixtures("made_up")


def run_folders():
    folders = (path for path in Path("reports").iterdir() if path.is_dir() and not path.is_symlink())
    return {path.name for path in folders}


def test_older_runs_are_removed_and_named(call, scenario):
    scenario("stop")
    for _ in range(3):
        call("run", "-q")
    before = run_folders()
    assert len(before) == 3  # nothing is removed without the option
    answer = call("run", "-q", "--keep", "2")
    gone = before - run_folders()
    assert (answer.code, len(run_folders()), len(gone)) == (0, 2, 2)
    for name in gone:
        assert f"uictest: --keep 2: removed {name}, older than the newest 2\n" in answer.err
        assert f'"./{name}/index.html"' not in Path("reports", "index.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("outcome", "code", "left", "said"), [("fail", 1, 1, "removed"), ("error", 3, 2, "nothing is removed")]
)
def test_a_case_that_is_not_as_expected_is_a_result_too_and_an_error_is_none(
    call, scenario, outcome, code, left, said
):
    scenario("stop", f"tags: [{outcome}]")
    call("run")
    answer = call("run", "--keep", "1")
    assert (answer.code, len(run_folders())) == (code, left)
    assert said in answer.err


@pytest.mark.parametrize("named", ["reports/{first}", "reports/latest"])
def test_the_baseline_stays_under_whatever_name_it_was_given(call, scenario, named):
    scenario("stop")
    call("run")
    [first] = run_folders()
    answer = call("run", "--baseline", named.format(first=first), "--keep", "1")
    assert first in run_folders()
    assert f"{first} stays: " in answer.err
    assert f"reports/{first}" in Path("reports", "latest", "results.json").read_text("utf-8")


def accepted_run():
    [run] = [run for run in history.list_runs(Path("reports")).runs if run.name == "baseline"]
    return run


def test_accepted_results_are_listed_with_their_verdict_and_stay(call, scenario):
    scenario("dry", "tags: [pass]\n")
    wet = scenario("wet", "tags: [fail]\n")
    call("run", "--baseline", "reports/baseline", "--accept", code=1)
    assert accepted_run().counts == {"pass": 1, "fail": 1}
    scenario("dry", "tags: [fail]\n")
    call("run", "scenarios/dry.yaml", "--baseline", "reports/baseline", "--accept", code=1)
    assert (accepted_run().subject, accepted_run().counts) == ("dry, wet", {"fail": 2})
    wet.unlink()
    call("run", code=1)
    assert "baseline stays: " in call("run", "--keep", "1").err
    assert Path("reports", "baseline", "results.json").is_file()


@pytest.mark.parametrize("command", ["run", "evaluate"])
@pytest.mark.parametrize("number", ["0", "-1", "all"])
def test_at_least_one_run_is_kept(call, command, number):
    call(command, "x", "--keep", number, code=4, says="--keep")

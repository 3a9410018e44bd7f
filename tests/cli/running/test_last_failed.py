"""`--lf`: what failed last, also after other commands have left their results beside the runs."""

from pathlib import Path

import pytest

from uictest.core.recording.formats import writer_of

from ..conftest import STATED, rolling_train


@pytest.fixture
def evaluate(call):
    """Evaluate a recording, whose results lie beside those of the runs."""

    def run():
        writer_of("csv")(rolling_train(), Path("recorded.csv"))
        call("evaluate", "recorded.csv", *STATED, code=0)
        assert '"recorded"' in Path("reports/latest/results.json").read_text()

    return run


def test_what_failed_last_is_selected_whatever_was_evaluated_since(call, scenario, made_up, evaluate):
    scenario("a")
    scenario("b", "tags: [fail]\n")
    call("run", "-q")
    evaluate()
    made_up.clear()
    assert call("run", "--lf").code == 1
    assert made_up == ["b"]
    scenario("b")
    assert call("run", "--lf").code == 0
    made_up.clear()
    assert "all are selected" in call("run", "--lf").err
    assert sorted(made_up) == ["a", "b"]


def test_without_an_earlier_run_all_are_selected_and_evaluations_are_none(call, scenario, made_up, evaluate):
    scenario("a")
    evaluate()
    answer = call("run", "--lf")
    assert (answer.code, made_up) == (0, ["a"])
    assert "no earlier run" in answer.err


@pytest.mark.usefixtures("made_up")
@pytest.mark.parametrize("content", ["", "{", "[]", '{"schema": "other"}', '{"schema": "uictest/result/1"}'])
def test_results_that_cannot_be_read_exit_4(call, scenario, content):
    scenario("a")
    call("run")
    Path("reports/latest/results.json").write_text(content)
    call("run", "--lf", code=4, says="results.json")


def test_of_several_runs_the_newest_counts(call, scenario, made_up, evaluate):
    """Within a second, too, and whatever the hash in their names."""
    for failing in ("a", "b", "c"):
        for name in ("a", "b", "c"):
            scenario(name, "tags: [fail]\n" if name == failing else "")
        call("run")
    evaluate()
    made_up.clear()
    call("run", "--lf")
    assert made_up == ["c"]

"""`--lf`: what failed last, also after other commands have left their results beside the runs."""

import json
from pathlib import Path

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.core.recording.formats import writer_of

from ..conftest import STATED, rolling_train


@pytest.fixture(params=["evaluate", "log"])
def evaluate(call, request):
    """Judge a recording, or the stops in a log (here none), whose results lie beside those of the runs."""

    def run():
        train = rolling_train()
        channels = {**train.channels, "brake_command": np.zeros(len(train))}
        units = {**train.units, "brake_command": "1"}
        writer_of("csv")(Recording(channels, units, train.metadata), Path("recorded.csv"))
        call(request.param, "recorded.csv", *STATED, code=0 if request.param == "evaluate" else 5)
        command = json.loads(Path("reports/latest/manifest.json").read_text("utf-8"))["command"]
        assert command[1] == request.param

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

"""Controllers from outside in a batch: what one does wrong is an error of its case."""

import json
import signal
import subprocess
import time
from pathlib import Path

import pytest

from ..conftest import HANGING

WSP = """
import os
import time

from uictest.controllers import Outputs


class Wsp:
    def __init__(self, config):
        self.fault = config.parameters["fault"]

    def reset(self):
        pass

    def step(self, inputs):
        print("from the controller")
        if inputs.cycle == 50 and self.fault == "exit":
            os._exit(0)
        if inputs.cycle == 50 and self.fault == "hang":
            open("hanging", "w").close()
            time.sleep(3600.0)
        return Outputs([0, 0, 0, 0], [0, 0, int(inputs.cycle == 50 and self.fault == "forbidden"), 0])
"""
CASES = """
criteria: uictest-stop
controller: {python: ../wsp.py, class: Wsp, time_limit: 600 s, free_parameters: true}
matrix: {controller.parameters.fault: [%s]}
"""


@pytest.fixture
def faults(scenario, workplace):
    """Write a scenario with a case for each fault of a controller."""

    def write(*names):
        (workplace / "wsp.py").write_text(WSP, "utf-8")
        scenario("stop", CASES % ", ".join(names))

    return write


def results():
    document = json.loads(Path("reports/latest/results.json").read_text("utf-8"))
    return {case["parameters"]["controller.parameters.fault"]: case for case in document["cases"]}


def test_other_cases_finish_and_what_a_controller_prints_is_no_data(process, faults):
    faults("none", "exit", "forbidden", "last")
    answer = process("run", "-n2", "--format", "json")
    assert answer.code == 3
    assert json.loads(answer.out) == json.loads(Path("reports/latest/results.json").read_text("utf-8"))
    assert "from the controller" not in answer.out + answer.err
    log = Path("reports/latest", results()["none"]["controller_log"]).read_text("utf-8")
    assert "from the controller" in log
    outcomes = {fault: (case["outcome"], case["reason"]) for fault, case in results().items()}
    assert outcomes == {
        "none": ("pass", ""),
        "exit": ("error", "controller: ended its process with exit code 0 (cycle 50)"),
        "forbidden": ("error", "controller: forbidden command for wheelset 3: vent without hold (cycle 50)"),
        "last": ("pass", ""),
    }


def test_a_child_process_and_this_one_give_the_same_results(call, faults):
    faults("none")
    answer = call("run")
    assert (answer.code, "not isolated" in answer.err) == (0, False)
    isolated = results()
    del isolated["none"]["controller_log"]  # here nobody can tell whose output it is
    answer = call("run", "--in-process")
    assert (answer.code, "not isolated" in answer.err) == (0, True)
    assert results() == isolated


def test_who_interrupts_a_hanging_controller_leaves_no_process(faults, program, workplace):
    faults("hang")
    with subprocess.Popen([program, "run"], start_new_session=True) as running:
        while not (workplace / "hanging").exists() and running.poll() is None:
            time.sleep(0.01)
        tasks = Path(f"/proc/{running.pid}/task").glob("*/children")
        children = [child for task in tasks for child in task.read_text().split()]
        running.send_signal(signal.SIGTERM)
        assert running.wait(HANGING) == 2
    assert len(children) == 1
    assert not any(Path("/proc", child).exists() for child in children)
    # A stop that ends with its child is no result, in particular no crash of the controller.
    assert list(workplace.rglob("results.json")) == []

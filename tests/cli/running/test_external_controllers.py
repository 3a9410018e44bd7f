"""Controllers from outside in a batch: what one does wrong is an error of its case."""

import json
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ..conftest import HANGING, Call, Write

Call = Call

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
def faults(scenario: Write, workplace: Path) -> Callable[..., None]:
    """Write a scenario with a case for each fault of a controller."""

    def write(*names: str) -> None:
        (workplace / "wsp.py").write_text(WSP, "utf-8")
        scenario("stop", CASES % ", ".join(names))

    return write


def results() -> dict[str, Any]:
    document = json.loads(Path("reports/latest/results.json").read_text("utf-8"))
    return {case["parameters"]["controller.parameters.fault"]: case for case in document["cases"]}


def test_other_cases_finish(call: Call, faults: Callable[..., None]) -> None:
    faults("none", "exit", "forbidden", "last")
    assert call("run", "-n2").code == 3
    outcomes = {fault: (case["outcome"], case["reason"]) for fault, case in results().items()}
    assert outcomes == {
        "none": ("pass", ""),
        "exit": ("error", "controller: ended its process with exit code 0 (cycle 50)"),
        "forbidden": ("error", "controller: forbidden command for wheelset 3: vent without hold (cycle 50)"),
        "last": ("pass", ""),
    }


def test_what_a_controller_prints_is_no_data(call: Call, faults: Callable[..., None], program: Path) -> None:
    faults("none")
    done = subprocess.run([program, "run", "--format", "json"], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout)["cases"][0]["outcome"] == "pass"
    assert "from the controller" in done.stderr


def test_a_child_process_and_this_one_give_the_same_results(call: Call, faults: Callable[..., None]) -> None:
    faults("none")
    answer = call("run")
    assert (answer.code, "not isolated" in answer.err) == (0, False)
    isolated = results()
    answer = call("run", "--in-process")
    assert (answer.code, "not isolated" in answer.err) == (0, True)
    assert results() == isolated


def test_who_interrupts_a_hanging_controller_leaves_no_process(
    faults: Callable[..., None], program: Path, workplace: Path
) -> None:
    faults("hang")
    with subprocess.Popen([program, "run"], start_new_session=True) as running:
        while not (workplace / "hanging").exists() and running.poll() is None:
            time.sleep(0.01)
        children = children_of(running.pid)
        running.send_signal(signal.SIGTERM)
        assert running.wait(HANGING) == 2
    assert len(children) == 1
    assert not any(Path(f"/proc/{child}").exists() for child in children)
    # A stop that ends with its child is no result, in particular no crash of the controller.
    assert list(workplace.rglob("results.json")) == []


def children_of(pid: int) -> list[int]:
    tasks = Path(f"/proc/{pid}/task").glob("*/children")
    return [int(child) for task in tasks for child in task.read_text().split()]

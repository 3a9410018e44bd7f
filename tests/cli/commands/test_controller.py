import json
import os
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from uictest.selftest import conformance
from uictest.selftest.conformance import bench as situations

FILLS = """\
from uictest.controllers import Outputs

class Fills:
    def __init__(self, config): pass
    def reset(self): pass
    def step(self, inputs):
        {fault}
        return Outputs([0] * 4, [0] * 4)
"""


@pytest.fixture(autouse=True)
def longer_cycles(monkeypatch):
    """Ask a controller from outside every 50 ms, not every 10 ms: what it answers is the same each time.

    Of cycles with random inputs there are as few for all.
    """
    monkeypatch.setattr(situations, "anything", partial(situations.anything, cycles=600))
    subject_of = conformance.subject_of

    def longer(name, part):
        subject = subject_of(name, part)
        if subject.program is None:
            return subject
        return replace(subject, config=replace(subject.config, cycle_time=0.05))

    monkeypatch.setattr(conformance, "subject_of", longer)


def program(fault="pass"):
    """A controller that never protects a wheelset."""
    path = Path("fills.py")
    path.write_text(FILLS.format(fault=fault), "utf-8")
    return path


def test_what_is_missed_exits_1_is_drawn_and_is_a_failure_in_junit(call):
    """What a controller prints cannot disturb the table. 0, where all is met, is asserted with `init`."""
    files = ("--html", "check.html", "--junitxml", "check.xml")
    answer = call("controller", "check", program("print('noise')"), *files, "--format", "json", code=1)
    assert json.loads(answer.out)["about"]["controller.kind"] == "python"
    assert '<failure message="from the beginning of the slide' in Path("check.xml").read_text("utf-8")
    assert "fills" not in sys.modules  # the program is not imported here
    page = Path("check.html").read_text("utf-8")
    assert "12 checks: " in page
    assert "fail vents-sliding: from the beginning of the slide" in page
    for n in (1, 2, 3, 4):
        assert f"<h3>wheelset {n} slides</h3>" in page
    assert "<h3>good rail</h3>" not in page  # nothing is missed there alone


def test_a_controller_is_given_parameters_and_a_class_and_one_that_raises_exits_3(call):
    call("controller", "check", program("raise ValueError"), code=3)
    path = program()
    path.write_text(path.read_text() + "\nclass Other:\n    def step(self, inputs): pass\n")
    assert call("controller", "check", path, "--class", "Fills").code == 1
    path = program("pass")
    path.write_text(
        path.read_text().replace("config): pass", "config): assert config.parameters == {'a': 2.5}")
        + 'PARAMETERS = {"a": {"default": 1.0, "unit": "s"}}\n'
    )
    assert call("controller", "check", path, "--set", "a=2.5").code == 1


CONTROLLER = "controller: {python: fills.py, class: Fills}\n"


@pytest.mark.parametrize(
    "text",
    [
        "schema: uictest/controller/1\nname: fills\npython: fills.py\nclass: Fills\n",
        f"schema: uictest/scenario/1\nname: stop\ninitial_speed: 80 km/h\n{CONTROLLER}",
    ],
    ids=["part", "scenario"],
)
def test_a_part_and_a_scenario_name_their_controller(call, text):
    program()
    Path("file.yaml").write_text(text, "utf-8")
    answer = call("controller", "check", "file.yaml", code=1)
    assert "fail vents-sliding" in answer.out


def test_a_hang_ends_and_leaves_no_process(call):
    path = program("open('pid', 'w').write(str(__import__('os').getpid())); __import__('time').sleep(600)")
    answer = call("controller", "check", path, "--time-limit", "0.2", code=3)
    assert "step did not return within 0.2 s (cycle 0)" in answer.out
    with pytest.raises(ProcessLookupError):
        os.kill(int(Path("pid").read_text()), 0)

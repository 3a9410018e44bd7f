"""Batches with a controller in a program at a socket, with and without a clock."""

import signal
import subprocess
import sys
import time
from pathlib import Path
from xml.etree import ElementTree

import pytest

from .conftest import HANGING, results_of

EXAMPLE = Path(__file__).parents[2] / "examples" / "socket" / "wsp.py"

IN_REAL_TIME = ("run", "--real-time", "--set", "initial_speed=3 km/h")
PROGRAM = """
import importlib.util
import sys
import time

spec = importlib.util.spec_from_file_location("wsp", sys.argv[1])
wsp = importlib.util.module_from_spec(spec)
spec.loader.exec_module(wsp)


class Faulty(wsp.SlipBand):
    def __init__(self, cycle_time, initial_speed, parameters):
        super().__init__(cycle_time, initial_speed, parameters)
        self.cycle, self.fault = 0, parameters["fault"]
        with open("stops", "a") as stops:
            stops.write(self.fault + " ")

    def step(self, speeds):
        self.cycle += 1
        if self.cycle == 51 and self.fault == "close":
            raise ConnectionError
        if self.cycle == 51 and self.fault == "sleep":
            time.sleep(3 * self.cycle_time)
        if self.cycle == 51 and self.fault == "hang":
            open("hanging", "w").close()
            time.sleep(3600)
        return super().step(speeds)


wsp.SlipBand = Faulty
wsp.main(0)
"""
CASES = """
criteria: uictest-stop
controller: {connect: "%s", time_limit: 600 s, parameters: {fault: none}, free_parameters: true}
matrix: {controller.parameters.fault: [%s]}
"""


@pytest.fixture
def faults(scenario):
    """Start a program, and write a scenario with a case for each of its faults."""
    command = [sys.executable, "-c", PROGRAM, str(EXAMPLE)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        address = process.stdout.readline().removeprefix("listening on ").strip()
        yield lambda *names: scenario("stop", CASES % (address, ", ".join(names)))
        process.kill()


def results():
    document = results_of()
    return {case["parameters"]["controller.parameters.fault"]: case for case in document["cases"]}


def test_a_connection_that_breaks_ends_its_case_and_results_name_the_program(call, faults):
    faults("none", "close", "sleep")
    answer = call("run", "-n2", "-v", code=3)
    outcomes = {fault: (case["outcome"], case["reason"]) for fault, case in results().items()}
    broken = "the program closed the connection before its answer to the step frame"
    assert outcomes == {
        "none": ("pass", ""),
        "close": ("error", f"controller: step failed: {broken} (cycle 50)"),
        "sleep": ("pass", ""),
    }
    named, closed, late = results().values()
    assert "response_times" not in late  # without a clock nothing is said of time
    assert named["controller_version"] == "slip band in Python 1.0"
    first, *_ = answer.out.splitlines()
    # Once, although the case whose connection broke told no version.
    assert first.endswith(" (version slip band in Python 1.0, contract 1), car intercity-180, 45 t")
    digests = {named["case_sha256"], closed["case_sha256"]}
    assert [len(digest) for digest in digests] == [64, 64]
    assert "controller_version" not in closed


def test_a_missed_deadline_makes_a_stop_invalid(call, faults):
    faults("sleep")
    answer = call(*IN_REAL_TIME, "-v", "--junitxml", "junit.xml", code=1)
    result = results()["sleep"]
    times = result["response_times"]
    # At least: on a machine that others use as well, more can come late.
    assert times["missed_deadlines"] >= 3
    assert times["longest_answer_s"] >= 0.03
    assert times["cycle_time_s"] == 0.01
    sentence = f"{times['missed_deadlines']} of {times['answers']} answers came after the end of their cycle"
    assert result["outcome"] == "invalid"
    assert result["reason"].startswith(f"real-time: {sentence} of 10 ms; the longest took ")
    assert (result["criteria"][-1]["id"], result["criteria"][-1]["verdict"]) == ("real-time", "fail")
    shown = f"in real time: {times['missed_deadlines']} of {times['answers']} answers after the end"
    assert shown in " ".join(answer.out.split())
    assert shown in (ElementTree.parse("junit.xml").findtext(".//failure") or "")
    assert shown[1:] in Path("reports/latest/index.html").read_text("utf-8")
    # A stop that misses its expectation is recorded, and not by running it a second time.
    assert Path("reports/latest/recordings/stop[fault=sleep].parquet").is_file()
    assert Path("stops").read_text("utf-8") == "sleep "


def test_a_stop_in_real_time_takes_its_time_and_is_drawn_as_it_ran(call, faults):
    faults("none")
    began = time.monotonic()
    call(*IN_REAL_TIME, "--record-rate", "10")  # too coarse for the valves: else the stop would run again
    times = results()["none"]["response_times"]
    assert time.monotonic() - began >= times["cycle_time_s"] * (times["answers"] - 1)
    assert Path("stops").read_text("utf-8") == "none "
    page = Path("reports/latest/index.html").read_text("utf-8")
    assert f"In real time: {times['missed_deadlines']} of {times['answers']} answers" in page


def test_who_interrupts_does_not_wait_for_a_program(faults, program, workplace):
    faults("hang", "none")
    with subprocess.Popen([program, "run", "-n2"], start_new_session=True) as running:
        while not (workplace / "hanging").exists() and running.poll() is None:
            time.sleep(0.01)
        running.send_signal(signal.SIGTERM)
        assert running.wait(HANGING) == 2

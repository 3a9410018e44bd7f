"""Where no machine code can be run, that ends a run or a sweep at once, and is no result of its cases."""

import os

import pytest

SWEEP = "schema: uictest/scenario/1\nname: s\nextends: stop.yaml\nvary: {matrix: {seed: [1, 2]}}\n"


@pytest.mark.parametrize("command", ["run", "sweep"])
def test_a_kernel_that_cannot_be_used_is_said_once(scenario, process, command):
    path = scenario(text="matrix: {seed: [1, 2, 3]}\n" if command == "run" else "")
    if command == "sweep":
        path = path.with_name("s.sweep.yaml")
        path.write_text(SWEEP, "utf-8")
    answer = process(command, path, env={**os.environ, "UICTEST_PROCESSOR": "none"})
    assert (answer.code, answer.out) == (3, "")
    assert answer.err.count("this processor runs") == 1

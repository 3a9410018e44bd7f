"""Sweeps over controllers from outside, as their users meet them."""

import csv
import json
from pathlib import Path

import pytest

FILE = "study.sweep.yaml"
CONTROLLER = """\
from uictest.controllers import Config, Inputs, Outputs


class Share:
    def __init__(self, config: Config) -> None:
        self.share = config.parameters.get("share", 0.0)

    def reset(self) -> None:
        pass

    def step(self, inputs: Inputs) -> Outputs:
        if self.share < 0:
            raise ValueError("a share below zero")
        holds = inputs.cycle % 10 < 10 * self.share
        return Outputs([holds] * 4, [0] * 4)


PARAMETERS = {"share": {"default": 0.0, "unit": "1"}}
"""
"""Holds in a share of all cycles: the more, the longer the stop."""


@pytest.fixture
def study(scenario):
    """A sweep of a stop from 30 km/h with that controller; it says the given text after its head."""
    scenario("stop", "controller: {python: ../share.py, class: Share}\nmeasures: {extends: standard}\n")
    Path("share.py").write_text(CONTROLLER)

    def write(text):
        head = "schema: uictest/scenario/1\nname: study\nextends: scenarios/stop.yaml\nvary:\n"
        Path(FILE).write_text(f"{head}  {text}")
        return Path(FILE)

    return write


def summary():
    with Path("reports/study/summary.csv").open() as file:
        return list(csv.DictReader(file))


def test_a_controller_that_fails_is_an_error_and_the_sweep_goes_on(call, study):
    call("sweep", study("matrix: {controller.parameters.share: [0, -1, 0.3]}\n"), code=3)
    outcomes = [row["outcome"] for row in summary()]
    assert outcomes[1] == "error" and "error" not in outcomes[::2]
    assert summary()[1]["reason"].startswith("controller: step failed: ValueError: a share below zero")
    assert summary()[1]["reason"].endswith("(cycle 0)")
    distances = [float(row["braking_distance_m"]) for row in summary()[::2]]
    assert distances[0] < distances[1]


def test_another_content_of_the_controller_is_another_sweep(call, study):
    file = study("matrix: {controller.parameters.share: [0, 0.3]}\n")
    assert call("sweep", file).code in (0, 1)
    first = summary()
    manifest = json.loads(Path("reports/study/manifest.json").read_bytes())
    assert len(manifest["inputs"]["share.py"]) == 64
    Path("share.py").write_text(CONTROLLER + "\n")
    answer = call("sweep", file, code=4, says="holds chunks of this sweep with other inputs")
    assert "inputs: share.py" in answer.err
    assert call("sweep", file, "--restart").code in (0, 1)
    assert summary() == first


def test_an_axis_of_controllers_names_them_in_manifest_and_ids(call, study):
    file = study("matrix: {controller: [threshold, {python: share.py, class: Share}, own.yaml]}\n")
    Path("own.yaml").write_text(
        "schema: uictest/controller/1\npython: share.py\nclass: Share\nparameters: {share: 0.5}\n"
    )
    assert call("sweep", file).code in (0, 1)
    assert [row["id"] for row in summary()] == [
        "study[controller=threshold]",
        "study[controller=share]",
        "study[controller=own]",
    ]
    inputs = json.loads(Path("reports/study/manifest.json").read_bytes())["inputs"]
    assert {"share.py", "own.yaml"} <= inputs.keys()


def test_the_frontier_of_a_parameter_is_found(call, study):
    file = study("matrix: {controller.parameters.share: [0.0, 1.0]}\n")
    scenario = Path("scenarios/stop.yaml")
    text = scenario.read_text()
    scenario.write_text(f"{text}criteria: [uictest-stop]\nsimulation: {{maximum_duration: 15 s}}\n")
    answer = call("sweep", file, "--frontier", "controller.parameters.share", "--tolerance", "0.1", code=1)
    assert "Frontier along controller.parameters.share" in answer.out
    with Path("reports/study/frontier.csv").open() as lines:
        (flip,) = csv.DictReader(lines)
    assert 0.0 < float(flip["from"]) < float(flip["to"]) <= 1.0
    assert float(flip["to"]) - float(flip["from"]) <= 0.1

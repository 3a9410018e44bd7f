"""What a controller prints in a run: a file for each case, named by its result, and not a word elsewhere."""

import json

HEAD = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 20 km/h\ncriteria: uictest-rig\n"
WSP = """\
import sys
from uictest.controllers import Outputs

PARAMETERS = {"says": {"default": ""}}


class Wsp:
    def __init__(self, config):
        self.says = config.parameters["says"]

    def reset(self):
        pass

    def step(self, inputs):
        if inputs.cycle == 3 and self.says:
            sys.stdout.write(f"{self.says} in C:\\u00e9\\n")
        if inputs.cycle == 4 and self.says == "bad":
            raise ValueError("told to")
        return Outputs([0] * 4, [0] * 4)
"""


def run(call, workplace, more, *arguments):
    (workplace / "wsp.py").write_text(WSP, "utf-8")
    controller = "controller: {python: wsp.py, class: Wsp}\n"
    (workplace / "stop.yaml").write_text(f"{HEAD}{controller}{more}", "utf-8")
    outcome = call("run", "stop.yaml", "-o", "out", *arguments)
    folder = workplace / "out" / "latest"
    results = json.loads((folder / "results.json").read_text("utf-8"))["cases"]
    return outcome, folder, {each["id"]: each.get("controller_log", "") for each in results}


def test_each_case_has_a_file_with_what_its_controller_printed(call, workplace):
    matrix = "matrix: {controller.parameters.says: ['', good, bad]}\n"
    outcome, folder, logs = run(call, workplace, matrix)
    silent, good, bad = logs.values()
    assert silent == ""
    listed = (folder / "SHA256SUMS").read_text("utf-8")
    for log, text in ((good, "good in C:\u00e9\n"), (bad, "bad in C:\u00e9\n")):
        assert (folder / log).read_text("utf-8") == text
        assert log in listed
        assert f"controller_log={log}" in outcome.out
    assert len(list((folder / "logs").iterdir())) == 2
    assert "in C:" not in outcome.out + outcome.err


def test_the_stops_of_a_repeated_case_share_one_file(call, workplace):
    _, folder, logs = run(call, workplace, "repeat: 2\nseed: 5\n", "--set", "controller.parameters.says=good")
    (log,) = logs.values()
    said = "good in C:\u00e9\n"
    assert (folder / log).read_text("utf-8") == f"--- seed 5\n{said}--- seed 6\n{said}"


def test_the_cars_of_a_train_share_what_their_process_printed(call, workplace):
    cars = "{controller: wsp.yaml}, {controller: wsp.yaml}, {controller: threshold}"
    train = f"train: [{cars}]\n"
    (workplace / "wsp.yaml").write_text(
        "schema: uictest/controller/1\nname: wsp\npython: wsp.py\nclass: Wsp\nparameters: {says: car}\n",
        "utf-8",
    )
    _, folder, logs = run(call, workplace, train)
    first, second, built_in = logs.values()
    assert built_in == ""
    for log in (first, second):
        assert (folder / log).read_text("utf-8") == "car in C:\u00e9\n" * 2

"""Controllers from outside in a run: where they run, what they print, and what is said of them."""

import json
import shutil
import signal
import subprocess
import time
from hashlib import sha256
from pathlib import Path
from xml.etree import ElementTree

import pytest

from .conftest import HANGING, manifest_of, results_of

TWIN = Path(__file__).parents[1] / "sweeps" / "controllers" / "slip_band.py"
"""The built-in slip-band as a controller from outside."""
WSP = """\
import os
import time
from pathlib import Path

from uictest.controllers import Outputs

PARAMETERS = {"fault": {"default": ""}, "says": {"default": ""}}


class Wsp:
    def __init__(self, config):
        self.fault, self.says = config.parameters["fault"], config.parameters["says"]

    def reset(self):
        pass

    def step(self, inputs):
        at = inputs.cycle == 4
        if self.says and at:
            print(f"{self.says} in C:\\u00e9")
        if at and self.fault == "exit":
            os._exit(0)
        if at and self.fault == "raise":
            raise ValueError("told to")
        if at and self.fault == "hang":
            open("hanging", "w").close()
            time.sleep(3600.0)
        return Outputs([0, 0, 0, 0], [0, 0, int(at and self.fault == "forbidden"), 0])
"""


@pytest.fixture
def stop(scenario):
    """Write a stop with that controller; more lines are appended."""

    def write(text="", own="free_parameters: true"):
        path = scenario("stop", f"controller: {{python: wsp.py, class: Wsp, {own}}}\n{text}")
        path.with_name("wsp.py").write_text(WSP, "utf-8")
        return path

    return write


def faults(*names):
    return f"matrix: {{controller.parameters.fault: [{', '.join(names)}]}}\n"


def cases(folder="reports"):
    return results_of(f"{folder}/latest")["cases"]


def test_what_a_controller_does_wrong_is_an_error_of_its_case_and_what_it_prints_is_no_data(process, stop):
    stop(faults("none", "exit", "forbidden", "raise", "last") + "criteria: uictest-stop\n")
    answer = process("run", "-n2", "--format", "json", "--set", "controller.parameters.says=noise")
    assert answer.code == 3
    assert json.loads(answer.out)["cases"] == cases()
    assert "noise in" not in answer.out + answer.err
    assert [(case["outcome"], case["reason"]) for case in cases()] == [
        ("pass", ""),
        ("error", "controller: ended its process with exit code 0 (cycle 4)"),
        ("error", "controller: forbidden command for wheelset 3: vent without hold (cycle 4)"),
        ("error", "controller: step failed: ValueError: told to (wsp.py, line 24) (cycle 4)"),
        ("pass", ""),
    ]


def test_a_child_process_and_this_one_give_the_same_results(call, stop):
    path = stop()
    assert "not isolated" not in call("run", path, code=0).err
    isolated = cases()
    call("run", path, "--in-process", code=0, says="not isolated")
    assert cases() == isolated


def test_who_interrupts_a_hanging_controller_leaves_no_process(stop, program, workplace):
    path = stop(faults("hang"), "time_limit: 600 s, free_parameters: true")
    with subprocess.Popen([program, "run", path], start_new_session=True) as running:
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


def logs():
    """Return the file of each case with what its controller printed, and the text of it."""
    named = [case.get("controller_log", "") for case in cases()]
    return named, [Path("reports/latest", name).read_text("utf-8") if name else "" for name in named]


def test_each_case_has_a_file_with_what_its_controller_printed(call, stop):
    call("run", stop("matrix: {controller.parameters.says: ['', good, bad]}\n"))
    named, texts = logs()
    assert texts == ["", "good in C:\u00e9\n", "bad in C:\u00e9\n"]
    listed = Path("reports/latest/SHA256SUMS").read_text("utf-8")
    assert all(name in listed for name in named[1:])
    assert len(list(Path("reports/latest/logs").iterdir())) == 2


def test_the_stops_of_a_repeated_case_and_the_cars_of_a_train_share_one(call, stop):
    path = stop("repeat: 2\nseed: 5\n")
    call("run", path, "--set", "controller.parameters.says=good")
    said = "good in C:\u00e9\n"
    assert logs()[1] == [f"--- seed 5\n{said}--- seed 6\n{said}"]
    part = "schema: uictest/controller/1\npython: wsp.py\nclass: Wsp\nparameters: {says: car}\n"
    path.with_name("wsp.yaml").write_text(part, "utf-8")
    cars = "train: [{controller: wsp.yaml}, {controller: wsp.yaml}, {controller: threshold}]\n"
    head = path.read_text("utf-8").split("controller")[0]
    path.write_text(head + cars, "utf-8")
    call("run", path)
    assert logs()[1] == ["car in C:\u00e9\n" * 2, "car in C:\u00e9\n" * 2, ""]


CASES = "rail: {condition: wet}\nmatrix: {rail.friction: [0.08, 0.10], seed: [1, 2]}\n"
OUTSIDE = "controller={python: slip_band.py, class: SlipBand, parameters: {lower_slide: %s}}"
BUILT_IN = "controller=slip-band"


@pytest.fixture
def run(call, scenario):
    """Run four cases with a controller into a folder."""
    scenario("stop", CASES)
    shutil.copy(TWIN, ".")
    return lambda folder, *options: call(
        "run", "--in-process", "--report", "csv", "-o", folder, "--set", *options
    )


def test_a_controller_named_on_the_command_line_leaves_ids_and_noise(run, call):
    """The noise belongs to the case, not to the controller: a twin of the built-in one keeps its baseline."""
    run("ours", BUILT_IN, "--record", "all", "--baseline", "kept", "--accept")
    twin = run("theirs", OUTSIDE % 0.08, "--record", "all", "--baseline", "kept")
    assert "no difference" in twin.err
    call("compare", "ours/latest", "theirs/latest", code=0, says="no difference")
    ours, theirs = (sorted(Path(name, "latest/recordings").glob("*")) for name in ("ours", "theirs"))
    assert [path.name for path in ours] == [path.name for path in theirs] != []
    assert "measured_speed" not in call("compare", ours[0], theirs[0]).out
    other = run("other", OUTSIDE % 0.15, "--baseline", "kept")
    assert (other.code, "differ from the baseline" in other.out) == (1, True)
    compared = call("compare", "ours/latest", "other/latest", code=1).out
    for condition in ("friction 0.08", "friction 0.10"):  # of two seeds each
        assert f"\n{condition} " in compared


def test_cases_of_another_name_have_other_noise(run):
    run("ours", BUILT_IN)
    run("both", "controller=slip-band,threshold")
    first, second = (Path(folder, "latest/summary.csv").read_text() for folder in ("ours", "both"))
    distance = first.splitlines()[0].split(",").index("braking_distance_m")
    ours, both = ({line.split(",")[distance] for line in each.splitlines()[1:]} for each in (first, second))
    assert not ours & both


PROGRAM = """__version__ = "1.2.0"
from uictest.controllers import Outputs


class Wsp:
    def __init__(self, config):
        pass

    def reset(self):
        pass

    def step(self, inputs):
        return Outputs([0] * 4, [0] * 4)
"""
TELLING = (
    PROGRAM.replace('"1.2.0"', 'str(1) + ".2.0"')
    .replace("from uictest", "from pathlib import Path\nfrom uictest", 1)
    .replace("        pass\n", '        Path("stops").write_text(config.case_sha256)\n', 1)
)
"""Its version cannot be read without running it; it notes which stop it was given."""


@pytest.fixture
def versioned(scenario):
    """Write a stop with the program of this text; returns the path of the stop."""

    def write(program=PROGRAM, own="parameters: {gain: 2}, free_parameters: true"):
        path = scenario("stop", f"controller: {{python: wsp.py, class: Wsp, {own}}}\n")
        path.with_name("wsp.py").write_text(program, "utf-8")
        return path

    return write


def properties():
    found = ElementTree.parse("reports/latest/junit.xml").iter("property")
    return {str(each.get("name")): str(each.get("value")) for each in found}


@pytest.mark.parametrize(("program", "options"), [(PROGRAM, ()), (TELLING, ()), (TELLING, ("--in-process",))])
def test_every_report_names_the_program_and_its_version_though_it_tells_it_only_when_run(
    call, versioned, program, options
):
    answer = call("run", versioned(program), "-v", *options, "--report", "csv,html,md")
    digest = sha256(program.encode()).hexdigest()
    told = f"version 1.2.0, python wsp.py, SHA-256 {digest[:12]}"
    assert f"part controller: Wsp, {told}, with gain 2" in answer.out
    folder = Path("reports/latest")
    for name in ("summary.csv", "summary.md", "index.html", "junit.xml"):
        assert told in (folder / name).read_text("utf-8"), name
    assert (properties()["controller.sha256"], properties()["controller.version"]) == (digest, "1.2.0")
    assert "controller.told_version" not in properties()
    manifest = manifest_of(folder)
    assert manifest["inputs"]["scenarios/wsp.py"] == digest
    document = results_of(folder)
    part = document["parts"][document["cases"][0]["parts"]["controller"]]
    assert part["name"] == "Wsp"
    parameters = {each["key"].removeprefix("controller."): each["value"] for each in part["parameters"]}
    written = {"python": "wsp.py", "class": "Wsp", "sha256": digest, "parameters.gain": 2}
    assert parameters.items() >= written.items()
    if program == PROGRAM:
        assert parameters["version"] == "1.2.0"
        assert f"Wsp, {told}, with gain 2" in manifest["parts"].values()
        settings = document["subjects"]["stop"]["settings"]
        assert settings["WSP"] == "active, controller Wsp 1.2.0 (python wsp.py)"


@pytest.mark.parametrize("program", [PROGRAM, TELLING])
def test_a_baseline_and_compare_say_that_it_is_of_another_build(call, versioned, program):
    """Even where every measure agrees."""
    call("run", versioned(program), "--baseline", "kept", "--accept", code=0)
    answer = call("run", versioned(program.replace(".2.0", ".3.0")), "--baseline", "kept", code=0)
    assert "parameter controller.version: 1.2.0 -> 1.3.0" in answer.err
    assert f"parameter controller.sha256: {sha256(program.encode()).hexdigest()[:12]}... -> " in answer.err
    assert "parameter controller.version: 1.2.0 -> 1.3.0" in call("compare", "kept", "reports/latest").out


def test_a_recording_of_such_a_stop_can_be_judged_and_drawn(call, versioned):
    """Without its controller: the recording says what it did."""
    path = versioned()
    call("run", path, "--record", "all", code=0)
    path.with_name("wsp.py").write_text("raise SystemExit('never run')\nclass Wsp: ...\n", "utf-8")
    call("report", "reports/latest", "--format", "html", code=0)
    recording = Path("reports/latest/recordings/stop.parquet")
    call("evaluate", recording, "--scenario", path, "-o", "judged", code=0)


@pytest.mark.parametrize(("fails", "code", "version"), [(False, 0, "1.2.0"), (True, 3, None)])
def test_a_result_has_the_digest_that_the_program_was_given_though_it_failed(
    call, versioned, fails, code, version
):
    """So that its log can be matched with the result."""
    broken = TELLING.replace("        return Outputs", "        raise MemoryError\n        return Outputs")
    call("run", versioned(broken if fails else TELLING), code=code)
    (result,) = cases()
    assert result["case_sha256"] == Path("stops").read_text("utf-8")
    assert result.get("controller_version") == version
    assert result.get("controller_contract") == (None if fails else 1)


def test_a_program_that_contradicts_its_scenario_is_quoted_and_a_built_in_one_has_no_version(
    call, versioned, scenario
):
    answer = call("run", versioned(TELLING, "version: 1.1.9"), "-v")
    assert "part controller: Wsp, version 1.1.9 (the program says 1.2.0), python wsp.py" in answer.out
    told = {"controller.version": "1.1.9", "controller.told_version": "1.2.0"}
    assert properties().items() >= told.items()
    call("run", scenario("stop"))
    assert {"controller_version", "case_sha256"}.isdisjoint(cases()[0])


@pytest.mark.parametrize("version", ['"\\ud800"', '"1" * 101', '"1\\n2"'])
def test_a_version_that_no_line_can_show_is_none(call, versioned, version):
    call("run", versioned(TELLING.replace('str(1) + ".2.0"', f"str({version})")), code=0)
    assert "controller_version" not in cases()[0]

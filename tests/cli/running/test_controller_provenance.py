"""Which controller from outside a run was made with: in the terminal, its folder and a baseline."""

import json
from hashlib import sha256
from pathlib import Path
from xml.etree import ElementTree

import pytest

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
def stop(scenario):
    path = scenario(
        "stop", "controller: {python: wsp.py, class: Wsp, parameters: {gain: 2}, free_parameters: true}\n"
    )
    (path.parent / "wsp.py").write_text(PROGRAM, "utf-8")
    return path


def properties_in(junit):
    return {
        str(each.get("name")): str(each.get("value")) for each in ElementTree.parse(junit).iter("property")
    }


def result_in(folder):
    (case,) = json.loads((folder / "results.json").read_text("utf-8"))["cases"]
    return case


@pytest.mark.parametrize(("program", "options"), [(PROGRAM, ()), (TELLING, ()), (TELLING, ("--in-process",))])
def test_every_report_names_the_program_and_its_version_though_it_tells_it_only_when_run(
    call, stop, program, options
):
    (stop.parent / "wsp.py").write_text(program, "utf-8")
    answer = call("run", stop, "-v", *options, "--report", "csv,html,md", "-o", "out")
    digest = sha256(program.encode()).hexdigest()
    told = f"version 1.2.0, python wsp.py, SHA-256 {digest[:12]}"
    assert f"part controller: Wsp, {told}, with gain 2" in answer.out
    folder = Path("out/latest")
    for name in ("summary.csv", "summary.md"):
        assert f"controller Wsp ({told}, with gain 2)" in (folder / name).read_text("utf-8")
    page = (folder / "index.html").read_text("utf-8")
    assert page.count(told) == 3  # in the row of the case, above its plots, and among its parts
    assert digest in page
    properties = properties_in("out/latest/junit.xml")
    assert (properties["controller.sha256"], properties["controller.version"]) == (digest, "1.2.0")
    assert "controller.told_version" not in properties
    assert told in (ElementTree.parse(folder / "junit.xml").findtext(".//system-out") or "")
    manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
    assert manifest["inputs"]["scenarios/wsp.py"] == digest
    document = json.loads((folder / "results.json").read_text("utf-8"))
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
def test_a_baseline_and_compare_say_that_it_is_of_another_build(call, stop, program):
    """Even where every measure agrees."""
    (stop.parent / "wsp.py").write_text(program, "utf-8")
    assert call("run", stop, "--baseline", "kept", "--accept").code == 0
    (stop.parent / "wsp.py").write_text(program.replace(".2.0", ".3.0"), "utf-8")
    answer = call("run", stop, "--baseline", "kept", "-o", "out", code=0)
    assert "parameter controller.version: 1.2.0 -> 1.3.0" in answer.err
    assert f"parameter controller.sha256: {sha256(program.encode()).hexdigest()} -> " in answer.err
    assert "parameter controller.version: 1.2.0 -> 1.3.0" in call("compare", "kept", "out/latest").out


def test_a_recording_of_such_a_stop_can_be_judged_and_drawn(call, stop):
    """Without its controller: the recording says what it did."""
    run = call("run", stop, "--record", "all", "-o", "out")
    (stop.parent / "wsp.py").write_text("raise SystemExit('never run')\nclass Wsp: ...\n", "utf-8")
    recording = Path("out/latest/recordings/stop.parquet")
    judged = call("evaluate", recording, "--scenario", stop, "-o", "judged")
    assert judged.code == run.code == 0
    assert call("report", "out/latest", "--format", "html").code == 0


@pytest.mark.parametrize(("fails", "code", "version"), [(False, 0, "1.2.0"), (True, 3, None)])
def test_a_result_has_the_digest_that_the_program_was_given_though_it_failed(
    call, stop, fails, code, version
):
    """So that its log can be matched with the result."""
    broken = TELLING.replace("        return Outputs", "        raise MemoryError\n        return Outputs")
    (stop.parent / "wsp.py").write_text(broken if fails else TELLING, "utf-8")
    assert call("run", stop, "-o", "out").code == code
    result = result_in(Path("out/latest"))
    assert result["case_sha256"] == Path("stops").read_text("utf-8")
    assert result.get("controller_version") == version
    assert result.get("controller_contract") == (None if fails else 1)


def test_a_program_that_contradicts_its_scenario_is_quoted(call, scenario):
    path = scenario("stop", "controller: {python: wsp.py, class: Wsp, version: 1.1.9}\n")
    (path.parent / "wsp.py").write_text(TELLING, "utf-8")
    answer = call("run", path, "-v", "-o", "out")
    assert "part controller: Wsp, version 1.1.9 (the program says 1.2.0), python wsp.py" in answer.out
    properties = properties_in("out/latest/junit.xml")
    assert properties["controller.version"] == "1.1.9"
    assert properties["controller.told_version"] == "1.2.0"


def test_a_built_in_controller_has_neither_version_nor_digest(call, scenario):
    call("run", scenario("stop"), "-o", "out")
    assert {"controller_version", "case_sha256"}.isdisjoint(result_in(Path("out/latest")))


@pytest.mark.parametrize("version", ['"\\ud800"', '"1" * 101', '"1\\n2"'])
def test_a_version_that_no_line_can_show_is_none(call, stop, version):
    (stop.parent / "wsp.py").write_text(TELLING.replace('str(1) + ".2.0"', f"str({version})"), "utf-8")
    assert call("run", stop, "-o", "out").code == 0
    assert "controller_version" not in result_in(Path("out/latest"))

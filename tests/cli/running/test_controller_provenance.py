"""Which controller from outside a run was made with: in the terminal, its folder and a baseline."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

Call = Callable[..., Any]
Write = Callable[..., Path]

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
def stop(scenario: Write) -> Path:
    path = scenario(
        "stop", "controller: {python: wsp.py, class: Wsp, parameters: {gain: 2}, free_parameters: true}\n"
    )
    (path.parent / "wsp.py").write_text(PROGRAM, "utf-8")
    return path


def test_every_report_names_the_program(call: Call, stop: Path) -> None:
    answer = call("run", stop, "-v", "--report", "csv,html,md", "-o", "out")
    digest = sha256(PROGRAM.encode()).hexdigest()
    told = f"version 1.2.0, python wsp.py, SHA-256 {digest[:12]}"
    assert f"part controller: Wsp, {told}, with gain 2" in answer.out
    folder = Path("out/latest")
    manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
    assert manifest["inputs"]["scenarios/wsp.py"] == digest
    assert f"Wsp, {told}, with gain 2" in manifest["parts"].values()
    assert f"controller Wsp ({told})" in (folder / "summary.csv").read_text("utf-8")
    assert digest[:12] in (folder / "summary.md").read_text("utf-8")
    assert digest in (folder / "index.html").read_text("utf-8")
    properties = {
        each.get("name"): each.get("value")
        for each in ElementTree.parse(folder / "junit.xml").iter("property")
    }
    assert properties["controller.sha256"] == digest
    document = json.loads((folder / "results.json").read_text("utf-8"))
    part = document["parts"][document["cases"][0]["parts"]["controller"]]
    values = {each["key"]: each["value"] for each in part["parameters"]}
    assert part["name"] == "Wsp"
    assert values["controller.python"] == "wsp.py"
    assert values["controller.class"] == "Wsp"
    assert values["controller.version"] == "1.2.0"
    assert values["controller.sha256"] == digest
    assert values["controller.parameters.gain"] == 2
    assert document["subjects"]["stop"]["settings"]["WSP"] == "active, controller Wsp 1.2.0 (python wsp.py)"


def test_a_baseline_says_that_it_is_of_another_build(call: Call, stop: Path) -> None:
    """Even where every measure agrees."""
    assert call("run", stop, "--baseline", "kept", "--accept").code == 0
    (stop.parent / "wsp.py").write_text(PROGRAM.replace("1.2.0", "1.3.0"), "utf-8")
    answer = call("run", stop, "--baseline", "kept")
    assert answer.code == 0
    assert "parameter controller.version: 1.2.0 -> 1.3.0" in answer.err
    assert f"parameter controller.sha256: {sha256(PROGRAM.encode()).hexdigest()} -> " in answer.err


def test_a_recording_of_such_a_stop_can_be_judged_and_drawn(call: Call, stop: Path) -> None:
    """Without its controller: the recording says what it did."""
    run = call("run", stop, "--record", "all", "-o", "out")
    (stop.parent / "wsp.py").write_text("raise SystemExit('never run')\n", "utf-8")
    recording = Path("out/latest/recordings/stop.parquet")
    judged = call("evaluate", recording, "--scenario", stop, "-o", "judged")
    assert judged.code == run.code == 0
    assert call("report", "out/latest", "--format", "html,xlsx").code == 0


def result_in(folder: Path) -> Any:
    (case,) = json.loads((folder / "results.json").read_text("utf-8"))["cases"]
    return case


@pytest.mark.parametrize("where", [(), ("--in-process",)])
def test_every_report_says_the_version_that_only_a_running_program_tells(
    call: Call, stop: Path, where: tuple[str, ...]
) -> None:
    (stop.parent / "wsp.py").write_text(TELLING, "utf-8")
    answer = call("run", stop, "-v", *where, "--report", "csv,html,md,xlsx", "-o", "out")
    told = f"version 1.2.0, python wsp.py, SHA-256 {sha256(TELLING.encode()).hexdigest()[:12]}"
    assert f"part controller: Wsp, {told}, with gain 2" in answer.out
    folder = Path("out/latest")
    assert result_in(folder)["controller_version"] == "1.2.0"
    assert f"controller Wsp ({told})" in (folder / "summary.csv").read_text("utf-8")
    assert f"controller Wsp ({told})" in (folder / "summary.md").read_text("utf-8")
    page = (folder / "index.html").read_text("utf-8")
    assert page.count(told) == 3  # in the row of the case, above its plots, and among its parts
    with zipfile.ZipFile(folder / "report.xlsx") as workbook:
        assert any(told in workbook.read(name).decode() for name in workbook.namelist() if "sheet" in name)
    (suite,) = ElementTree.parse(folder / "junit.xml").iter("testsuite")
    properties = {each.get("name"): each.get("value") for each in suite.iter("property")}
    assert properties["controller.version"] == "1.2.0"
    assert "controller.told_version" not in properties
    assert told in (suite.findtext(".//system-out") or "")


def test_a_result_has_the_digest_that_the_program_was_given(call: Call, stop: Path) -> None:
    """So that its log can be matched with the result."""
    (stop.parent / "wsp.py").write_text(TELLING, "utf-8")
    call("run", stop, "-o", "out")
    assert result_in(Path("out/latest"))["case_sha256"] == Path("stops").read_text("utf-8")


def test_the_digest_is_there_where_the_program_failed(call: Call, stop: Path) -> None:
    broken = TELLING.replace("        return Outputs", "        raise MemoryError\n        return Outputs")
    (stop.parent / "wsp.py").write_text(broken, "utf-8")
    assert call("run", stop, "-o", "out").code == 3
    result = result_in(Path("out/latest"))
    assert result["case_sha256"] == Path("stops").read_text("utf-8")
    assert "controller_version" not in result


def test_a_program_that_contradicts_its_scenario_is_quoted(call: Call, scenario: Write) -> None:
    path = scenario("stop", "controller: {python: wsp.py, class: Wsp, version: 1.1.9}\n")
    (path.parent / "wsp.py").write_text(TELLING, "utf-8")
    answer = call("run", path, "-v", "-o", "out")
    assert "part controller: Wsp, version 1.1.9 (the program says 1.2.0), python wsp.py" in answer.out
    junit = ElementTree.parse("out/latest/junit.xml")
    properties = {each.get("name"): each.get("value") for each in junit.iter("property")}
    assert properties["controller.version"] == "1.1.9"
    assert properties["controller.told_version"] == "1.2.0"


def test_a_baseline_and_compare_show_another_told_version(call: Call, stop: Path) -> None:
    (stop.parent / "wsp.py").write_text(TELLING, "utf-8")
    assert call("run", stop, "--baseline", "kept", "--accept").code == 0
    (stop.parent / "wsp.py").write_text(TELLING.replace(".2.0", ".3.0"), "utf-8")
    answer = call("run", stop, "--baseline", "kept", "-o", "out")
    assert answer.code == 0
    assert "parameter controller.version: 1.2.0 -> 1.3.0" in answer.err
    assert "parameter controller.version: 1.2.0 -> 1.3.0" in call("compare", "kept", "out/latest").out


def test_a_built_in_controller_has_neither_version_nor_digest(call: Call, scenario: Write) -> None:
    call("run", scenario("stop"), "-o", "out")
    assert {"controller_version", "case_sha256"}.isdisjoint(result_in(Path("out/latest")))


@pytest.mark.parametrize("version", ['"\\ud800"', '"1" * 101', '"1\\n2"'])
def test_a_version_that_no_line_can_show_is_none(call: Call, stop: Path, version: str) -> None:
    (stop.parent / "wsp.py").write_text(TELLING.replace('str(1) + ".2.0"', f"str({version})"), "utf-8")
    assert call("run", stop, "-o", "out").code == 0
    assert "controller_version" not in result_in(Path("out/latest"))

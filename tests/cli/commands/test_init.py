import json
from functools import partial
from pathlib import Path

import jsonschema
import yaml

from uictest.selftest.conformance import bench as situations


def test_the_first_scenario_is_valid_for_program_and_editor_and_is_met(call):
    assert call("init").code == 0
    assert call("check").code == 0
    scenario = yaml.safe_load(Path("scenarios/first-stop.yaml").read_text())
    schema = json.loads(Path("schema/scenario.schema.json").read_text())
    jsonschema.Draft7Validator(schema).validate(scenario)
    call("init", "somewhere")
    assert call("run", "somewhere/scenarios").code == 0


def test_the_scenarios_that_ship_come_with_their_schemas_beside_a_first_one(call):
    assert call("init").code == 0
    written = Path("schema/scenario.schema.json").read_text("utf-8")
    Path("schema/scenario.schema.json").write_text(written.replace("description", "title"), "utf-8")
    assert call("init", "--scenarios").code == 0
    assert Path("schema/scenario.schema.json").read_text("utf-8") == written
    assert Path("scenarios/slip-120.yaml").is_file() and Path("scenarios/first-stop.yaml").is_file()
    for path in Path("scenarios").iterdir():
        first = path.read_text("utf-8").splitlines()[0]
        named = path.parent / first.removeprefix("# yaml-language-server: $schema=")
        assert "const" in named.read_text("utf-8"), path


def test_a_first_controller_is_checked_with_the_command_that_is_shown_and_one_in_c_has_its_header(
    call, monkeypatch
):
    monkeypatch.setattr(situations, "anything", partial(situations.anything, cycles=300))
    answer = call("init", "controller", "--python", "wsp", code=0)
    [command] = [line.split() for line in answer.err.splitlines() if "controller check" in line]
    call(*command[1:], "--html", "check.html", code=0)
    assert "<h3>" not in Path("check.html").read_text("utf-8")  # nothing is missed: nothing is drawn
    call("init", "controller", "--c", "in-c", code=0)
    assert {path.name for path in Path("in-c").iterdir()} == {
        *("Makefile", "wsp.c", "uictest_controller.h", "my-wsp.yaml", "slip-120.yaml")
    }

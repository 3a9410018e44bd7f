import json
from pathlib import Path

import jsonschema
import yaml


def test_the_first_scenario_is_valid_for_program_and_editor_and_is_met(call):
    assert call("init").code == 0
    assert call("check").code == 0
    scenario = yaml.safe_load(Path("scenarios/first-stop.yaml").read_text())
    schema = json.loads(Path("schema/scenario.schema.json").read_text())
    jsonschema.Draft7Validator(schema).validate(scenario)
    call("init", "somewhere")
    assert call("run", "somewhere/scenarios").code == 0


def test_every_schema_that_a_shipped_scenario_names_is_written_with_it(call):
    assert call("init", "--scenarios").code == 0
    for path in Path("scenarios").iterdir():
        first = path.read_text("utf-8").splitlines()[0]
        named = path.parent / first.removeprefix("# yaml-language-server: $schema=")
        assert "const" in named.read_text("utf-8"), path


def test_nothing_is_overwritten(call):
    call("init")
    Path("scenarios/first-stop.yaml").write_text("mine")
    call("init", code=4, says="already there")
    assert Path("scenarios/first-stop.yaml").read_text() == "mine"


def test_the_scenarios_that_ship_come_beside_a_first_one_and_renew_the_schema(call):
    assert call("init").code == 0
    written = Path("schema/scenario.schema.json").read_text("utf-8")
    Path("schema/scenario.schema.json").write_text(written.replace("description", "title"), "utf-8")
    assert call("init", "--scenarios").code == 0
    assert Path("schema/scenario.schema.json").read_text("utf-8") == written
    assert Path("scenarios/slip-120.yaml").is_file() and Path("scenarios/first-stop.yaml").is_file()


def test_a_schema_of_another_program_is_left_alone_and_nothing_is_written(call):
    Path("schema").mkdir()
    Path("schema/scenario.schema.json").write_text("{}")
    call("init", code=4, says="not written by this version of uictest: schema/scenario.schema.json")
    assert not Path("scenarios").exists()

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

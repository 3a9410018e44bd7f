import json
from pathlib import Path

import jsonschema
import yaml

from ..conftest import Call


def test_the_first_scenario_is_valid_for_program_and_editor(call: Call) -> None:
    assert call("init").code == 0
    assert call("check").code == 0
    scenario = yaml.safe_load(Path("scenarios/first-stop.yaml").read_text())
    schema = json.loads(Path("schema/scenario.schema.json").read_text())
    jsonschema.Draft7Validator(schema).validate(scenario)


def test_the_first_scenario_runs_and_is_met(call: Call) -> None:
    call("init", "somewhere")
    assert call("run", "somewhere/scenarios").code == 0


def test_nothing_is_overwritten(call: Call) -> None:
    call("init")
    Path("scenarios/first-stop.yaml").write_text("mine")
    answer = call("init")
    assert answer.code == 4
    assert "already there" in answer.err
    assert Path("scenarios/first-stop.yaml").read_text() == "mine"

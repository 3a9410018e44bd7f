"""The JSON Schema that editors use."""

import json
from pathlib import Path

import pytest
import yaml
from jsonschema import Draft7Validator

from uictest.plans.scenario import json_schema
from uictest.plans.scenario.model import Scenario

ROOT = Path(__file__).parents[2]
SHIPPED = [
    path
    for path in sorted((ROOT / "scenarios").glob("*.yaml"))
    if not {".sweep", ".series"} & set(path.suffixes)
]
HEAD = {"schema": "uictest/scenario/1", "name": "stop", "initial_speed": "120 km/h"}


@pytest.fixture(scope="module")
def schema():
    return json_schema()


@pytest.fixture(scope="module")
def validator(schema):
    return Draft7Validator(schema)


def test_it_is_a_draft_07_schema(schema):
    Draft7Validator.check_schema(schema)
    assert schema["$schema"] == "http://json-schema.org/draft-07/schema#"
    newer = ("$defs", "prefixItems", "x-quantity", '"discriminator"', "unevaluatedProperties")
    assert not any(keyword in json.dumps(schema) for keyword in newer)


def properties(node, path=""):
    if isinstance(node, dict):
        for name, schema in node.get("properties", {}).items():
            yield f"{path}.{name}", schema
        for key, inner in node.items():
            yield from properties(inner, f"{path}/{key}")
    elif isinstance(node, list):
        for inner in node:
            yield from properties(inner, path)


def described(field, schema):
    """Whether the field, or what it refers to, has a description."""
    name = field.get("$ref", "").rpartition("/")[2]
    return bool(field.get("description") or schema["definitions"].get(name, {}).get("description"))


def test_every_field_is_described(schema):
    fields = dict(properties(schema))
    assert len(fields) > 150
    assert [path for path, field in fields.items() if not described(field, schema)] == []


def test_it_knows_every_key_of_the_model(schema):
    keys = {field.alias or name for name, field in Scenario.model_fields.items()}
    assert set(schema["properties"]) == keys


def test_references_resolve(schema):
    used = {word for word in json.dumps(schema).split('"') if word.startswith("#/definitions/")}
    assert used
    assert used <= {f"#/definitions/{name}" for name in schema["definitions"]}


def as_json(path):
    """The content of a YAML file; keys of JSON are texts, also where YAML reads numbers."""
    return json.loads(json.dumps(yaml.safe_load(path.read_text())))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_scenarios_are_valid(path, validator):
    assert [error.message for error in validator.iter_errors(as_json(path))] == []


@pytest.mark.parametrize(
    "more",
    [
        {"vehicle": {"extends": "crh380a", "body": {"mass": "40 t"}}},
        {"vehicle": {"extends": "crh380a", "body": {"mass": {"value": "40 t", "source": "crh380a"}}}},
        {"controller": {"extends": "threshold", "cycle_time": "20 ms"}},
        {"controller": {"python": "wsp.py", "class": "Wsp", "parameters": {"a": [1, {"b": True}]}}},
        {"controller": {"extends": "mine.yaml", "parameters": {"a": 1}, "version": "2.1"}},
        {"controller": {"library": "libwsp.so", "time_limit": "50 ms", "cycle_time": "5 ms"}},
        {"controller": {"fmu": "wsp.fmu", "variables": {"hold": "ev_%d"}}},
        {"controller": {"connect": "tcp://127.0.0.1:5025"}},
        {"rail": {"friction": {"points": [{"position": "0 m", "friction": 0.1}]}}},
        {"criteria": [{"extends": "uictest-stop"}, "uictest-stop"]},
        {"rig": {"compensation_model": {"extends": "six-inch", "cylinder": {"denominator": [-0.5, 0, 0]}}}},
        {"matrix": {"rail.friction": [0.1]}, "exclude": [{"rail.friction": 0.1}]},
    ],
)
def test_what_the_loader_accepts_is_valid(more, validator):
    assert [error.message for error in validator.iter_errors({**HEAD, **more})] == []


@pytest.mark.parametrize(
    "wrong",
    [
        {"initial_speed": 120},
        {"initial_speed": "120 kmh"},
        {"rial": {}},
        {"rail": {"friction": 2}},
        {"rail": {"friction": {"points": []}}},
        {"rig": {"topology": "two-caliper"}},
        {"name": "A b"},
        {"seed": -1},
        {"matrix": {}},
        {"matrix": {"seed": []}},
        {"vehicle": {"extends": "crh380a", "body": {"mas": "40 t"}}},
        {"controller": {"extends": "threshold", "cycle_tim": "20 ms"}},
        {"controller": {"pyton": "wsp.py", "class": "Wsp"}},
        {"controller": {"python": "wsp.py"}},
        {"controller": {"python": "wsp.py", "class": "Wsp", "library": "libwsp.so"}},
        {"controller": {"connect": "127.0.0.1:5025"}},
        {"controller": {"library": "libwsp.so", "parameters": {"a": None}}},
    ],
)
def test_what_the_loader_refuses_is_mostly_invalid(wrong, validator):
    assert not validator.is_valid({**HEAD, **wrong})


def test_an_initial_speed_may_come_from_the_parent_only(validator):
    assert validator.is_valid({"schema": "uictest/scenario/1", "name": "a", "extends": "b.yaml"})
    assert not validator.is_valid({"schema": "uictest/scenario/1", "name": "a"})

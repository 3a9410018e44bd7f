"""The JSON Schema that editors use."""

import json
from pathlib import Path

import pytest
import yaml
from jsonschema import Draft7Validator

from uictest.plans.scenario import ScenarioErrors, json_schema
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.train import TrainCar
from uictest.plans.scenario.yaml import Document, parse, plain

ROOT = Path(__file__).parents[2]
SHIPPED = [
    path
    for path in sorted((ROOT / "scenarios").glob("*.yaml"))
    if not {".sweep", ".series", ".programme"} & set(path.suffixes)
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


def test_it_describes_every_field_of_the_model_and_its_references_resolve(schema):
    fields = dict(properties(schema))
    assert len(fields) > 150
    assert [path for path, field in fields.items() if not described(field, schema)] == []
    keys = {field.alias or name for name, field in Scenario.model_fields.items()}
    assert set(schema["properties"]) == keys
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


OTHERS = (None, [], {}, "", "x", 5, 0.5, True, {"bogus": 1})
"""Values of every type, which stand in the place of any."""
BY_HAND = {
    "train: [{}]": True,
    "train: [{count: 2}, {vehicle: null}]": True,
    "train: null": True,
    "vary: null": True,
    "train: []": False,
    **{f"train: [{{{key}: null}}]": False for key in TrainCar.model_fields if key != "vehicle"},
    "extends: null": False,
    'rail: {friction: "0.1"}': True,
    "rail: {friction: 0.1 1}": False,
    "rail: {friction: {value: 0.1, range: [0.05, 0.2]}}": True,
    "rail: {friction: {value: {value: 0.1, source: scenario}, source: scenario}}": False,
    "rail: {friction: {value: 0.1, range: [{value: 0.05, source: scenario}, 0.2]}}": False,
    "rail: {friction: {value: 0.1, source: scenario, prior: uniform}}": False,
    "controller: {connect: 'tcp://rig:1', free_parameters: true}": True,
    "controller: {connect: 'tcp://rig:1', free_parameters: yes}": False,
    "controller: {connect: 'tcp://rig:1', free_parameters: 1}": False,
}


def places_in(content, above=()):
    """The key of every value, those in lists and in `matrix`, which a schema knows nothing of, left out."""
    for key, value in content.items():
        if not above and key in ("matrix", "zip", "include", "exclude", "schema"):
            continue
        yield (*above, key)
        if isinstance(value, dict):
            yield from places_in(value, (*above, key))


def with_change(content, place, change):
    """A copy in which the mapping that holds a place is changed."""
    first, *rest = place
    if rest:
        return {**content, first: with_change(content[first], rest, change)}
    return change(dict(content), first)


def variants_of(content):
    """The file without any of its keys, and with any other value there."""
    for place in places_in(content):
        yield with_change(content, place, lambda inner, key: {k: v for k, v in inner.items() if k != key})
        for other in OTHERS:
            yield with_change(content, place, lambda inner, key, other=other: {**inner, key: other})


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_what_the_program_accepts_is_valid(path, validator, loaded):
    """The other way round a schema can say little: a parent may give what a file leaves out."""
    content = {**as_json(path), "name": "changed"}
    content.pop("matrix", None)  # its values would replace those that are changed
    accepted = 0
    for variant in variants_of(content):
        if accepts(loaded, json.dumps(variant)):
            accepted += 1
            assert [error.message for error in validator.iter_errors(variant)] == [], variant
    assert accepted


def accepts(loaded, text):
    try:
        return bool(loaded(text))
    except ScenarioErrors:
        return False


@pytest.mark.parametrize(("text", "valid"), BY_HAND.items())
def test_the_program_and_the_schema_agree(text, valid, validator, loaded, head):
    assert accepts(loaded, f"{head}{text}\n") is valid
    content = json.loads(json.dumps(plain(parse(Document("x", Path(), f"{head}{text}\n")))))
    assert validator.is_valid(content) is valid

"""`uictest schema`: every kind of file has one, which shipped files keep to and mistakes do not."""

import json
import os
from functools import cache
from pathlib import Path

import jsonschema
import pytest

from uictest.cli.commands.schema import SchemaKind, schema_text
from uictest.plans.scenario import PART_MODELS
from uictest.plans.scenario.yaml import plain, read_file

REPOSITORY = Path(__file__).parents[3]
KINDS = {kind.value: kind for kind in SchemaKind}
PARTS = [REPOSITORY / name for name in ("src/uictest/plans/library", "examples", "calibration", "scenarios")]


def _document(path):
    return json.loads(json.dumps(plain(read_file(path))))


def _files():
    for folder in PARTS:
        for path in sorted(folder.rglob("*.yaml")):
            if path.read_text("utf-8").partition("uictest/")[2].partition("/")[0] in KINDS:
                yield path


@cache
def _validator(kind):
    return jsonschema.Draft7Validator(json.loads(schema_text(KINDS[kind])))


def _errors(kind, document):
    errors = _validator(kind).iter_errors(document)
    return [f"{list(error.path)}: {error.message}" for error in errors]


@pytest.mark.parametrize("kind", SchemaKind, ids=str)
def test_the_schema_of_each_kind_is_one(kind):
    jsonschema.Draft7Validator.check_schema(json.loads(schema_text(kind)))


@pytest.mark.parametrize("path", list(_files()), ids=lambda path: path.stem)
def test_shipped_files_keep_to_the_schema_and_a_mistyped_key_does_not(path):
    document = _document(path)
    kind = document["schema"].split("/")[1]
    assert _errors(kind, document) == []
    assert _errors(kind, {**document, "mistyped_key": 1}) != []


def test_every_kind_has_a_schema_and_shipped_files():
    assert PART_MODELS.keys() <= set(KINDS)
    assert {_document(path)["schema"].split("/")[1] for path in _files()} == set(KINDS) - {"validation"}


@pytest.mark.parametrize(
    ("kind", "own", "valid"),
    [
        ("vehicle", {"extends": "intercity-180", "body": {"mass": "25 t"}}, True),
        ("vehicle", {"extends": "intercity-180", "body": {"mass": "25 m"}}, False),
        ("vehicle", {"extends": "intercity-180", "body": {"mas": "25 t"}}, False),
        ("brake", {"extends": "ep-disc", "positions": {"R": {"maximum_pressure": "3.1 bar"}}}, True),
        ("controller", {"extends": "threshold", "slip_threshold": "1.4 m/s"}, True),
        ("controller", {"extends": "threshold", "slip_threshold": "1.4 s"}, False),
        ("controller", {"python": "my_wsp.py", "class": "MyWsp", "parameters": {"a": 1}}, True),
        ("pad", {"speed": {"points": [{"speed": "20 km/h", "factor": 1.08}]}}, True),
        ("pad", {"speed": {"points": [{"speed": "20 km/h"}]}}, False),
        ("criteria", {"criteria": [{"id": "x"}]}, False),
        ("channel-map", {"extends": "uictest", "channels": {"speed": "v", "time": ["t", "Zeit"]}}, True),
        ("channel-map", {"extends": "uictest", "channels": {"speed": 3}}, False),
        ("channel-map", {"channels": {"speed": {"source": "V_ACTUAL", "unit": "km/h"}}}, True),
        ("channel-map", {"channels": {"speed": {"source": ["V_ACTUAL", "v_radar"]}}}, True),
        ("channel-map", {"channels": {"speed": {"source": []}}}, False),
    ],
)
def test_a_part_states_only_what_differs(kind, own, valid):
    document = {"schema": f"uictest/{kind}/1", "name": "mine", **own}
    assert (_errors(kind, document) == []) is valid


@pytest.mark.parametrize("folder", ["examples", "scenarios"])
def test_shipped_files_name_the_schema_of_their_kind_in_the_folder_beside(folder):
    """`uictest schema --all schema` writes it there, and `init` beside the scenarios that it writes."""
    for path in sorted((REPOSITORY / folder).rglob("*.yaml")):
        first = path.read_text("utf-8").splitlines()[0]
        named = path.parent / first.removeprefix("# yaml-language-server: $schema=")
        kind = str(read_file(path).get("schema").text).split("/")[1].replace("sweep", "scenario")
        assert named.resolve() == REPOSITORY / f"schema/{kind}.schema.json", path


def test_schemas_are_of_draft_07_and_all_are_written_and_named_and_may_be_written_again(call):
    schema = json.loads(call("schema").out)
    assert schema["$schema"] == "http://json-schema.org/draft-07/schema#"
    jsonschema.Draft7Validator.check_schema(schema)
    Path("schema").mkdir()
    other = Path("schema/other.schema.json")
    other.write_text("{}")
    call("schema", "--all", "schema", code=0)
    text = Path("schema/rail.schema.json").read_text("utf-8")
    Path("schema/rail.schema.json").write_text(text.replace("friction", "adhesion"), "utf-8")
    written = {Path(line) for line in call("schema", "--all", "schema", code=0).out.splitlines()}
    assert written == {Path(f"schema/{kind}.schema.json") for kind in SchemaKind}
    assert set(Path("schema").iterdir()) == {*written, other}
    assert other.read_text() == "{}"
    for kind in SchemaKind:
        text = Path(f"schema/{kind}.schema.json").read_text("utf-8")
        assert text.rstrip() == call("schema", kind.value).out.rstrip()


def test_neither_a_link_nor_a_pipe_is_written_to_or_read(call):
    Path("rail.schema.json").symlink_to("nowhere")
    os.mkfifo("pad.schema.json")
    call("schema", "--all", ".", code=4, says="pad.schema.json, rail.schema.json")
    assert {path.name for path in Path().iterdir()} == {"rail.schema.json", "pad.schema.json"}

import json
import os
from pathlib import Path

import jsonschema
import pytest

from uictest.cli.commands.schema import SchemaKind


def test_the_schema_is_draft_07(call):
    schema = json.loads(call("schema").out)
    assert schema["$schema"] == "http://json-schema.org/draft-07/schema#"
    jsonschema.Draft7Validator.check_schema(schema)


def test_all_of_them_are_written_and_named_and_may_be_written_again(call):
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


@pytest.mark.parametrize("text", ["{}", '{"const": "uictest/rail/1"}'])
def test_a_file_of_somebody_else_is_left_alone_and_nothing_is_written(call, text):
    Path("rail.schema.json").write_text(text)
    call("schema", "--all", ".", code=4, says="not written by this version of uictest: rail.schema.json")
    assert [path.name for path in Path().iterdir()] == ["rail.schema.json"]
    assert Path("rail.schema.json").read_text() == text


def test_neither_a_link_nor_a_pipe_is_written_to_or_read(call):
    Path("rail.schema.json").symlink_to("nowhere")
    os.mkfifo("pad.schema.json")
    call("schema", "--all", ".", code=4, says="pad.schema.json, rail.schema.json")
    assert {path.name for path in Path().iterdir()} == {"rail.schema.json", "pad.schema.json"}


def test_one_kind_or_all(call):
    call("schema", "rail", "--all", "schema", code=4, says="either KIND or --all DIR")
    assert list(Path().iterdir()) == []

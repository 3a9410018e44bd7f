import json
from pathlib import Path

import jsonschema

from uictest.cli.commands.schema import SchemaKind


def test_the_schema_is_draft_07(call):
    schema = json.loads(call("schema").out)
    assert schema["$schema"] == "http://json-schema.org/draft-07/schema#"
    jsonschema.Draft7Validator.check_schema(schema)


def test_all_of_them_are_written_and_named_and_may_be_written_again(call):
    Path("schema").mkdir()
    other = Path("schema/other.schema.json")
    other.write_text("{}")
    Path("schema/rail.schema.json").write_text('{"const": "uictest/rail/1"}')
    written = {Path(line) for line in call("schema", "--all", "schema", code=0).out.splitlines()}
    assert written == {Path(f"schema/{kind}.schema.json") for kind in SchemaKind}
    assert set(Path("schema").iterdir()) == {*written, other}
    assert other.read_text() == "{}"
    for kind in SchemaKind:
        text = Path(f"schema/{kind}.schema.json").read_text("utf-8")
        assert text.rstrip() == call("schema", kind.value).out.rstrip()


def test_a_file_of_another_program_is_left_alone_and_nothing_is_written(call):
    Path("rail.schema.json").write_text("{}")
    call("schema", "--all", ".", code=4, says="no schema of uictest: rail.schema.json")
    assert [path.name for path in Path().iterdir()] == ["rail.schema.json"]
    assert Path("rail.schema.json").read_text() == "{}"


def test_one_kind_or_all(call):
    call("schema", "rail", "--all", "schema", code=4, says="either KIND or --all DIR")
    assert list(Path().iterdir()) == []

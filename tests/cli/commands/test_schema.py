import json
from pathlib import Path

import jsonschema


def test_the_schema_is_draft_07_and_the_same_on_stdout_and_in_a_file(call):
    printed = call("schema").out
    assert call("schema", "-o", "schema.json").out == ""
    assert Path("schema.json").read_text("utf-8") == printed
    schema = json.loads(printed)
    assert schema["$schema"] == "http://json-schema.org/draft-07/schema#"
    jsonschema.Draft7Validator.check_schema(schema)


def test_a_file_in_a_folder_that_is_not_there_exits_4(call):
    call("schema", "-o", "missing/schema.json", code=4, says="No such file or directory")

import json

import jsonschema


def test_the_schema_is_draft_07(call):
    schema = json.loads(call("schema").out)
    assert schema["$schema"] == "http://json-schema.org/draft-07/schema#"
    jsonschema.Draft7Validator.check_schema(schema)

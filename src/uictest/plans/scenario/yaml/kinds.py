"""Kinds of file: what each begins with, and the command that takes it."""

from typing import Final

from uictest.plans.scenario.yaml.diagnostics import single_error
from uictest.plans.scenario.yaml.tree import Map, Scalar, describe, quoted

SCENARIO_SCHEMA: Final = "uictest/scenario/1"
SERIES_SCHEMA: Final = "uictest/series/1"
VALIDATION_SCHEMA: Final = "uictest/validation/1"
BENCH_SCHEMA: Final = "uictest/bench/1"
SWEEP_SCHEMA: Final = "uictest/sweep/1"
"""Of a sweep as 0.2 wrote it: a file of its own, which names the scenario."""

_COMMANDS: Final = {
    SCENARIO_SCHEMA: "a scenario is run with `uictest run`",
    SERIES_SCHEMA: "a series is in a file that ends in .series.yaml",
    VALIDATION_SCHEMA: "a validation is run with `uictest validate`",
    BENCH_SCHEMA: "a bench test is run with `uictest bench`",
    SWEEP_SCHEMA: "a sweep is run with `uictest sweep`",
}


def require_schema(tree: Map, *accepted: str, hints: dict[str, str] | None = None) -> str:
    """Return the schema of a file. Raises ScenarioErrors where it is none of those accepted.

    The first of `accepted` is the one to write. `hints` say of other kinds of file what to do with them,
    where that is not the command that takes them.
    """
    schema = tree.get("schema")
    expected = accepted[0]
    if schema is None:
        raise single_error(tree.place, "missing key 'schema'", "schema", f"write `schema: {expected}`")
    if isinstance(schema, Scalar) and schema.value in accepted:
        return schema.text
    actual, hint = describe(schema), ""
    if isinstance(schema, Scalar):
        actual, hint = quoted(schema.text), {**_COMMANDS, **(hints or {})}.get(schema.text, "")
    raise single_error(schema.place, f"expected {expected}, found {actual}", "schema", hint)

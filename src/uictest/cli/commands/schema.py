"""`uictest schema`: the JSON Schema of scenario, sweep and series files."""

from __future__ import annotations

import json
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from uictest import recording
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import Verbosity
from uictest.cli.output import data


class SchemaKind(StrEnum):
    """Kinds of file that have a schema."""

    SCENARIO = "scenario"
    SWEEP = "sweep"
    SERIES = "series"


def schema(
    subject: Annotated[
        SchemaKind, typer.Argument(metavar="[scenario|sweep|series]", help="Kind of file.")
    ] = (SchemaKind.SCENARIO),
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="Write to FILE instead of stdout.")
    ] = None,
    verbosity: Verbosity = 0,
) -> ExitCode:
    """Print the JSON Schema (draft-07) of scenario, sweep or series files."""
    text = schema_text(subject)
    if output is None:
        data(text.rstrip("\n"))
        return ExitCode.MET

    recording.write_text_atomic(output, text)
    return ExitCode.MET


def schema_text(subject: SchemaKind = SchemaKind.SCENARIO) -> str:
    """Return the schema of a kind of file as the JSON text that is kept in the repository."""
    if subject is SchemaKind.SWEEP:
        from uictest.sweep import sweep_schema as described
    elif subject is SchemaKind.SERIES:
        from uictest.series import series_schema as described
    else:
        from uictest.scenario import json_schema as described

    return f"{json.dumps(described(), indent=2, ensure_ascii=False)}\n"

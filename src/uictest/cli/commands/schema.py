"""`uictest schema`: the JSON Schema of a kind of file, or of all."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, Final

import typer

from uictest import runs
from uictest.cli.options import argument, option
from uictest.cli.output import ExitCode, data
from uictest.core import files
from uictest.plans import scenario, series
from uictest.recorded import field_data
from uictest.rig import bench as rig_bench


class SchemaKind(StrEnum):
    """Kinds of file that have a schema."""

    SCENARIO = "scenario"
    SERIES = "series"
    PROGRAMME = "programme"
    VALIDATION = "validation"
    BENCH = "bench"
    CHANNEL_MAP = "channel-map"
    BRAKE = "brake"
    CALIPER = "caliper"
    COMPENSATION = "compensation"
    CONTROLLER = "controller"
    CRITERIA = "criteria"
    MEASURES = "measures"
    PAD = "pad"
    RAIL = "rail"
    SENSORS = "sensors"
    VEHICLE = "vehicle"


_COMMENT: Final = "Written by uictest, which writes it again: keep a schema of your own elsewhere."
"""Tells a schema that may be replaced from one of somebody else."""

Kind = Annotated[
    SchemaKind | None,
    argument(
        "KIND", "Kind of file: what `schema: uictest/KIND/1` says [default: scenario].", show_default=False
    ),
]
Folder = Annotated[
    Path | None, option("--all DIR", "Write the schema of every kind to DIR/KIND.schema.json instead.")
]


def schema(kind: Kind = None, everything: Folder = None) -> ExitCode:
    """Print the JSON Schema (draft-07) of a kind of file, with which an editor completes and checks it."""
    if everything is None:
        data(schema_text(kind or SchemaKind.SCENARIO).rstrip("\n"))
    elif kind is None:
        data("\n".join(map(str, _write_all(everything))))
    else:
        raise typer.BadParameter("write `uictest schema` with either KIND or --all DIR")
    return ExitCode.MET


def _write_all(folder: Path) -> list[Path]:
    """Write the schema of every kind, and return the paths. Raises WriteError, InvalidInputError."""
    texts = schemas_below(folder, *SchemaKind)
    files.write_all(texts)
    return list(texts)


def schemas_below(folder: Path, *kinds: SchemaKind) -> dict[Path, str]:
    """Return the texts of schemas by the paths that first lines of shipped files name.

    Raises OSError, and InvalidInputError where something else has such a path.
    """
    texts = {folder / f"{kind}.schema.json": schema_text(kind) for kind in kinds}
    if others := [path for path in texts if os.path.lexists(path) and not _is_own(path)]:
        raise runs.InvalidInputError(
            f"already there, and not written by this version of uictest: {', '.join(map(str, others))}"
        )
    return texts


def _is_own(path: Path) -> bool:
    return not path.is_symlink() and path.is_file() and _COMMENT.encode() in path.read_bytes()


def schema_text(kind: SchemaKind) -> str:
    """Return the schema of a kind of file as the JSON text of its file."""
    content = {"$comment": _COMMENT, **_schema(kind)}
    return f"{json.dumps(content, indent=2, ensure_ascii=False)}\n"


def _schema(kind: SchemaKind) -> dict[str, Any]:
    of_files: dict[str, Callable[[], dict[str, Any]]] = {
        SchemaKind.SCENARIO: lambda: scenario.json_schema(),
        SchemaKind.SERIES: lambda: series.series_schema(),
        SchemaKind.PROGRAMME: lambda: scenario.schema_of(series.ProgrammeFile, "uictest programme"),
        SchemaKind.VALIDATION: lambda: scenario.schema_of(series.ValidationFile, "uictest validation"),
        SchemaKind.BENCH: lambda: scenario.schema_of(rig_bench.BenchRecipe, "uictest bench"),
        SchemaKind.CHANNEL_MAP: lambda: field_data.channel_map_schema(),
    }
    described = of_files.get(kind)
    return scenario.part_schema(kind.value) if described is None else described()

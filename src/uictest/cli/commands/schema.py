"""`uictest schema`: the JSON Schema of a kind of file."""

from __future__ import annotations

import json
from collections.abc import Callable
from enum import StrEnum
from typing import Annotated, Any

from uictest.cli.options import argument
from uictest.cli.output import ExitCode, data
from uictest.plans import scenario, series
from uictest.recorded import field_data
from uictest.rig import bench as rig_bench


class SchemaKind(StrEnum):
    """Kinds of file that have a schema."""

    SCENARIO = "scenario"
    SERIES = "series"
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


def schema(
    kind: Annotated[SchemaKind, argument("[KIND]", "Kind of file: what `schema: uictest/KIND/1` says.")] = (
        SchemaKind.SCENARIO
    ),
) -> ExitCode:
    """Print the JSON Schema (draft-07) of a kind of file, with which an editor completes and checks it."""
    data(schema_text(kind).rstrip("\n"))
    return ExitCode.MET


def schema_text(kind: SchemaKind = SchemaKind.SCENARIO) -> str:
    """Return the schema of a kind of file as the JSON text that is kept in the repository."""
    return f"{json.dumps(_schema(kind), indent=2, ensure_ascii=False)}\n"


def _schema(kind: SchemaKind) -> dict[str, Any]:
    of_files: dict[str, Callable[[], dict[str, Any]]] = {
        SchemaKind.SCENARIO: lambda: scenario.json_schema(),
        SchemaKind.SERIES: lambda: series.series_schema(),
        SchemaKind.VALIDATION: lambda: scenario.schema_of(series.ValidationFile, "uictest validation"),
        SchemaKind.BENCH: lambda: scenario.schema_of(rig_bench.BenchRecipe, "uictest bench"),
        SchemaKind.CHANNEL_MAP: lambda: field_data.channel_map_schema(),
    }
    described = of_files.get(kind)
    return scenario.part_schema(kind.value) if described is None else described()

"""Sweeps: one scenario with many values of its parameters, worked out in parts that survive anything.

Names are imported when they are first used: checking a sweep file takes a fraction of what running it does.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from uictest.sweep.definition import load_sweep
    from uictest.sweep.execution import run_parts
    from uictest.sweep.frontier import FrontierError, Search
    from uictest.sweep.manifest import sweep_manifest
    from uictest.sweep.nominal import drawn_ranges
    from uictest.sweep.part import Worker, worker
    from uictest.sweep.plan import Plan
    from uictest.sweep.schema import sweep_schema
    from uictest.sweep.selection import Selection, select
    from uictest.sweep.shard import Shard, parse_shard
    from uictest.sweep.store import ChangedInputsError, MissingPartsError, Store

__all__ = [
    "ChangedInputsError",
    "FrontierError",
    "MissingPartsError",
    "Plan",
    "Search",
    "Selection",
    "Shard",
    "Store",
    "Worker",
    "drawn_ranges",
    "load_sweep",
    "parse_shard",
    "run_parts",
    "select",
    "sweep_manifest",
    "sweep_schema",
    "worker",
]

_MODULES = {
    "definition": ("load_sweep",),
    "execution": ("run_parts",),
    "frontier": ("FrontierError", "Search"),
    "manifest": ("sweep_manifest",),
    "nominal": ("drawn_ranges",),
    "part": ("Worker", "worker"),
    "plan": ("Plan",),
    "schema": ("sweep_schema",),
    "selection": ("Selection", "select"),
    "shard": ("Shard", "parse_shard"),
    "store": ("ChangedInputsError", "MissingPartsError", "Store"),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(import_module(f"uictest.sweep.{module}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

"""What a user writes: scenario files, read with positions, checked, and expanded into cases."""

from uictest.scenario.case import Case
from uictest.scenario.diagnostics import Diagnostic, ScenarioErrors
from uictest.scenario.json_schema import json_schema
from uictest.scenario.library_parts import Number, load_part, load_part_file, numbers
from uictest.scenario.loading import load
from uictest.scenario.model import Scenario
from uictest.scenario.quantities import Quantity

__all__ = [
    "Case",
    "Diagnostic",
    "Number",
    "Quantity",
    "Scenario",
    "ScenarioErrors",
    "json_schema",
    "load",
    "load_part",
    "load_part_file",
    "numbers",
]

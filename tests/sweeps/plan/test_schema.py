"""The shipped sweeps keep the schema that editors check them by."""

from pathlib import Path

import pytest
import yaml
from jsonschema import Draft7Validator

from uictest.plans.scenario import json_schema
from uictest.plans.sweeps import load_sweep

ROOT = Path(__file__).parents[3]
SHIPPED = sorted((ROOT / "scenarios").glob("*.sweep.yaml"))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.name)
def test_shipped_sweeps_are_valid(path: Path) -> None:
    Draft7Validator(json_schema()).validate(yaml.safe_load(path.read_text()))
    assert load_sweep(path).name == path.name.removesuffix(".sweep.yaml")

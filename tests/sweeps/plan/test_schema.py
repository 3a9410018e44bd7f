"""The schema in the repository is the models', and the shipped sweeps keep it."""

import json
from pathlib import Path

import pytest
import yaml
from jsonschema import Draft7Validator

from uictest.plans.sweeps import load_sweep, sweep_schema

ROOT = Path(__file__).parents[3]
SHIPPED = sorted((ROOT / "scenarios").glob("*.sweep.yaml"))


def test_the_committed_schema_is_current() -> None:
    assert json.loads((ROOT / "schema/sweep.schema.json").read_text()) == sweep_schema()
    Draft7Validator.check_schema(sweep_schema())


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.name)
def test_shipped_sweeps_are_valid(path: Path) -> None:
    Draft7Validator(sweep_schema()).validate(yaml.safe_load(path.read_text()))
    assert load_sweep(path).name == path.name.removesuffix(".sweep.yaml")

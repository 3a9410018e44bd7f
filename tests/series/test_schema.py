"""The schema in the repository is the models', and the shipped series keep it."""

import json
from pathlib import Path

import pytest
import yaml
from jsonschema import Draft7Validator

from uictest.plans import series

ROOT = Path(__file__).parents[2]
SHIPPED = sorted([*(ROOT / "scenarios").glob("*.series.yaml"), *(ROOT / "examples").rglob("*.series.yaml")])


def test_the_committed_schema_is_current() -> None:
    assert json.loads((ROOT / "schema/series.schema.json").read_text()) == series.series_schema()
    Draft7Validator.check_schema(series.series_schema())


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.name)
def test_shipped_series_keep_the_schema(path: Path) -> None:
    Draft7Validator(series.series_schema()).validate(yaml.safe_load(path.read_text()))


@pytest.mark.parametrize(
    "path", sorted((ROOT / "scenarios").glob("*.series.yaml")), ids=lambda path: path.name
)
def test_shipped_series_are_called_like_their_files(path: Path) -> None:
    (planned,) = series.load_series(path)
    assert f"{planned.id}.series.yaml" == path.name

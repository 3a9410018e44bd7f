"""JSON that is nested deeper than it can be read is no run and no sweep, and no error of the program."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Call = Callable[..., Any]


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("results.json", ["run", "--baseline", "deep", "stop.yaml"]),
        ("manifest.json", ["compare", "deep", "deep"]),
        ("sweep.json", ["report", "deep"]),
    ],
)
def test_it_is_a_usage_error(call: Call, workplace: Path, name: str, arguments: list[str]) -> None:
    (workplace / "deep").mkdir()
    (workplace / "deep" / name).write_text("[" * 100_000)
    (workplace / "stop.yaml").write_text("schema: uictest/scenario/1\nname: stop\ninitial_speed: 40 km/h\n")
    answer = call(*arguments)
    assert answer.code == 4, answer.err
    assert "internal error" not in answer.err

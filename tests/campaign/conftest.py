"""Cases whose stops are made up, so that a batch can be watched without simulating anything."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

MakeCase = Callable[..., Any]


@pytest.fixture
def make_case() -> MakeCase:
    """A case as far as a campaign looks at it."""

    def make(case_id: str, *tags: str, file: str = "a.yaml", expect: str = "pass") -> Any:
        controller = SimpleNamespace(program=None)
        named = {"requirements": (), "test_case": None, "criteria": (), "repeat": 1}
        rig = SimpleNamespace(compensation_model=SimpleNamespace(to_identify=False))
        scenario = SimpleNamespace(tags=tags, expect=expect, controller=controller, rig=rig, **named)
        return SimpleNamespace(id=case_id, scenario=scenario, path=Path("scenarios", file), parameters={})

    return make

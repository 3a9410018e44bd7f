"""Cases whose stops are made up, so that a batch can be watched without simulating anything."""

from pathlib import Path
from types import SimpleNamespace

import pytest


@pytest.fixture
def make_case():
    """A case as far as a campaign looks at it."""

    def make(case_id, *tags, file="a.yaml", expect="pass"):
        controller = SimpleNamespace(program=None)
        named = {"requirements": (), "test_case": None, "criteria": (), "repeat": 1}
        rig = SimpleNamespace(compensation_model=SimpleNamespace(to_identify=False))
        scenario = SimpleNamespace(tags=tags, expect=expect, controller=controller, rig=rig, **named)
        return SimpleNamespace(
            id=case_id, scenario=scenario, path=Path("scenarios", file), parameters={}, train=None
        )

    return make

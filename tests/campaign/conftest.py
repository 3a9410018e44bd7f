"""Cases whose stops are made up, so that a batch can be watched without simulating anything."""

from pathlib import Path
from types import SimpleNamespace

from uictest.plans.scenario import expectation_of


def make_case(case_id, *tags, file="a.yaml", expect="pass"):
    """A case as far as a campaign looks at it."""
    named = {"requirements": (), "test_case": None, "criteria": (), "repeat": 1}
    rig = SimpleNamespace(compensation_model=SimpleNamespace(to_identify=False))
    scenario = SimpleNamespace(tags=tags, expect=expectation_of(expect), rig=rig, **named)
    place = {"path": Path("scenarios", file), "train": None, "is_from_outside": False}
    return SimpleNamespace(id=case_id, scenario=scenario, parameters={}, **place)

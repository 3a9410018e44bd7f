"""The compensation that an identification starts from."""

from __future__ import annotations

from pathlib import Path

from uictest.scenario.parts.compensation import Compensation
from uictest.scenario.reading import nowhere
from uictest.scenario.references import Files, Parts
from uictest.scenario.tree import Scalar


def load_compensation(reference: str) -> Compensation:
    """The compensation of a library name or of a .yaml file. Raises ScenarioErrors."""
    if reference.endswith((".yaml", ".yml")):
        tree = Files().at(Path(reference))
        part: Compensation = Parts(Files()).resolve(tree, Compensation, ()).part
        return part
    place = nowhere(Path("--base"))
    named: Compensation = (
        Parts(Files()).resolve(Scalar(reference, reference, place), Compensation, ("base",)).part
    )
    return named

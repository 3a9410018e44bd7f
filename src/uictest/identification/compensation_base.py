"""The compensation that an identification starts from."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from uictest.scenario.parts.compensation import Compensation
from uictest.scenario.reading import nowhere
from uictest.scenario.references import Files, Parts
from uictest.scenario.roots import Roots
from uictest.scenario.tree import Scalar


def load_compensation(reference: str, trusted: Sequence[Path] = ()) -> Compensation:
    """The compensation of a library name or of a .yaml file.

    References stay at or below the file's folder, the working folder and the ``trusted`` folders. Raises
    ScenarioErrors.
    """
    if reference.endswith((".yaml", ".yml")):
        files = Files(Roots.of([Path(reference)], trusted))
        part: Compensation = Parts(files).resolve(files.at(Path(reference)), Compensation, ()).part
        return part
    place = nowhere(Path("--base"))
    named: Compensation = (
        Parts(Files()).resolve(Scalar(reference, reference, place), Compensation, ("base",)).part
    )
    return named

"""The compensation that an identification starts from."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from uictest.scenario import Compensation, Files, Parts, Roots
from uictest.scenario.yaml import Scalar, whole_file


def load_compensation(reference: str, trusted: Sequence[Path] = ()) -> Compensation:
    """The compensation of a library name or of a .yaml file.

    References stay at or below the file's folder, the working folder and the ``trusted`` folders. Raises
    ScenarioErrors.
    """
    if reference.endswith((".yaml", ".yml")):
        files = Files(Roots.of([Path(reference)], trusted))
        part: Compensation = Parts(files).resolve(files.at(Path(reference)), Compensation, ()).part
        return part
    place = whole_file(Path("--base"))
    named: Compensation = (
        Parts(Files()).resolve(Scalar(reference, reference, place), Compensation, ("base",)).part
    )
    return named

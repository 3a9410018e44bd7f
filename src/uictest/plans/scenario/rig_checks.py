"""The checks of the rig: a profile of the library that judges every simulated stop."""

from functools import cache
from pathlib import Path
from typing import Final

from uictest.plans.scenario.files import Files
from uictest.plans.scenario.parts.criteria import Criteria
from uictest.plans.scenario.references import Parts
from uictest.plans.scenario.yaml import Document, Place, Scalar

RIG_CHECKS: Final = "uictest-rig"
"""Name of the profile."""


@cache
def rig_checks() -> Criteria:
    """Return the profile."""
    place = Place(Document(RIG_CHECKS, Path(), RIG_CHECKS))
    profile: Criteria = Parts(Files()).resolve(Scalar(RIG_CHECKS, RIG_CHECKS, place), Criteria, ()).part
    return profile

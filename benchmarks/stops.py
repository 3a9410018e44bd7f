"""The stops that are timed: shipped scenarios."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.rig.assembly import assemble
from uictest.scenario import load

SCENARIOS = Path(__file__).parent.parent / "scenarios"
TIMED = ("dry-120", "slide-80[compensation=full]", "low-adhesion-80")
"""Ids of the timed cases: nothing slides, some wheelsets slide, all slide and stand."""

Stop = tuple[Any, NDArray[np.float64]]
"""Parameter record and friction laws."""


def shipped() -> dict[str, Stop]:
    """Return every shipped case by its id."""
    return {case.id: assemble(case) for case in load([SCENARIOS])}

"""A validation as it is run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from uictest.plans.scenario import Case
from uictest.plans.series import Recorded


@dataclass(frozen=True, slots=True)
class PlannedComparison:
    """Recorded stops and the case that simulates them; `tuned`: numbers of the case come from them."""

    case: Case
    recorded: Recorded
    tuned: bool = False


@dataclass(frozen=True, slots=True)
class ValidationPlan:
    """One validation.

    Attributes:
        name: of the validation.
        title: one line for people.
        path: its file, as shown to users.
        comparisons: what is compared.
        speed_tolerance: largest difference of a recorded initial speed from its scenario's, m/s.
        confidence: of the intervals.
        inputs: every file read for it, by shown name, and its SHA-256; recordings are not among them.
    """

    name: str
    title: str
    path: Path
    comparisons: tuple[PlannedComparison, ...]
    speed_tolerance: float
    confidence: float
    inputs: Mapping[str, str]

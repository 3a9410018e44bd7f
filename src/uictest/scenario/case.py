"""A case: one expanded scenario, ready to run."""

from dataclasses import dataclass
from pathlib import Path

from uictest.scenario.model import Scenario


@dataclass(frozen=True, slots=True)
class Case:
    """One stop on the rig."""

    id: str
    """Unique among the cases loaded together; safe as a file name."""
    scenario: Scenario
    """Resolved: every reference to a part replaced by the part."""
    path: Path
    """The file it comes from, as shown to users."""
    parameters: dict[str, str]
    """Swept dotted keys and their values as written, in order."""
    inputs: dict[str, str]
    """Every file read for it, by shown name, and its SHA-256."""

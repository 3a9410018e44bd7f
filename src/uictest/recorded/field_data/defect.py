"""The defects of a record, by kind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

DefectKind = Literal[
    "time-missing",
    "time-backwards",
    "time-duplicate",
    "gap",
    "coarse",
    "not-a-number",
    "out-of-range",
    "dropout",
    "stuck",
    "offset",
    "starts-late",
    "ends-before-standstill",
]


@dataclass(frozen=True, slots=True)
class Defect:
    """One defect of one channel.

    `spoils`: the channel cannot be used at all. A gap or a missing sample affects only the measures that need
    the missing samples.
    """

    kind: DefectKind
    channel: str
    text: str
    spoils: bool = False

    def __str__(self) -> str:
        """Return the defect for a reader, as in "gap: speed is not recorded from 3.2 to 3.9 s"."""
        return f"{self.kind}: {self.channel} {self.text}"

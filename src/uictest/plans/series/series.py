"""A series as it is run: the cases of its stops, and how they are judged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from uictest.core.series_measures import Rail
from uictest.plans.scenario import Case, Criteria, Criterion
from uictest.plans.series.model import SeriesFile

Role = Literal["dry", "wet", "bypassed"]
"""dry: the reference. wet: a stop on a slippery rail, in which the WSP is at work. bypassed: the same stop
without it, simulated to compare K_wet; it decides nothing."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """Recorded stops that are judged as one case, and the reference of their channel map."""

    files: tuple[Path, ...]
    channel_map: str


@dataclass(frozen=True, slots=True)
class PlannedStop:
    """One case of a series; `recorded` is None where the file names no recording of it.

    `rail` is the kind of rail of a simulated stop that is not dry.
    """

    role: Role
    case: Case
    recorded: Recorded | None = None
    rail: Rail = ""

    @property
    def speed(self) -> float:
        """The nominal initial speed, m/s."""
        return float(self.case.scenario.initial_speed)


@dataclass(frozen=True, slots=True)
class Series:
    """One series.

    Args:
        id: its name, with the values by which series of the same file differ; safe as a file name.
        path: its file, as shown to users.
        file: what the file says.
        parameters: dotted keys and values, as written, by which series of the same file differ.
        stops: dry ones first.
        inputs: every file read for it, by shown name, and its SHA-256.

    """

    id: str
    path: Path
    file: SeriesFile
    parameters: Mapping[str, str]
    stops: tuple[PlannedStop, ...]
    inputs: Mapping[str, str]

    @property
    def cases(self) -> list[Case]:
        """The cases of its stops."""
        return [stop.case for stop in self.stops]

    @property
    def criteria(self) -> tuple[Criteria, ...]:
        """The profiles that it is judged by."""
        return self.file.criteria

    @property
    def judged_criteria(self) -> list[tuple[Criteria, Criterion]]:
        """The criteria that the series as a whole has a verdict on, each with its profile.

        A criterion of validity of stops is none of them: it decides which stops count.
        """
        return [
            (profile, criterion)
            for profile in self.criteria
            for criterion in profile.criteria
            if criterion.scope == "series" or criterion.layer == "requirement"
        ]

"""A series: what its file says of the dry and the wet stops, and the cases of these as they are run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final, Literal, NamedTuple

from pydantic import BeforeValidator, Field

from uictest.core.series_measures import Rail
from uictest.core.units import in_unit
from uictest.plans.scenario import (
    PASS,
    Case,
    Criteria,
    Criterion,
    Expect,
    TestFile,
    criteria_of_the_same_name,
    schema_of,
)
from uictest.plans.scenario.yaml import (
    Inconsistency,
    Model,
    PartReference,
    Quantity,
    field,
    optional,
    quantity,
)

DEFAULT_CRITERIA: Final = "uictest-wsp"


def _entries(content: object) -> object:
    entries = content if isinstance(content, list | tuple) else (content,)
    return tuple({"scenario": each} if isinstance(each, str) else each for each in entries)


class Stops(Model):
    """Stops of one scenario, simulated or recorded."""

    scenario: str = field("Relative path of the scenario, or one that ships.")
    set: dict[str, Any] = field(
        "Values by dotted key of the scenario; a list makes one stop for each of its values.", default={}
    )
    repeat: Annotated[int, Field(ge=1, le=1000, strict=True)] | None = optional(
        "How often each stop is repeated under further seeds."
    )
    recordings: tuple[str, ...] = field(
        "Relative paths of recorded stops, for `uictest evaluate`.", default=()
    )
    map: str = field("Channel map of the recordings: a preset or a relative path.", default="uictest")


StopsField = Annotated[tuple[Stops, ...], BeforeValidator(_entries)]


class SeriesFile(TestFile):
    """A dry reference and wet stops, judged together."""

    schema_id: Literal["uictest/series/1"] = field("What the file holds: uictest/series/1.", alias="schema")
    repeat: Annotated[int, Field(ge=1, le=1000, strict=True)] | None = optional(
        "How often each stop is repeated under further seeds."
    )
    set: dict[str, Any] = field(
        "Values by dotted key of the scenarios, for all stops of the series.", default={}
    )
    dry: StopsField = field("The reference: scenarios of dry stops, at least one for each initial speed.")
    wet: StopsField = field("Scenarios of stops on a slippery rail.")
    cars: Literal["first", "all"] = field(
        "The cars of trains that are judged: the first, or every car in a series of its own.", default="first"
    )
    criteria: Annotated[tuple[Criteria, ...], PartReference(Criteria, DEFAULT_CRITERIA, several=True)] = (
        field("One profile of criteria or a list of them.")
    )
    valid_stops: Quantity = quantity(
        "Least share of the wet stops from each speed that must count for a verdict.",
        "share",
        "> 0 % .. 100 %",
        default="80 %",
    )
    speed_tolerance: Quantity = quantity(
        "Largest deviation of an initial speed that counts.", "speed", "0 km/h .. 50 km/h", default="3 km/h"
    )
    confidence: Quantity = quantity(
        "Confidence of the intervals.", "share", "50 % .. 99.99 %", default="95 %"
    )
    expect: Expect = field(
        "The expected outcome, or what may be missed by name: {fail: [k-wet]}.", default=PASS
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield requirements named twice, empty lists of stops, and criteria of the same name."""
        yield from super().inconsistencies()
        for name in ("dry", "wet"):
            if not getattr(self, name):
                yield Inconsistency((name,), "an empty list", "name at least one scenario")
        yield from criteria_of_the_same_name(self.criteria)
        yield from self.expect.unknown_names(self.criteria)


_STOPS: Final = {"anyOf": [{"type": "string"}, {"$ref": "#/definitions/Stops"}]}
_REQUIRED: Final = ("schema", "name", "dry", "wet")


def series_schema() -> dict[str, Any]:
    """Return the schema of ``uictest/series/1``, every field described."""
    schema: dict[str, Any] = schema_of(SeriesFile, "uictest series")
    schema["required"] = list(_REQUIRED)
    for role in ("dry", "wet"):
        listed = {"type": "array", "minItems": 1, "items": _STOPS}
        description = schema["properties"][role]["description"]
        schema["properties"][role] = {"description": description, "anyOf": [*_STOPS["anyOf"], listed]}
    schema["properties"]["criteria"]["anyOf"][-1]["minItems"] = 0  # stops may be judged by theirs alone
    return schema


Role = Literal["dry", "wet", "bypassed"]
"""dry: the reference. wet: a stop on a slippery rail, in which the WSP is at work. bypassed: the same stop
without it, simulated to compare K_wet; it decides nothing."""


class Recorded(NamedTuple):
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

    @property
    def speed_kmh(self) -> float:
        """The same in km/h, without the digits that conversion adds."""
        return round(in_unit(self.speed, "km/h"), 6)


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


def cases_run_together(planned: Sequence[Series]) -> list[Case]:
    """Return the cases of the first of some series, each with those of the other cars of its train."""
    of_trains: dict[str, list[Case]] = {}
    for case in planned[0].cases:
        of_trains[case.id if case.train is None else case.train.train] = [case]
    for case in (case for each in planned[1:] for case in each.cases):
        if case.train is not None and case.train.train in of_trains:
            of_trains[case.train.train].append(case)
    return [case for cases in of_trains.values() for case in cases]


def series_of(name: str, stops: Sequence[PlannedStop]) -> Series:
    """Return a series of stops that no file lists, dry ones first; defaults as in a file, no criteria."""
    head = {"schema": "uictest/series/1", "name": name, "dry": [name], "wet": [name], "criteria": []}
    file = SeriesFile.model_validate(head)
    inputs = {path: digest for stop in stops for path, digest in stop.case.inputs.items()}
    return Series(name, Path(name), file, {}, tuple(stops), inputs)

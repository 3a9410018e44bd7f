"""The verdict of one criterion on one stop, and whether it would flip."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Final, Literal

from pydantic import Field, SerializerFunctionWrapHandler, WrapSerializer

from uictest.judging.evaluation.json_values import Number, OptionalNumber, absent_if_empty, ignored

Status = Literal["pass", "fail", "not_applicable", "inconclusive"]
"""not_applicable: the criterion says nothing of such a stop. inconclusive: data to judge it are missing."""

READINGS: Final = "readings"
"""Name among the definitions of a criterion for its readings, taken together."""

Layer = Literal["rig", "record", "validity", "requirement"]
"""rig: the rig can be believed. record: the recorded stop agrees with its scenario. validity: the stop counts
as a test. requirement: the vehicle or its WSP is good enough."""


@dataclass(frozen=True, slots=True)
class VerdictInterval:
    """An interval of a definition's range in which the verdict stays the same; both ends belong to it.

    Of the readings of a criterion each has one, `first` and `last` its number from 1, `reading` its id.
    """

    first: Number
    last: Number
    status: Annotated[Status, Field(alias="verdict")]
    reading: str = ""

    def __str__(self) -> str:
        """Return the interval for a reader, as in "pass 2 .. 3.41"; of a reading "depth fail"."""
        if self.reading:
            return f"{self.reading} {self.status.replace('_', ' ')}"
        ends = f"{self.first:.4g}" if self.first == self.last else f"{self.first:.4g} .. {self.last:.4g}"
        return f"{self.status.replace('_', ' ')} {ends}"


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """How a verdict changes while one definition runs through its stated range, all others held.

    `lower`, `upper` and the ends of the intervals are in `unit`. Intervals come in rising order. A definition
    that moves in classes (the low-speed cut-off) leaves gaps between intervals: there is nothing between.
    """

    definition: str
    unit: str
    lower: Number
    upper: Number
    intervals: Annotated[
        tuple[Annotated[VerdictInterval, absent_if_empty("reading")], ...], Field(alias="stretches")
    ]

    @property
    def flips(self) -> bool:
        """Whether the verdict is not the same all over the range."""
        return len({interval.status for interval in self.intervals}) > 1

    def __str__(self) -> str:
        """Return a line for a reader: "low_speed_cutoff 10 .. 60 km/h: pass 10 .. 40, fail 50 .. 60"."""
        if self.definition == READINGS:
            return f"{READINGS}: {', '.join(map(str, self.intervals))}"
        scope = f"{self.definition} {self.lower:.4g} .. {self.upper:.4g} {self.unit}"
        if not self.flips:
            return f"{scope}: {self.intervals[0].status.replace('_', ' ')} throughout"
        return f"{scope}: {', '.join(map(str, self.intervals))}"


def _with_flips(sensitivity: Sensitivity, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    return {**write(sensitivity), "flips": sensitivity.flips}


WrittenSensitivity = Annotated[Sensitivity, WrapSerializer(_with_flips), ignored("flips")]
"""In JSON `flips` is written with the intervals, for readers that need no more."""


@dataclass(frozen=True, slots=True)
class AppliedDefinition:
    """A definition as a number: what a verdict, or its measure, was taken to mean.

    `value`, `lowest` and `highest` are in `unit`, an SI unit; without a range the last two are None. `mark`
    says how far the number can be trusted, as that of :class:`~uictest.judging.evaluation.Parameter` does.
    """

    name: str
    value: Number
    unit: str
    mark: str
    lowest: OptionalNumber = None
    highest: OptionalNumber = None


@dataclass(frozen=True, slots=True)
class ReadVerdict:
    """What a criterion says by one of its readings; that which `decides` gives the criterion its status.

    `value`, `lower`, `upper` and `margin` are in `unit`, as those of a verdict. `mark` and `source` say where
    the reading comes from. `definition` maps each definition to its text, for people only. `sensitivity` is
    that of the reading: a verdict turns where another reading disagrees at the values it states. Both stand
    with the verdict for the deciding one.
    """

    id: str
    decides: bool
    status: Annotated[Status, Field(alias="verdict")]
    measure: str
    value: OptionalNumber
    unit: str
    lower: OptionalNumber
    upper: OptionalNumber
    margin: OptionalNumber
    reason: str = ""
    mark: str = ""
    source: str = ""
    definition: dict[str, str] = field(default_factory=dict)
    sensitivity: tuple[WrittenSensitivity, ...] = ()


@dataclass(frozen=True, slots=True)
class OverStops:
    """How one criterion came out over the stops of a repeated case: how many stops have each status.

    `lowest` and `highest` are those of its values over the stops; None where no stop has a value.
    """

    passed: int = 0
    failed: int = 0
    inconclusive: int = 0
    not_applicable: int = 0
    lowest: OptionalNumber = None
    highest: OptionalNumber = None

    @property
    def stops(self) -> int:
        """The number of stops."""
        return self.passed + self.failed + self.inconclusive + self.not_applicable

    @property
    def turns(self) -> bool:
        """Whether the verdict is not the same in all stops."""
        return self.stops not in (self.passed, self.failed, self.inconclusive, self.not_applicable)


@dataclass(frozen=True, slots=True)
class Verdict:
    """One criterion's verdict on one stop, or over the stops of a repeated case.

    `value`, `lower`, `upper` and `margin` are in `unit`; None where a bound is not set or there is no value.
    `margin` is the distance to the nearest bound, positive on the good side. For a criterion over wheelsets
    `value` is the one of the wheelset that decides. `measure` and `definitions` hold the name of the measure
    and the definitions that are numbers. `definition` maps each definition to its text, for people only.
    `requirements` holds the ids of those that the criterion verifies, `readings` what each of its readings
    says, the deciding one first; empty where there is only one. `over_stops` is None but for a repeated case,
    in which `value` is the median. `missed_by` holds the wheelsets, from 1, that miss the bounds in one stop.
    `in_valid_test` requirements stand in a valid test alone. `lacks_data`: the criterion does not apply for
    lack of a channel in the record, or of a reference.
    """

    id: str
    layer: Layer
    value: OptionalNumber
    unit: str
    lower: OptionalNumber
    upper: OptionalNumber
    margin: OptionalNumber
    status: Annotated[Status, Field(alias="verdict")]
    reason: str
    definition: dict[str, str] = field(default_factory=dict)
    sensitivity: tuple[WrittenSensitivity, ...] = ()
    measure: str = ""
    definitions: tuple[AppliedDefinition, ...] = ()
    requirements: tuple[str, ...] = ()
    over_stops: OverStops | None = None
    readings: tuple[ReadVerdict, ...] = ()
    missed_by: tuple[int, ...] = ()
    in_valid_test: bool = False
    lacks_data: bool = False

    @property
    def is_check(self) -> bool:
        """Whether it says that the figures are those of the test, and judges nothing else."""
        return self.layer in ("rig", "record")

    @property
    def lacks_channel(self) -> bool:
        """Whether a requirement was left out for lack of a channel in the record, or of a reference."""
        return self.layer == "requirement" and self.lacks_data

    @property
    def turns(self) -> bool:
        """Whether the verdict changes within the stated range of a definition."""
        return any(sensitivity.flips for sensitivity in self.sensitivity)

    @property
    def settled(self) -> bool:
        """Whether the criterion was decided wherever it applies, by every definition within its range."""
        return self.status != "inconclusive" and not self.turns

    @property
    def steady(self) -> bool:
        """Whether the verdict stays the same over the stated range of every definition, and in every stop."""
        return not self.turns and (self.over_stops is None or not self.over_stops.turns)

    def defined(self, name: str) -> float | None:
        """Return the SI value of a definition, None where the verdict has none of this name."""
        return next((each.value for each in self.definitions if each.name == name), None)


def with_outcome_of(verdict: Verdict, other: Verdict) -> Verdict:
    """Return a verdict with the definitions of `verdict` and all that depends on the stop from `other`."""
    return replace(other, definition=verdict.definition, definitions=verdict.definitions)


WrittenVerdict = Annotated[
    Verdict, absent_if_empty("over_stops", "readings", "missed_by", "in_valid_test", "lacks_data")
]
"""In JSON what only some verdicts have is absent from the others."""


def relative_margin(verdict: Verdict) -> float | None:
    """Return the margin over the bound, negative where the bound is missed; None where there is none.

    All criteria share this scale. A criterion that is met exactly, as that of standstill is, only says yes
    or no and has no margin. A verdict that flips within the range of a definition, or from stop to stop of a
    repeated case, has none to spare: at most 0.
    """
    if verdict.margin is None or (verdict.margin == 0.0 and verdict.status == "pass" and verdict.steady):
        return None
    bound = max(abs(verdict.lower or 0.0), abs(verdict.upper or 0.0))
    share = verdict.margin / bound if bound else min(verdict.margin, 0.0)
    return share if verdict.steady else min(share, 0.0)

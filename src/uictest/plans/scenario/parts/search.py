"""The section `search`: where `uictest search` looks for stops that fail, and what counts as found."""

import re
from collections.abc import Iterator
from decimal import Decimal
from typing import Annotated, Final, NamedTuple

from pydantic import AfterValidator, PlainSerializer, PlainValidator, WithJsonSchema

from uictest.plans.faults import FAULT_KINDS, FaultKind
from uictest.plans.scenario.expansion import TwoBounds
from uictest.plans.scenario.overrides import FRICTION, sets_friction
from uictest.plans.scenario.parts.rail import MOST_POINTS
from uictest.plans.scenario.yaml import (
    DecimalQuantity,
    Inconsistency,
    Model,
    Quantity,
    common_unit,
    field,
    optional,
    quantity,
    quoted,
    refused,
    suggestion,
)


class FailsIn(NamedTuple):
    """In how many stops under different seeds a case must fail to be found."""

    needed: int
    stops: int

    def __str__(self) -> str:
        """Return it as written: `8 of 10`."""
        return f"{self.needed} of {self.stops}"


_FORM: Final = re.compile(r"\s*(\d{1,3})\s+of\s+(\d{1,3})\s*")


def _parse_fails_in(value: object) -> FailsIn:
    if isinstance(value, FailsIn):
        return value
    match = _FORM.fullmatch(str(value))
    if match is None:
        raise refused(f"{quoted(str(value))} is no number of stops", "write `8 of 10`")
    parsed = FailsIn(int(match[1]), int(match[2]))
    if not 1 <= parsed.needed <= parsed.stops <= 100:
        raise refused(f"{parsed} is impossible", "write `8 of 10`; at most 100 stops are accepted")
    return parsed


def _rising(bounds: tuple[DecimalQuantity, DecimalQuantity]) -> tuple[DecimalQuantity, DecimalQuantity]:
    low, high = bounds
    if common_unit(bounds) is None:
        raise refused(f"{low} and {high} have different units", "write both with the same unit")
    if float(low.number) >= float(high.number):
        raise refused(f"the bounds must rise from {low} to {high}")
    return bounds


RisingBounds = Annotated[TwoBounds, AfterValidator(_rising)]


def kinds_named(name: str) -> list[FaultKind]:
    """Return the kinds of faults that a name means: `speed-sensor-offset`, or some of its words in order.

    `valve-stuck` means the stuck fill and vent valves, open and closed.
    """
    exact = [row for row in FAULT_KINDS.values() if fault_name(row) == name]
    wanted = name.split("-")

    def has_words(row: FaultKind) -> bool:
        words = iter(fault_name(row).split("-"))
        return all(word in words for word in wanted)

    return exact or list(filter(has_words, FAULT_KINDS.values()))


def fault_name(row: FaultKind) -> str:
    """Return part and kind of a fault in one word."""
    return f"{row.part}-{row.name}"


def _known_kind(name: str) -> str:
    if not kinds_named(name):
        raise refused(
            f"no fault is called {quoted(name)}", suggestion(name, map(fault_name, FAULT_KINDS.values()))
        )
    return name


class SearchedFaults(Model):
    """The faults that a search adds to those of the scenario."""

    kinds: tuple[Annotated[str, AfterValidator(_known_kind)], ...] = field(
        "Part and kind joined by a hyphen, such as speed-sensor-offset, or some of these words in order, such"
        " as valve-stuck; left out: all kinds.",
        default=tuple(map(fault_name, FAULT_KINDS.values())),
        min_length=1,
    )
    begin: RisingBounds = field(
        "Earliest and latest beginning of a fault: two times, speeds or distances.",
        alias="from",
        default=(DecimalQuantity(Decimal(0), "s"), DecimalQuantity(Decimal(30), "s")),
        examples=[["0 s", "30 s"]],
    )
    count: int = field(
        "How many faults a stop has besides those of the scenario.", default=1, ge=1, le=3, strict=True
    )


class SearchedProfile(Model):
    """Friction at points along the track, searched in place of `rail.friction`."""

    points: int = field("Number of points.", ge=2, le=MOST_POINTS, strict=True)
    spacing: Quantity = quantity(
        "Distance between two of them; the first is at 0 m.", "length", "1 m .. 10 km"
    )
    friction: RisingBounds = field(
        "Lowest and highest friction coefficient at any of them.", examples=[[0.05, 0.25]]
    )


class Search(Model):
    """A search: the space in which stops are looked for that fail, and what counts as found."""

    criteria: tuple[str, ...] = field(
        "Ids of the criteria, each searched for itself.", min_length=1, examples=[["locked-wheels"]]
    )
    ranges: dict[str, RisingBounds] = field(
        "Lowest and highest value by dotted key.",
        default={},
        max_length=32,
        examples=[{"initial_speed": ["60 km/h", "160 km/h"]}],
    )
    profile: SearchedProfile | None = optional("Friction along the track, in place of `rail.friction`.")
    faults: SearchedFaults | None = optional("Faults that are added; none if left out.")
    fails_in: Annotated[
        FailsIn, PlainValidator(_parse_fails_in), PlainSerializer(str), WithJsonSchema({"type": "string"})
    ] = field(
        "Stops in which a case must fail, of so many under different seeds.",
        default=FailsIn(8, 10),
        examples=["8 of 10"],
    )
    stops: int = field(
        "Stops to simulate for each search; shrinking takes some more.",
        default=2000,
        ge=16,
        le=1_000_000,
        strict=True,
    )
    seed: int = field("Seed of the points that are tried.", default=0, ge=0, le=2**32 - 1, strict=True)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield an empty space, keys that the search sets itself, and a criterion that is named twice."""
        if not self.ranges and self.profile is None and self.faults is None:
            hint = "give `ranges`, `profile` or `faults`: ranges: {rail.friction: [0.05, 0.20]}"
            yield Inconsistency((), "there is nothing to search", hint)
        for key in filter(sets_friction, self.ranges if self.profile is not None else ()):
            message = f"`profile` stands in place of `{FRICTION}`"
            yield Inconsistency(("ranges", key), message, "leave one of them out")
        for key in {"seed", "repeat"} & self.ranges.keys():
            yield Inconsistency(("ranges", key), "the search sets it", "`fails_in` says how many seeds")
        if len(set(self.criteria)) < len(self.criteria):
            yield Inconsistency(("criteria",), "a criterion is named twice")

"""Definitions of the measures, repeats of a stop, ids of requirements."""

from collections.abc import Iterator, Sequence
from typing import Annotated, ClassVar, Final, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from uictest.plans.scenario.yaml import Inconsistency, Model, Part, Quantity, default, of_kind, quoted

Speed = Annotated[Quantity, of_kind("speed", at_least="0.001 km/h", at_most="100 km/h")]

Share = Annotated[Quantity, of_kind("share", at_least="0.001 %", at_most="100 %")]


class MeasureDefinitions(Part):
    """The definitions of the measures of every stop, simulated or recorded."""

    folder: ClassVar[str] = "measures"

    schema_id: Literal["uictest/measures/1"] = Field(
        default="uictest/measures/1", alias="schema", description="What the file holds: uictest/measures/1."
    )
    sliding_slide: Share = Field(description="Relative slide from which a wheelset counts as sliding.")
    sliding_slip: Speed = Field(description="Slip speed that a sliding wheelset must have as well.")
    locked_speed: Speed = Field(description="Wheel speed below which a wheelset counts as locked.")
    moving_speed: Speed = Field(
        description="Train speed above which slides, locks and decelerations are observed."
    )
    deceleration_filter: Annotated[Quantity, of_kind("time", at_least="0 s", at_most="10 s")] = Field(
        description="Time constant of the low-pass of the deceleration."
    )
    developed_time: Annotated[Quantity, of_kind("time", at_least="0 s", at_most="60 s")] = Field(
        description="Time after the command from which the smallest deceleration is kept."
    )
    rising_share: Share = Field(
        description="Share of the commanded pressure at which the brake-line pressure counts as rising."
    )
    developed_share: Share = Field(
        description="Share of the commanded pressure at which the brake counts as built up."
    )
    reduced_share: Share = Field(
        description="Share of the brake-line pressure below which a tank counts as held down by the WSP."
    )
    released_share: Annotated[Quantity, of_kind("share", at_least="0 %", at_most="100 %")] = Field(
        default=default("20 %", "share"),
        description="Share of the largest clamping force below which a wheelset is without brake force.",
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a brake that is built up before its pressure rises."""
        yield from super().inconsistencies()
        if self.developed_share <= self.rising_share:
            yield Inconsistency(
                ("developed_share",),
                f"{self.developed_share.text} is not above rising_share = {self.rising_share.text}",
                "the brake is built up after its pressure has begun to rise",
            )


MOST_REPEATS: Final = 1000
LARGEST_SEED: Final = 2**32 - 1
_WORDS: Final = ("all", "median")


Repeat = Annotated[
    int,
    Field(
        ge=1,
        le=MOST_REPEATS,
        strict=True,
        description="How many times the stop is run: under this seed and those that follow it.",
    ),
]
"""The number of stops of a case."""


class ShareOfStops(Model):
    """A share of the stops that must come out as expected."""

    at_least: Annotated[Quantity, of_kind("share", above="0 %", at_most="100 %")] = Field(
        description="Least share of the stops that must come out as expected."
    )


def _form(value: object) -> str:
    return "share" if isinstance(value, dict | ShareOfStops) else "word"


def _known(word: object) -> object:
    if isinstance(word, str) and word not in _WORDS:
        message = f"unknown value {quoted(word)}, expected one of {', '.join(_WORDS)}"
        context = {"message": message, "hint": "write {at_least: 90 %} for a share of the stops"}
        raise PydanticCustomError("outcome_of_repeats", "{message}", context)
    return word


OutcomeOfRepeats = Annotated[
    Annotated[Literal["all", "median"], BeforeValidator(_known), Tag("word")]
    | Annotated[ShareOfStops, Tag("share")],
    Discriminator(_form),
    Field(
        description="What must come out as expected: all stops, the median of each criterion's value, or a"
        " share of the stops, as in `{at_least: 90 %}`."
    ),
]
"""`all` stops, the `median` of each criterion's value, or a share of the stops."""


def seeds_too_large(seed: int, repeat: int) -> Iterator[Inconsistency]:
    """Yield repeats whose last seed is beyond the largest one."""
    last = seed + repeat - 1
    if last > LARGEST_SEED:
        yield Inconsistency(
            ("repeat",),
            f"{repeat} stops from seed {seed} end with seed {last}; the largest is {LARGEST_SEED}",
            f"take a seed of at most {LARGEST_SEED - repeat + 1}",
        )


REQUIREMENT_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9._:/-]{0,99}$"
"""No blank, comma or semicolon: those separate ids in lists."""

RequirementId = Annotated[str, Field(pattern=REQUIREMENT_PATTERN)]
RequirementIds = Annotated[tuple[RequirementId, ...], Field(max_length=100)]


def repeated_requirements(requirements: Sequence[str]) -> Iterator[Inconsistency]:
    """Yield every id that a list under the key `requirements` names a second time."""
    for index, requirement in enumerate(requirements):
        if requirement in requirements[:index]:
            yield Inconsistency(("requirements", index), f"{quoted(requirement)} appears twice", "remove one")

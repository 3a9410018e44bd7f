"""How often a stop is repeated under further seeds, and which outcome that is."""

from collections.abc import Iterator
from typing import Annotated, Final, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from uictest.plans.scenario.yaml import Inconsistency, Model, Quantity, of_kind, quoted

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

"""What files of scenarios, series, sweeps and validations have alike: name, requirements, repeats."""

from collections.abc import Iterator, Sequence
from typing import Annotated, Final, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from uictest.plans.scenario.yaml import Inconsistency, Model, Quantity, quoted
from uictest.plans.scenario.yaml.quantity_field import field, optional, quantity

REQUIREMENT_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9._:/-]{0,99}$"
"""No blank, comma or semicolon: those separate ids in lists."""

RequirementId = Annotated[str, Field(pattern=REQUIREMENT_PATTERN)]
RequirementIds = Annotated[tuple[RequirementId, ...], Field(max_length=100)]


def repeated_requirements(requirements: Sequence[str]) -> Iterator[Inconsistency]:
    """Yield every id that a list under the key `requirements` names a second time."""
    for index, requirement in enumerate(requirements):
        if requirement in requirements[:index]:
            yield Inconsistency(("requirements", index), f"{quoted(requirement)} appears twice", "remove one")


Slug = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9._-]{0,99}$")]


class NamedFile(Model):
    """A file with a name; each kind narrows `schema_id` to what it is called."""

    schema_id: str = field(
        "What the file holds and in which version, such as uictest/scenario/1.", alias="schema"
    )
    name: Slug = field("Name in every report: lower-case letters, digits, dots, dashes and underscores.")
    title: str = field("One line for people.", default="", max_length=200, pattern=r"^[^\x00-\x1f\x7f]*$")


class TestFile(NamedFile):
    """A file of stops that are judged, with what tools of test management know it by."""

    __test__ = False

    description: str = field(
        "What it is for.", default="", max_length=5000, pattern=r"^[^\x00-\x08\x0b-\x1f\x7f]*$"
    )
    tags: tuple[Slug, ...] = field("Words that select it (-m).", default=(), max_length=32)
    requirements: RequirementIds = field("Ids of the requirements that it verifies.", default=())
    test_case: RequirementId | None = optional(
        "Id of the test case in the test management tool, such as WSP-TC-7."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield requirements named twice."""
        yield from repeated_requirements(self.requirements)


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

    at_least: Quantity = quantity(
        "Least share of the stops that must come out as expected.", "share", "> 0 % .. 100 %"
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

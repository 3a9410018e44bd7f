"""What files of scenarios, series, sweeps and validations have alike: their name, and what they are for."""

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from uictest.plans.scenario.parts.measures import RequirementId, RequirementIds, repeated_requirements
from uictest.plans.scenario.yaml import Inconsistency, Model

Slug = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9._-]{0,99}$")]


class NamedFile(Model):
    """A file with a name; each kind narrows `schema_id` to what it is called."""

    schema_id: str = Field(
        alias="schema", description="What the file holds and in which version, such as uictest/scenario/1."
    )
    name: Slug = Field(
        description="Name in every report: lower-case letters, digits, dots, dashes and underscores."
    )
    title: str = Field(
        default="", max_length=200, pattern=r"^[^\x00-\x1f\x7f]*$", description="One line for people."
    )


class DescribedFile(NamedFile):
    """A file that says what it is for."""

    description: str = Field(
        default="", max_length=5000, pattern=r"^[^\x00-\x08\x0b-\x1f\x7f]*$", description="What it is for."
    )


class TestFile(DescribedFile):
    """A file of stops that are judged, with what tools of test management know it by."""

    __test__ = False

    tags: tuple[Slug, ...] = Field(default=(), max_length=32, description="Words that select it (-m).")
    requirements: RequirementIds = Field(default=(), description="Ids of the requirements that it verifies.")
    test_case: RequirementId | None = Field(
        default=None, description="Id of the test case in the test management tool, such as WSP-TC-7."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield requirements named twice."""
        yield from repeated_requirements(self.requirements)

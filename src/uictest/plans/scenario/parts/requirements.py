"""Ids of requirements and test cases, as a requirements tool calls them."""

from collections.abc import Iterator, Sequence
from typing import Annotated

from pydantic import Field

from uictest.plans.scenario.yaml import Inconsistency, quoted

REQUIREMENT_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9._:/-]{0,99}$"
"""No blank, comma or semicolon: those separate ids in lists."""

RequirementId = Annotated[str, Field(pattern=REQUIREMENT_PATTERN)]
RequirementIds = Annotated[tuple[RequirementId, ...], Field(max_length=100)]


def repeated_requirements(requirements: Sequence[str]) -> Iterator[Inconsistency]:
    """Yield every id that a list under the key `requirements` names a second time."""
    for index, requirement in enumerate(requirements):
        if requirement in requirements[:index]:
            yield Inconsistency(("requirements", index), f"{quoted(requirement)} appears twice", "remove one")

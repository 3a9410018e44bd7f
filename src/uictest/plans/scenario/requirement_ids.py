"""Which requirements a scenario names, and the order in which their ids are listed."""

import re
from collections.abc import Iterable

from uictest.plans.scenario.model import Scenario

_NUMBERS = re.compile(r"([0-9]+)")


def named_requirements(scenario: Scenario) -> tuple[str, ...]:
    """Return the ids of the requirements that a resolved scenario or one of its criteria names, each once.

    Criteria that only a series can be judged by are left out.
    """
    criteria = (each for profile in scenario.criteria for each in profile.criteria if not each.needs_series)
    of_criteria = (requirement for criterion in criteria for requirement in criterion.requirements)
    return tuple(dict.fromkeys((*scenario.requirements, *of_criteria)))


def in_order_of_ids(requirements: Iterable[str]) -> list[str]:
    """Return ids in alphabetical order, numbers within them by value: BR-9 before BR-10."""
    return sorted(requirements, key=lambda text: (_split_at_numbers(text), text))


def _split_at_numbers(text: str) -> list[str | int]:
    return [int(part) if place % 2 else part for place, part in enumerate(_NUMBERS.split(text))]

"""The rig that a compensation file lists: the one of the records that its numbers were identified from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from uictest.plans.scenario import RIG_SOURCE, Compensation, Quantity

Numbers = dict[str, Any]
"""Nested mapping like the file; a number is a pair of its text and the key of its source."""

TOLERANCES_OF: Final = "six-inch"
"""The compensation of the library whose tolerances others take."""
RIG_DESCRIBED: Final = {"mark": "identified", "text": "The rig of the records, as built"}
_SUBJECTS: Final = ("hysteresis", "cylinder", "air")


def is_of_one_rig(facts: Mapping[str, str]) -> bool:
    """Return whether all numbers of a compensation with this provenance were identified on one known rig."""
    digests = {facts.get(f"{subject} rig sha256", "") for subject in _SUBJECTS}
    return len(digests) == 1 and "" not in digests


def listed_rig(rig: Mapping[str, str], tolerances_of: Compensation) -> Numbers:
    """Return the section that lists a rig, given by the keys of a scenario; the last two elements tell."""
    assert tolerances_of.identified_for is not None
    numbers: Numbers = {"caliper": {}, "wsp_valve": {}}
    for key, text in rig.items():
        section, name = key.split(".")[-2:]
        if section == "tank":
            numbers["tank_volume"] = (text, RIG_SOURCE)
        else:
            numbers[section][name] = (text, RIG_SOURCE)
    tolerances = {
        name: with_source(value) if isinstance(value, Quantity) else with_sources(value)
        for name, value in tolerances_of.identified_for.tolerances
    }
    return {**numbers, "tolerances": tolerances}


def with_sources(section: Any) -> Numbers:
    """Return the quantities of a section, each with its source."""
    return {name: with_source(value) for name, value in section}


def with_source(quantity: Quantity) -> tuple[str, str]:
    """Return a quantity as written, and its source."""
    return quantity.text, quantity.source

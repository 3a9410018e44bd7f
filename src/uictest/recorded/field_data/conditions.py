"""What a recording does not hold and its user must state: rail, brake position, WSP, criteria."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from uictest.plans.scenario import (
    EXPANSION_KEYS,
    PART_KEYS,
    SCENARIO_SCHEMA,
    Case,
    Files,
    Parts,
    Roots,
    resolve,
    with_default_parts,
)
from uictest.plans.scenario.yaml import (
    Document,
    Map,
    apply_overrides,
    dotted,
    parse,
    parse_overrides,
    single_error,
)

REQUIRED_STATEMENTS: Final = ("rail.condition", "brake.position", "rig.wsp", "criteria")
"""Keys of a scenario that must be stated for a recording that has none."""


def stated_case(
    name: str, initial_speed: float, statements: Sequence[str], trusted: Sequence[Path] = ()
) -> Case:
    """Return the case that `key=value` statements make of a stop from `initial_speed` (m/s).

    References stay at or below the files stated, the working folder and the `trusted` folders.

    Raises ScenarioErrors where a statement is no key of a scenario, or not acceptable.
    """
    begin = {"schema": SCENARIO_SCHEMA, "name": name, "initial_speed": f"{initial_speed:.9g} m/s"}
    document = Document("what is stated about the stop", Path(), json.dumps(begin))
    tree = parse(document)
    assert isinstance(tree, Map)
    keys = frozenset(map(dotted, PART_KEYS))
    tree = apply_overrides(with_default_parts(tree), parse_overrides(statements, None), keys)
    for section in EXPANSION_KEYS:
        if (entry := tree.entries.get(section)) is not None:
            raise single_error(entry.key, "a recording is one stop: several values make no sense", section)
    scenario, documents = resolve(tree, Parts(Files(Roots.of((), trusted))))
    inputs = {each.display: each.sha256 for each in documents if each.sha256}
    return Case(name, scenario, Path(document.display), {}, inputs)

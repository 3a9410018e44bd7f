"""One entry of a file that lists stops, and whether two stops are of the same train."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from uictest.plans.scenario import Files, Scenario
from uictest.plans.scenario.yaml import (
    Map,
    Node,
    Override,
    Scalar,
    Sequence as List,
    is_file,
    quoted,
    single_error,
)
from uictest.plans.series.model import Stops
from uictest.plans.series.series import Recorded


def scenario_of(node: Node) -> Scalar:
    """Return the reference of the scenario of an entry, which may stand alone."""
    reference = node.get("scenario") if isinstance(node, Map) else node
    assert isinstance(reference, Scalar)
    return reference


def values_set_by(node: Node) -> Iterator[Override]:
    """Yield what an entry sets; every key is an axis, so that the ids of its stops name the values.

    Raises ScenarioErrors for an empty list.
    """
    if not isinstance(node, Map):
        return
    if (repeat := node.entries.get("repeat")) is not None:
        yield Override("repeat", repeat.key, (repeat.node,))
    section = node.get("set")
    for key, entry in section.entries.items() if isinstance(section, Map) else ():
        values = entry.node.items if isinstance(entry.node, List) else (entry.node,)
        if not values:
            raise single_error(entry.node.place, "an empty list makes no stop", f"set.{key}")
        yield Override(key, entry.key, tuple(values), swept=True)


def recorded_by(node: Node, files: Files) -> Recorded | None:
    """Return the recordings of an entry, None without any. Raises ScenarioErrors where one is missing."""
    listed = node.get("recordings") if isinstance(node, Map) else None
    if not isinstance(listed, List) or not listed.items:
        return None
    return Recorded(tuple(_existing(each, files) for each in listed.items), _channel_map(node, files))


def _existing(reference: Node, files: Files) -> Path:
    assert isinstance(reference, Scalar)
    path = files.path_of(reference, "recordings")
    if not is_file(path):
        raise single_error(reference.place, f"no such file: {quoted(reference.text)}", "recordings")
    return path


def _channel_map(node: Node, files: Files) -> str:
    reference = node.get("map") if isinstance(node, Map) else None
    if not isinstance(reference, Scalar):
        return Stops.model_fields["map"].get_default()  # type: ignore[no-any-return]
    is_path = reference.text.endswith((".yaml", ".yml"))
    return str(files.path_of(reference, "map")) if is_path else reference.text


def differences_of_train(dry: Scenario, wet: Scenario) -> Iterator[str]:
    """Yield the keys of what must be the same in both stops and is not."""
    dry_discs, wet_discs = dry.brake.initial_disc_temperature, wet.brake.initial_disc_temperature
    for key, one, other in (
        ("vehicle", dry.vehicle, wet.vehicle),
        ("brake.command", dry.brake.command, wet.brake.command),
        ("brake.position", dry.brake.position, wet.brake.position),
        ("brake.system", dry.brake.system, wet.brake.system),
        ("brake.pad", dry.brake.pad, wet.brake.pad),
        ("brake.disc_temperature", dry.brake.disc_temperature, wet.brake.disc_temperature),
        ("brake.initial_disc_temperature", dry_discs, wet_discs),
        ("faults", dry.faults, wet.faults),
        ("rail.gradient", dry.rail.gradient, wet.rail.gradient),
    ):
        if one != other:
            yield key

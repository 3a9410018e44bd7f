"""Whether a dry and a wet stop are of the same train with the same brake on the same slope."""

from __future__ import annotations

from collections.abc import Iterator

from uictest.plans.scenario import Scenario


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

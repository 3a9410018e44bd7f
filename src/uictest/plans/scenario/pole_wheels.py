"""Speed sensors that cannot be: gaps without teeth beside them, gaps that no teeth are counted over."""

from collections.abc import Iterator

from uictest.plans.scenario.wheelset_values import WHEELSET_NUMBERS, deciding_key, wheelset_value
from uictest.plans.scenario.yaml import Inconsistency, Model


def impossible_pole_wheels(scenario: Model) -> Iterator[Inconsistency]:
    """Yield settings of the speed sensors that no pole wheel can have, for every wheelset."""
    for number in WHEELSET_NUMBERS:
        yield from _of_wheelset(scenario, number)


def _of_wheelset(scenario: Model, number: int) -> Iterator[Inconsistency]:
    names = [f"sensors.speed.{name}" for name in ("missing_teeth", "teeth", "method")]
    missing, teeth, method = (wheelset_value(scenario, number, name) for name in names)
    if missing >= teeth:
        yield Inconsistency(
            deciding_key(scenario, number, *names[:2]),
            f"{missing.text} of {teeth.text} teeth: at least one must be left",
        )
    elif missing > 0 and method == "momentary":
        yield Inconsistency(
            deciding_key(scenario, number, names[0], names[2]),
            f"a momentary speed counts no teeth, and wheelset {number} has {missing.text} missing",
            "write method: whole-teeth, or missing_teeth: 0",
        )

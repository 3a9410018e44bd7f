"""The values that hold for one wheelset: its own where it has any, else the regular ones."""

from collections.abc import Iterator
from operator import attrgetter
from typing import Any, Final

from uictest.plans.scenario.parts.wheelsets import NUMBERS, REGULAR
from uictest.plans.scenario.yaml import Key, Model, Quantity, default

WHEELSET_NUMBERS: Final = tuple(map(int, NUMBERS))
"""Numbers of the wheelsets from the leading end."""
_WHEELSETS: Final = attrgetter("vehicle.wheelsets")
_WHOLE: Final = default("100 %", "share")


def wheelset_value(scenario: Model, number: int, name: str) -> Any:
    """Return a quantity or setting of wheelset ``number`` (1 to 4) by its name below ``vehicle.wheelsets.N``.

    Names are those of :class:`~uictest.plans.scenario.parts.wheelsets.OwnValues`, e.g.
    ``caliper.load_friction``.
    """
    own = attrgetter(name)(_WHEELSETS(scenario)[str(number)])
    return _regular(scenario, name) if own is None else own


def wheelset_keys(number: int, name: str) -> tuple[str, ...]:
    """Return the keys of a scenario that decide a value of a wheelset."""
    own = f"vehicle.wheelsets.{number}.{name}"
    return (own, REGULAR[name]) if name in REGULAR else (own,)


def deciding_key(scenario: Model, number: int, *names: str) -> Key:
    """Return the key of the first value that the wheelset has of its own, else of the first, regular."""
    for name in names:
        if attrgetter(name)(_WHEELSETS(scenario)[str(number)]) is not None:
            return tuple(wheelset_keys(number, name)[0].split("."))
    return tuple(REGULAR[names[0]].split("."))


def distinct_values(scenario: Model, name: str) -> Iterator[tuple[Key, Quantity]]:
    """Yield the values that wheelsets have under a name of `REGULAR` and their keys, the regular one once."""
    written: dict[Key, Quantity] = {}
    for number in WHEELSET_NUMBERS:
        value = wheelset_value(scenario, number, name)
        own, regular = wheelset_keys(number, name)
        written[tuple((regular if value is _regular(scenario, name) else own).split("."))] = value
    yield from written.items()


def _regular(scenario: Model, name: str) -> Any:
    return attrgetter(REGULAR[name])(scenario) if name in REGULAR else _WHOLE

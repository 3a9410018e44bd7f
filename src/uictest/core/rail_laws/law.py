"""What a law of the rail declares, the laws that there are, and the choice among them in the model.

The default is a mixture: a rail whose cleaned share counts as it is, so that friction is the mean of that of
the rail as found and that of the clean one.
"""

import pkgutil
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any, Final, NamedTuple

from uictest.core import rail_laws
from uictest.core.physics import cleaned_share

MOST_NUMBERS: Final = 4
"""Numbers of its own that a law may have."""
DEFAULT: Final = "mixture"
"""Name of the law of a rail that names none."""


class LawNumber(NamedTuple):
    """A number that a law has of its own.

    Attributes:
        kind: kind of quantity, a name of :data:`uictest.core.units.KINDS`.
        description: one sentence for people.
        at_least: smallest value, as a user would write it, such as ``"1 ms"``.
        at_most: largest value, likewise.
        convert: from the value in SI units to what the equations take.
    """

    kind: str
    description: str
    at_least: str
    at_most: str
    convert: Callable[[float], float] = float


_FAR: Final = 1e6
"""Length of track, in m and in reaches, after which a state has settled."""


class RailLaw(NamedTuple):
    """A law, as its module declares it.

    Both functions are scalar code of :mod:`uictest.core.physics`, which also runs compiled and beside lanes.
    After the arguments that are named here, each takes `numbers`, the law's own in their order.

    Attributes:
        name: its key below `rail.cleaning`.
        description: one sentence for people.
        own_share: state of the rail under one wheelset at the end of a stretch of track, 0 as found to 1
            clean: of `share` at its beginning, `loss` of both contacts on the way in J, `distance` > 0 in m,
            `response` = 1 / energy in m/J and `decay` = 1 / reach in 1/m.
        clean_part: how far friction and creep curve have gone from those of the rail as found, 0, to those
            of the clean one, 1: of `share`, the state that all wheelsets so far have left.
        numbers: its own, by name.
    """

    name: str
    description: str
    own_share: Callable[..., float]
    clean_part: Callable[..., float]
    numbers: Mapping[str, LawNumber] = {}

    def settled_share(self, loss: float, response: float, numbers: Sequence[float]) -> float:
        """Return the state of a rail of which every metre has taken a loss in J; `numbers` are the law's."""
        return self.own_share(0.0, loss * _FAR, _FAR, response, 1.0, numbers)


def cleaned_by_energy(
    share: float, loss: float, distance: float, response: float, decay: float, numbers: Sequence[float]
) -> float:
    """Return the state of the rail of a law that has no equation of its own for it."""
    return cleaned_share(share, loss, distance, response, decay)


def _share_itself(share: float, numbers: Sequence[float]) -> float:
    return share


def _laws() -> dict[str, RailLaw]:
    """Return the default law, and that of every other module of this room, by their names."""
    mixture = RailLaw(
        name=DEFAULT,
        description="Friction is in proportion to the cleaned share.",
        own_share=cleaned_by_energy,
        clean_part=_share_itself,
    )
    names = [module.name for module in pkgutil.iter_modules(rail_laws.__path__) if module.name != "law"]
    laws = [mixture, *(import_module(f"{rail_laws.__name__}.{name}").LAW for name in names)]
    return {law.name: law for law in laws}


LAWS: Final = _laws()
"""Every law by its name; its index is its number in the model."""

_OF_NUMBER: Final = tuple(LAWS.values())


def own_share(share: float, loss: float, distance: float, p: Any) -> Any:
    """Return the state of the rail under one wheelset at the end of a stretch of track, by the law of `p`."""
    return _OF_NUMBER[p.rail_law].own_share(
        share, loss, distance, p.cleaning_response, p.cleaning_decay, p.law_numbers
    )


def clean_part(share: float, p: Any) -> Any:
    """Return how far a rail of some state has gone to a clean one, by the law of the parameters `p`."""
    return _OF_NUMBER[p.rail_law].clean_part(share, p.law_numbers)

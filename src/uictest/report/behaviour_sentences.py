"""What the WSP did in a stop, in sentences: as the cause of a failure, and as facts beside its plots."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.report.traces.behaviour import DEEP, ROLLING, SLIDING, WRONG, WspBehaviour
from uictest.report.words import percent

_LATE: Final = 1.0
"""s of a slide without a vent from which that is a cause; chosen."""
_WITHOUT_BRAKE: Final = 3.0
"""s without brake from which that is a cause; chosen."""
_NEEDLESS: Final = 5
"""Vents while rolling from which they are a cause; chosen."""


def behaviour_causes(behaviour: WspBehaviour) -> Iterator[str]:
    """Yield what of the WSP's behaviour can be why a stop failed, the most likely first."""
    unvented, reference, released, _, needless = behaviour
    if unvented is not None and unvented.duration > _LATE:
        yield (
            f"wheelset {unvented.wheelset} slides more than {percent(SLIDING)} for {unvented.duration:.3g} s"
            f" from {unvented.start:.3g} s on without a vent"
        )
    if reference is not None and abs(reference.share) > WRONG:
        shown, train = (
            speed / KILOMETRE_PER_HOUR for speed in (reference.reference_speed, reference.train_speed)
        )
        yield (
            f"the controller's reference speed is wrong by more than {percent(WRONG)} from"
            f" {reference.start:.3g} s on: {shown:.3g} km/h while the train runs at {train:.3g} km/h"
            f" ({reference.time:.3g} s)"
        )
    if released is not None and released.duration > _WITHOUT_BRAKE:
        yield (
            f"wheelset {released.wheelset} is without brake for {released.duration:.3g} s"
            f" from {released.start:.3g} s on"
        )
    if needless is not None and needless >= _NEEDLESS:
        yield f"{needless} vents begin while the wheelset rolls (slide below {percent(ROLLING)})"


def behaviour_facts(behaviour: WspBehaviour) -> dict[str, str]:
    """Return what the WSP did by name, as the viewer of a stop shows it."""
    unvented, reference, released, deep, needless = behaviour
    facts = {}
    if reference is not None:
        facts["largest error of the reference speed"] = (
            f"{100 * reference.share:+.3g} % at {reference.train_speed / KILOMETRE_PER_HOUR:.3g} km/h, "
            f"{reference.time:.3g} s"
        )
    for name, spell in {
        f"longest slide above {percent(SLIDING)} without a vent": unvented,
        "longest without brake": released,
        f"longest slide above {percent(DEEP)}": deep,
    }.items():
        if spell is not None:
            facts[name] = f"{spell.duration:.3g} s from {spell.start:.3g} s, wheelset {spell.wheelset}"
    if needless is not None:
        facts["vents while rolling"] = str(needless)
    return facts

"""What a WSP did in one stop, from its recording: how soon it vents, how well it knows the train's speed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.report.traces.quantities import VENT, WHEELSETS

Series = NDArray[np.float64]

SLIDING: Final = 0.25
"""Slide beyond which a wheelset needs its valve to vent; chosen, beyond the slides that controllers keep."""
DEEP: Final = 0.5
"""Slide that counts as deep; chosen."""
ANSWERED: Final = 0.5
"""s that a vent may end before a slide exceeds `SLIDING` and still answer it; chosen."""
WRONG: Final = 0.15
"""Share of the train's speed by which a reference speed must be off to be called wrong; chosen."""
ROLLING: Final = 0.03
"""Slide below which a vent gives brake force away; chosen."""
_MOVING: Final = 10.0 * KILOMETRE_PER_HOUR
"""m/s: below this train speed nothing is looked at, as slides of slow trains say little; chosen."""
_RELEASED: Final = 0.1
"""Share of the largest clamping force of a wheelset below which it is without brake; chosen."""


class Spell(NamedTuple):
    """How long something lasted at one wheelset: `start` in s since the brake command, `duration` in s."""

    wheelset: int
    start: float
    duration: float


class SpeedError(NamedTuple):
    """The reference speed of the controller where it is furthest from the speed of the train, in m/s.

    `start` is since when, s, it has been wrong by more than `WRONG` without a break.
    """

    start: float
    time: float
    reference_speed: float
    train_speed: float

    @property
    def share(self) -> float:
        """Its error as a share of the speed of the train, negative where the reference is too low."""
        return self.reference_speed / self.train_speed - 1.0


class WspBehaviour(NamedTuple):
    """What a WSP did in one stop; None for what the recording does not tell or never happened.

    Args:
        unvented: the longest time with a slide above `SLIDING` before a vent answers that slide.
        reference: where the controller's reference speed is furthest from the train's, as a share of it.
        released: the longest time without brake, once the brake was applied.
        deep_slide: the longest time with a slide above `DEEP`.
        rolling_vents: vents that begin while the wheelset rolls.

    """

    unvented: Spell | None = None
    reference: SpeedError | None = None
    released: Spell | None = None
    deep_slide: Spell | None = None
    rolling_vents: int | None = None


NOTHING_KNOWN: Final = WspBehaviour()
"""Of a stop without the channels."""


def wsp_behaviour(channels: Mapping[str, Series]) -> WspBehaviour:
    """Return what the WSP did, from the channels of a recording in SI units."""
    if "speed" not in channels:
        return NOTHING_KNOWN
    time, speed = channels["time"], channels["speed"]
    moving = speed > _MOVING
    wheel_speeds, vents, forces = (
        {n: channels[f"{name}_{n}"] for n in WHEELSETS if f"{name}_{n}" in channels}
        for name in ("wheel_speed", "valve_command", "clamping_force")
    )
    train_speed = np.where(moving, speed, math.nan)
    slides = {n: 1.0 - wheel_speed / train_speed for n, wheel_speed in wheel_speeds.items()}
    venting = {n: np.rint(valve) == VENT for n, valve in vents.items()}
    both = [n for n in slides if n in venting]
    return WspBehaviour(
        _longest(time, {n: _unvented(time, (slides[n] > SLIDING) & moving, venting[n]) for n in both}),
        _worst_reference(time, speed, moving, channels.get("reference_speed")),
        _longest(time, {n: _released(force) & moving for n, force in forces.items()}),
        _longest(time, {n: (slide > DEEP) & moving for n, slide in slides.items()}),
        sum(_vents_while_rolling(slides[n], venting[n] & moving) for n in both) if both else None,
    )


def _unvented(time: Series, slides: NDArray[np.bool_], venting: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return when a wheelset slides and no vent has answered this slide yet."""
    unvented = slides.copy()
    for first, after in _stretches(slides):
        since = int(np.searchsorted(time, time[first] - ANSWERED))
        vents = np.flatnonzero(venting[since:after])
        if len(vents):
            unvented[max(since + vents[0], first) : after] = False
    return unvented


def _worst_reference(
    time: Series, speed: Series, moving: NDArray[np.bool_], reference: Series | None
) -> SpeedError | None:
    if reference is None or not (known := moving & np.isfinite(reference)).any():
        return None
    errors = np.where(known, np.abs(reference / np.where(moving, speed, 1.0) - 1.0), -1.0)
    row = int(np.argmax(errors))
    right = np.flatnonzero(errors[:row] <= WRONG)
    start = right[-1] + 1 if len(right) else 0
    return SpeedError(float(time[start]), float(time[row]), float(reference[row]), float(speed[row]))


def _released(force: Series) -> NDArray[np.bool_]:
    """Return when a wheelset is without brake, from the first sample with half of its largest force on."""
    largest = float(np.nanmax(force, initial=0.0))
    applied = np.logical_or.accumulate(force > 0.5 * largest)
    return applied & (force < _RELEASED * largest)


def _longest(time: Series, states: Mapping[int, NDArray[np.bool_]]) -> Spell | None:
    """Return the longest time at a stretch for which a wheelset is in a state; None where none ever is."""
    spells = []
    for wheelset, state in states.items():
        for first, after in _stretches(state):
            start, end = float(time[first]), float(time[min(after, len(time) - 1)])
            spells.append(Spell(wheelset, start, end - start))
    return max(spells, key=lambda spell: spell.duration, default=None)


def _stretches(state: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return the first sample of each stretch in a state, and the first one after it."""
    return np.flatnonzero(np.diff(state, prepend=False, append=False)).reshape(-1, 2)


def _vents_while_rolling(slide: Series, venting: NDArray[np.bool_]) -> int:
    begins = venting & ~np.append(False, venting[:-1])
    return int(np.count_nonzero(begins & (slide < ROLLING)))

"""Which speed readings a controller can believe, and which wheelsets have a speed at all.

A wheelset on the rail gains and loses speed only so fast. A reading beyond that is rejected and the last
plausible one stays, so that the gap of a pole wheel or a reading that fails does no harm. A wheelset is
distrusted when its sensor reports a fault, when more readings are rejected than not for a while, or when its
reading has stood still while those of others have not. It is trusted again once its readings have been
plausible and near the train's speed for a while.

What cannot be found like this: a sensor whose error is small or grows slowly, and one that fails while its
wheelset stands or the train is slower than the jump that is accepted.
"""

from collections.abc import Sequence

from uictest.controllers.contract import (
    ControlledWheelset,
    ControllerParameters,
    duration,
    low_speed,
    parameter,
)

_FEWEST_CHANGING = 2
"""Other wheelsets whose readings change: a single one may slide while the train runs on at one speed."""


class PlausibilityParameters(ControllerParameters):
    """What a wheelset on the rail can do, and how long a sensor may contradict it."""

    largest_acceleration: float = parameter(
        "acceleration",
        "Largest change of speed that a wheelset can have, either way.",
        at_least="1 m/s2",
        at_most="10000 m/s2",
    )
    jump_tolerance: float = low_speed("Jump of a reading that is accepted besides, such as noise.")
    distrust_time: float = duration(
        "Time by which rejected readings may outnumber plausible ones before a wheelset counts as without a"
        " speed.",
        at_least="0 s",
    )
    stuck_time: float = duration(
        "Time without any change of the reading, while others change, from which a wheelset counts as without"
        " a speed."
    )
    trust_time: float = duration(
        "Time of plausible readings near the train's speed after which a wheelset has a speed again."
    )


class WatchedWheelset(ControlledWheelset):
    """A wheelset whose readings are watched."""

    plausible_speed: float  # newest plausible reading, m/s
    rejected_cycles: int  # since that
    doubtful_cycles: int  # by which rejected readings have outnumbered plausible ones
    unchanged_cycles: int  # for which it has been the same
    distrusted: int  # 1 while the wheelset counts as without a speed
    sound_cycles: int  # of plausible readings near the train's speed while it is distrusted


def begin_watch(wheelset: WatchedWheelset, speed: float) -> None:
    """Start with a wheelset that is trusted and rolls at ``speed`` m/s."""
    wheelset.plausible_speed = speed
    wheelset.rejected_cycles = 0
    wheelset.doubtful_cycles = 0
    wheelset.unchanged_cycles = 0
    wheelset.distrusted = 0
    wheelset.sound_cycles = 0


def take_over(wheelset: WatchedWheelset, parameters: PlausibilityParameters) -> float:
    """Take over a plausible reading; return the time since the one before, s, or 0 where it is rejected."""
    elapsed = (wheelset.rejected_cycles + 1) * parameters.cycle_time
    jump = abs(wheelset.measured_speed - wheelset.plausible_speed)
    if (
        wheelset.speed_valid == 0
        or jump > parameters.jump_tolerance + parameters.largest_acceleration * elapsed
    ):
        wheelset.rejected_cycles += 1
        wheelset.doubtful_cycles += 1
        return 0.0
    still = jump == 0.0 and wheelset.measured_speed > parameters.minimum_speed
    wheelset.unchanged_cycles = wheelset.unchanged_cycles + 1 if still else 0
    wheelset.plausible_speed = wheelset.measured_speed
    wheelset.rejected_cycles = 0
    wheelset.doubtful_cycles = max(wheelset.doubtful_cycles - 1, 0)
    return elapsed


def watch(
    wheelsets: Sequence[WatchedWheelset], reference: float, near: float, parameters: PlausibilityParameters
) -> None:
    """Decide which wheelsets have a speed.

    Args:
        wheelsets: all four, their readings taken over.
        reference: estimate of the train's speed, m/s.
        near: how far from it a rolling wheelset may be, m/s.
        parameters: of the controller.
    """
    changing = 0
    for i in range(4):
        if wheelsets[i].distrusted == 0 and not _stands_still(wheelsets[i], parameters):
            changing += 1
    for i in range(4):
        stuck = changing >= _FEWEST_CHANGING and _stands_still(wheelsets[i], parameters)
        doubtful_time = wheelsets[i].doubtful_cycles * parameters.cycle_time
        if stuck or wheelsets[i].speed_valid == 0 or doubtful_time > parameters.distrust_time:
            wheelsets[i].distrusted = 1
            wheelsets[i].sound_cycles = 0
            wheelsets[i].doubtful_cycles = 0
        elif wheelsets[i].distrusted == 1:
            _regain_trust(wheelsets[i], reference, near, parameters)


def _stands_still(wheelset: WatchedWheelset, parameters: PlausibilityParameters) -> bool:
    return bool(wheelset.unchanged_cycles * parameters.cycle_time > parameters.stuck_time)


def shows_speed_of_train(wheelset: WatchedWheelset) -> bool:
    """Return whether a reading may raise the estimate of the train's speed: nothing casts doubt on it."""
    return bool(wheelset.distrusted == 0 and wheelset.doubtful_cycles == 0)


def _regain_trust(
    wheelset: WatchedWheelset, reference: float, near: float, parameters: PlausibilityParameters
) -> None:
    sound = wheelset.doubtful_cycles == 0 and abs(reference - wheelset.plausible_speed) <= near
    wheelset.sound_cycles = wheelset.sound_cycles + 1 if sound else 0
    if wheelset.sound_cycles * parameters.cycle_time > parameters.trust_time:
        wheelset.distrusted = 0

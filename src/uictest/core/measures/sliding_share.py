"""Time that wheelsets turn slower than a share of the train's speed, until the train is down to a speed.

Times are kept per band of train speed: row `k` of a table holds those before the train first ran at or below
`END_SPEEDS[k]`, but not yet those before it did at `END_SPEEDS[k + 1]`. The time until the train is down to
one of these speeds is the sum of that row and all above. A row has one time per share of `SLOW_SHARES`.
"""

from collections.abc import Sequence

from uictest.core.measures.records import END_SPEEDS, SLOW_SHARES, SLOW_TIMES, StopMeasures, WheelsetMeasures

NAN = float("nan")
_SPEEDS, _SHARES, _WHEELSETS = len(END_SPEEDS), len(SLOW_SHARES), 4


def begin_slow_times(measures: StopMeasures, wheelset_measures: Sequence[WheelsetMeasures]) -> None:
    """Start the times of a stop and of its four wheelsets."""
    for k in range(_SPEEDS):
        measures.reached_time[k] = NAN
    for k in range(SLOW_TIMES):
        measures.half_slow_time[k] = 0.0
        for i in range(_WHEELSETS):
            wheelset_measures[i].slow_time[k] = 0.0


def keep_slow_times(
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    samples: StopMeasures,
    wheelset_samples: Sequence[WheelsetMeasures],
) -> None:
    """Add the time since the sample before to every wheelset that turns too slowly at the last one.

    A wheelset that turns at exactly a share of the train's speed is not below it. A speed that is NaN, where
    a recording has a gap, is not below any.

    Args:
        measures: record of the stop that holds the times.
        wheelset_measures: records of its wheelsets that hold the times.
        samples: record that :func:`observe_train` filled with the last sample; may be the same.
        wheelset_samples: those that :func:`observe_wheelset` filled; may be the same.
    """
    row = _SPEEDS - 1
    while row >= 0 and measures.reached_time[row] >= 0.0:  # false for the NaN before
        row -= 1
    if row < 0:
        return
    interval = samples.end_time - samples.previous_time
    for j in range(_SHARES):
        slow = 0
        for i in range(_WHEELSETS):
            if wheelset_samples[i].wheel_speed < SLOW_SHARES[j] * samples.end_speed:
                wheelset_measures[i].slow_time[row * _SHARES + j] += interval
                slow += 1
        if 2 * slow >= _WHEELSETS:
            measures.half_slow_time[row * _SHARES + j] += interval
    while row >= 0 and samples.end_speed <= END_SPEEDS[row]:
        measures.reached_time[row] = samples.end_time
        row -= 1

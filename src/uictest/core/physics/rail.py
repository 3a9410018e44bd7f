"""Friction along the track and in time."""

from collections.abc import Sequence


def interpolated(at: float, places: Sequence[float], values: Sequence[float], count: int) -> float:
    """Value at ``at`` of a piecewise linear law through ``count`` points, constant beyond its ends.

    Two points at the same place make a step; the value there is that of the later point.
    """
    if at < places[0]:
        return values[0]
    i = 0
    while i + 1 < count and places[i + 1] <= at:
        i += 1
    if i + 1 >= count:
        return values[count - 1]
    share = (at - places[i]) / (places[i + 1] - places[i])
    return values[i] + share * (values[i + 1] - values[i])

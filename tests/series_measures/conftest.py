"""Stops of a series, made by hand."""

from uictest.core.series_measures import CountedStop, SpeedStops


def make_stop(distance=460.0, *, passed=True, locked=0.0, **columns):
    """A stop with a braking distance, a deceleration distance 60 m shorter, and whatever else is given."""
    own = {"braking_distance_m": distance, "corrected_distance_m": distance}
    measures = own | {"deceleration_distance_m": distance - 60.0} | columns
    wheelsets = tuple({"locked_time_s": time} for time in (0.0, locked, 0.0, 0.0))
    return CountedStop(measures, wheelsets, passed)


def make_speed(dry, wet, speed=120.0 / 3.6):
    """Dry and wet stops by their braking distances."""
    return SpeedStops(speed, tuple(map(make_stop, dry)), tuple(map(make_stop, wet)))

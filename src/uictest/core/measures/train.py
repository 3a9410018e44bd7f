"""Measures of the train: speed, distance, deceleration, air."""

from uictest.core.measures.records import WINDOW_SECONDS, MeasureDefinition, StopMeasures
from uictest.core.physics import maximum, minimum, select

NAN, INFINITY = float("nan"), float("inf")


def begin_train(
    measures: StopMeasures, time: float, distance: float, speed: float, reservoir_pressure: float
) -> None:
    """Start the measures with the first sample (s, m, m/s, Pa gauge)."""
    measures.initial_speed = speed
    measures.stopped = 0.0
    measures.braking_time = NAN
    measures.braking_distance = NAN
    measures.previous_time = time
    measures.previous_speed = speed
    measures.end_time = time
    measures.end_distance = distance
    measures.end_speed = speed
    measures.minimum_deceleration = NAN
    measures.maximum_deceleration = NAN
    measures.filtered_deceleration = 0.0
    measures.sliding_time = NAN
    measures.sliding_wheelset = NAN
    measures.reservoir_minimum_pressure = reservoir_pressure
    measures.reservoir_margin = INFINITY
    measures.air_consumed = NAN
    measures.energy_residual = NAN
    measures.air_residual = NAN
    measures.air_energy_residual = NAN
    measures.line_saturation = 0.0
    measures.saturation_time = NAN
    measures.compensation_misfit = NAN
    measures.samples = 1.0
    measures.fault_time = NAN
    measures.reference_excess = NAN


def begin_window(measures: StopMeasures) -> None:
    """Start the speeds after the first sliding."""
    for second in range(WINDOW_SECONDS + 1):
        measures.speed_after_sliding[second] = NAN


def observe_train(
    measures: StopMeasures,
    definition: MeasureDefinition,
    time: float,
    distance: float,
    speed: float,
    reservoir_pressure: float,
) -> None:
    """Observe the next sample, after those of the wheelsets (s since the command, m, m/s, Pa gauge)."""
    _observe_deceleration(measures, definition, time, speed)
    measures.reservoir_minimum_pressure = minimum(measures.reservoir_minimum_pressure, reservoir_pressure)
    measures.previous_time = measures.end_time
    measures.previous_speed = measures.end_speed
    measures.end_time = time
    measures.end_distance = distance
    measures.end_speed = speed
    measures.samples += 1.0


def observe_reservoir_margin(
    measures: StopMeasures, reservoir_pressure: float, highest_cylinder_pressure: float
) -> None:
    """Observe how far the reservoir lies above the cylinder of the highest pressure (Pa)."""
    margin = reservoir_pressure - highest_cylinder_pressure
    # A sample that is NaN, where a recording has a gap, leaves the smallest as it is.
    measures.reservoir_margin = minimum(margin, measures.reservoir_margin)


def keep_window(measures: StopMeasures, samples: StopMeasures) -> None:
    """Keep the speed at whole seconds after the first sliding, linear between the last two samples.

    Args:
        measures: record that holds the window.
        samples: record that :func:`observe_train` filled; may be the same.
    """
    since = samples.end_time - samples.sliding_time
    if not since >= 0.0:
        return
    before = samples.previous_time - samples.sliding_time
    change = samples.end_speed - samples.previous_speed
    second = int(before) if before >= 0.0 else -1
    while second < WINDOW_SECONDS and second + 1.0 <= since:
        second += 1
        share = (second - before) / (since - before)
        measures.speed_after_sliding[second] = samples.previous_speed + share * change


def note_standstill(measures: StopMeasures, stands: bool, time: float, distance: float) -> None:
    """Where the train ``stands``, note that it came to a standstill at ``time`` s after ``distance`` m."""
    measures.stopped = select(stands, 1.0, measures.stopped)
    measures.braking_time = select(stands, time, measures.braking_time)
    measures.braking_distance = select(stands, distance, measures.braking_distance)
    measures.end_time = select(stands, time, measures.end_time)
    measures.end_distance = select(stands, distance, measures.end_distance)
    measures.end_speed = select(stands, 0.0, measures.end_speed)


def _observe_deceleration(
    measures: StopMeasures, definition: MeasureDefinition, time: float, speed: float
) -> None:
    """Filter the deceleration and keep its extremes while the train moves and the brake is developed."""
    interval = time - measures.end_time
    deceleration = (measures.end_speed - speed) / interval
    share = interval / (interval + definition.deceleration_filter)
    filtered = measures.filtered_deceleration + share * (deceleration - measures.filtered_deceleration)
    measures.filtered_deceleration = filtered
    moves = speed >= definition.moving_speed
    developed = moves & (time >= definition.developed_time)
    # Until the first sample the extremes are NaN; minimum and maximum then give the other number.
    highest = maximum(measures.maximum_deceleration, filtered)
    lowest = minimum(measures.minimum_deceleration, filtered)
    measures.maximum_deceleration = select(moves, highest, measures.maximum_deceleration)
    measures.minimum_deceleration = select(developed, lowest, measures.minimum_deceleration)

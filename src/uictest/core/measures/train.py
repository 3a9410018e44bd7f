"""Measures of the train: speed, distance, deceleration, air, and the equivalent build-up time of its brake.

Build-up time: T_react + 0.5 T_increase (UNISIG SUBSET-026, 3.13.2.2.3.2), observed on the pressure of the
brake line. It begins to rise T_react after the brake command and has reached 95 % of what is commanded after
a further T_increase. A WSP valve lets air out of its tank only, so that dry and wet stops of a train build up
their line pressure nearly alike.
"""

from uictest.core.measures.records import WINDOW_SECONDS, MeasureDefinition, StopMeasures
from uictest.core.physics import clamp, maximum, minimum, select

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
    measures.track_brake_energy = NAN
    measures.track_brake_time = NAN
    measures.track_brake_time_beside = NAN
    measures.energy_residual = NAN
    measures.air_residual = NAN
    measures.air_energy_residual = NAN
    measures.line_saturation = 0.0
    measures.saturation_time = NAN
    measures.compensation_misfit = NAN
    measures.held_time = NAN
    measures.samples = 1.0
    measures.fault_time = NAN
    measures.reference_excess = NAN
    measures.reference_distance = NAN
    measures.has_diagnosis = NAN


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


def begin_build_up(measures: StopMeasures, commanded_pressure: float, line_pressure: float) -> None:
    """Start with the first sample: pressure commanded and of the brake line, gauge, Pa."""
    measures.commanded_pressure = commanded_pressure
    measures.line_pressure = line_pressure
    measures.rise_time = NAN
    measures.rise_distance = NAN
    measures.rise_speed = NAN
    measures.build_up_time = NAN
    measures.build_up_distance = NAN


def observe_build_up(
    measures: StopMeasures,
    definition: MeasureDefinition,
    time: float,
    distance: float,
    speed: float,
    line_pressure: float,
) -> None:
    """Observe the next sample, before the train's (s since the command, m, m/s, Pa gauge).

    Time, distance and speed are linear in the pressure between two samples. The equivalent build-up time lies
    midway between both instants; the distance run until then is that of a cubic between them, which is exact
    where the deceleration grows evenly.
    """
    rising = definition.rising_share * measures.commanded_pressure
    developed = definition.developed_share * measures.commanded_pressure
    at, place, rate = _instant(measures, time, distance, speed, line_pressure, rising)
    rises = line_pressure >= rising
    known = measures.rise_time >= 0.0  # false for the NaN before
    measures.rise_time = select(known, measures.rise_time, select(rises, at, NAN))
    measures.rise_distance = select(known, measures.rise_distance, select(rises, place, NAN))
    measures.rise_speed = select(known, measures.rise_speed, select(rises, rate, NAN))
    at, place, rate = _instant(measures, time, distance, speed, line_pressure, developed)
    increase = at - measures.rise_time
    midway = 0.5 * (measures.rise_distance + place) + 0.125 * increase * (measures.rise_speed - rate)
    develops = line_pressure >= developed
    known = measures.build_up_time >= 0.0
    middle = 0.5 * (measures.rise_time + at)
    measures.build_up_time = select(known, measures.build_up_time, select(develops, middle, NAN))
    measures.build_up_distance = select(known, measures.build_up_distance, select(develops, midway, NAN))
    measures.line_pressure = line_pressure


def _instant(
    measures: StopMeasures, time: float, distance: float, speed: float, line_pressure: float, level: float
) -> tuple[float, float, float]:
    """Time, distance and speed at which the pressure passed a level since the last sample."""
    rise = line_pressure - measures.line_pressure
    share = clamp((level - measures.line_pressure) / select(rise > 0.0, rise, 1.0), 0.0, 1.0)
    return (
        measures.end_time + share * (time - measures.end_time),
        measures.end_distance + share * (distance - measures.end_distance),
        measures.end_speed + share * (speed - measures.end_speed),
    )

"""Measures of the train: speed, distance, deceleration, air, and the equivalent build-up time of its brake.

Build-up time: T_react + 0.5 T_increase (UNISIG SUBSET-026, 3.13.2.2.3.2), observed on the pressure of the
brake line. It begins to rise T_react after the brake command and has reached 95 % of what is commanded after
a further T_increase. A WSP valve lets air out of its tank only, so that dry and wet stops of a train build up
their line pressure nearly alike.
"""

from collections.abc import Sequence

from uictest.core.measures.records import WINDOW_SECONDS, MeasureDefinition, StopMeasures, WheelsetMeasures
from uictest.core.physics import clamp, maximum, minimum, select
from uictest.core.record import FieldStarter

NAN = float("nan")


_start = FieldStarter(StopMeasures)


def begin_train(
    measures: StopMeasures,
    time: float,
    distance: float,
    speed: float,
    reservoir_pressure: float,
    commanded_pressure: float,
    line_pressure: float,
) -> None:
    """Start the measures that are one number with the first sample (s, m, m/s, Pa gauge).

    `commanded_pressure` is that of the brake line, gauge, Pa.
    """
    _start(measures)
    measures.initial_speed = speed
    measures.previous_time = time
    measures.previous_speed = speed
    measures.end_time = time
    measures.end_distance = distance
    measures.end_speed = speed
    measures.reservoir_minimum_pressure = reservoir_pressure
    measures.commanded_pressure = commanded_pressure
    measures.line_pressure = line_pressure


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
    at, position, rate = _instant(measures, time, distance, speed, line_pressure, rising)
    rises = line_pressure >= rising
    known = measures.rise_time >= 0.0  # false for the NaN before
    measures.rise_time = select(known, measures.rise_time, select(rises, at, NAN))
    measures.rise_distance = select(known, measures.rise_distance, select(rises, position, NAN))
    measures.rise_speed = select(known, measures.rise_speed, select(rises, rate, NAN))
    at, position, rate = _instant(measures, time, distance, speed, line_pressure, developed)
    increase = at - measures.rise_time
    midway = 0.5 * (measures.rise_distance + position) + 0.125 * increase * (measures.rise_speed - rate)
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


def close_contacts(
    measures: StopMeasures, wheelset_measures: Sequence[WheelsetMeasures], mass: float
) -> None:
    """Relate the work of the rail to what it could have done, and to the mass of the train in kg.

    Deceleration of a bogie: work of the rail on its two wheelsets over mass and distance of the train.
    """
    measures.adhesion_utilisation = _share(measures.exploited_work, measures.available_work)
    for i in range(4):
        wheelset = wheelset_measures[i]
        wheelset.adhesion_utilisation = _share(wheelset.exploited_work, wheelset.available_work)
    leading = wheelset_measures[0].rail_work + wheelset_measures[1].rail_work
    trailing = wheelset_measures[2].rail_work + wheelset_measures[3].rail_work
    inertia = mass * measures.end_distance
    measures.deceleration_bogie_1 = _share(leading, inertia)
    measures.deceleration_bogie_2 = _share(trailing, inertia)


def _share(part: float, whole: float) -> float:
    return part / whole if whole > 0.0 else NAN

"""Equivalent build-up time of the brake, observed on the pressure of the brake line.

T_react + 0.5 T_increase (UNISIG SUBSET-026, 3.13.2.2.3.2): the pressure begins to rise T_react after the
brake command and has reached 95 % of what is commanded after a further T_increase. A WSP valve lets air out
of its tank only, so that dry and wet stops of a train build up their line pressure nearly alike.
"""

from uictest.core.measures.records import MeasureDefinition, StopMeasures
from uictest.core.physics import clamp, select

NAN = float("nan")


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

"""Measures of one wheelset: slide, locks, valve actuations, clamping force, disc temperature."""

from uictest.core.measures.records import SPEED_CLASSES, MeasureDefinition, StopMeasures, WheelsetMeasures
from uictest.core.physics import maximum, minimum, select

NAN = float("nan")
_CLASSES_PER_SPEED = 3.6 / 10.0
"""Classes of 10 km/h per m/s."""


def begin_wheelset(measures: WheelsetMeasures) -> None:
    """Start the measures of a wheelset that rolls with its brake released."""
    measures.wheel_speed = NAN
    measures.maximum_slide = 0.0
    measures.slide = 0.0
    measures.first_sliding_time = NAN
    measures.sliding = 0.0
    measures.sliding_duration = 0.0
    measures.locked_time = 0.0
    measures.longest_lock = 0.0
    measures.lock = 0.0
    measures.valve_actuations = 0.0
    measures.venting = 0.0
    measures.maximum_clamping_force = 0.0
    measures.air_vented = NAN
    measures.pressure_saturation = 0.0
    measures.loadcell_saturation = 0.0
    measures.maximum_disc_temperature = NAN
    measures.faulty = 0.0
    measures.release = 0.0
    measures.longest_release = NAN


def begin_slides(measures: WheelsetMeasures) -> None:
    """Start the slides of the classes of speed."""
    for k in range(SPEED_CLASSES):
        measures.maximum_slide_above[k] = NAN


def observe_wheelset(
    measures: WheelsetMeasures,
    train: StopMeasures,
    definition: MeasureDefinition,
    number: int,
    time: float,
    speed: float,
    wheel_speed: float,
    venting: float,
    clamping_force: float,
    disc_temperature: float,
) -> None:
    """Observe the next sample of wheelset ``number`` (1..4), before the train's.

    Args:
        measures: measures of the wheelset.
        train: measures of the stop; its last sample gives the interval.
        definition: how samples become measures.
        number: number of the wheelset, from the leading end.
        time: since the brake command, s.
        speed: of the train, m/s.
        wheel_speed: circumferential speed r omega, m/s.
        venting: 1.0 while the WSP valve is commanded to vent, else 0.0.
        clamping_force: of one caliper, N.
        disc_temperature: of the friction surface of the discs, K; NaN where it is not known.
    """
    measures.valve_actuations += select(venting > measures.venting, 1.0, 0.0)
    measures.venting = venting
    # A sample that is NaN, where a recording has a gap, leaves the largest as it is.
    measures.maximum_clamping_force = maximum(clamping_force, measures.maximum_clamping_force)
    hottest = maximum(disc_temperature, measures.maximum_disc_temperature)
    known = measures.maximum_disc_temperature >= 0.0  # false for the NaN before the first sample
    measures.maximum_disc_temperature = select(known, hottest, disc_temperature)
    moves = speed > definition.moving_speed
    interval = time - train.end_time
    slip = speed - wheel_speed
    slide = slip / select(moves, speed, 1.0)
    measures.wheel_speed = wheel_speed
    measures.slide = select(moves, slide, measures.slide)
    measures.maximum_slide = select(moves, maximum(measures.maximum_slide, slide), measures.maximum_slide)
    slides = moves & (slide > definition.sliding_slide) & (slip > definition.sliding_slip)
    _observe_sliding(measures, train, slides, number, time, interval)
    _observe_lock(measures, moves, moves & (wheel_speed < definition.locked_speed), interval)


def keep_slide(
    measures: WheelsetMeasures, samples: WheelsetMeasures, definition: MeasureDefinition, speed: float
) -> None:
    """Keep the largest slide for each lowest train speed.

    Args:
        measures: record that holds a slide for each class of speed.
        samples: record that :func:`observe_wheelset` filled with the last sample; may be the same.
        definition: how samples become measures.
        speed: of the train at that sample, m/s.
    """
    if not speed > definition.moving_speed:
        return
    k = _highest_class_below(speed)
    # A slide counts above every lower speed, too: once a class holds as much, so do all classes below.
    while k >= 0 and not measures.maximum_slide_above[k] >= samples.slide:
        measures.maximum_slide_above[k] = samples.slide
        k -= 1


def _highest_class_below(speed: float) -> int:
    """Number of the highest class whose lowest speed is below ``speed`` > 0."""
    classes = speed * _CLASSES_PER_SPEED
    if classes >= SPEED_CLASSES:
        return SPEED_CLASSES - 1
    highest = int(classes)
    return highest - 1 if highest == classes else highest


def _observe_sliding(
    measures: WheelsetMeasures, train: StopMeasures, slides: bool, number: int, time: float, interval: float
) -> None:
    """Add up the time spent sliding, and note which wheelset slid first and when."""
    measures.sliding = select(slides, 1.0, 0.0)
    measures.sliding_duration += select(slides, interval, 0.0)
    # Before the first sliding the times are NaN; the minimum then gives the other number.
    first = minimum(measures.first_sliding_time, time)
    measures.first_sliding_time = select(slides, first, measures.first_sliding_time)
    leader = select(train.sliding_time <= time, train.sliding_wheelset, float(number))
    train.sliding_wheelset = select(slides, leader, train.sliding_wheelset)
    train.sliding_time = select(slides, minimum(train.sliding_time, time), train.sliding_time)


def _observe_lock(measures: WheelsetMeasures, moves: bool, locked: bool, interval: float) -> None:
    """Add up the time during which the wheelset stands while the train moves."""
    measures.locked_time += select(locked, interval, 0.0)
    measures.lock = select(locked, measures.lock + interval, select(moves, 0.0, measures.lock))
    measures.longest_lock = maximum(measures.longest_lock, measures.lock)

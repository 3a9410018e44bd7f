"""Measures of one wheelset: slide, locks, valve actuations, clamping force, disc, reaction to faults.

The time that a wheelset turns slower than a share of the train's speed is kept per band of train speed: row
`k` of a table holds the times before the train first ran at or below `END_SPEEDS[k]`, but not yet those
before it did at `END_SPEEDS[k + 1]`. The time until the train is down to one of these speeds is the sum of
that row and all above. A row has one time per share of `SLOW_SHARES`.
"""

from collections.abc import Sequence

from uictest.core.measures.monitoring import begin_monitoring
from uictest.core.measures.records import (
    END_SPEEDS,
    SLOW_SHARES,
    SLOW_TIMES,
    SPEED_CLASSES,
    MeasureDefinition,
    StopMeasures,
    WheelsetMeasures,
)
from uictest.core.physics import maximum, minimum, select

NAN = float("nan")
_CLASSES_PER_SPEED = 3.6 / 10.0
"""Classes of 10 km/h per m/s."""
_SPEEDS, _SHARES, _WHEELSETS = len(END_SPEEDS), len(SLOW_SHARES), 4


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
    measures.dynamic_energy = NAN
    measures.sand_laid = NAN
    measures.sand_in_30_s = NAN
    measures.longest_sanding = NAN
    measures.faulty = 0.0
    measures.release = 0.0
    measures.longest_release = NAN
    begin_monitoring(measures)


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
    measures.maximum_slide = select(moves, maximum(slide, measures.maximum_slide), measures.maximum_slide)
    slides = moves & (slide > definition.sliding_slide) & (slip > definition.sliding_slip)
    _observe_sliding(measures, train, slides, number, time, interval)
    # A lock before a gap and one after it need not be the same lock.
    ended = moves | (slip != slip)
    _observe_lock(measures, ended, moves & (wheel_speed < definition.locked_speed), interval)


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
    if not speed > definition.moving_speed or samples.slide != samples.slide:  # a gap
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


def _observe_lock(measures: WheelsetMeasures, ended: bool, locked: bool, interval: float) -> None:
    """Add up the time during which the wheelset stands while the train moves; `ended` where none goes on."""
    measures.locked_time += select(locked, interval, 0.0)
    measures.lock = select(locked, measures.lock + interval, select(ended, 0.0, measures.lock))
    measures.longest_lock = maximum(measures.longest_lock, measures.lock)


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


def observe_reference(measures: StopMeasures, definition: MeasureDefinition, reference_speed: float) -> None:
    """Observe the controller's estimate of the train's speed in one cycle with a fault, after the train.

    Args:
        measures: measures of the stop; the estimate is of its last speed but one, from which the controller
            made it.
        definition: how samples become measures.
        reference_speed: m/s; NaN where the controller has none.
    """
    if not measures.previous_speed > definition.moving_speed:
        return
    # Before the first sample both are NaN; minimum and maximum then give the other number.
    measures.fault_time = minimum(measures.fault_time, measures.previous_time)
    excess = reference_speed - measures.previous_speed
    if excess == excess:
        measures.reference_excess = maximum(measures.reference_excess, excess)


def observe_reaction(
    measures: WheelsetMeasures,
    train: StopMeasures,
    definition: MeasureDefinition,
    faulty: float,
    speed_sensor_faulty: float,
    clamping_force: float,
    largest_force: float,
) -> None:
    """Observe one wheelset in one cycle, after the train.

    Args:
        measures: measures of the wheelset.
        train: measures of the stop; its last two samples give the interval.
        definition: how samples become measures.
        faulty: 1 once one of its parts has had a fault.
        speed_sensor_faulty: 1 while its speed sensor has one.
        clamping_force: of one caliper, N.
        largest_force: that of the wheelset with most of it, N.
    """
    measures.faulty = faulty
    observed = train.end_speed > definition.moving_speed and train.end_time >= definition.developed_time
    if not (speed_sensor_faulty > 0.0 and observed):
        measures.release = 0.0
        return
    released = clamping_force < definition.released_share * largest_force
    measures.release = measures.release + (train.end_time - train.previous_time) if released else 0.0
    measures.longest_release = maximum(measures.longest_release, measures.release)

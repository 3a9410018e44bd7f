"""Measures of one wheelset: slide, locks, valve actuations, clamping force, disc; contacts; reports.

The time that a wheelset turns slower than a share of the train's speed is kept per band of train speed: row
`k` of a table holds the times before the train first ran at or below `END_SPEEDS[k]`, but not yet those
before it did at `END_SPEEDS[k + 1]`. The time until the train is down to one of these speeds is the sum of
that row and all above. A row has one time per share of `SLOW_SHARES`.

What a controller reports is observed once per controller cycle, after the train, only where a controller can
report or a fault may be to be reported.
"""

from collections.abc import Sequence

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
from uictest.core.record import FieldStarter

NAN = float("nan")
_CLASSES_PER_SPEED = 3.6 / 10.0
"""Classes of 10 km/h per m/s."""
_SPEEDS, _SHARES, _WHEELSETS = len(END_SPEEDS), len(SLOW_SHARES), 4


begin_wheelset = FieldStarter(WheelsetMeasures)
"""Start the measures that are one number, of a wheelset that rolls with its brake released."""


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


def observe_contact(
    measures: WheelsetMeasures,
    train: StopMeasures,
    definition: MeasureDefinition,
    time: float,
    speed: float,
    pressure: float,
    line_pressure: float,
    rail_work: float,
    contact_loss: float,
    highest_force: float,
) -> None:
    """Observe the next sample of a wheelset's contacts, after its slide and before the train's sample.

    What the rail gives counts against what it could give while the brake demands more: while the wheelset
    slides and, once it has slid, while the WSP holds its pressure below that of the brake line.

    Args:
        measures: measures of the wheelset.
        train: measures of the stop; its last sample gives the distance run.
        definition: how samples become measures.
        time: since the brake command, s.
        speed: of the train, m/s.
        pressure: in the wheelset's tank, gauge, Pa.
        line_pressure: of the brake line, gauge, Pa.
        rail_work: of the rail on the wheelset since the brake command, against its motion, J.
        contact_loss: energy turned into heat in its contacts since then, J.
        highest_force: that both contacts could transmit, N.
    """
    slides = measures.sliding > 0.0
    # Unknown, as NaN, where the last sample of a recording lies in a gap.
    before = select(train.end_speed >= 0.0, train.end_speed, speed)
    run = 0.5 * (before + speed) * (time - train.end_time)
    measures.slid_distance += select(slides, run, 0.0)
    measures.contact_energy += select(slides, contact_loss - measures.contact_loss, 0.0)
    has_slid = (measures.first_sliding_time <= time) & (speed > definition.moving_speed)
    limited = slides | (has_slid & (pressure < definition.reduced_share * line_pressure))
    exploited = select(limited, rail_work - measures.rail_work, 0.0)
    available = select(limited, highest_force * run, 0.0)
    measures.exploited_work += exploited
    measures.available_work += available
    train.exploited_work += exploited
    train.available_work += available
    measures.rail_work = rail_work
    measures.contact_loss = contact_loss


_REPORTS_OF_FIRST = 0x01010101


def reports_wheelset(diagnosis: int, i: int) -> float:
    """Return 1 where a diagnosis reports wheelset ``i`` (0 to 3): by bit i, 8 + i, 16 + i or 24 + i."""
    return 1.0 if (diagnosis >> i) & _REPORTS_OF_FIRST else 0.0


def observe_monitoring(
    measures: WheelsetMeasures,
    train: StopMeasures,
    definition: MeasureDefinition,
    reported: float,
    faulty: float,
    report_required: float,
    shown_speed: float,
    fills: float,
) -> None:
    """Observe one wheelset in one cycle, after the train.

    Report, shown speed and command are of the train's last sample but one, from which the controller decided.
    The interval since then counts as unreported unless the report came at once.

    Args:
        measures: measures of the wheelset.
        train: measures of the stop; its last two samples give the interval.
        definition: how samples become measures.
        reported: 1 while the diagnosis reports the wheelset.
        faulty: 1 once one of its parts has had a fault.
        report_required: 1 once it has had one of a kind that is to be reported.
        shown_speed: of the wheelset as its sensor shows it, m/s; NaN, in a gap of a recording, deviates from
            nothing.
        fills: 1 while its valve is commanded to fill.
    """
    interval = train.end_time - train.previous_time
    speed = train.previous_speed
    if not speed > definition.moving_speed:
        measures.deviation = 0.0
        measures.unfilled = 0.0
        return
    allowed = definition.monitored_speed + definition.monitored_share * speed
    _observe_deviation(measures, abs(shown_speed - speed) > allowed, reported, interval)
    measures.unfilled = 0.0 if fills > 0.0 else measures.unfilled + interval
    measures.longest_unfilled = maximum(measures.longest_unfilled, measures.unfilled)
    stands_out = measures.longest_deviation >= 0.0 or measures.locked_time > 0.0
    if reported > 0.0 and faulty == 0.0 and not stands_out:
        measures.falsely_reported = 1.0
    if faulty > 0.0 and measures.fault_reported == 0.0:
        measures.fault_reported = reported
        measures.report_delay = _delayed(measures.report_delay, reported, interval)
    if report_required > 0.0 and measures.required_reported == 0.0:
        measures.required_reported = reported
        measures.required_delay = _delayed(measures.required_delay, reported, interval)


def _observe_deviation(measures: WheelsetMeasures, deviates: bool, reported: float, interval: float) -> None:
    """Count the time at a stretch for which a wheelset deviates and no report has said so."""
    if not deviates:
        measures.deviation = 0.0
        measures.deviation_reported = 0.0
        return
    measures.deviation_reported = maximum(measures.deviation_reported, reported)
    if measures.deviation_reported == 0.0:
        measures.deviation += interval
    # Before the first deviation this is NaN; the maximum then gives the other number.
    measures.longest_deviation = maximum(measures.longest_deviation, measures.deviation)


def _delayed(delay: float, reported: float, interval: float) -> float:
    """Return a delay, NaN before its beginning, after one more interval with or without the report."""
    return maximum(delay, 0.0) + (0.0 if reported > 0.0 else interval)

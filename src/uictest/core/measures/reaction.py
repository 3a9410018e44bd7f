"""Measures of the reaction to faults: the estimate of the train's speed, and brakes that stay released."""

from uictest.core.measures.records import MeasureDefinition, StopMeasures, WheelsetMeasures
from uictest.core.physics import maximum, minimum


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

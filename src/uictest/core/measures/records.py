"""Measures of a stop as records: one per stop and one per wheelset.

SI units; NaN where something never happened. `starts_at` is the number before anything is observed; what is
kept from the first sample, and tables, have none.
"""

from collections.abc import MutableSequence
from typing import Annotated

from uictest.core.record import Record, from_scenario, starts_at

NAN, INFINITY = float("nan"), float("inf")

SPEED_CLASSES = 21
"""Classes of train speed, 10 km/h apart: the largest slide is kept above each of 0, 10, .. 200 km/h."""
SLOW_SHARES = (0.85, 0.90, 0.95)
"""Shares of the train's speed below which a wheelset may be said to slide, each with times of its own."""
END_SPEEDS = tuple(50.0 * k / 18.0 for k in range(1, 11))
"""m/s: 10, 20, .. 100 km/h, train speeds down to which the time spent sliding may count."""
SLOW_TIMES = len(END_SPEEDS) * len(SLOW_SHARES)
WINDOW_SECONDS = 10
"""Whole seconds after the first sliding at which the train's speed is kept."""


class StopMeasures(Record):
    """Measures of a stop; pressures are gauge."""

    initial_speed: float  # m/s
    stopped: float = starts_at(0.0)  # 1 when the train came to a standstill
    braking_time: float = starts_at(NAN)  # from the command to standstill, s
    braking_distance: float = starts_at(NAN)  # from the command to standstill, m
    previous_time: float  # last sample but one, s
    previous_speed: float  # m/s
    end_time: float  # last sample, s
    end_distance: float  # m
    end_speed: float  # m/s
    minimum_deceleration: float = starts_at(NAN)  # filtered, brake developed, train moving, m/s2
    maximum_deceleration: float = starts_at(NAN)  # filtered, train moving, m/s2
    filtered_deceleration: float = starts_at(0.0)  # memory of the low-pass, m/s2
    sliding_time: float = starts_at(NAN)  # first sliding of any wheelset, s
    sliding_wheelset: float = starts_at(NAN)  # which one, 1..4
    speed_after_sliding: Annotated[MutableSequence[float], WINDOW_SECONDS + 1]  # at 0, 1, .. s after it, m/s
    reached_time: Annotated[MutableSequence[float], len(END_SPEEDS)]  # first sample at or below each, s
    half_slow_time: Annotated[MutableSequence[float], SLOW_TIMES]  # at least half of the wheelsets at once, s
    reservoir_minimum_pressure: float  # Pa
    reservoir_margin: float = starts_at(INFINITY)  # lowest over the highest cylinder pressure, Pa
    commanded_pressure: float  # of the brake line, Pa
    line_pressure: float  # of the brake line at the last sample, Pa
    rise_time: float = starts_at(NAN)  # when it began to rise, s
    rise_distance: float = starts_at(NAN)  # m
    rise_speed: float = starts_at(NAN)  # m/s
    build_up_time: float = starts_at(NAN)  # equivalent, s
    build_up_distance: float = starts_at(NAN)  # run until then, m
    exploited_work: float = starts_at(0.0)  # of the rail on all wheelsets while it limits the brake, J
    available_work: float = starts_at(0.0)  # that it could have done meanwhile, J
    adhesion_utilisation: float = starts_at(NAN)  # share of the two over the whole stop
    deceleration_bogie_1: float = starts_at(NAN)  # mean, given by the rail through the leading bogie, m/s2
    deceleration_bogie_2: float = starts_at(NAN)
    air_consumed: float = starts_at(NAN)  # taken from the reservoir, kg
    energy_residual: float = starts_at(NAN)  # share of the initial kinetic energy
    air_residual: float = starts_at(NAN)  # share of the air taken from the reservoir
    air_energy_residual: float = starts_at(NAN)  # share of the enthalpy of that air
    line_saturation: float = starts_at(0.0)  # for which the brake line's sensor is limited by its range, s
    saturation_time: float = starts_at(NAN)  # first sample by which any sensor has been, s
    compensation_misfit: float = starts_at(NAN)  # differences from the rig identified, over tolerances
    samples: float = starts_at(1.0)
    held_time: float = starts_at(NAN)  # for which traction has held the speed of a drag, s
    track_brake_energy: float = starts_at(NAN)  # that the track brake turned into heat, where there is one, J
    track_brake_time: float = starts_at(NAN)  # for which it acted, s
    track_brake_time_beside: float = starts_at(NAN)  # the longest of other cars of its train, s
    fault_time: float = starts_at(NAN)  # first cycle with a fault while the train moves, s
    reference_excess: float = starts_at(NAN)  # largest since then, of the controller's estimate, m/s
    reference_distance: float = starts_at(NAN)  # shortest at any slide that is kept, of a car alone, m
    has_diagnosis: float = starts_at(NAN)  # 1 where the controller can report something


class WheelsetMeasures(Record):
    """Measures of one wheelset; slides are shares of the train's speed."""

    wheel_speed: float = starts_at(NAN)  # circumferential, last sample, m/s
    slow_time: Annotated[MutableSequence[float], SLOW_TIMES]  # below each share of the train's speed, s
    slide: float = starts_at(0.0)  # last sample, train moving
    maximum_slide: float = starts_at(0.0)  # train moving
    maximum_slide_above: Annotated[MutableSequence[float], SPEED_CLASSES]  # train faster than 0, 10, .. km/h
    first_sliding_time: float = starts_at(NAN)  # s
    sliding: float = starts_at(0.0)  # 1 while it slides
    sliding_duration: float = starts_at(0.0)  # s
    slid_distance: float = starts_at(0.0)  # run while it slides, m
    contact_energy: float = starts_at(0.0)  # turned into heat in its contacts while it slides, J
    contact_loss: float = starts_at(0.0)  # until the last sample, sliding or not, J
    rail_work: float = starts_at(0.0)  # of the rail on it until the last sample, J
    exploited_work: float = starts_at(0.0)  # of the rail on it while the rail limits the brake, J
    available_work: float = starts_at(0.0)  # that the rail could have done meanwhile, J
    adhesion_utilisation: float = starts_at(NAN)  # share of the two over the whole stop
    locked_time: float = starts_at(0.0)  # s
    longest_lock: float = starts_at(0.0)  # s
    lock: float = starts_at(0.0)  # length of the lock that lasts at present, s
    valve_actuations: float = starts_at(0.0)  # openings of the vent that also closed, or last to the end
    venting: float = starts_at(0.0)  # 1 while the vent is commanded open
    maximum_clamping_force: float = starts_at(0.0)  # of one caliper, N
    air_vented: float = starts_at(NAN)  # kg
    dynamic_energy: float = starts_at(NAN)  # taken by the dynamic brake, where there is one, J
    sand_laid: float = starts_at(NAN)  # by its sander, where the car has any, kg
    sand_in_30_s: float = starts_at(NAN)  # most that it laid within 30 s, kg
    longest_sanding: float = starts_at(NAN)  # time for which it laid sand without a break, s
    pressure_saturation: float = starts_at(0.0)  # for which its sensor is limited by its range, s
    loadcell_saturation: float = starts_at(0.0)  # the same of the loadcells of its caliper, s
    maximum_disc_temperature: float = starts_at(NAN)  # of the friction surface, where modelled, K
    faulty: float = starts_at(0.0)  # 1 once one of its parts has had a fault
    release: float = starts_at(0.0)  # time without brake force that lasts at present, s
    longest_release: float = starts_at(NAN)  # while its speed sensor was faulty, s
    # What a controller reports of it, and for how long it keeps the brake from it.
    deviation: float = starts_at(0.0)  # at present, of its shown speed, without a report, s
    deviation_reported: float = starts_at(0.0)  # 1 once that deviation is reported
    longest_deviation: float = starts_at(NAN)  # without a report, s
    unfilled: float = starts_at(0.0)  # time without a command to fill that lasts at present, s
    longest_unfilled: float = starts_at(NAN)  # s
    falsely_reported: float = starts_at(0.0)  # 1 once it is reported without a fault, a lock or a deviation
    report_delay: float = starts_at(NAN)  # from its first fault to its report, or the last sample, s
    fault_reported: float = starts_at(0.0)  # 1 once it is reported since then
    required_delay: float = starts_at(NAN)  # since its first fault that is to be reported, s
    required_reported: float = starts_at(0.0)


class MeasureDefinition(Record):
    """How samples become measures: the ``measures`` part of a scenario."""

    # Relative slide from which a wheelset counts as sliding.
    sliding_slide: float = from_scenario("measures.sliding_slide")
    # Slip speed that it must have as well, m/s.
    sliding_slip: float = from_scenario("measures.sliding_slip")
    # Circumferential speed below which a wheelset counts as locked, m/s.
    locked_speed: float = from_scenario("measures.locked_speed")
    # Train speed above which all of these are observed, m/s.
    moving_speed: float = from_scenario("measures.moving_speed")
    # Time constant of the low-pass of the deceleration, s.
    deceleration_filter: float = from_scenario("measures.deceleration_filter")
    # Time after the command from which the smallest deceleration is kept, s.
    developed_time: float = from_scenario("measures.developed_time")
    # Shares of the commanded pressure at which the line pressure counts as rising and as developed.
    rising_share: float = from_scenario("measures.rising_share")
    developed_share: float = from_scenario("measures.developed_share")
    # Share of the line pressure below which a tank counts as held down by its WSP valve.
    reduced_share: float = from_scenario("measures.reduced_share")
    # Share of the largest clamping force below which a wheelset counts as without brake force.
    released_share: float = from_scenario("measures.released_share")
    # Difference between the speeds of a wheelset and the train beyond which it deviates: m/s, and share of
    # the train's speed.
    monitored_speed: float = from_scenario("measures.monitored_speed")
    monitored_share: float = from_scenario("measures.monitored_share")

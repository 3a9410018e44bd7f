"""Measures of a stop, fed by the rig once per controller cycle."""

from collections.abc import Sequence

from uictest.core.measures import (
    StopMeasures,
    TrainState,
    WheelsetMeasures,
    WheelsetState,
    begin_slides,
    begin_slow_times,
    begin_train,
    begin_wheelset,
    begin_window,
    close_contacts,
    note_standstill,
    observe_monitoring,
    observe_reaction,
    observe_reference,
    observe_sample,
    reports_wheelset,
)
from uictest.core.physics import FILL, highest_creep_force, maximum, select
from uictest.rig.model.balance import air_energy_residual, air_residual, energy_residual, rail_work
from uictest.rig.model.controller import FROM_OUTSIDE
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.records import CarRecords
from uictest.rig.model.state import Car, Wheelset

NAN = float("nan")


def begin_stop_measures(
    car: Car, measures: StopMeasures, wheelset_measures: Sequence[WheelsetMeasures], p: Parameters
) -> None:
    """Start the measures of a stop that are one number."""
    reservoir, line = (
        car.reservoir_pressure - p.atmospheric_pressure,
        car.line_pressure - p.atmospheric_pressure,
    )
    developed = NAN if p.has_dynamic_brake > 0.0 else p.commanded_pressure
    begin_train(measures, car.time, car.position, car.speed, reservoir, developed, line)
    measures.compensation_misfit = p.compensation_misfit
    measures.has_diagnosis = select(p.controller == FROM_OUTSIDE, 1.0, 0.0)
    for i in range(4):
        begin_wheelset(wheelset_measures[i])


def begin_tables(measures: StopMeasures, wheelset_measures: Sequence[WheelsetMeasures]) -> None:
    """Start the measures of a stop that are a table."""
    begin_window(measures)
    begin_slow_times(measures, wheelset_measures)
    for i in range(4):
        begin_slides(wheelset_measures[i])


def observe_cycle(
    car: Car,
    wheelsets: Sequence[Wheelset],
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    p: Parameters,
) -> None:
    """Feed the measures at the end of a controller cycle; at standstill only with the standstill itself."""
    stands = (car.stopped > 0.0) & (p.end_speed <= 0.0)  # a stop that ends above ends with its cycle
    time = select(stands, car.stop_time, car.time)
    position = select(stands, car.stop_position, car.position)
    speed = select(stands, 0.0, car.speed)
    train = TrainState(
        time,
        position,
        speed,
        car.reservoir_pressure - p.atmospheric_pressure,
        car.line_pressure - p.atmospheric_pressure,
        _highest_cylinder_pressure(wheelsets),
    )
    states = (
        _state(wheelsets[0], wheelset_measures[0], stands, speed, p),
        _state(wheelsets[1], wheelset_measures[1], stands, speed, p),
        _state(wheelsets[2], wheelset_measures[2], stands, speed, p),
        _state(wheelsets[3], wheelset_measures[3], stands, speed, p),
    )
    observe_sample(measures, wheelset_measures, p, train, states)
    _observe_saturation(car, wheelsets, measures, wheelset_measures, p, time)
    note_standstill(measures, stands, time, position)


def _state(
    wheelset: Wheelset, measures: WheelsetMeasures, stands: bool, speed: float, p: Parameters
) -> WheelsetState:
    """Return the observed state of a wheelset; from standstill on, its valve and brake are not counted."""
    return WheelsetState(
        wheelset.rotation * wheelset.wheel_radius,
        select(stands, measures.venting, wheelset.venting),
        select(stands, 0.0, wheelset.clamping_force),
        wheelset.disc_surface_temperature,
        wheelset.pressure - p.atmospheric_pressure,
        rail_work(wheelset, p),
        wheelset.contact_loss,
        _highest_force(wheelset, speed, p),
    )


def _observe_saturation(
    car: Car,
    wheelsets: Sequence[Wheelset],
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    p: Parameters,
    time: float,
) -> None:
    """Keep how long sensors have been limited by their range, and by when the first was."""
    steps = car.line_saturated_steps
    measures.line_saturation = steps * p.step
    for i in range(4):
        wheelset = wheelsets[i]
        observed = wheelset_measures[i]
        observed.pressure_saturation = wheelset.pressure_saturated_steps * p.step
        observed.loadcell_saturation = wheelset.loadcell_saturated_steps * p.step
        steps += wheelset.pressure_saturated_steps + wheelset.loadcell_saturated_steps
    known = measures.saturation_time >= 0.0  # false for the NaN before the first
    first = select(steps > 0.0, time, NAN)
    measures.saturation_time = select(known, measures.saturation_time, first)


def observe_faults(
    car: Car,
    wheelsets: Sequence[Wheelset],
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    p: Parameters,
) -> None:
    """Feed the measures of the reaction to faults, after the others of the same cycle; scalar code."""
    if car.begun_faults == 0:
        return
    observe_reference(measures, p, car.reference_speed)
    largest = 0.0
    for i in range(4):
        largest = maximum(largest, wheelsets[i].clamping_force)
    for i in range(4):
        observe_reaction(
            wheelset_measures[i],
            measures,
            p,
            wheelsets[i].faulty,
            wheelsets[i].speed_sensor_faulty,
            wheelsets[i].clamping_force,
            largest,
        )


def observe_reports(
    car: Car,
    wheelsets: Sequence[Wheelset],
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    p: Parameters,
) -> None:
    """Feed the measures of what the controller reports, after the others of the same cycle; scalar code.

    Does nothing without faults if the controller is built in: built-in controllers report no faults.
    """
    if p.fault_count == 0 and p.controller != FROM_OUTSIDE:
        return
    for i in range(4):
        wheelset = wheelsets[i]
        observe_monitoring(
            wheelset_measures[i],
            measures,
            p,
            reports_wheelset(car.diagnosis, i),
            wheelset.faulty,
            wheelset.report_required,
            wheelset.measured_speed,
            1.0 if wheelset.valve_command == FILL else 0.0,
        )


def _highest_force(wheelset: Wheelset, speed: float, p: Parameters) -> float:
    """Largest creep force of both wheels on the rail as it is, N.

    Between that of the rail as found and that of a clean one, both with the friction that is met.
    """
    clean = highest_creep_force(
        speed,
        wheelset.wheel_load,
        wheelset.friction,
        wheelset.contact_stiffness,
        p.clean_highest_creep_scale,
        p.clean_highest_creep_0,
        p.clean_highest_creep_1,
        p.clean_highest_creep_2,
        p.clean_highest_creep_3,
        p.clean_highest_creep_4,
        p.clean_highest_creep_5,
        p.clean_highest_creep_6,
        p.clean_highest_creep_7,
    )
    found = highest_creep_force(
        speed,
        wheelset.wheel_load,
        wheelset.friction,
        wheelset.contact_stiffness,
        p.highest_creep_scale,
        p.highest_creep_0,
        p.highest_creep_1,
        p.highest_creep_2,
        p.highest_creep_3,
        p.highest_creep_4,
        p.highest_creep_5,
        p.highest_creep_6,
        p.highest_creep_7,
    )
    return 2.0 * (found + wheelset.cleaned_share * (clean - found))


def _highest_cylinder_pressure(wheelsets: Sequence[Wheelset]) -> float:
    leading = maximum(wheelsets[0].compensated_pressure, wheelsets[1].compensated_pressure)
    trailing = maximum(wheelsets[2].compensated_pressure, wheelsets[3].compensated_pressure)
    return maximum(leading, trailing)


def close_stop_measures(records: CarRecords) -> None:
    """Add the ledgers and balances of the whole stop."""
    car, bogies, wheelsets, p = records.car, records.bogies, records.wheelsets, records.parameters
    measures, wheelset_measures = records.measures, records.wheelset_measures
    close_contacts(measures, wheelset_measures, p.total_mass)
    measures.air_consumed = car.consumed_air
    measures.held_time = car.held_time
    measures.track_brake_energy = car.track_brake_energy if p.has_track_brake > 0.0 else NAN
    measures.track_brake_time = car.track_brake_time if p.has_track_brake > 0.0 else NAN
    measures.energy_residual = energy_residual(car, bogies, wheelsets, p)
    measures.air_residual = air_residual(car, wheelsets)
    measures.air_energy_residual = air_energy_residual(car, wheelsets, p)
    for i in range(4):
        wheelset_measures[i].air_vented = wheelsets[i].vented_air
        motored = p.has_dynamic_brake > 0.0
        wheelset_measures[i].dynamic_energy = wheelsets[i].dynamic_energy if motored else NAN
        if p.has_sanders > 0.0:
            wheelset_measures[i].sand_laid = wheelsets[i].sand_laid
            wheelset_measures[i].sand_in_30_s = wheelsets[i].sand_in_window
            wheelset_measures[i].longest_sanding = wheelsets[i].longest_sanding
        if p.models_disc_temperature == 0.0:
            wheelset_measures[i].maximum_disc_temperature = NAN

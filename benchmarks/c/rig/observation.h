/* The measures at the start, after each controller cycle and at the end of a stop. */
#ifndef OBSERVATION_H
#define OBSERVATION_H

#include "../measures/build_up.h"
#include "../measures/contact.h"
#include "../measures/sliding_share.h"
#include "../measures/train.h"
#include "../measures/wheelset.h"
#include "balance.h"
#include "records.h"

static inline void begin_stop_measures(const Car *car, Measures *measures, WheelsetMeasures *wheelset_measures,
                                       const Parameters *p)
{
    begin_measures(measures, car->time, car->position, car->speed, car->reservoir_pressure - p->atmospheric_pressure);
    begin_build_up(measures, p->commanded_pressure, car->line_pressure - p->atmospheric_pressure);
    begin_utilisation(measures);
    begin_slow_times(measures, wheelset_measures);
    measures->compensation_misfit = p->compensation_misfit;
    for (int i = 0; i < 4; i++) {
        begin_wheelset(&wheelset_measures[i]);
        begin_contact(&wheelset_measures[i]);
    }
}

static inline void observe_wheelset_and_contact(const Car *car, const Wheelset *wheelset, Measures *measures,
                                                WheelsetMeasures *observed, const Parameters *p, int place, double time,
                                                double speed, int stands)
{
    observe_wheelset(observed, measures, p, place, time, speed, wheelset->rotation * wheelset->wheel_radius,
                     stands ? observed->venting : wheelset->venting, stands ? 0.0 : wheelset->clamping_force);
    double force = highest_creep_force(speed, wheelset->wheel_load, wheelset->friction, wheelset->contact_stiffness, p);
    observe_contact(observed, measures, p, time, speed, wheelset->pressure - p->atmospheric_pressure,
                    car->line_pressure - p->atmospheric_pressure, rail_work(wheelset, p), wheelset->contact_loss,
                    2.0 * force);
}

static inline void observe_saturation(const Wheelset *wheelsets, Measures *measures,
                                      WheelsetMeasures *wheelset_measures, const Parameters *p, double time)
{
    double steps = 0.0; /* the sensor of the brake line is read for the modelled air alone */
    for (int i = 0; i < 4; i++) {
        wheelset_measures[i].pressure_saturation = wheelsets[i].pressure_saturated_steps * p->step;
        wheelset_measures[i].loadcell_saturation = wheelsets[i].loadcell_saturated_steps * p->step;
        steps += wheelsets[i].pressure_saturated_steps + wheelsets[i].loadcell_saturated_steps;
    }
    if (steps > 0.0 && !(measures->saturation_time >= 0.0))
        measures->saturation_time = time;
}

static inline void observe_cycle(const Car *car, const Wheelset *wheelsets, Measures *measures,
                                 WheelsetMeasures *wheelset_measures, const Parameters *p)
{
    int stands = car->stopped > 0.0;
    double reservoir = car->reservoir_pressure - p->atmospheric_pressure;
    double time = stands ? car->stop_time : car->time;
    double position = stands ? car->stop_position : car->position;
    double speed = stands ? 0.0 : car->speed;
    for (int i = 0; i < 4; i++)
        observe_wheelset_and_contact(car, &wheelsets[i], measures, &wheelset_measures[i], p, i + 1, time, speed, stands);
    double leading = maximum(wheelsets[0].compensated_pressure, wheelsets[1].compensated_pressure);
    double trailing = maximum(wheelsets[2].compensated_pressure, wheelsets[3].compensated_pressure);
    observe_saturation(wheelsets, measures, wheelset_measures, p, time);
    observe_reservoir_margin(measures, reservoir, maximum(leading, trailing));
    observe_build_up(measures, p, time, position, speed, car->line_pressure - p->atmospheric_pressure);
    observe_train(measures, p, time, position, speed, reservoir);
    if (stands)
        finish(measures, time, position);
    keep_slow_times(measures, wheelset_measures);
}

static inline void close_stop_measures(const Car *car, const Bogie *bogies, const Wheelset *wheelsets,
                                       Measures *measures, WheelsetMeasures *wheelset_measures, const Parameters *p)
{
    close_contacts(measures, wheelset_measures, p->total_mass);
    measures->air_consumed = car->consumed_air;
    measures->energy_residual = energy_residual(car, bogies, wheelsets, p);
    measures->air_residual = air_residual(car, wheelsets);
    measures->air_energy_residual = air_energy_residual(car, wheelsets, p);
    for (int i = 0; i < 4; i++)
        wheelset_measures[i].air_vented = wheelsets[i].vented_air;
}

#endif

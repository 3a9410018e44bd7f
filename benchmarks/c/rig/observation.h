/* The measures at the start, after each controller cycle and at the end of a stop. */
#ifndef OBSERVATION_H
#define OBSERVATION_H

#include "../measures/train.h"
#include "../measures/wheelset.h"
#include "balance.h"
#include "records.h"

static inline void begin_stop_measures(const Car *car, Measures *measures, WheelsetMeasures *wheelset_measures,
                                       const Parameters *p)
{
    begin_measures(measures, car->time, car->position, car->speed, car->reservoir_pressure - p->atmospheric_pressure);
    for (int i = 0; i < 4; i++)
        begin_wheelset(&wheelset_measures[i]);
}

static inline void observe_cycle(const Car *car, const Wheelset *wheelsets, Measures *measures,
                                 WheelsetMeasures *wheelset_measures, const Parameters *p)
{
    double reservoir = car->reservoir_pressure - p->atmospheric_pressure;
    if (car->stopped > 0.0) {
        observe_train(measures, p, car->stop_time, car->stop_position, 0.0, reservoir);
        finish(measures, car->stop_time, car->stop_position);
        return;
    }
    for (int i = 0; i < 4; i++)
        observe_wheelset(&wheelset_measures[i], measures, p, i + 1, car->time, car->speed,
                         wheelsets[i].rotation * wheelsets[i].wheel_radius, wheelsets[i].venting,
                         wheelsets[i].clamping_force);
    observe_train(measures, p, car->time, car->position, car->speed, reservoir);
}

static inline void close_stop_measures(const Car *car, const Bogie *bogies, const Wheelset *wheelsets,
                                       Measures *measures, WheelsetMeasures *wheelset_measures, const Parameters *p)
{
    measures->air_consumed = car->consumed_air;
    measures->energy_residual = energy_residual(car, bogies, wheelsets, p);
    measures->air_residual = air_residual(car, wheelsets);
    measures->air_energy_residual = air_energy_residual(car, wheelsets, p);
    for (int i = 0; i < 4; i++)
        wheelset_measures[i].air_vented = wheelsets[i].vented_air;
}

#endif

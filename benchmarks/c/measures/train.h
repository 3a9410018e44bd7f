#ifndef TRAIN_H
#define TRAIN_H

#include "../physics/arithmetic.h"
#include "records.h"

#define WINDOW_SECONDS 10

static inline void begin_measures(Measures *m, double time, double distance, double speed, double reservoir_pressure)
{
    m->initial_speed = speed;
    m->stopped = 0.0;
    m->braking_time = m->braking_distance = NAN;
    m->previous_time = m->end_time = time;
    m->end_distance = distance;
    m->previous_speed = m->end_speed = speed;
    m->minimum_deceleration = m->maximum_deceleration = NAN;
    m->filtered_deceleration = 0.0;
    m->sliding_time = m->sliding_wheelset = NAN;
    for (int second = 0; second <= WINDOW_SECONDS; second++)
        m->speed_after_sliding[second] = NAN;
    m->reservoir_minimum_pressure = reservoir_pressure;
    m->reservoir_margin = INFINITY;
    m->air_consumed = m->energy_residual = m->air_residual = m->air_energy_residual = NAN;
    m->line_saturation = 0.0;
    m->saturation_time = NAN;
    m->samples = 1.0;
    m->fault_time = m->reference_excess = m->reference_distance = NAN;
    m->track_brake_energy = m->track_brake_time = m->track_brake_time_beside = NAN;
    m->has_diagnosis = 0.0;
}

static inline void observe_deceleration(Measures *m, const Parameters *p, double time, double speed)
{
    double interval = time - m->end_time;
    double deceleration = (m->end_speed - speed) / interval;
    double share = interval / (interval + p->deceleration_filter);
    double filtered = m->filtered_deceleration + share * (deceleration - m->filtered_deceleration);
    m->filtered_deceleration = filtered;
    if (speed < p->moving_speed)
        return;
    if (!(m->maximum_deceleration >= filtered))
        m->maximum_deceleration = filtered;
    if (time >= p->developed_time && !(m->minimum_deceleration <= filtered))
        m->minimum_deceleration = filtered;
}

static inline void observe_window(Measures *m, double time, double speed)
{
    double since = time - m->sliding_time;
    if (!(since >= 0.0))
        return;
    double before = m->end_time - m->sliding_time;
    int64_t second = before >= 0.0 ? (int64_t)before : -1;
    while (second < WINDOW_SECONDS && (double)second + 1.0 <= since) {
        second++;
        double share = ((double)second - before) / (since - before);
        m->speed_after_sliding[second] = m->end_speed + share * (speed - m->end_speed);
    }
}

static inline void observe_train(Measures *m, const Parameters *p, double time, double distance, double speed,
                                 double reservoir_pressure)
{
    observe_deceleration(m, p, time, speed);
    observe_window(m, time, speed);
    m->reservoir_minimum_pressure = minimum(m->reservoir_minimum_pressure, reservoir_pressure);
    m->previous_time = m->end_time;
    m->previous_speed = m->end_speed;
    m->end_time = time;
    m->end_distance = distance;
    m->end_speed = speed;
    m->samples += 1.0;
}

static inline void observe_reservoir_margin(Measures *m, double reservoir_pressure, double highest_cylinder_pressure)
{
    m->reservoir_margin = minimum(reservoir_pressure - highest_cylinder_pressure, m->reservoir_margin);
}

static inline void finish(Measures *m, double time, double distance)
{
    m->stopped = 1.0;
    m->braking_time = m->end_time = time;
    m->braking_distance = m->end_distance = distance;
    m->end_speed = 0.0;
}

#endif

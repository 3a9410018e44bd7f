#ifndef WHEELSET_H
#define WHEELSET_H

#include "../physics/arithmetic.h"
#include "records.h"

#define SPEED_CLASSES 21

static inline void begin_wheelset(WheelsetMeasures *m)
{
    m->wheel_speed = NAN;
    m->slide = m->maximum_slide = 0.0;
    for (int k = 0; k < SPEED_CLASSES; k++)
        m->maximum_slide_above[k] = NAN;
    m->first_sliding_time = NAN;
    m->sliding = 0.0;
    m->sliding_duration = m->locked_time = m->longest_lock = m->lock = 0.0;
    m->valve_actuations = m->venting = m->maximum_clamping_force = 0.0;
    m->pressure_saturation = m->loadcell_saturation = 0.0;
    m->air_vented = m->dynamic_energy = m->maximum_disc_temperature = NAN;
    m->sand_laid = m->sand_in_30_s = m->longest_sanding = NAN;
    m->faulty = m->release = 0.0;
    m->longest_release = NAN;
    m->deviation = m->deviation_reported = m->unfilled = m->falsely_reported = 0.0;
    m->fault_reported = m->required_reported = 0.0;
    m->longest_deviation = m->longest_unfilled = m->report_delay = m->required_delay = NAN;
}

static inline void observe_slide(WheelsetMeasures *m, Measures *train, const Parameters *p, int place, double time,
                                 double speed, double slip)
{
    double slide = slip / speed;
    m->slide = slide;
    m->maximum_slide = maximum(m->maximum_slide, slide);
    double classes = speed * (3.6 / 10.0);
    int64_t k = classes >= SPEED_CLASSES ? SPEED_CLASSES - 1 : (int64_t)classes - ((int64_t)classes == classes);
    for (; k >= 0 && !(m->maximum_slide_above[k] >= slide); k--)
        m->maximum_slide_above[k] = slide;
    if (!(slide > p->sliding_slide && slip > p->sliding_slip))
        return;
    m->sliding = 1.0;
    m->sliding_duration += time - train->end_time;
    if (!(m->first_sliding_time <= time))
        m->first_sliding_time = time;
    if (!(train->sliding_time <= time)) {
        train->sliding_time = time;
        train->sliding_wheelset = place;
    }
}

static inline void observe_lock(WheelsetMeasures *m, const Parameters *p, double interval, double wheel_speed)
{
    if (wheel_speed < p->locked_speed) {
        m->locked_time += interval;
        m->lock += interval;
        m->longest_lock = maximum(m->longest_lock, m->lock);
    } else {
        m->lock = 0.0;
    }
}

static inline void observe_wheelset(WheelsetMeasures *m, Measures *train, const Parameters *p, int place,
                                    double time, double speed, double wheel_speed, double venting,
                                    double clamping_force)
{
    if (venting > m->venting)
        m->valve_actuations += 1.0;
    m->venting = venting;
    m->maximum_clamping_force = maximum(m->maximum_clamping_force, clamping_force);
    m->sliding = 0.0;
    m->wheel_speed = wheel_speed;
    if (speed > p->moving_speed) {
        observe_slide(m, train, p, place, time, speed, speed - wheel_speed);
        observe_lock(m, p, time - train->end_time, wheel_speed);
    }
}

#endif

#ifndef BUILD_UP_H
#define BUILD_UP_H

#include "../physics/arithmetic.h"
#include "records.h"

static inline void begin_build_up(Measures *m, double commanded_pressure, double line_pressure)
{
    m->commanded_pressure = commanded_pressure;
    m->line_pressure = line_pressure;
    m->rise_time = m->rise_distance = m->rise_speed = NAN;
    m->build_up_time = m->build_up_distance = NAN;
}

typedef struct {
    double time, distance, speed;
} Instant;

static inline Instant instant_of(const Measures *m, double time, double distance, double speed, double line_pressure,
                                 double level)
{
    double rise = line_pressure - m->line_pressure;
    double share = (level - m->line_pressure) / (rise > 0.0 ? rise : 1.0);
    share = minimum(maximum(share, 0.0), 1.0);
    return (Instant){m->end_time + share * (time - m->end_time), m->end_distance + share * (distance - m->end_distance),
                     m->end_speed + share * (speed - m->end_speed)};
}

static inline void observe_build_up(Measures *m, const Parameters *p, double time, double distance, double speed,
                                    double line_pressure)
{
    double rising = p->rising_share * m->commanded_pressure;
    double developed = p->developed_share * m->commanded_pressure;
    if (!(m->rise_time >= 0.0) && line_pressure >= rising) {
        Instant rise = instant_of(m, time, distance, speed, line_pressure, rising);
        m->rise_time = rise.time;
        m->rise_distance = rise.distance;
        m->rise_speed = rise.speed;
    }
    if (!(m->build_up_time >= 0.0) && line_pressure >= developed) {
        Instant end = instant_of(m, time, distance, speed, line_pressure, developed);
        double increase = end.time - m->rise_time;
        m->build_up_time = 0.5 * (m->rise_time + end.time);
        m->build_up_distance =
            0.5 * (m->rise_distance + end.distance) + 0.125 * increase * (m->rise_speed - end.speed);
    }
    m->line_pressure = line_pressure;
}

#endif

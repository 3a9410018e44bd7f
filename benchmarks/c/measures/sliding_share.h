#ifndef SLIDING_SHARE_H
#define SLIDING_SHARE_H

#include "../physics/arithmetic.h"
#include "records.h"

#define END_SPEEDS 10
#define SLOW_SHARES 3

static const double SLOW_SHARE[SLOW_SHARES] = {0.85, 0.90, 0.95};

static inline void begin_slow_times(Measures *m, WheelsetMeasures *wheelsets)
{
    for (int k = 0; k < END_SPEEDS; k++)
        m->reached_time[k] = NAN;
    for (int k = 0; k < END_SPEEDS * SLOW_SHARES; k++) {
        m->half_slow_time[k] = 0.0;
        for (int i = 0; i < 4; i++)
            wheelsets[i].slow_time[k] = 0.0;
    }
}

static inline void keep_slow_times(Measures *m, WheelsetMeasures *wheelsets)
{
    int row = END_SPEEDS - 1;
    while (row >= 0 && m->reached_time[row] >= 0.0)
        row--;
    if (row < 0)
        return;
    double interval = m->end_time - m->previous_time;
    for (int j = 0; j < SLOW_SHARES; j++) {
        int slow = 0;
        for (int i = 0; i < 4; i++)
            if (wheelsets[i].wheel_speed < SLOW_SHARE[j] * m->end_speed) {
                wheelsets[i].slow_time[row * SLOW_SHARES + j] += interval;
                slow++;
            }
        if (2 * slow >= 4)
            m->half_slow_time[row * SLOW_SHARES + j] += interval;
    }
    for (; row >= 0 && m->end_speed <= 50.0 * (row + 1) / 18.0; row--)
        m->reached_time[row] = m->end_time;
}

#endif

#ifndef SLIP_BAND_H
#define SLIP_BAND_H

#include "../physics/arithmetic.h"
#include "../physics/once_per_cycle.h"
#include "records.h"

static inline void begin_slip_band(Car *car, double speed) { car->band_reference_speed = speed; }

static inline int64_t slip_band_command(double slide, double reference, const Parameters *p)
{
    if (reference < p->band_minimum_speed || slide < p->lower_slide)
        return FILL;
    return slide > p->upper_slide ? VENT : HOLD;
}

static inline void decide_by_slip_band(Car *car, Wheelset *wheelsets, const Parameters *p)
{
    double reference = car->band_reference_speed - p->band_reference_deceleration * p->cycle_time;
    for (int i = 0; i < 4; i++)
        reference = maximum(reference, wheelsets[i].measured_speed);
    car->band_reference_speed = reference;
    for (int i = 0; i < 4; i++) {
        double slide = (reference - wheelsets[i].measured_speed) / maximum(reference, p->band_minimum_speed);
        wheelsets[i].command = slip_band_command(slide, reference, p);
    }
}

#endif

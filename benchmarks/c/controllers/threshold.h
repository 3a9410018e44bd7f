#ifndef THRESHOLD_H
#define THRESHOLD_H

#include <stdbool.h>

#include "../physics/arithmetic.h"
#include "../physics/once_per_cycle.h"
#include "records.h"

enum { FREE = 0, VENTING = 1, HOLDING = 2, REFILLING = 3, PROBING = 4 };

static inline void begin_threshold(Car *car, Wheelset *wheelsets, double speed)
{
    car->reference_speed = speed;
    car->blind_cycles = 0;
    car->probed = 3;
    for (int i = 0; i < 4; i++) {
        wheelsets[i].previous_speed = speed;
        wheelsets[i].measured_acceleration = 0.0;
        wheelsets[i].mode = FREE;
        wheelsets[i].mode_cycles = 0;
    }
}

static inline void differentiate(Wheelset *wheelset, const Parameters *p)
{
    double change = (wheelset->measured_speed - wheelset->previous_speed) / p->cycle_time;
    double share = p->cycle_time / (p->cycle_time + p->acceleration_filter_time);
    wheelset->measured_acceleration += share * (change - wheelset->measured_acceleration);
    wheelset->previous_speed = wheelset->measured_speed;
}

static inline bool rolls(const Wheelset *wheelset, const Parameters *p)
{
    double time_in_mode = (double)wheelset->mode_cycles * p->cycle_time;
    return wheelset->mode == FREE && time_in_mode > p->rolling_time;
}

static inline bool shows_speed(const Wheelset *wheelset, const Parameters *p)
{
    double time_in_mode = (double)wheelset->mode_cycles * p->cycle_time;
    if (wheelset->mode != PROBING || time_in_mode < p->sounding_time)
        return false;
    bool gains = wheelset->measured_acceleration > p->reacceleration_threshold;
    bool loses = wheelset->measured_acceleration < -p->reference_deceleration;
    return !(gains || loses);
}

static inline void estimate_speed(Car *car, const Wheelset *wheelsets, const Parameters *p)
{
    double fastest = 0.0;
    bool rolling = false, probed = false;
    for (int i = 0; i < 4; i++) {
        fastest = maximum(fastest, wheelsets[i].measured_speed);
        rolling = rolling || rolls(&wheelsets[i], p);
        probed = probed || shows_speed(&wheelsets[i], p);
    }
    double fall = rolling ? p->reference_deceleration : p->holding_deceleration;
    double estimate = car->reference_speed - fall * p->cycle_time;
    if (probed) {
        double blind_time = (double)car->blind_cycles * p->cycle_time;
        estimate -= (p->reference_deceleration - p->holding_deceleration) * blind_time;
    }
    if (rolling || probed) {
        car->blind_cycles = 0;
    } else {
        car->blind_cycles += 1;
        estimate = maximum(estimate, minimum(car->reference_speed, p->minimum_speed));
    }
    car->reference_speed = maximum(fastest, estimate);
}

static inline void enter(Wheelset *wheelset, int64_t mode)
{
    if (mode == wheelset->mode) {
        wheelset->mode_cycles += 1;
        return;
    }
    wheelset->mode = mode;
    wheelset->mode_cycles = 0;
}

static inline bool slides(const Wheelset *wheelset, double slip, double threshold, const Parameters *p)
{
    bool losing = wheelset->measured_acceleration < p->reacceleration_threshold;
    bool falling = wheelset->measured_acceleration < -p->vent_deceleration;
    return (slip > threshold && losing) || falling;
}

static inline int64_t after_venting(const Wheelset *wheelset, double slip, double reference, double time_in_mode,
                                    const Parameters *p)
{
    bool deep = slip > p->deep_slide * reference;
    double enough = deep ? p->reacceleration_threshold : -p->hold_deceleration;
    if (wheelset->measured_acceleration > enough)
        return HOLDING;
    return time_in_mode > p->vent_watchdog ? REFILLING : VENTING;
}

static inline int64_t after_holding(const Wheelset *wheelset, double slip, double reference, double threshold,
                                    double time_in_mode, const Parameters *p)
{
    if (slip < p->recovery_share * threshold)
        return REFILLING;
    bool deep = slip > p->deep_slide * reference;
    if (wheelset->measured_acceleration < (deep ? 0.0 : -p->vent_deceleration))
        return VENTING;
    if (time_in_mode > p->hold_limit)
        return wheelset->measured_acceleration < p->reacceleration_threshold ? VENTING : HOLDING;
    return HOLDING;
}

static inline int64_t next_mode(const Wheelset *wheelset, double reference, const Parameters *p)
{
    double slip = reference - wheelset->measured_speed;
    double threshold = p->slip_threshold + p->slide_threshold * reference;
    double time_in_mode = (double)(wheelset->mode_cycles + 1) * p->cycle_time;
    if (reference < p->minimum_speed)
        return FREE;
    if (wheelset->mode == PROBING)
        return shows_speed(wheelset, p) || time_in_mode > p->vent_watchdog ? REFILLING : PROBING;
    if (wheelset->mode == VENTING)
        return after_venting(wheelset, slip, reference, time_in_mode, p);
    if (wheelset->mode == HOLDING)
        return after_holding(wheelset, slip, reference, threshold, time_in_mode, p);
    if (slides(wheelset, slip, threshold, p))
        return VENTING;
    return wheelset->mode == REFILLING && time_in_mode <= p->refill_time ? REFILLING : FREE;
}

static inline int64_t threshold_command(const Wheelset *wheelset, const Parameters *p)
{
    if (wheelset->mode == VENTING || wheelset->mode == PROBING)
        return VENT;
    if (wheelset->mode == HOLDING)
        return HOLD;
    if (wheelset->mode == REFILLING) {
        int64_t on = (int64_t)rint(p->fill_pulse_on / p->cycle_time);
        int64_t off = (int64_t)rint(p->fill_pulse_off / p->cycle_time);
        return wheelset->mode_cycles % (on + off) < on ? FILL : HOLD;
    }
    return FILL;
}

static inline void probe(Car *car, Wheelset *wheelsets, const Parameters *p)
{
    for (int i = 0; i < 4; i++)
        if (wheelsets[i].mode == PROBING)
            return;
    if ((double)car->blind_cycles * p->cycle_time > p->sounding_interval) {
        car->probed = (car->probed + 1) % 4;
        enter(&wheelsets[car->probed], PROBING);
    }
}

static inline void decide_by_threshold(Car *car, Wheelset *wheelsets, const Parameters *p)
{
    for (int i = 0; i < 4; i++)
        differentiate(&wheelsets[i], p);
    estimate_speed(car, wheelsets, p);
    for (int i = 0; i < 4; i++)
        enter(&wheelsets[i], next_mode(&wheelsets[i], car->reference_speed, p));
    probe(car, wheelsets, p);
    for (int i = 0; i < 4; i++)
        wheelsets[i].valve_command = threshold_command(&wheelsets[i], p);
}

#endif

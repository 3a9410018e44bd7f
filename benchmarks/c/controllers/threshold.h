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
        wheelsets[i].plausible_speed = speed;
        wheelsets[i].rejected_cycles = 0;
        wheelsets[i].doubtful_cycles = 0;
        wheelsets[i].unchanged_cycles = 0;
        wheelsets[i].distrusted = 0;
        wheelsets[i].sound_cycles = 0;
        wheelsets[i].measured_acceleration = 0.0;
        wheelsets[i].mode = FREE;
        wheelsets[i].mode_cycles = 0;
    }
}

static inline double slip_threshold_at(double reference, const Parameters *p)
{
    return p->slip_threshold + p->slide_threshold * reference;
}

static inline double take_over(Wheelset *wheelset, const Parameters *p)
{
    double elapsed = (double)(wheelset->rejected_cycles + 1) * p->cycle_time;
    double jump = fabs(wheelset->measured_speed - wheelset->plausible_speed);
    if (wheelset->speed_valid == 0 || jump > p->jump_tolerance + p->largest_acceleration * elapsed) {
        wheelset->rejected_cycles += 1;
        wheelset->doubtful_cycles += 1;
        return 0.0;
    }
    bool still = jump == 0.0 && wheelset->measured_speed > p->minimum_speed;
    wheelset->unchanged_cycles = still ? wheelset->unchanged_cycles + 1 : 0;
    wheelset->plausible_speed = wheelset->measured_speed;
    wheelset->rejected_cycles = 0;
    if (wheelset->doubtful_cycles > 0)
        wheelset->doubtful_cycles -= 1;
    return elapsed;
}

static inline void read_speed(Wheelset *wheelset, const Parameters *p)
{
    double before = wheelset->plausible_speed;
    double elapsed = take_over(wheelset, p);
    if (elapsed > 0.0) {
        double change = (wheelset->plausible_speed - before) / elapsed;
        double share = p->cycle_time / (p->cycle_time + p->acceleration_filter_time);
        wheelset->measured_acceleration += share * (change - wheelset->measured_acceleration);
    }
}

static inline bool stands_still(const Wheelset *wheelset, const Parameters *p)
{
    return (double)wheelset->unchanged_cycles * p->cycle_time > p->stuck_time;
}

static inline bool is_lost(const Wheelset *wheelset, const Parameters *p)
{
    double doubtful_time = (double)wheelset->doubtful_cycles * p->cycle_time;
    return wheelset->speed_valid == 0 || doubtful_time > p->distrust_time;
}

static inline void regain_trust(Wheelset *wheelset, double reference, const Parameters *p)
{
    bool near = fabs(reference - wheelset->plausible_speed) <= p->recovery_share * slip_threshold_at(reference, p);
    wheelset->sound_cycles = near && wheelset->doubtful_cycles == 0 ? wheelset->sound_cycles + 1 : 0;
    if ((double)wheelset->sound_cycles * p->cycle_time > p->trust_time)
        wheelset->distrusted = 0;
}

static inline void watch(Wheelset *wheelsets, double reference, const Parameters *p)
{
    int changing = 0;
    for (int i = 0; i < 4; i++)
        changing += wheelsets[i].distrusted == 0 && !stands_still(&wheelsets[i], p);
    for (int i = 0; i < 4; i++) {
        if ((changing >= 2 && stands_still(&wheelsets[i], p)) || is_lost(&wheelsets[i], p)) {
            wheelsets[i].distrusted = 1;
            wheelsets[i].sound_cycles = 0;
            wheelsets[i].doubtful_cycles = 0;
        } else if (wheelsets[i].distrusted == 1) {
            regain_trust(&wheelsets[i], reference, p);
        }
    }
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
        if (wheelsets[i].distrusted == 1)
            continue;
        if (wheelsets[i].doubtful_cycles == 0)
            fastest = maximum(fastest, wheelsets[i].plausible_speed);
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
    double slip = reference - wheelset->plausible_speed;
    double threshold = slip_threshold_at(reference, p);
    double time_in_mode = (double)(wheelset->mode_cycles + 1) * p->cycle_time;
    if (reference < p->minimum_speed || wheelset->distrusted == 1)
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
    if ((double)car->blind_cycles * p->cycle_time <= p->sounding_interval)
        return;
    for (int k = 1; k < 5; k++) {
        int64_t candidate = (car->probed + k) % 4;
        if (wheelsets[candidate].distrusted == 0) {
            car->probed = candidate;
            enter(&wheelsets[candidate], PROBING);
            return;
        }
    }
}

static inline void decide_by_threshold(Car *car, Wheelset *wheelsets, const Parameters *p)
{
    for (int i = 0; i < 4; i++)
        read_speed(&wheelsets[i], p);
    watch(wheelsets, car->reference_speed, p);
    estimate_speed(car, wheelsets, p);
    for (int i = 0; i < 4; i++)
        enter(&wheelsets[i], next_mode(&wheelsets[i], car->reference_speed, p));
    probe(car, wheelsets, p);
    for (int i = 0; i < 4; i++) {
        int other = i + 1 - 2 * (i % 2);
        wheelsets[i].valve_command = threshold_command(&wheelsets[wheelsets[i].distrusted ? other : i], p);
    }
}

#endif

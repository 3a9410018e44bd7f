/* The threshold controller of uictest in C: slip speed, relative slide and wheel acceleration choose fill,
 * hold or vent. It gives the commands of the built-in controller bit for bit.
 *
 * Each wheelset runs through modes. FREE fills. When its slip exceeds the threshold or its deceleration is
 * more than any wheel on a good rail can have, it VENTs until the wheel has stopped losing speed, then HOLDs
 * while the wheel catches up, and REFILLs in pulses until the brake is back at the demand. While all four
 * slide nothing shows the train's speed; after a while one of them is PROBING: vented until it rolls and
 * shows that speed.
 *
 * Readings beyond what a wheelset on a rail can do are rejected. A wheelset without a speed that can be
 * believed has no part in the estimate and gets the commands of the other wheelset of its bogie.
 *
 * It keeps version 2 of the contract: a dynamic brake is taken off before a valve vents, and comes back while it
 * refills.
 *
 * All thresholds are parameters of the scenario, in SI units: see threshold.yaml. Compile with
 * -ffp-contract=off, or some processors round a product and a sum at once and the last bits differ.
 */
#define UICTEST_ABI_VERSION 2
#include "uictest_controller.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WHEELSETS = UICTEST_WHEELSETS };
static const double TAKEN_OFF = 0.2, LEFT_OFF = 0.5; /* of a dynamic brake: no valve waits for less; refilling */

typedef struct {
    double cycle_time;                  /* s */
    double reference_deceleration;      /* fastest fall of the estimate of the train's speed, m/s2 */
    double minimum_speed;               /* estimate below which the brake is left alone, m/s */
    double slip_threshold;              /* slip speed from which a wheelset slides, m/s */
    double slide_threshold;             /* share of the estimate that is added to it */
    double deep_slide;                  /* relative slide beyond which a vent goes on until speed is gained */
    double vent_deceleration;           /* of a wheelset, beyond which it is vented, m/s2 */
    double hold_deceleration;           /* of a wheelset, below which a vent turns into a hold, m/s2 */
    double reacceleration_threshold;    /* of a wheelset, from which it regains speed, m/s2 */
    double acceleration_filter_time;    /* time constant, s */
    double holding_deceleration;        /* fall of the estimate while every wheelset slides, m/s2 */
    double rolling_time;                /* without a slide before a wheelset shows the train's speed, s */
    double sounding_interval;           /* without a rolling wheelset before one is probed, s */
    double sounding_time;               /* shortest vent of a probed wheelset, s */
    double recovery_share;              /* of the slip threshold, below which a wheelset has caught up */
    double vent_watchdog;               /* longest vent, s */
    double hold_limit;                  /* longest hold, s */
    double fill_pulse_on;               /* s */
    double fill_pulse_off;              /* s */
    double refill_time;                 /* of filling in pulses, s */
    double largest_acceleration;        /* change of speed that a wheelset can have, m/s2 */
    double jump_tolerance;              /* jump of a reading that is accepted besides, m/s */
    double distrust_time;               /* of more rejected than plausible readings before it has no speed, s */
    double stuck_time;                  /* without a change of the reading, likewise, s */
    double trust_time;                  /* of sound readings before it has one again, s */
} Parameters;

#define PARAMETER(name) {#name, offsetof(Parameters, name)}
static const struct {
    const char *name;
    size_t offset;
} PARAMETERS[] = {
    PARAMETER(reference_deceleration), PARAMETER(minimum_speed), PARAMETER(slip_threshold),
    PARAMETER(slide_threshold), PARAMETER(deep_slide), PARAMETER(vent_deceleration),
    PARAMETER(hold_deceleration), PARAMETER(reacceleration_threshold), PARAMETER(acceleration_filter_time),
    PARAMETER(holding_deceleration), PARAMETER(rolling_time), PARAMETER(sounding_interval),
    PARAMETER(sounding_time), PARAMETER(recovery_share), PARAMETER(vent_watchdog), PARAMETER(hold_limit),
    PARAMETER(fill_pulse_on), PARAMETER(fill_pulse_off), PARAMETER(refill_time),
    PARAMETER(largest_acceleration), PARAMETER(jump_tolerance), PARAMETER(distrust_time),
    PARAMETER(stuck_time), PARAMETER(trust_time),
};

typedef enum { FREE, VENTING, HOLDING, REFILLING, PROBING } Mode;

typedef struct {
    double reading;             /* of the speed sensor, m/s */
    bool valid;                 /* the sensor reports no fault */
    double speed;               /* newest plausible reading, m/s */
    int64_t rejected_cycles;    /* since that */
    int64_t doubtful_cycles;    /* by which rejected readings have outnumbered plausible ones */
    int64_t unchanged_cycles;   /* for which it has been the same */
    bool distrusted;            /* the wheelset counts as without a speed */
    int64_t sound_cycles;       /* of plausible readings near the estimate while it is distrusted */
    double acceleration;        /* low-pass filtered, m/s2 */
    Mode mode;
    int64_t mode_cycles;        /* since the mode began */
} Wheelset;

typedef struct {
    Parameters parameters;
    double initial_speed;       /* m/s */
    double reference_speed;     /* estimated speed of the train, m/s */
    int64_t blind_cycles;       /* since a wheelset last showed the train's speed */
    int probed;                 /* wheelset that was probed last */
    Wheelset wheelsets[WHEELSETS];
} Controller;

/* Why the last uictest_create of this thread failed: there is no controller yet to keep it. */
static _Thread_local char create_error[128];

static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }

/* ---- one wheelset ---- */

static double slip_threshold_at(double reference, const Parameters *p)
{
    return p->slip_threshold + p->slide_threshold * reference;
}

static double recovered_slip_at(double reference, const Parameters *p)
{
    return p->recovery_share * slip_threshold_at(reference, p);
}

/* Take over a plausible reading; the time since the one before, or 0 where it is rejected. */
static double take_over(Wheelset *wheelset, const Parameters *p)
{
    double elapsed = (double)(wheelset->rejected_cycles + 1) * p->cycle_time;
    double jump = fabs(wheelset->reading - wheelset->speed);
    if (!wheelset->valid || jump > p->jump_tolerance + p->largest_acceleration * elapsed) {
        wheelset->rejected_cycles += 1;
        wheelset->doubtful_cycles += 1;
        return 0.0;
    }
    bool still = jump == 0.0 && wheelset->reading > p->minimum_speed;
    wheelset->unchanged_cycles = still ? wheelset->unchanged_cycles + 1 : 0;
    wheelset->speed = wheelset->reading;
    wheelset->rejected_cycles = 0;
    if (wheelset->doubtful_cycles > 0)
        wheelset->doubtful_cycles -= 1;
    return elapsed;
}

/* Take over a plausible reading, differentiate it and filter the acceleration (first order). */
static void read_speed(Wheelset *wheelset, const Parameters *p)
{
    double before = wheelset->speed;
    double elapsed = take_over(wheelset, p);
    if (elapsed > 0.0) {
        double change = (wheelset->speed - before) / elapsed;
        double weight = p->cycle_time / (p->cycle_time + p->acceleration_filter_time);
        wheelset->acceleration += weight * (change - wheelset->acceleration);
    }
}

static bool stands_still(const Wheelset *wheelset, const Parameters *p)
{
    return (double)wheelset->unchanged_cycles * p->cycle_time > p->stuck_time;
}

static bool is_lost(const Wheelset *wheelset, const Parameters *p)
{
    return !wheelset->valid || (double)wheelset->doubtful_cycles * p->cycle_time > p->distrust_time;
}

static void regain_trust(Wheelset *wheelset, double reference, const Parameters *p)
{
    bool near = fabs(reference - wheelset->speed) <= recovered_slip_at(reference, p);
    wheelset->sound_cycles = near && wheelset->doubtful_cycles == 0 ? wheelset->sound_cycles + 1 : 0;
    if ((double)wheelset->sound_cycles * p->cycle_time > p->trust_time)
        wheelset->distrusted = false;
}

/* Whether a wheelset has been free for so long that it must roll. */
static bool rolls(const Wheelset *wheelset, const Parameters *p)
{
    return wheelset->mode == FREE && (double)wheelset->mode_cycles * p->cycle_time > p->rolling_time;
}

/* Whether a probed wheelset rolls: it gains no speed and loses no more than a train can. */
static bool shows_speed(const Wheelset *wheelset, const Parameters *p)
{
    double time_in_mode = (double)wheelset->mode_cycles * p->cycle_time;
    if (wheelset->mode != PROBING || time_in_mode < p->sounding_time)
        return false;
    bool gains = wheelset->acceleration > p->reacceleration_threshold;
    bool loses = wheelset->acceleration < -p->reference_deceleration;
    return !(gains || loses);
}

/* Whether the wheel slides: slip above the threshold without recovery, or an impossible fall. */
static bool slides(const Wheelset *wheelset, double slip, double threshold, const Parameters *p)
{
    bool losing = wheelset->acceleration < p->reacceleration_threshold;
    bool falling = wheelset->acceleration < -p->vent_deceleration;
    return (slip > threshold && losing) || falling;
}

/* The mode after a vent: hold once the wheel loses no more speed. In a deep slide it must gain speed first;
 * a locked wheel loses no speed either, and only goes on turning when it is vented further. */
static Mode after_venting(const Wheelset *wheelset, double slip, double reference, double time_in_mode,
                          const Parameters *p)
{
    bool deep = slip > p->deep_slide * reference;
    double enough = deep ? p->reacceleration_threshold : -p->hold_deceleration;
    if (wheelset->acceleration > enough)
        return HOLDING;
    return time_in_mode > p->vent_watchdog ? REFILLING : VENTING;
}

/* The mode after a hold: refill once the wheel has caught up, else vent again. */
static Mode after_holding(const Wheelset *wheelset, double slip, double reference, double time_in_mode,
                          const Parameters *p)
{
    if (slip < recovered_slip_at(reference, p))
        return REFILLING;
    bool deep = slip > p->deep_slide * reference;
    if (wheelset->acceleration < (deep ? 0.0 : -p->vent_deceleration))
        return VENTING;
    if (time_in_mode > p->hold_limit && wheelset->acceleration < p->reacceleration_threshold)
        return VENTING;
    return HOLDING;
}

static Mode next_mode(const Wheelset *wheelset, double reference, const Parameters *p)
{
    double slip = reference - wheelset->speed;
    double time_in_mode = (double)(wheelset->mode_cycles + 1) * p->cycle_time;
    if (reference < p->minimum_speed || wheelset->distrusted)
        return FREE;
    if (wheelset->mode == PROBING)
        return shows_speed(wheelset, p) || time_in_mode > p->vent_watchdog ? REFILLING : PROBING;
    if (wheelset->mode == VENTING)
        return after_venting(wheelset, slip, reference, time_in_mode, p);
    if (wheelset->mode == HOLDING)
        return after_holding(wheelset, slip, reference, time_in_mode, p);
    if (slides(wheelset, slip, slip_threshold_at(reference, p), p))
        return VENTING;
    return wheelset->mode == REFILLING && time_in_mode <= p->refill_time ? REFILLING : FREE;
}

static void enter(Wheelset *wheelset, Mode mode)
{
    wheelset->mode_cycles = mode == wheelset->mode ? wheelset->mode_cycles + 1 : 0;
    wheelset->mode = mode;
}

/* Whether a refilling wheelset is filled in this cycle: pulses of filling, with pauses. */
static bool fills(const Wheelset *wheelset, const Parameters *p)
{
    int64_t on = (int64_t)rint(p->fill_pulse_on / p->cycle_time);
    int64_t off = (int64_t)rint(p->fill_pulse_off / p->cycle_time);
    return wheelset->mode_cycles % (on + off) < on;
}

/* ---- the train ---- */

/* Decide which wheelsets have a speed. A reading that stands still is a fault only where those of two others
 * change: a single one may slide while the train runs on at one speed. */
static void watch(Controller *c)
{
    const Parameters *p = &c->parameters;
    int changing = 0;
    for (int i = 0; i < WHEELSETS; i++)
        changing += !c->wheelsets[i].distrusted && !stands_still(&c->wheelsets[i], p);
    for (int i = 0; i < WHEELSETS; i++) {
        Wheelset *wheelset = &c->wheelsets[i];
        if ((changing >= 2 && stands_still(wheelset, p)) || is_lost(wheelset, p)) {
            wheelset->distrusted = true;
            wheelset->sound_cycles = 0;
            wheelset->doubtful_cycles = 0;
        } else if (wheelset->distrusted) {
            regain_trust(wheelset, c->reference_speed, p);
        }
    }
}

/* Estimate the train's speed from the fastest wheelset that is trusted. While some wheelset rolls the estimate follows the
 * fastest one, falling at most as fast as a train can. While all of them slide it falls more slowly, so that
 * it does not sink with them; a probed wheelset then lowers it, at most to the speed that the train can have
 * reached by then. Only a wheelset that rolls shows that the train is too slow for protection. */
static void estimate_speed(Controller *c)
{
    const Parameters *p = &c->parameters;
    double fastest = 0.0;
    bool rolling = false, probed = false;
    for (int i = 0; i < WHEELSETS; i++) {
        if (c->wheelsets[i].distrusted)
            continue;
        if (c->wheelsets[i].doubtful_cycles == 0)
            fastest = larger(fastest, c->wheelsets[i].speed);
        rolling = rolling || rolls(&c->wheelsets[i], p);
        probed = probed || shows_speed(&c->wheelsets[i], p);
    }
    double fall = rolling ? p->reference_deceleration : p->holding_deceleration;
    double estimate = c->reference_speed - fall * p->cycle_time;
    if (probed) {
        double blind_time = (double)c->blind_cycles * p->cycle_time;
        estimate -= (p->reference_deceleration - p->holding_deceleration) * blind_time;
    }
    if (rolling || probed) {
        c->blind_cycles = 0;
    } else {
        c->blind_cycles += 1;
        estimate = larger(estimate, smaller(c->reference_speed, p->minimum_speed));
    }
    c->reference_speed = larger(fastest, estimate);
}

/* Start probing the next trusted wheelset when none has shown the train's speed for too long. */
static void probe(Controller *c)
{
    for (int i = 0; i < WHEELSETS; i++)
        if (c->wheelsets[i].mode == PROBING)
            return;
    if ((double)c->blind_cycles * c->parameters.cycle_time <= c->parameters.sounding_interval)
        return;
    for (int k = 1; k <= WHEELSETS; k++) {
        int candidate = (c->probed + k) % WHEELSETS;
        if (!c->wheelsets[candidate].distrusted) {
            c->probed = candidate;
            enter(&c->wheelsets[candidate], PROBING);
            return;
        }
    }
}

/* Share that a mode takes off the dynamic brake: all; LEFT_OFF and ever less while refilling. */
static double reduction(const Wheelset *wheelset, const Parameters *p)
{
    if (wheelset->mode == REFILLING) {
        double time_left = p->refill_time - wheelset->mode_cycles * p->cycle_time;
        return LEFT_OFF * larger(time_left / p->refill_time, 0.0);
    }
    return wheelset->mode == FREE ? 0.0 : 1.0;
}

/* ---- parameters ---- */

/* Read a number of a flat JSON object. */
static bool number(const char *json, const char *name, double *value)
{
    size_t length = strlen(name);
    for (const char *at = strstr(json, name); at != NULL; at = strstr(at + 1, name)) {
        if (at == json || at[-1] != '"' || at[length] != '"')
            continue;
        at += length + 1;
        at += strspn(at, " \t\r\n");
        if (*at != ':')
            continue;
        char *end;
        *value = strtod(at + 1, &end);
        return end != at + 1;
    }
    return false;
}

static bool read_parameters(Parameters *p, const char *json)
{
    for (size_t i = 0; i < sizeof PARAMETERS / sizeof *PARAMETERS; i++) {
        double *value = (double *)((char *)p + PARAMETERS[i].offset);
        if (!number(json, PARAMETERS[i].name, value)) {
            snprintf(create_error, sizeof create_error, "parameter %s is missing or not a number",
                     PARAMETERS[i].name);
            return false;
        }
    }
    if (p->fill_pulse_on < p->cycle_time) {
        snprintf(create_error, sizeof create_error, "fill_pulse_on is shorter than one cycle");
        return false;
    }
    return true;
}

/* ---- what uictest calls ---- */

uint32_t uictest_abi_version(void) { return UICTEST_ABI_VERSION; }

const char *uictest_version(void) { return "1.0"; }

void *uictest_create(const uictest_config *config)
{
    Controller *c = calloc(1, sizeof *c);
    create_error[0] = '\0';
    if (c == NULL) {
        snprintf(create_error, sizeof create_error, "no memory");
        return NULL;
    }
    c->parameters.cycle_time = config->cycle_time;
    c->initial_speed = config->initial_speed;
    if (!read_parameters(&c->parameters, config->parameters)) {
        free(c);
        return NULL;
    }
    uictest_reset(c);
    return c;
}

int32_t uictest_reset(void *controller)
{
    Controller *c = controller;
    c->reference_speed = c->initial_speed;
    c->blind_cycles = 0;
    c->probed = WHEELSETS - 1;
    for (int i = 0; i < WHEELSETS; i++)
        c->wheelsets[i] = (Wheelset){.speed = c->initial_speed, .mode = FREE};
    return 0;
}

int32_t uictest_step(void *controller, const uictest_inputs *inputs, uictest_outputs *outputs)
{
    Controller *c = controller;
    const Parameters *p = &c->parameters;
    for (int i = 0; i < WHEELSETS; i++) {
        c->wheelsets[i].reading = inputs->wheel_speed[i];
        c->wheelsets[i].valid = inputs->speed_valid[i] != 0;
        read_speed(&c->wheelsets[i], p);
    }
    watch(c);
    estimate_speed(c);
    for (int i = 0; i < WHEELSETS; i++)
        enter(&c->wheelsets[i], next_mode(&c->wheelsets[i], c->reference_speed, p));
    probe(c);
    for (int i = 0; i < WHEELSETS; i++) {
        int other = i + 1 - 2 * (i % 2);
        const Wheelset *wheelset = &c->wheelsets[c->wheelsets[i].distrusted ? other : i];
        bool vents = wheelset->mode == VENTING || wheelset->mode == PROBING;
        bool pause = wheelset->mode == REFILLING && !fills(wheelset, p);
        outputs->hold[i] = vents || wheelset->mode == HOLDING || pause;
        outputs->vent[i] = vents && inputs->dynamic_brake[i] <= TAKEN_OFF;
        outputs->dynamic_reduction[i] = reduction(wheelset, p);
    }
    outputs->reference_speed = c->reference_speed;
    return 0;
}

void uictest_destroy(void *controller) { free(controller); }

const char *uictest_last_error(void *controller) { return controller == NULL ? create_error : NULL; }

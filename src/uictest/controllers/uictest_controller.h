/* A wheel-slide-protection controller for uictest, in C.
 *
 * A controller is a shared library that exports the functions below (`uictest_version` and
 * `uictest_parameters` may be left out). uictest creates a controller for every stop, resets it, calls
 * `uictest_step` once per controller cycle, and destroys it. Several controllers of one library may live at the
 * same time, each used by one thread at a time: keep all memory in the controller, none in static variables.
 *
 *     gcc -O2 -fPIC -shared -o libwsp.so wsp.c        the header's folder: uictest init controller --c DIR
 *
 * Version 2 of the contract adds the dynamic brake: write `#define UICTEST_ABI_VERSION 2` before this header is
 * included. Without that, inputs and outputs are those of version 1, with which a dynamic brake drops at the
 * first hold or vent. SI units. Wheelset 0 is the leading one.
 */
#ifndef UICTEST_CONTROLLER_H
#define UICTEST_CONTROLLER_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef UICTEST_ABI_VERSION
#define UICTEST_ABI_VERSION 1
#endif
#define UICTEST_WHEELSETS 4

#if defined(_WIN32)
#define UICTEST_EXPORT __declspec(dllexport)
#else
#define UICTEST_EXPORT __attribute__((visibility("default")))
#endif

/* Given once, before a stop. Copy what you need: the memory is not kept. */
typedef struct {
    int32_t wheelsets;                          /* UICTEST_WHEELSETS */
    int32_t reserved;
    double cycle_time;                          /* s */
    double initial_speed;                       /* of the train at the brake command, m/s */
    double wheel_radius[UICTEST_WHEELSETS];     /* that wheel_speed is computed with, m */
    const char *parameters;                     /* `parameters` of the scenario, a JSON object in UTF-8 */
} uictest_config;

/* Read once per cycle, before the controller decides. */
typedef struct {
    int64_t cycle;                              /* 0 at the brake command */
    double time;                                /* cycle x cycle_time, s */
    double wheel_speed[UICTEST_WHEELSETS];      /* circumferential, as the sensor gives it, m/s */
    double cylinder_pressure[UICTEST_WHEELSETS];/* as the sensor gives it, gauge, Pa */
    double brake_demand;                        /* share of full service; a brake is demanded above 0 */
    int32_t speed_valid[UICTEST_WHEELSETS];     /* 0: the sensor reports a fault */
#if UICTEST_ABI_VERSION >= 2
    double dynamic_brake[UICTEST_WHEELSETS];    /* what the motor gives of what it could at its speed, 0 to 1 */
    double axle_load;                           /* of one axle at rest, N */
    double brake_command;                       /* share of full service, before the delays of the brake */
    double train_speed;                         /* from outside the wheelsets, m/s; 0 where it is not valid */
    double acceleration;                        /* by an accelerometer on the car, m/s2; 0 where it is not valid */
    int32_t train_speed_valid;                  /* 0: there is no such source, or it reports a fault */
    int32_t acceleration_valid;                 /* 0: there is no accelerometer */
#endif
} uictest_inputs;

/* Magnets of the WSP valves: hold 0 vent 0 fills, 1 0 holds, 1 1 vents; 0 1 is forbidden and ends the stop.
 * Before every call reference_speed is NaN, and all others are 0. */
typedef struct {
    double reference_speed;                     /* estimated speed of the train, m/s; NaN: none */
    int32_t hold[UICTEST_WHEELSETS];            /* 0 or 1 */
    int32_t vent[UICTEST_WHEELSETS];            /* 0 or 1 */
    uint32_t diagnosis;                         /* any bits; i, 8 + i, 16 + i, 24 + i report wheelset i (0 to 3) */
#if UICTEST_ABI_VERSION >= 2
    double dynamic_reduction[UICTEST_WHEELSETS];/* share that is taken off the dynamic brake, 0 to 1 */
    int32_t sand_request[UICTEST_WHEELSETS];    /* 0 or 1; obeyed by sanders with `when: requested` */
    int32_t track_brake_request;                /* 0 or 1; acts where the scenario has `when: requested` */
#endif
} uictest_outputs;

/* Return UICTEST_ABI_VERSION. */
UICTEST_EXPORT uint32_t uictest_abi_version(void);
/* Version of the controller for the reports, such as "2.1.0". May be left out. */
UICTEST_EXPORT const char *uictest_version(void);
/* The parameters that it knows, a JSON object: {"pause": {"default": 0.5, "unit": "s", "range": [0, 10]}}.
 * What a scenario gives besides, or beyond a range, ends the stop as an error. May be left out. */
UICTEST_EXPORT const char *uictest_parameters(void);
/* A controller with memory of its own, several of which may be in use, or NULL: uictest_last_error(NULL) says
 * why. */
UICTEST_EXPORT void *uictest_create(const uictest_config *config);
/* Return to the state after create. 0, or any other number: uictest_last_error says why. */
UICTEST_EXPORT int32_t uictest_reset(void *controller);
/* Decide on the coming cycle. 0, or any other number to end the stop: uictest_last_error says why. */
UICTEST_EXPORT int32_t uictest_step(void *controller, const uictest_inputs *inputs, uictest_outputs *outputs);
UICTEST_EXPORT void uictest_destroy(void *controller);
/* Why the last call failed, UTF-8, valid until the next call; NULL or "" if there is nothing to say. */
UICTEST_EXPORT const char *uictest_last_error(void *controller);

#ifdef __cplusplus
}
#endif

#endif

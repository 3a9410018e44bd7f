/* A first WSP controller: a band of slide around the speed of the fastest wheelset.
 *
 * It fills the brake cylinder of a wheelset below a lower slide, vents it above an upper one, and holds its
 * pressure between them. Every number is a parameter in my-wsp.yaml; none of them is tuned.
 *
 *     make        or: gcc -O2 -fPIC -shared -o libwsp.so wsp.c
 */
#include "uictest_controller.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    uictest_config config;
    double lower_slide, upper_slide;                    /* 1 */
    double reference_deceleration, blind_deceleration;  /* m/s2 */
    double minimum_speed;                               /* m/s */
    double longest_vent, pause;                         /* s */
    double reference_speed;                             /* m/s */
    double vented_for[UICTEST_WHEELSETS];               /* s */
} wsp;

static char reason[100];                                /* why uictest_create has failed */

/* Read one number of a flat JSON object; for nested parameters link a JSON library. */
static int read_number(const char *json, const char *name, double *value) {
    char key[80], *end;
    snprintf(key, sizeof key, "\"%s\":", name);
    const char *place = strstr(json, key);
    if (place == NULL) {
        snprintf(reason, sizeof reason, "parameter %s is missing", name);
        return 0;
    }
    place += strlen(key);
    *value = strtod(place, &end);
    if (end == place) {
        snprintf(reason, sizeof reason, "parameter %s is no number", name);
        return 0;
    }
    return 1;
}

uint32_t uictest_abi_version(void) { return UICTEST_ABI_VERSION; }

const char *uictest_version(void) { return "0.1.0"; }

void *uictest_create(const uictest_config *config) {
    const char *json = config->parameters;
    wsp *self = calloc(1, sizeof *self);
    if (self == NULL) return NULL;
    self->config = *config;
    self->config.parameters = NULL;                     /* its memory is not kept */
    if (read_number(json, "lower_slide", &self->lower_slide) &&
        read_number(json, "upper_slide", &self->upper_slide) &&
        read_number(json, "reference_deceleration", &self->reference_deceleration) &&
        read_number(json, "blind_deceleration", &self->blind_deceleration) &&
        read_number(json, "minimum_speed", &self->minimum_speed) &&
        read_number(json, "longest_vent", &self->longest_vent) &&
        read_number(json, "pause", &self->pause)) {
        uictest_reset(self);
        return self;
    }
    free(self);
    return NULL;
}

int32_t uictest_reset(void *controller) {
    wsp *self = controller;
    self->reference_speed = self->config.initial_speed;
    memset(self->vented_for, 0, sizeof self->vented_for);
    return 0;
}

/* Follow the fastest wheelset; fall no faster than a train can, and slower while all of them slide. */
static void estimate_speed(wsp *self, const uictest_inputs *inputs) {
    double fastest = 0.0;
    for (int i = 0; i < UICTEST_WHEELSETS; i++)
        if (inputs->speed_valid[i] && inputs->wheel_speed[i] > fastest) fastest = inputs->wheel_speed[i];
    int one_rolls = fastest > self->reference_speed * (1.0 - self->lower_slide);
    double fall = one_rolls ? self->reference_deceleration : self->blind_deceleration;
    double estimate = self->reference_speed - fall * self->config.cycle_time;
    self->reference_speed = fastest > estimate ? fastest : estimate;
}

/* Vent; after a long vent fill for a while, so that no wheelset loses its brake for ever. */
static void vent_with_watchdog(wsp *self, int i, uictest_outputs *outputs) {
    self->vented_for[i] += self->config.cycle_time;
    if (self->vented_for[i] > self->longest_vent + self->pause) self->vented_for[i] = 0.0;
    outputs->hold[i] = outputs->vent[i] = self->vented_for[i] <= self->longest_vent;
}

/* Set the magnets of one wheelset; both are 0 before, which fills. */
static void set_magnets(wsp *self, int i, const uictest_inputs *inputs, uictest_outputs *outputs) {
    double reference = self->reference_speed;
    double base = reference > self->minimum_speed ? reference : self->minimum_speed;
    double slide = (reference - inputs->wheel_speed[i]) / base;
    if (!inputs->speed_valid[i] || reference <= self->minimum_speed || slide < self->lower_slide)
        self->vented_for[i] = 0.0;
    else if (slide < self->upper_slide)
        outputs->hold[i] = 1;
    else
        vent_with_watchdog(self, i, outputs);
}

int32_t uictest_step(void *controller, const uictest_inputs *inputs, uictest_outputs *outputs) {
    wsp *self = controller;
    estimate_speed(self, inputs);
    for (int i = 0; i < UICTEST_WHEELSETS; i++) set_magnets(self, i, inputs, outputs);
    outputs->reference_speed = self->reference_speed;
    return 0;
}

void uictest_destroy(void *controller) { free(controller); }

const char *uictest_last_error(void *controller) { return controller == NULL ? reason : ""; }

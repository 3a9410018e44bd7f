/* A WSP controller in C: it fills below a lower slide, vents above an upper one and holds between them.
 *
 * serve.c makes a program at a socket of it. As a library it gives the same answers:
 *
 *     gcc -O2 -ffp-contract=off -fPIC -shared -IFOLDER -o libwsp.so wsp.c
 */
#include "uictest_controller.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    double cycle_time;                  /* s */
    double initial_speed, minimum_speed, reference_speed;  /* m/s */
    double reference_deceleration;      /* m/s2 */
    double lower_slide, upper_slide;
} wsp;

static double parameter(const char *json, const char *key, double otherwise) {
    const char *at = strstr(json, key);
    return at ? strtod(at + strlen(key) + 2, NULL) : otherwise;            /* behind `": ` */
}

uint32_t uictest_abi_version(void) { return UICTEST_ABI_VERSION; }
const char *uictest_version(void) { return "slip band in C 1.0"; }

void *uictest_create(const uictest_config *config) {
    const char *json = config->parameters;
    wsp *self = calloc(1, sizeof *self);
    if (self == NULL) return NULL;
    self->cycle_time = config->cycle_time;
    self->initial_speed = config->initial_speed;
    self->reference_deceleration = parameter(json, "reference_deceleration", 1.8);
    self->minimum_speed = parameter(json, "minimum_speed", 5 / 3.6);
    self->lower_slide = parameter(json, "lower_slide", 0.08);
    self->upper_slide = parameter(json, "upper_slide", 0.20);
    return self;
}

int32_t uictest_reset(void *controller) {
    wsp *self = controller;
    self->reference_speed = self->initial_speed;
    return 0;
}

int32_t uictest_step(void *controller, const uictest_inputs *inputs, uictest_outputs *outputs) {
    wsp *self = controller;
    double reference = self->reference_speed - self->reference_deceleration * self->cycle_time;
    for (int i = 0; i < UICTEST_WHEELSETS; i++)
        if (inputs->wheel_speed[i] > reference) reference = inputs->wheel_speed[i];
    double least = reference > self->minimum_speed ? reference : self->minimum_speed;
    for (int i = 0; i < UICTEST_WHEELSETS; i++) {
        double slide = (reference - inputs->wheel_speed[i]) / least;
        outputs->hold[i] = reference >= self->minimum_speed && slide >= self->lower_slide;
        outputs->vent[i] = outputs->hold[i] && slide > self->upper_slide;
    }
    self->reference_speed = outputs->reference_speed = reference;
    return 0;
}

void uictest_destroy(void *controller) { free(controller); }

const char *uictest_last_error(void *controller) { return controller == NULL ? "no memory" : ""; }

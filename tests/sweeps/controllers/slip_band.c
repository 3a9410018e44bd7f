/* The built-in controller slip-band in C; with the parameter fails_at it fails in that cycle. */
#include "uictest_controller.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    double reference_deceleration, minimum_speed, lower_slide, upper_slide, fails_at;
    double cycle_time, initial_speed, reference_speed;
} Controller;

static double number(const char *parameters, const char *name, double otherwise)
{
    const char *found = strstr(parameters, name);
    return found ? strtod(found + strlen(name), NULL) : otherwise;
}

uint32_t uictest_abi_version(void) { return UICTEST_ABI_VERSION; }

const char *uictest_parameters(void)
{
    return "{\"reference_deceleration\": {}, \"minimum_speed\": {}, \"lower_slide\": {}, \"upper_slide\": {},"
           " \"fails_at\": {\"default\": -1}}";
}

void *uictest_create(const uictest_config *config)
{
    Controller *controller = calloc(1, sizeof *controller);
    controller->reference_deceleration = number(config->parameters, "\"reference_deceleration\": ", 1.8);
    controller->minimum_speed = number(config->parameters, "\"minimum_speed\": ", 5.0 / 3.6);
    controller->lower_slide = number(config->parameters, "\"lower_slide\": ", 0.08);
    controller->upper_slide = number(config->parameters, "\"upper_slide\": ", 0.2);
    controller->fails_at = number(config->parameters, "\"fails_at\": ", -1.0);
    controller->cycle_time = config->cycle_time;
    controller->initial_speed = config->initial_speed;
    return controller;
}

int32_t uictest_reset(void *handle)
{
    Controller *controller = handle;
    controller->reference_speed = controller->initial_speed;
    return 0;
}

static double larger(double a, double b) { return a > b ? a : b; }

int32_t uictest_step(void *handle, const uictest_inputs *inputs, uictest_outputs *outputs)
{
    Controller *own = handle;
    if ((double)inputs->cycle == own->fails_at)
        return 1;
    double reference = own->reference_speed - own->reference_deceleration * own->cycle_time;
    for (int i = 0; i < UICTEST_WHEELSETS; i++)
        reference = larger(reference, inputs->wheel_speed[i]);
    own->reference_speed = outputs->reference_speed = reference;
    for (int i = 0; i < UICTEST_WHEELSETS; i++) {
        double slide = (reference - inputs->wheel_speed[i]) / larger(reference, own->minimum_speed);
        if (reference < own->minimum_speed || slide < own->lower_slide)
            continue;
        outputs->hold[i] = 1;
        outputs->vent[i] = slide > own->upper_slide;
    }
    return 0;
}

void uictest_destroy(void *handle) { free(handle); }

const char *uictest_last_error(void *handle) { return handle ? "told to" : ""; }

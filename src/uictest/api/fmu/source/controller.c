/* A controller behind uictest_controller.h, in the shared library that lies beside this one. One of version 1
 * reads and writes the first part of inputs and outputs. */
#define _GNU_SOURCE
#define UICTEST_ABI_VERSION 2
#include "instance.h"

#include <dlfcn.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "given.h"
#include "uictest_controller.h"

static struct {
    void *(*create)(const uictest_config *);
    int32_t (*reset)(void *);
    int32_t (*step)(void *, const uictest_inputs *, uictest_outputs *);
    void (*destroy)(void *);
    const char *(*last_error)(void *);
} program;
static const char *why_not_loaded = "the folder of the FMU is not known";

/* What stands in the JSON object of the parameters: a key before its number or truth value, or both. */
typedef struct {
    enum { NUMBER, TRUTH, FIXED, END } form;
    const char *text;
    size_t offset;
} Given;
static const Given GIVEN[] = {GIVEN_ROWS};

/* Load the controller together with this library, by its whole path: another FMU has another one. */
__attribute__((constructor)) static void load(void)
{
    static char reason[300];
    char path[PATH_MAX];
    Dl_info own;
    if (!dladdr(&program, &own) || strrchr(own.dli_fname, '/') == NULL)
        return;
    int length = (int)(strrchr(own.dli_fname, '/') + 1 - own.dli_fname);
    snprintf(path, sizeof path, "%.*s%s", length, own.dli_fname, LIBRARY);
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        snprintf(reason, sizeof reason, "the controller cannot be loaded: %s", dlerror());
        why_not_loaded = reason;
        return;
    }
    *(void **)&program.create = dlsym(library, "uictest_create");
    *(void **)&program.reset = dlsym(library, "uictest_reset");
    *(void **)&program.step = dlsym(library, "uictest_step");
    *(void **)&program.destroy = dlsym(library, "uictest_destroy");
    *(void **)&program.last_error = dlsym(library, "uictest_last_error");
    why_not_loaded = NULL;
}

const char *why_not_on_this_machine(void) { return why_not_loaded; }

double cycle_time(const Instance *instance)
{
    return *(const double *)((const unsigned char *)instance->state.memory + CYCLE_TIME_AT);
}

void set_start_values(Instance *instance) { memcpy(at(instance, 0), START, sizeof START); }

void begin(Instance *instance) { (void)instance; }

static int failed(Instance *instance, const char *function)
{
    const char *reason = program.last_error(instance->controller);
    return fail(instance, "%s failed: %s", function, reason && *reason ? reason : "no reason given");
}

/* Write the parameters as the JSON object that a controller is given; 17 digits keep every bit. */
static void write_json(Instance *instance, char *json)
{
    const char *comma = "";
    *json++ = '{';
    for (const Given *given = GIVEN; given->form != END; given++, comma = ", ") {
        double value = *(double *)at(instance, given->offset);
        if (given->form == FIXED)
            json += sprintf(json, "%s%s", comma, given->text);
        else if (given->form == TRUTH)
            json += sprintf(json, "%s%s%s", comma, given->text, value != 0.0 ? "true" : "false");
        else
            json += sprintf(json, "%s%s%.17g", comma, given->text, value);
    }
    strcpy(json, "}");
}

static int create(Instance *instance)
{
    char json[LONGEST_JSON];
    uictest_config config = {
        .wheelsets = UICTEST_WHEELSETS,
        .cycle_time = cycle_time(instance),
        .initial_speed = *(double *)at(instance, INITIAL_SPEED_AT),
        .parameters = json,
    };
    memcpy(config.wheel_radius, at(instance, WHEEL_RADIUS_AT), sizeof config.wheel_radius);
    write_json(instance, json);
    instance->controller = program.create(&config);
    if (instance->controller == NULL)
        return failed(instance, "uictest_create");
    return program.reset(instance->controller) == 0 || failed(instance, "uictest_reset");
}

int complete(Instance *instance)
{
    /* Numbers have a decimal point here, whatever the language of the program that runs the FMU. */
    locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0), before = uselocale(plain);
    int succeeded = create(instance);
    uselocale(before);
    freelocale(plain);
    return succeeded;
}

int carry_out(Instance *instance)
{
    uictest_inputs *inputs = at(instance, INPUTS_AT);
    uictest_outputs *outputs = at(instance, OUTPUTS_AT);
    inputs->cycle = instance->state.steps;
    inputs->time = (double)instance->state.steps * cycle_time(instance);
    memset(outputs, 0, sizeof *outputs);
    outputs->reference_speed = NAN;
    return program.step(instance->controller, inputs, outputs) == 0
        || failed(instance, "uictest_step");
}

void release(Instance *instance)
{
    if (instance->controller != NULL)
        program.destroy(instance->controller);
    instance->controller = NULL;
}

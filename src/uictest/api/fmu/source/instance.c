#include "instance.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Share of a cycle by which time may differ from whole cycles; chosen: far above what adding up cycles as
 * floating-point numbers loses. */
#define TOLERANCE 1e-3

static const Variable VARIABLES[] = {VARIABLE_ROWS};

void *at(Instance *instance, size_t offset)
{
    return (unsigned char *)instance->state.memory + offset;
}

int fail(Instance *instance, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(instance->message, sizeof instance->message, format, arguments);
    va_end(arguments);
    return 0;
}

const char *why_unusable(const char *token)
{
    if (token == NULL || strcmp(token, TOKEN) != 0)
        return "the model description and the shared library are not of the same FMU";
    return why_not_on_this_machine();
}

Instance *create_instance(const char *name, void *environment, void (*logger)(void))
{
    Instance *instance = calloc(1, sizeof *instance);
    const char *own = name == NULL ? "" : name;
    if (instance == NULL)
        return NULL;
    instance->name = malloc(strlen(own) + 1);
    if (instance->name == NULL) {
        free(instance);
        return NULL;
    }
    strcpy(instance->name, own);
    instance->environment = environment;
    instance->logger = logger;
    reset_instance(instance);
    return instance;
}

void free_instance(Instance *instance)
{
    if (instance == NULL)
        return;
    release(instance);
    free(instance->name);
    free(instance);
}

void reset_instance(Instance *instance)
{
    release(instance);
    memset(&instance->state, 0, sizeof instance->state);
    set_start_values(instance);
}

double instance_time(const Instance *instance)
{
    return instance->state.start_time + (double)instance->state.steps * cycle_time(instance);
}

int enter_initialization(Instance *instance, double start_time)
{
    if (instance->state.phase != INSTANTIATED)
        return fail(instance, "initialization can only be entered once, after instantiation or reset");
    instance->state.start_time = start_time;
    *(double *)at(instance, TIME_AT) = start_time;
    instance->state.phase = INITIALIZING;
    begin(instance);
    return 1;
}

int exit_initialization(Instance *instance)
{
    if (instance->state.phase != INITIALIZING)
        return fail(instance, "initialization can only be left after it was entered");
    if (!complete(instance))
        return 0;
    instance->state.phase = STEPPING;
    return 1;
}

int terminate(Instance *instance)
{
    instance->state.phase = TERMINATED;
    return 1;
}

int step_instance(Instance *instance, double communication_point, double step_size)
{
    double cycle = cycle_time(instance), now = instance_time(instance);
    if (instance->state.phase != STEPPING)
        return fail(instance, "a step can only be taken between initialization and termination");
    if (!(fabs(step_size - cycle) <= TOLERANCE * cycle))
        return fail(instance, "the communication step is %g s; it must be the controller cycle, %g s", step_size,
                    cycle);
    if (!(fabs(communication_point - now) <= TOLERANCE * cycle))
        return fail(instance, "the communication point is %g s; the last step ended at %g s", communication_point,
                    now);
    if (!carry_out(instance))
        return 0;
    instance->state.steps += 1;
    *(double *)at(instance, TIME_AT) = instance_time(instance);
    return 1;
}

static const Variable *variable(Instance *instance, uint32_t reference, Kind kind)
{
    if (reference < sizeof VARIABLES / sizeof *VARIABLES && VARIABLES[reference].kind == kind)
        return &VARIABLES[reference];
    fail(instance, "no variable of this type has the value reference %u", (unsigned)reference);
    return NULL;
}

int get_value(Instance *instance, uint32_t reference, Kind kind, double *value)
{
    const Variable *found = variable(instance, reference, kind);
    if (found == NULL)
        return 0;
    switch (found->storage) {
    case FLOAT64: *value = *(double *)at(instance, found->offset); break;
    case INT32: *value = *(int32_t *)at(instance, found->offset); break;
    case INT64: *value = (double)*(int64_t *)at(instance, found->offset); break;
    }
    return 1;
}

static void store(Instance *instance, const Variable *variable, double value)
{
    switch (variable->storage) {
    case FLOAT64: *(double *)at(instance, variable->offset) = value; break;
    case INT32: *(int32_t *)at(instance, variable->offset) = (int32_t)value; break;
    case INT64: *(int64_t *)at(instance, variable->offset) = (int64_t)value; break;
    }
}

static int set_parameter(Instance *instance, const Variable *parameter, double value)
{
    if (instance->state.phase != INSTANTIATED && instance->state.phase != INITIALIZING)
        return fail(instance, "a parameter can only be set before the end of the initialization");
    if (!(value >= parameter->lowest && value <= parameter->highest))
        return fail(instance, "%s is %.15g, expected a number from %.15g to %.15g", parameter->name, value,
                    parameter->lowest, parameter->highest);
    store(instance, parameter, value);
    if (instance->state.phase == INITIALIZING)
        begin(instance);
    return 1;
}

int set_value(Instance *instance, uint32_t reference, Kind kind, double value)
{
    const Variable *found = variable(instance, reference, kind);
    if (found == NULL)
        return 0;
    if (kind == BOOLEAN)
        value = value != 0.0;
    if (found->causality == PARAMETER)
        return set_parameter(instance, found, value);
    if (found->causality != INPUT)
        return fail(instance, "the variable with value reference %u cannot be set", (unsigned)reference);
    store(instance, found, value);
    return 1;
}

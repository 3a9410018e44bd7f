#include "rig.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Share of a cycle by which time may differ from whole cycles; chosen: far above what adding up cycles as
 * floating-point numbers loses. */
#define TOLERANCE 1e-3
#define LARGEST_SEED 4294967295.0

static unsigned char *at(Rig *rig, size_t offset)
{
    return (unsigned char *)rig->state.memory + offset;
}

static int64_t *whole_number_at(Rig *rig, size_t offset)
{
    return (int64_t *)at(rig, offset);
}

static int32_t *magnets_at(Rig *rig, size_t offset)
{
    return (int32_t *)at(rig, offset);
}

int fail(Rig *rig, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(rig->message, sizeof rig->message, format, arguments);
    va_end(arguments);
    return 0;
}

const char *why_unusable(const char *token)
{
    if (token == NULL || strcmp(token, TOKEN) != 0)
        return "the model description and the shared library are not of the same FMU";
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") || !__builtin_cpu_supports("bmi2"))
        return "this FMU needs a processor with AVX2, FMA and BMI2 (x86-64-v3)";
#endif
    return NULL;
}

Rig *create_rig(const char *name, void *environment, void (*logger)(void))
{
    Rig *rig = calloc(1, sizeof *rig);
    const char *own = name == NULL ? "" : name;
    if (rig == NULL)
        return NULL;
    rig->name = malloc(strlen(own) + 1);
    if (rig->name == NULL) {
        free(rig);
        return NULL;
    }
    strcpy(rig->name, own);
    rig->environment = environment;
    rig->logger = logger;
    reset_rig(rig);
    return rig;
}

void free_rig(Rig *rig)
{
    if (rig != NULL)
        free(rig->name);
    free(rig);
}

void reset_rig(Rig *rig)
{
    memset(&rig->state, 0, sizeof rig->state);
    memcpy(at(rig, PARAMETERS_AT), PARAMETERS, sizeof PARAMETERS);
}

/* Begin the stop: zeroed, the memory is a stop that has not begun. */
static void begin(Rig *rig)
{
    uint64_t parameters[sizeof PARAMETERS / 8];
    memcpy(parameters, at(rig, PARAMETERS_AT), sizeof parameters);
    memset(at(rig, 0), 0, STOP_SIZE);
    memcpy(at(rig, PARAMETERS_AT), parameters, sizeof parameters);
    CARRY_OUT(at(rig, 0));
}

int enter_initialization(Rig *rig, double start_time)
{
    if (rig->state.phase != INSTANTIATED)
        return fail(rig, "initialization can only be entered once, after instantiation or reset");
    rig->state.start_time = start_time;
    *(double *)at(rig, TIME_AT) = start_time;
    rig->state.phase = INITIALIZING;
    begin(rig);
    return 1;
}

int exit_initialization(Rig *rig)
{
    if (rig->state.phase != INITIALIZING)
        return fail(rig, "initialization can only be left after it was entered");
    rig->state.phase = STEPPING;
    return 1;
}

int terminate(Rig *rig)
{
    rig->state.phase = TERMINATED;
    return 1;
}

static int has_ended(Rig *rig)
{
    return *(double *)at(rig, STOPPED_AT) != 0.0
        || *whole_number_at(rig, CYCLE_AT) >= *whole_number_at(rig, LONGEST_STOP_AT);
}

static int command_valves(Rig *rig)
{
    const int32_t *hold = magnets_at(rig, HOLD_AT), *vent = magnets_at(rig, VENT_AT);
    for (int i = 0; i < 4; i++)
        if (vent[i] > hold[i])
            return fail(rig, "vent_%d without hold_%d is forbidden: both are true in order to vent", i + 1, i + 1);
    memcpy(at(rig, COMMANDED_HOLD_AT), hold, 4 * sizeof *hold);
    memcpy(at(rig, COMMANDED_VENT_AT), vent, 4 * sizeof *vent);
    return 1;
}

int step_rig(Rig *rig, double communication_point, double step_size)
{
    double now = rig->state.start_time + (double)rig->state.steps * CYCLE_TIME;
    if (rig->state.phase != STEPPING)
        return fail(rig, "a step can only be taken between initialization and termination");
    if (!(fabs(step_size - CYCLE_TIME) <= TOLERANCE * CYCLE_TIME))
        return fail(rig, "the communication step is %g s; it must be the controller cycle, %g s", step_size,
                    CYCLE_TIME);
    if (!(fabs(communication_point - now) <= TOLERANCE * CYCLE_TIME))
        return fail(rig, "the communication point is %g s; the last step ended at %g s", communication_point, now);
    if (!has_ended(rig)) {
        if (!command_valves(rig))
            return 0;
        CARRY_OUT(at(rig, 0));
        *whole_number_at(rig, ENDED_AT) = has_ended(rig);
    }
    rig->state.steps += 1;
    *(double *)at(rig, TIME_AT) = rig->state.start_time + (double)rig->state.steps * CYCLE_TIME;
    return 1;
}

static const Variable *variable(Rig *rig, uint32_t reference, Kind kind)
{
    if (reference < sizeof VARIABLES / sizeof *VARIABLES && VARIABLES[reference].kind == kind)
        return &VARIABLES[reference];
    fail(rig, "no variable of this type has the value reference %u", (unsigned)reference);
    return NULL;
}

int get_value(Rig *rig, uint32_t reference, Kind kind, double *value)
{
    const Variable *found = variable(rig, reference, kind);
    if (found == NULL)
        return 0;
    switch (found->storage) {
    case FLOAT64: *value = *(double *)at(rig, found->offset); break;
    case INT32: *value = *magnets_at(rig, found->offset); break;
    case INT64: *value = (double)*whole_number_at(rig, found->offset); break;
    }
    return 1;
}

static int set_seed(Rig *rig, const Variable *seed, double value)
{
    if (rig->state.phase != INSTANTIATED && rig->state.phase != INITIALIZING)
        return fail(rig, "a parameter can only be set before the end of the initialization");
    if (!(value >= 0.0 && value <= LARGEST_SEED))
        return fail(rig, "seed is %.0f, expected a number from 0 to %.0f", value, LARGEST_SEED);
    *whole_number_at(rig, seed->offset) = (int64_t)value;
    if (rig->state.phase == INITIALIZING)
        begin(rig);
    return 1;
}

int set_value(Rig *rig, uint32_t reference, Kind kind, double value)
{
    const Variable *found = variable(rig, reference, kind);
    if (found == NULL)
        return 0;
    if (found->causality == PARAMETER)
        return set_seed(rig, found, value);
    if (found->causality != INPUT)
        return fail(rig, "the variable with value reference %u cannot be set", (unsigned)reference);
    *magnets_at(rig, found->offset) = value != 0.0;
    return 1;
}

/* The rig of one case: the machine code of its stop, which is linked with this file. */
#include "instance.h"

#include <string.h>

#include "case.h"

const char *why_not_on_this_machine(void)
{
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") || !__builtin_cpu_supports("bmi2"))
        return "this FMU needs a processor with AVX2, FMA and BMI2 (x86-64-v3)";
#endif
    return NULL;
}

double cycle_time(const Instance *instance)
{
    (void)instance;
    return CYCLE_TIME;
}

void set_start_values(Instance *instance) { memcpy(at(instance, PARAMETERS_AT), PARAMETERS, sizeof PARAMETERS); }

/* Begin the stop: zeroed, the memory is a stop that has not begun. */
void begin(Instance *instance)
{
    uint64_t parameters[sizeof PARAMETERS / 8];
    unsigned char *memory = at(instance, 0);
    memcpy(parameters, memory + PARAMETERS_AT, sizeof parameters);
    memset(memory, 0, STOP_SIZE);
    memcpy(memory + PARAMETERS_AT, parameters, sizeof parameters);
    CARRY_OUT(memory);
}

int complete(Instance *instance)
{
    (void)instance;
    return 1;
}

static int has_ended(Instance *instance)
{
    return *(double *)at(instance, STOPPED_AT) != 0.0
        || *(int64_t *)at(instance, CYCLE_AT) >= *(int64_t *)at(instance, LONGEST_STOP_AT);
}

static int command_valves(Instance *instance)
{
    const int32_t *hold = at(instance, HOLD_AT), *vent = at(instance, VENT_AT);
    for (int i = 0; i < 4; i++)
        if (vent[i] > hold[i])
            return fail(instance, "vent_%d without hold_%d is forbidden: both are true in order to vent", i + 1,
                        i + 1);
    memcpy(at(instance, COMMANDED_HOLD_AT), hold, 4 * sizeof *hold);
    memcpy(at(instance, COMMANDED_VENT_AT), vent, 4 * sizeof *vent);
    return 1;
}

#if CONTRACT > 1
static int command_other_brakes(Instance *instance)
{
    const double *reduction = at(instance, REDUCTION_AT);
    for (int i = 0; i < 4; i++)
        if (!(reduction[i] >= 0.0 && reduction[i] <= 1.0))
            return fail(instance, "dynamic_reduction_%d is %g, expected 0 to 1", i + 1, reduction[i]);
    memcpy(at(instance, COMMANDED_REDUCTION_AT), reduction, 4 * sizeof *reduction);
    memcpy(at(instance, COMMANDED_SAND_AT), at(instance, SAND_AT), 4 * sizeof(int32_t));
    memcpy(at(instance, COMMANDED_TRACK_BRAKE_AT), at(instance, TRACK_BRAKE_AT), sizeof(int32_t));
    return 1;
}
#else
static int command_other_brakes(Instance *instance)
{
    (void)instance;
    return 1;
}
#endif

int carry_out(Instance *instance)
{
    unsigned char *memory = at(instance, 0);
    if (has_ended(instance))
        return 1;
    if (!command_valves(instance) || !command_other_brakes(instance))
        return 0;
    CARRY_OUT(memory);
    *(int64_t *)at(instance, ENDED_AT) = has_ended(instance);
    return 1;
}

void release(Instance *instance) { (void)instance; }

/* FMI 3.0 for co-simulation: https://fmi-standard.org. The declarations below are those of the standard. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "instance.h"

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef void *fmi3Instance;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef bool fmi3Boolean;
typedef const char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const uint8_t *fmi3Binary;
typedef bool fmi3Clock;
typedef int Enumeration; /* dependency kinds and interval qualifiers, which this FMU never has */
typedef void (*Logger)(void *, fmi3Status, fmi3String, fmi3String);
typedef void (*IntermediateUpdate)(void *, double, bool, bool, bool, bool, bool *, double *);

static void report(void *environment, Logger logger, fmi3String message)
{
    if (logger != NULL)
        logger(environment, fmi3Error, "logStatusError", message);
}

static fmi3Status status_of(Instance *instance, int succeeded)
{
    if (succeeded)
        return fmi3OK;
    report(instance->environment, (Logger)instance->logger, instance->message);
    return fmi3Error;
}

static fmi3Status not_supported(Instance *instance)
{
    return status_of(instance, fail(instance, "this FMU does not support the function"));
}

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[])
{
    (void)c, (void)on, (void)n, (void)categories; /* only errors are logged, and always */
    return fmi3OK;
}

EXPORT fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                                fmi3Boolean visible, fmi3Boolean on, fmi3Boolean event_mode,
                                                fmi3Boolean early_return, const fmi3ValueReference required[],
                                                size_t n_required, void *environment, Logger logger,
                                                IntermediateUpdate intermediate_update)
{
    const char *reason = why_unusable(token);
    (void)resources, (void)visible, (void)on, (void)event_mode, (void)early_return;
    (void)required, (void)n_required, (void)intermediate_update;
    if (reason != NULL) {
        report(environment, logger, reason);
        return NULL;
    }
    return create_instance(name, environment, (void (*)(void))logger);
}

EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                                 fmi3Boolean visible, fmi3Boolean on, void *environment,
                                                 Logger logger)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)on;
    report(environment, logger, "this FMU is one for co-simulation only");
    return NULL;
}

EXPORT fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                                      fmi3Boolean visible, fmi3Boolean on, void *environment,
                                                      Logger logger, void (*update)(void *), void (*lock)(void),
                                                      void (*unlock)(void))
{
    (void)name, (void)token, (void)resources, (void)visible, (void)on, (void)update, (void)lock, (void)unlock;
    report(environment, logger, "this FMU is one for co-simulation only");
    return NULL;
}

EXPORT void fmi3FreeInstance(fmi3Instance c) { free_instance(c); }

EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerance_defined, double tolerance,
                                              double start_time, fmi3Boolean stop_time_defined, double stop_time)
{
    (void)tolerance_defined, (void)tolerance, (void)stop_time_defined, (void)stop_time;
    return status_of(c, enter_initialization(c, start_time));
}

EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return status_of(c, exit_initialization(c)); }
EXPORT fmi3Status fmi3Terminate(fmi3Instance c) { return status_of(c, terminate(c)); }

EXPORT fmi3Status fmi3Reset(fmi3Instance c)
{
    reset_instance(c);
    return fmi3OK;
}

#define GET(NAME, TYPE, KIND)                                                                                 \
    EXPORT fmi3Status fmi3Get##NAME(fmi3Instance c, const fmi3ValueReference vr[], size_t n, TYPE value[],    \
                                    size_t n_values)                                                          \
    {                                                                                                         \
        double number;                                                                                        \
        for (size_t i = 0; i < n && i < n_values; i++) {                                                      \
            if (!get_value(c, vr[i], KIND, &number))                                                          \
                return status_of(c, 0);                                                                       \
            value[i] = (TYPE)number;                                                                          \
        }                                                                                                     \
        return fmi3OK;                                                                                        \
    }
#define SET(NAME, TYPE, KIND)                                                                                 \
    EXPORT fmi3Status fmi3Set##NAME(fmi3Instance c, const fmi3ValueReference vr[], size_t n,                  \
                                    const TYPE value[], size_t n_values)                                      \
    {                                                                                                         \
        for (size_t i = 0; i < n && i < n_values; i++)                                                        \
            if (!set_value(c, vr[i], KIND, (double)value[i]))                                                 \
                return status_of(c, 0);                                                                       \
        return fmi3OK;                                                                                        \
    }
GET(Float64, double, REAL)
GET(Int64, int64_t, INTEGER)
GET(Boolean, fmi3Boolean, BOOLEAN)
SET(Float64, double, REAL)
SET(Int64, int64_t, INTEGER)
SET(Boolean, fmi3Boolean, BOOLEAN)

EXPORT fmi3Status fmi3DoStep(fmi3Instance c, double communication_point, double step_size,
                             fmi3Boolean no_state_prior, fmi3Boolean *event_handling_needed,
                             fmi3Boolean *terminate_simulation, fmi3Boolean *early_return, double *last_time)
{
    int succeeded = step_instance(c, communication_point, step_size);
    (void)no_state_prior;
    *event_handling_needed = *terminate_simulation = *early_return = false;
    *last_time = instance_time(c);
    return status_of(c, succeeded);
}

EXPORT fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state)
{
    if (!CAN_SAVE)
        return not_supported(c);
    if (*state == NULL)
        *state = malloc(sizeof(State));
    if (*state == NULL)
        return status_of(c, fail(c, "there is no memory for the state"));
    memcpy(*state, &((Instance *)c)->state, sizeof(State));
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state)
{
    if (!CAN_SAVE)
        return not_supported(c);
    memcpy(&((Instance *)c)->state, state, sizeof(State));
    return fmi3OK;
}

EXPORT fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state)
{
    if (!CAN_SAVE)
        return not_supported(c);
    free(*state);
    *state = NULL;
    return fmi3OK;
}

/* Types that no variable has, and what the model description says this FMU cannot do. */
#pragma GCC diagnostic ignored "-Wunused-parameter"
#define UNSUPPORTED(NAME, ...)                                                                                \
    EXPORT fmi3Status NAME(fmi3Instance c, __VA_ARGS__) { return not_supported(c); }
#define NO_VARIABLE(NAME, TYPE)                                                                               \
    UNSUPPORTED(fmi3Get##NAME, const fmi3ValueReference vr[], size_t n, TYPE value[], size_t n_values)        \
    UNSUPPORTED(fmi3Set##NAME, const fmi3ValueReference vr[], size_t n, const TYPE value[], size_t n_values)
NO_VARIABLE(Float32, float)
NO_VARIABLE(Int8, int8_t)
NO_VARIABLE(UInt8, uint8_t)
NO_VARIABLE(Int16, int16_t)
NO_VARIABLE(UInt16, uint16_t)
NO_VARIABLE(Int32, int32_t)
NO_VARIABLE(UInt32, uint32_t)
NO_VARIABLE(UInt64, uint64_t)
NO_VARIABLE(String, fmi3String)
UNSUPPORTED(fmi3GetBinary, const fmi3ValueReference vr[], size_t n, size_t sizes[], fmi3Binary value[],
            size_t n_values)
UNSUPPORTED(fmi3SetBinary, const fmi3ValueReference vr[], size_t n, const size_t sizes[],
            const fmi3Binary value[], size_t n_values)
UNSUPPORTED(fmi3GetClock, const fmi3ValueReference vr[], size_t n, fmi3Clock value[])
UNSUPPORTED(fmi3SetClock, const fmi3ValueReference vr[], size_t n, const fmi3Clock value[])
UNSUPPORTED(fmi3GetNumberOfVariableDependencies, fmi3ValueReference vr, size_t *n)
UNSUPPORTED(fmi3GetVariableDependencies, fmi3ValueReference dependent, size_t dependent_elements[],
            fmi3ValueReference independents[], size_t independent_elements[], Enumeration kinds[], size_t n)
UNSUPPORTED(fmi3SerializedFMUStateSize, fmi3FMUState state, size_t *size)
UNSUPPORTED(fmi3SerializeFMUState, fmi3FMUState state, fmi3Byte bytes[], size_t size)
UNSUPPORTED(fmi3DeserializeFMUState, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
#define DERIVATIVE(NAME)                                                                                      \
    UNSUPPORTED(NAME, const fmi3ValueReference unknowns[], size_t n_unknowns,                                 \
                const fmi3ValueReference knowns[], size_t n_knowns, const double seed[], size_t n_seed,       \
                double sensitivity[], size_t n_sensitivity)
DERIVATIVE(fmi3GetDirectionalDerivative)
DERIVATIVE(fmi3GetAdjointDerivative)
UNSUPPORTED(fmi3GetIntervalDecimal, const fmi3ValueReference vr[], size_t n, double intervals[],
            Enumeration qualifiers[])
UNSUPPORTED(fmi3GetIntervalFraction, const fmi3ValueReference vr[], size_t n, uint64_t counters[],
            uint64_t resolutions[], Enumeration qualifiers[])
UNSUPPORTED(fmi3GetShiftDecimal, const fmi3ValueReference vr[], size_t n, double shifts[])
UNSUPPORTED(fmi3GetShiftFraction, const fmi3ValueReference vr[], size_t n, uint64_t counters[],
            uint64_t resolutions[])
UNSUPPORTED(fmi3SetIntervalDecimal, const fmi3ValueReference vr[], size_t n, const double intervals[])
UNSUPPORTED(fmi3SetIntervalFraction, const fmi3ValueReference vr[], size_t n, const uint64_t counters[],
            const uint64_t resolutions[])
UNSUPPORTED(fmi3SetShiftDecimal, const fmi3ValueReference vr[], size_t n, const double shifts[])
UNSUPPORTED(fmi3SetShiftFraction, const fmi3ValueReference vr[], size_t n, const uint64_t counters[],
            const uint64_t resolutions[])
UNSUPPORTED(fmi3UpdateDiscreteStates, fmi3Boolean *states_need_update, fmi3Boolean *terminate_simulation,
            fmi3Boolean *nominals_changed, fmi3Boolean *values_changed, fmi3Boolean *next_event_defined,
            double *next_event_time)
UNSUPPORTED(fmi3GetOutputDerivatives, const fmi3ValueReference vr[], size_t n, const int32_t orders[],
            double value[], size_t n_values)
/* Functions of other interface types, which importing tools may look up nevertheless. */
UNSUPPORTED(fmi3CompletedIntegratorStep, fmi3Boolean no_state_prior, fmi3Boolean *enter_event_mode,
            fmi3Boolean *terminate_simulation)
UNSUPPORTED(fmi3SetTime, double time)
UNSUPPORTED(fmi3SetContinuousStates, const double states[], size_t n)
UNSUPPORTED(fmi3GetContinuousStateDerivatives, double derivatives[], size_t n)
UNSUPPORTED(fmi3GetEventIndicators, double indicators[], size_t n)
UNSUPPORTED(fmi3GetContinuousStates, double states[], size_t n)
UNSUPPORTED(fmi3GetNominalsOfContinuousStates, double nominals[], size_t n)
UNSUPPORTED(fmi3GetNumberOfEventIndicators, size_t *n)
UNSUPPORTED(fmi3GetNumberOfContinuousStates, size_t *n)
UNSUPPORTED(fmi3ActivateModelPartition, fmi3ValueReference clock, double time)
#define UNSUPPORTED_MODE(NAME)                                                                                \
    EXPORT fmi3Status NAME(fmi3Instance c) { return not_supported(c); }
UNSUPPORTED_MODE(fmi3EnterEventMode)
UNSUPPORTED_MODE(fmi3EnterStepMode)
UNSUPPORTED_MODE(fmi3EnterContinuousTimeMode)
UNSUPPORTED_MODE(fmi3EnterConfigurationMode)
UNSUPPORTED_MODE(fmi3ExitConfigurationMode)
UNSUPPORTED_MODE(fmi3EvaluateDiscreteStates)

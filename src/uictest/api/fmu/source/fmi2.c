/* FMI 2.0 for co-simulation: https://fmi-standard.org. The declarations below are those of the standard. */
#include <stdlib.h>
#include <string.h>

#include "instance.h"

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;
typedef void *fmi2Component;
typedef void *fmi2FMUstate;
typedef unsigned fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef const char *fmi2String;
typedef char fmi2Byte;
typedef void (*Logger)(void *, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
typedef struct {
    Logger logger;
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(void *, fmi2Status);
    void *componentEnvironment;
} fmi2CallbackFunctions;

/* The logger takes the message for a format, in which a percent sign is written twice. */
static void report(void *environment, fmi2String name, Logger logger, fmi2String message)
{
    char format[2 * LONGEST_MESSAGE], *end = format;
    for (; *message != '\0' && end < format + sizeof format - 2; message++) {
        if (*message == '%')
            *end++ = '%';
        *end++ = *message;
    }
    *end = '\0';
    if (logger != NULL)
        logger(environment, name, fmi2Error, "logStatusError", format);
}

static fmi2Status status_of(Instance *instance, int succeeded)
{
    if (succeeded)
        return fmi2OK;
    report(instance->environment, instance->name, (Logger)instance->logger, instance->message);
    return fmi2Error;
}

static fmi2Status not_supported(Instance *instance)
{
    return status_of(instance, fail(instance, "this FMU does not support the function"));
}

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[])
{
    (void)c, (void)on, (void)n, (void)categories; /* only errors are logged, and always */
    return fmi2OK;
}

EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                     const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean on)
{
    Logger logger = functions == NULL ? NULL : functions->logger;
    void *environment = functions == NULL ? NULL : functions->componentEnvironment;
    const char *reason = type == fmi2CoSimulation ? why_unusable(guid) : "this FMU is one for co-simulation only";
    (void)resources, (void)visible, (void)on;
    if (reason != NULL) {
        report(environment, name, logger, reason);
        return NULL;
    }
    return create_instance(name, environment, (void (*)(void))logger);
}

EXPORT void fmi2FreeInstance(fmi2Component c) { free_instance(c); }

EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance,
                                      fmi2Real start_time, fmi2Boolean stop_time_defined, fmi2Real stop_time)
{
    (void)tolerance_defined, (void)tolerance, (void)stop_time_defined, (void)stop_time;
    ((Instance *)c)->state.start_time = start_time;
    return fmi2OK;
}

EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    return status_of(c, enter_initialization(c, ((Instance *)c)->state.start_time));
}

EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return status_of(c, exit_initialization(c)); }
EXPORT fmi2Status fmi2Terminate(fmi2Component c) { return status_of(c, terminate(c)); }

EXPORT fmi2Status fmi2Reset(fmi2Component c)
{
    reset_instance(c);
    return fmi2OK;
}

#define GET(NAME, TYPE, KIND)                                                                                 \
    EXPORT fmi2Status fmi2Get##NAME(fmi2Component c, const fmi2ValueReference vr[], size_t n, TYPE value[])   \
    {                                                                                                         \
        double number;                                                                                        \
        for (size_t i = 0; i < n; i++) {                                                                      \
            if (!get_value(c, vr[i], KIND, &number))                                                          \
                return status_of(c, 0);                                                                       \
            value[i] = (TYPE)number;                                                                          \
        }                                                                                                     \
        return fmi2OK;                                                                                        \
    }
#define SET(NAME, TYPE, KIND)                                                                                 \
    EXPORT fmi2Status fmi2Set##NAME(fmi2Component c, const fmi2ValueReference vr[], size_t n,                 \
                                    const TYPE value[])                                                       \
    {                                                                                                         \
        for (size_t i = 0; i < n; i++)                                                                        \
            if (!set_value(c, vr[i], KIND, (double)value[i]))                                                 \
                return status_of(c, 0);                                                                       \
        return fmi2OK;                                                                                        \
    }
GET(Real, fmi2Real, REAL)
GET(Integer, fmi2Integer, INTEGER)
GET(Boolean, fmi2Boolean, BOOLEAN)
SET(Real, fmi2Real, REAL)
SET(Integer, fmi2Integer, INTEGER)
SET(Boolean, fmi2Boolean, BOOLEAN)

EXPORT fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2String value[])
{
    (void)vr, (void)value;
    return n == 0 ? fmi2OK : not_supported(c);
}

EXPORT fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                const fmi2String value[])
{
    (void)vr, (void)value;
    return n == 0 ? fmi2OK : not_supported(c);
}

EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real communication_point, fmi2Real step_size,
                             fmi2Boolean no_state_prior)
{
    (void)no_state_prior;
    return status_of(c, step_instance(c, communication_point, step_size));
}

EXPORT fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    if (!CAN_SAVE)
        return not_supported(c);
    if (*state == NULL)
        *state = malloc(sizeof(State));
    if (*state == NULL)
        return status_of(c, fail(c, "there is no memory for the state"));
    memcpy(*state, &((Instance *)c)->state, sizeof(State));
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    if (!CAN_SAVE)
        return not_supported(c);
    memcpy(&((Instance *)c)->state, state, sizeof(State));
    return fmi2OK;
}

EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    if (!CAN_SAVE)
        return not_supported(c);
    free(*state);
    *state = NULL;
    return fmi2OK;
}

/* What the model description says this FMU cannot do. */
#define UNSUPPORTED(NAME, ...)                                                                                \
    EXPORT fmi2Status NAME(fmi2Component c, __VA_ARGS__) { return not_supported(c); }
#pragma GCC diagnostic ignored "-Wunused-parameter"
UNSUPPORTED(fmi2SerializedFMUstateSize, fmi2FMUstate state, size_t *size)
UNSUPPORTED(fmi2SerializeFMUstate, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
UNSUPPORTED(fmi2DeSerializeFMUstate, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
UNSUPPORTED(fmi2GetDirectionalDerivative, const fmi2ValueReference unknown[], size_t n_unknown,
            const fmi2ValueReference known[], size_t n_known, const fmi2Real dv_known[], fmi2Real dv_unknown[])
UNSUPPORTED(fmi2SetRealInputDerivatives, const fmi2ValueReference vr[], size_t n, const fmi2Integer order[],
            const fmi2Real value[])
UNSUPPORTED(fmi2GetRealOutputDerivatives, const fmi2ValueReference vr[], size_t n, const fmi2Integer order[],
            fmi2Real value[])
UNSUPPORTED(fmi2GetStatus, fmi2StatusKind kind, fmi2Status *value)
UNSUPPORTED(fmi2GetRealStatus, fmi2StatusKind kind, fmi2Real *value)
UNSUPPORTED(fmi2GetIntegerStatus, fmi2StatusKind kind, fmi2Integer *value)
UNSUPPORTED(fmi2GetBooleanStatus, fmi2StatusKind kind, fmi2Boolean *value)
UNSUPPORTED(fmi2GetStringStatus, fmi2StatusKind kind, fmi2String *value)
EXPORT fmi2Status fmi2CancelStep(fmi2Component c) { return not_supported(c); }

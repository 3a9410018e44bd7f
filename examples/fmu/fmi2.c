/* FMI 2.0 for co-simulation; what is not here is in unused.c. */
#include "fmi2Functions.h"
#include "wsp.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    Wsp wsp;
    const fmi2CallbackFunctions *callbacks;
    char name[64];
} Instance;

static fmi2Status checked(Instance *instance, bool succeeded)
{
    if (succeeded)
        return fmi2OK;
    instance->callbacks->logger(instance->callbacks->componentEnvironment, instance->name, fmi2Error,
                                "logStatusError", "%s", instance->wsp.error);
    return fmi2Error;
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
                              const fmi2CallbackFunctions *callbacks, fmi2Boolean visible,
                              fmi2Boolean logging)
{
    (void)resources, (void)visible, (void)logging;
    if (type != fmi2CoSimulation || strcmp(token, INSTANTIATION_TOKEN) != 0)
        return NULL;
    Instance *instance = calloc(1, sizeof *instance);
    if (instance == NULL)
        return NULL;
    instance->callbacks = callbacks;
    strncpy(instance->name, name, sizeof instance->name - 1);
    wsp_reset(&instance->wsp);
    return instance;
}

void fmi2FreeInstance(fmi2Component c)
{
    if (c != NULL)
        wsp_reset(&((Instance *)c)->wsp);
    free(c);
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String names[])
{
    (void)c, (void)on, (void)n, (void)names;
    return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean has_stop, fmi2Real stop)
{
    (void)c, (void)has_tolerance, (void)tolerance, (void)start, (void)has_stop, (void)stop;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    Instance *instance = c;
    return checked(instance, wsp_start(&instance->wsp));
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real size, fmi2Boolean no_earlier_state)
{
    Instance *instance = c;
    (void)no_earlier_state;
    return checked(instance, wsp_step(&instance->wsp, time, size));
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    wsp_reset(&((Instance *)c)->wsp);
    return fmi2OK;
}

#define SET(Type, ctype, place)                                                                             \
    fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference vr[], size_t n, const ctype values[]) \
    {                                                                                                       \
        for (size_t i = 0; i < n; i++) {                                                                    \
            if (place(&((Instance *)c)->wsp, vr[i]) == NULL)                                                \
                return fmi2Error;                                                                           \
            *place(&((Instance *)c)->wsp, vr[i]) = values[i];                                               \
        }                                                                                                   \
        return fmi2OK;                                                                                      \
    }

#define GET(Type, ctype, place)                                                                             \
    fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference vr[], size_t n, ctype values[])      \
    {                                                                                                       \
        for (size_t i = 0; i < n; i++) {                                                                    \
            if (place(&((Instance *)c)->wsp, vr[i]) == NULL)                                                \
                return fmi2Error;                                                                           \
            values[i] = *place(&((Instance *)c)->wsp, vr[i]);                                               \
        }                                                                                                   \
        return fmi2OK;                                                                                      \
    }

SET(Real, fmi2Real, wsp_number)
GET(Real, fmi2Real, wsp_number)
SET(Boolean, fmi2Boolean, wsp_whole)
GET(Boolean, fmi2Boolean, wsp_whole)
SET(Integer, fmi2Integer, wsp_whole)
GET(Integer, fmi2Integer, wsp_whole)

/* FMI 3.0 for co-simulation; what is not here is in unused.c. */
#include "fmi3Functions.h"
#include "wsp.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    Wsp wsp;
    fmi3LogMessageCallback log;
    fmi3InstanceEnvironment environment;
} Instance;

static fmi3Status checked(Instance *instance, bool succeeded)
{
    if (succeeded)
        return fmi3OK;
    if (instance->log != NULL)
        instance->log(instance->environment, fmi3Error, "logStatusError", instance->wsp.error);
    return fmi3Error;
}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean event_mode, fmi3Boolean early_return, const fmi3ValueReference intermediate[], size_t n,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)resources, (void)visible, (void)logging, (void)event_mode, (void)early_return;
    (void)intermediate, (void)n, (void)update;
    Instance *instance = strcmp(token, INSTANTIATION_TOKEN) == 0 ? calloc(1, sizeof *instance) : NULL;
    if (instance == NULL)
        return NULL;
    instance->log = log;
    instance->environment = environment;
    wsp_reset(&instance->wsp);
    return instance;
}

void fmi3FreeInstance(fmi3Instance c)
{
    if (c != NULL)
        wsp_reset(&((Instance *)c)->wsp);
    free(c);
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String names[])
{
    (void)c, (void)on, (void)n, (void)names;
    return fmi3OK;
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop)
{
    (void)c, (void)has_tolerance, (void)tolerance, (void)start, (void)has_stop, (void)stop;
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    Instance *instance = c;
    return checked(instance, wsp_start(&instance->wsp));
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 size, fmi3Boolean no_earlier_state,
                      fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last)
{
    Instance *instance = c;
    (void)no_earlier_state;
    *event = *terminate = *early = fmi3False;
    *last = time + size;
    return checked(instance, wsp_step(&instance->wsp, time, size));
}

fmi3Status fmi3Terminate(fmi3Instance c)
{
    (void)c;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance c)
{
    wsp_reset(&((Instance *)c)->wsp);
    return fmi3OK;
}

#define SET(Type, ctype, place)                                                                             \
    fmi3Status fmi3Set##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const ctype values[], \
                             size_t m)                                                                      \
    {                                                                                                       \
        for (size_t i = 0; i < n && i < m; i++) {                                                           \
            if (place(&((Instance *)c)->wsp, vr[i]) == NULL)                                                \
                return fmi3Error;                                                                           \
            *place(&((Instance *)c)->wsp, vr[i]) = values[i];                                               \
        }                                                                                                   \
        return fmi3OK;                                                                                      \
    }

#define GET(Type, ctype, place)                                                                             \
    fmi3Status fmi3Get##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t n, ctype values[],       \
                             size_t m)                                                                      \
    {                                                                                                       \
        for (size_t i = 0; i < n && i < m; i++) {                                                           \
            if (place(&((Instance *)c)->wsp, vr[i]) == NULL)                                                \
                return fmi3Error;                                                                           \
            values[i] = *place(&((Instance *)c)->wsp, vr[i]);                                               \
        }                                                                                                   \
        return fmi3OK;                                                                                      \
    }

SET(Float64, fmi3Float64, wsp_number)
GET(Float64, fmi3Float64, wsp_number)
SET(Boolean, fmi3Boolean, wsp_whole)
GET(Boolean, fmi3Boolean, wsp_whole)
SET(Int32, fmi3Int32, wsp_whole)
GET(Int32, fmi3Int32, wsp_whole)
